#!/usr/bin/env bash
# unitful 1.1.0: NumPy's functions on lengths in different units
#
# Guess: `np.add(1 m, 500 mm)` is 1.5 m as 1 m + 500 mm is, and the sine of 30 degrees is 0.5; what cannot be done is a
#   `DimensionError`, as promised, never a silently wrong result.
# What happens: it is 501 m, for numbers and for arrays, and `np.subtract` gives -499 m. `np.maximum` says 500 m and
#   `np.hypot` 500.001 m, and both take a length and a time; 1 m is less than 500 mm; the logarithm of 500 mm over 1 m
#   is 6.2, the sine of 30 degrees -0.988 degrees, the square of 2 m is 4 m and its reciprocal 0.5 m. The operators +
#   and - are right, and so is `np.multiply`. No message.
# Why: the functions are computed with the bare numbers, and the result gets the first one's unit; for sums alone the
#   dimensions are compared before, but nothing is converted.
# Why it matters here: gaps in micrometres stand beside radii in millimetres. The distance of two centres by
#   `np.hypot`, the largest overlap by `np.maximum` and the logarithm of film over roughness are wrong by powers of
#   ten, with a unit. Write operators, or bring all to one unit before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'unitful==1.1.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from unitful import deg, m, mm, s

long, short = 1 * m, 500 * mm
longs, shorts = np.array([1.0, 2.0]) * m, np.array([500.0, 500.0]) * mm


def shown(result):
    return f"{np.round(np.atleast_1d(result.magnitude), 4)} {result.unit.symbol}"


print("unitful", version("unitful"), "- 1 m and 500 mm")
for name, result, value, unit, right in (
    ("1 m + 500 mm", long + short, 1.5, "m", "1.5 m"),
    ("arrays, +", longs + shorts, [1.5, 2.5], "m", "1.5, 2.5 m"),
    ("np.add", np.add(long, short), 501, "m", "1.5 m"),
    ("np.add, arrays", np.add(longs, shorts), [501, 502], "m", "1.5, 2.5 m"),
    ("np.subtract", np.subtract(long, short), -499, "m", "0.5 m"),
    ("np.maximum", np.maximum(long, short), 500, "m", "1 m"),
    ("np.hypot", np.hypot(long, short), math.hypot(1, 500), "m", "1.118 m"),
    ("np.less", np.less(long, short), 1, "m", "false"),
    ("np.log(short / long)", np.log(short / long), math.log(500), "mm/m", "-0.6931"),
    ("np.sin(30 deg)", np.sin(30 * deg), math.sin(30), "deg", "0.5"),
    ("np.square(2 m)", np.square(2 * m), 4, "m", "4 square metres"),
    ("np.reciprocal(2 m)", np.reciprocal(2 * m), 0.5, "m", "0.5 per metre"),
    ("np.maximum(1 m, 2 s)", np.maximum(1 * m, 2 * s), 2, "m", "an error"),
):
    print(f"{name:22s} {shown(result):20s} right: {right}")
    assert np.allclose(result.magnitude, value, rtol=1e-12), f"changed: {name}"
    assert result.unit.symbol == unit, f"changed: unit of {name}"
area = np.multiply(long, short).to(m * m)
print(f"np.multiply            {shown(area)}")
assert math.isclose(area.magnitude, 0.5), "product"
PY
