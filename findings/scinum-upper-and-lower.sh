#!/usr/bin/env bash
# scinum 2.2.2: what is subtracted or divided by, with unequal uncertainties up and down
#
# Guess: a diameter of 1 mm, +0.03 or -0.01, taken from a distance of 1.02 mm leaves a gap of 0.02 mm, +0.01 or -0.03:
#   what is larger makes the gap smaller.
# What happens: the gap is 0.02 mm, +0.03 or -0.01, from 0.01 to 0.05 mm. Wherever a function falls, upper and lower
#   uncertainty stay where they were: of -x, a - x, a / x, exp(-x), cos(x). Two falling steps, 5 - (5 - x), are right.
# Why: an uncertainty is carried on by the magnitude of the derivative; its sign is used for correlations between the
#   sources of two numbers only.
# Why it matters here: gaps and rebounds are differences and quotients, and sizes in pixels are seldom known equally
#   well to both sides. Here spheres that may touch are apart beyond doubt. Evaluate the function at both ends.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'scinum==2.2.2' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from scinum import Number, ops

x = Number(1.0, {"diameter": (0.03, 0.01)})  # mm, up and down
DISTANCE = 1.02  # mm
CASES = [
    ("x", x, lambda x: x, True),
    ("2 x - 1", 2 * x - 1, lambda x: 2 * x - 1, True),
    ("x^2", x**2, lambda x: x**2, True),
    ("5 - (5 - x)", 5 - (5 - x), lambda x: x, True),
    ("-x", -x, lambda x: -x, False),
    ("gap, 1.02 - x", DISTANCE - x, lambda x: DISTANCE - x, False),
    ("1 / x", 1 / x, lambda x: 1 / x, False),
    ("exp(-x)", ops.exp(-x), lambda x: np.exp(-x), False),
    ("cos(x)", ops.cos(x), np.cos, False),
]
print("scinum", version("scinum"), "- of x from 0.99 to 1.03, 1 most likely")
print("function          range by scinum      range")
for name, number, function, right in CASES:
    found = number.get("down"), number.get("up")
    exact = sorted((function(0.99), function(1.03)))
    print(f"{name:14s}" + "".join(f"{low:9.4f} to {high:7.4f}" for low, high in (found, exact)))
    nominal = function(1.0)
    exchanged = 2 * nominal - exact[1], 2 * nominal - exact[0]
    assert np.allclose(found, exact if right else exchanged, atol=1e-3), f"changed: {name}"
gap = DISTANCE - x
assert gap.get("down") > 0.009 and DISTANCE - 1.03 < 0, "changed: the gap"
PY
