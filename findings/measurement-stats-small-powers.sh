#!/usr/bin/env bash
# measurement-stats 0.3.0: powers of small numbers
#
# Guess: a film of 5 +- 0.1 micrometres, in metres, has the square 2.5e-11 +- 1e-12 square metres, as x * x has.
# What happens: its square is 5e-6 +- 1e-7, the number itself, and so are its root, its cube, its power -1 and its power
#   0. Below 1e-5 each power of a number is the number; from 1e-5 on it is right. In micrometres or millimetres the
#   same length is right. No message.
# Why: zero, whose relative uncertainty does not exist, is returned as it is, and numbers count as zero within a fixed
#   1e-5, which is not said.
# Why it matters here: films, gaps and roughnesses in metres are below 1e-5. A film force with the gap to the power -3
#   is too small by the fourth power of the gap, 1e-21 of itself. Take micrometres, or write x * x.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'measurement-stats==0.3.0' \
    'numpy==2.4.6' 'scipy==1.17.1' 'six==1.17.0'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

from measurement_stats import ValueUncertainty

POWERS = (2, 0.5, 3, -1, 0)
print("measurement-stats", version("measurement-stats"))
print("thickness            " + "".join(f"   power {power:<12g}" for power in POWERS) + "   x * x")
for micrometres, unit, scale, kept in (
    (5, "m", 1e-6, True),
    (9.9, "m", 1e-6, True),
    (10.1, "m", 1e-6, False),
    (5, "mm", 1e-3, False),
    (5, "micrometres", 1, False),
):
    value, deviation = micrometres * scale, 0.1 * scale
    x = ValueUncertainty(value, deviation)
    found = [x**power for power in POWERS]
    square = x * x
    print(f"{value:<9.3g} {unit:11s}" + "".join(f"{y.raw:10.3g} +- {y.raw_uncertainty:<7.2g}" for y in found), end="")
    print(f"{square.raw:10.3g}")
    assert math.isclose(square.raw, value**2), "the product"
    for power, result in zip(POWERS, found):
        right = value**power, abs(power) * value ** (power - 1) * deviation
        expected = (value, deviation) if kept else right
        assert all(map(math.isclose, (result.raw, result.raw_uncertainty), expected)), f"changed: power {power}"
        assert kept == (not math.isclose(result.raw, right[0])), "powers"
PY
