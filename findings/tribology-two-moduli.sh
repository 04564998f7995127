#!/usr/bin/env bash
# tribology 0.5.16: Hertz contacts, and viscosities from a rheometer's torque
#
# Guess: the effective modulus of `eeff` goes into each function that takes `e_eff`; what its documentation calls the
#   "outer diameter" of a rheometer's plate is a diameter.
# What happens: with `eeff` the radius of contact (`ahertz`) and the pressure (`phertz`) are Hertz's, the approach
#   `dhertz` is 0.63 of his. With the plate's diameter the viscosity is 16 times too small between plates and 8 times
#   with a cone, the torque as many times too large.
# Why: `eeff` returns twice Hertz's E*, which `ahertz` makes good by a factor of its own and `dhertz` does not: the
#   approach falls as the power -2/3. The formulae of the rheometer are those for the radius.
# Why it matters here: overlap and time of contact are those of the dry bounce beneath a film, and a sixteenth of the
#   viscosity is 16 times the Stokes number: what sticks is said to bounce.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'scipy==1.17.1' 'matplotlib==3.11.2' \
    'numexpr==2.14.2' 'opencv-python-headless==5.0.0.93' 'setuptools==80.9.0'
# its own list of requirements has NumPy 1.16 at most, which today's Python cannot install
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'tribology==0.5.16'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

from tribology import ahertz, dhertz, eeff, phertz, reff, viscrheomcone, viscrheomflat

RADIUS, YOUNG, POISSON = 1e-3, 210e9, 0.3  # steel spheres
modulus = YOUNG / (2 * (1 - POISSON**2))  # Hertz's E* of two equal spheres, and R* = R / 2
print("tribology", version("tribology"))
print(f"eeff / E* = {eeff(YOUNG, POISSON, YOUNG, POISSON) / modulus:.4f}")
print("force (N)   radius of contact / Hertz   mean pressure / Hertz   approach / Hertz")
for force in (0.1, 10.0, 1000.0):
    contact = (0.75 * force * RADIUS / 2 / modulus) ** (1 / 3)
    given = (*reff(*[RADIUS] * 4), eeff(YOUNG, POISSON, YOUNG, POISSON), force)
    radius = ahertz(*given)[0] / contact
    pressure = phertz(*given) / (force / math.pi / contact**2)
    approach = dhertz(eeff(YOUNG, POISSON, YOUNG, POISSON), *[RADIUS] * 4, force) / (contact**2 / (RADIUS / 2))
    print(f"{force:9g} {radius:27.4f} {pressure:23.4f} {approach:18.4f}")
    assert abs(radius - 1) < 1e-6 and abs(pressure - 1) < 1e-6, "changed: radius or pressure"
    assert abs(approach - 2 ** (-2 / 3)) < 1e-6, "changed: approach"
    assert abs(dhertz(modulus, *[RADIUS] * 4, force) / (2 * contact**2 / RADIUS) - 1) < 1e-6, "changed: with E*"

VISCOSITY, GAP, CONE, SPEED, PLATE = 0.1, 1e-3, math.radians(1), 10.0, 25e-3  # Pa s, m, rad, rad/s, the plate's radius
flat = math.pi * VISCOSITY * SPEED * PLATE**4 / (2 * GAP)
cone = 2 * math.pi * VISCOSITY * SPEED * PLATE**3 / (3 * CONE)
print("viscosity / true     with the diameter   with the radius")
for name, function, torque, opening, ratio in (
    ("plate and plate", viscrheomflat, flat, GAP, 16),
    ("cone and plate", viscrheomcone, cone, CONE, 8),
):
    wide, narrow = (function(torque, opening, SPEED, length) / VISCOSITY for length in (2 * PLATE, PLATE))
    print(f"{name:15s} {wide:22.4f} {narrow:17.4f}")
    assert "outer diameter" in function.__doc__ and math.isclose(wide, 1 / ratio), "changed: diameter"
    assert math.isclose(narrow, 1), "changed: radius"
PY
