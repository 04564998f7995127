#!/usr/bin/env bash
# quantities 0.16.4: numbers with units and uncertainties under roots, exponentials and negative powers
#
# Guess: the restitution of a ball dropped from 1 m that rises to 0.25 m, each +- 1 cm, is 0.5 +- 0.01, whether it is
#   written as `np.sqrt(rise / fall)` or as a power 0.5; no uncertainty is negative.
# What happens: the root is 0.5 +- 0, exact, and all that is computed from it is as certain. So it is with `np.exp`,
#   `np.log`, `np.sin`, `np.square` and `abs`. The power 0.5 has +- 0.01 and the power -0.5 has -0.04. Sums,
#   products and quotients are right.
# Why: only some functions know how an uncertainty goes on. The result of the others starts with none, which is shown
#   and used as 0. A power multiplies by the exponent with its sign.
# Why it matters here: a root is in each restitution from heights, an exponential in each that a film has left, and a
#   fit weighted by such errors divides by 0 or counts one point alone. Write roots as powers, and take `abs` of the
#   uncertainty.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'quantities==0.16.4' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import numpy as np
import quantities as pq

fall, rise = pq.UncertainQuantity(1.0, pq.m, 0.01), pq.UncertainQuantity(0.25, pq.m, 0.01)
ratio = rise / fall
spread = 0.25 * math.hypot(0.01, 0.04)  # of the ratio
print("quantities", version("quantities"), "- of rise / fall = 0.25")
print("                     value    +-       true")
for name, found, slope, kind in (
    ("rise / fall", ratio, 1, "right"),
    ("3 rise / fall", 3 * ratio, 3, "right"),
    ("power 2", ratio**2, 0.5, "right"),
    ("np.square", np.square(ratio), 0.5, "none"),
    ("power 0.5", ratio**0.5, 1, "right"),
    ("np.sqrt", np.sqrt(ratio), 1, "none"),
    ("3 np.sqrt", 3 * np.sqrt(ratio), 3, "none"),
    ("np.exp", np.exp(ratio), math.exp(0.25), "none"),
    ("np.log", np.log(ratio), 4, "none"),
    ("np.sin", np.sin(ratio), math.cos(0.25), "none"),
    ("abs", abs(ratio), 1, "none"),
    ("power -0.5", ratio**-0.5, 4, "negative"),
    ("power -1", ratio**-1, 16, "negative"),
):
    value, deviation, true = float(found.magnitude), float(found.uncertainty.magnitude), spread * slope
    print(f"{name:16s} {value:9.4f} {deviation:8.4f} {true:8.4f}")
    expected = {"right": true, "none": 0.0, "negative": -true}[kind]
    assert math.isclose(deviation, expected, abs_tol=1e-12), f"changed: {name}"
PY
