#!/usr/bin/env bash
# physlab 1.0.8: powers of negative numbers, products with zero
#
# Guess: the square of a rebound of -2 +- 0.001 m/s is 4 +- 0.004; a speed of 0 +- 0.02 m/s times a mass of 5 +- 0.1 g
#   is 0 +- 0.1.
# What happens: 4 +- 0.4 and 0 +- 0. A power of a negative number has a tenth of itself as uncertainty, whatever that of
#   the number is, also where it is exact; a product or quotient in which a factor is 0 is exact. In a list this is so
#   element by element. Products of negative numbers, and those of 0 with a plain number, are right. No message.
# Why: the formulae for relative uncertainties are infinite or not a number there, and wherever that happens, a tenth of
#   the result is taken, of 0 so 0. No page says so.
# Why it matters here: a rebound is negative, and its square is the energy that is left, here with a hundred times its
#   uncertainty. Spheres that stick have a relative speed of 0, and with it a momentum that is exact. Take powers of the
#   absolute value.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'physlab==1.0.8' 'numpy==2.4.6' \
    'matplotlib==3.11.2'
cd "$work"
MPLBACKEND=agg "$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

from physlab import phys

impact, rebound, exact = phys(2.0, 0.001), phys(-2.0, 0.001), phys(-2.0, 0.0)  # m/s
sticking, mass = phys(0.0, 0.02), phys(5.0, 0.1)  # m/s, g
print("physlab", version("physlab"))
print("                                         found                 true")
for text, found, value, wrong, true in (
    ("(2 +- 0.001)^2", impact**2, 4, 0.004, 0.004),
    ("(-2 +- 0.001)^2", rebound**2, 4, 0.4, 0.004),
    ("(-2 +- 0)^2", exact**2, 4, 0.4, 0),
    ("(-2 +- 0.001)^3", rebound**3, -8, 0.8, 0.012),
    ("(2 +- 0.001) (5 +- 0.1)", impact * mass, 10, math.hypot(0.2, 0.005), math.hypot(0.2, 0.005)),
    ("(-2 +- 0.001) (5 +- 0.1)", rebound * mass, -10, math.hypot(0.2, 0.005), math.hypot(0.2, 0.005)),
    ("(0 +- 0.02) (5 +- 0.1)", sticking * mass, 0, 0, 0.1),
    ("(0 +- 0.02) / (5 +- 0.1)", sticking / mass, 0, 0, 0.004),
    ("(0 +- 0.02) * 5", sticking * 5, 0, 0.1, 0.1),
):
    print(f"{text:30s} {found.value:12.4g} +- {found.sigma:.4g}".ljust(58) + f"{value:6.4g} +- {true:.4g}")
    assert math.isclose(found.value, value) and math.isclose(found.sigma, wrong), f"changed: {text}"
speeds = phys([2.0, -2.0, 0.5], 0.001) ** 2
print("squares of 2, -2 and 0.5, each +- 0.001:", *(f"{x:.4g} +- {s:.2g}" for x, s in zip(speeds.value, speeds.sigma)))
assert [round(float(s), 6) for s in speeds.sigma] == [0.004, 0.4, 0.001], "changed: a list"
PY
