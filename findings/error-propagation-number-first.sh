#!/usr/bin/env bash
# error-propagation 0.0.4, measurement-stats 0.3.0: a plain number before an uncertain one
#
# Guess: 1 - e^2 of a restitution of 0.5 +- 0.01 is 0.75 +- 0.01; 2 mm at 0.5 +- 0.01 mm/ms take 4 +- 0.08 ms.
# What happens: error-propagation takes the number away from the power, -0.75 +- 0.01, and both divide the speed by the
#   distance, 0.25 +- 0.005. Sums and products are right, and so is everything between two uncertain numbers, with the
#   number wrapped as one of uncertainty 0. measurement-stats subtracts rightly. No message.
# Why: the methods for a number on the left call those for a number on the right, which makes no difference for sums
#   and products only.
# Why it matters here: the share of energy that a bounce loses is 1 - e^2, the time to touch is the gap over the speed,
#   and one of the two is often exact. Wrap the number: `Complex(1, 0)`, `ValueUncertainty(2, 0)`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'error-propagation==0.0.4' \
    'measurement-stats==0.3.0' 'numpy==2.4.6' 'scipy==1.17.1' 'six==1.17.0'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

from error_propagation import Complex
from measurement_stats import ValueUncertainty

DISTANCE = 2  # mm
LIBRARIES = {
    "error-propagation": (Complex, lambda x: (x.value, x.error), (-0.75, 0.01)),
    "measurement-stats": (ValueUncertainty, lambda x: (x.raw, x.raw_uncertainty), (0.75, 0.01)),
}
TIME = (0.25, 0.005)  # the speed over the distance, by both

for name, (number, parts, loss) in LIBRARIES.items():
    x = number(0.5, 0.01)  # restitution, or mm/ms
    one, distance = number(1, 0), number(DISTANCE, 0)
    print(name, version(name), "- x is 0.5 +- 0.01")
    for text, found, expected in (
        ("1 - x^2", 1 - x**2, loss),
        ("1 wrapped - x^2", one - x**2, (0.75, 0.01)),
        ("2 / x", DISTANCE / x, TIME),
        ("2 wrapped / x", distance / x, (4, 0.08)),
        ("1 + x", 1 + x, (1.5, 0.01)),
        ("2 x", DISTANCE * x, (1, 0.02)),
    ):
        value, deviation = parts(found)
        print(f"  {text:16s} {value:7.3f} +- {deviation:.3f}")
        assert all(map(math.isclose, (value, deviation), expected)), f"changed: {text} of {name}"
PY
