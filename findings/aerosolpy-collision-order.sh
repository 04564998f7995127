#!/usr/bin/env bash
# aerosolpy 1.0.2: how often particles of two sizes collide
#
# Guess: the coagulation kernel of a particle of 10 nm with one of 100 nm is that of one of 100 with one of 10.
# What happens: it depends on which is named first: by 4 % for 10 and 100 nm, by 28 % for 2 and 500, and both values
#   are above Fuchs's kernel that is cited, by 12 and 7 %, by 58 and 102 %. Equal sizes agree with it to 1e-6. The
#   mobility of a charged particle is 0.43 % too large.
# Why: both of Fuchs's lengths are computed with the mean free path of the other particle in one of their places. The
#   elementary charge is given as 1.609e-19 C.
# Why it matters here: how often two grains meet and what a meeting does to them are the two halves of growth; an error
#   of the first is read as one of the second, as a chance to stick above 1.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'aerosolpy==1.0.2' 'numdifftools==0.11.2' \
    'numpy==2.4.6' 'pandas==2.3.3' 'python-dateutil==4.0.0' 'pytz==2026.6' 'scipy==1.17.1' \
    'six==1.17.0' 'tzdata==2026.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from aerosolpy.kinetics import AerosolKinetics
from scipy.constants import elementary_charge

BOLTZMANN, DENSITY = 1.380658e-23, 1000.0  # as the package has it; kg/m^3
air = AerosolKinetics()


def fuchs(*sizes):
    """Fuchs's kernel for two diameters in nm, as in table 13.1 of Seinfeld and Pandis, with the package's diffusion."""
    diameter = 1e-9 * np.array(sizes, dtype=float)
    diffusion = air.diff_coeff_p(np.array(sizes, dtype=float))
    speed = np.sqrt(8 * BOLTZMANN * air.temp_kelvin / np.pi / (DENSITY * np.pi / 6 * diameter**3))
    path = 8 * diffusion / np.pi / speed
    away = np.sqrt(2) / (3 * diameter * path) * ((diameter + path) ** 3 - (diameter**2 + path**2) ** 1.5) - diameter
    both, spread = diameter.sum(), diffusion.sum()
    slowed = both / (both + 2 * np.hypot(*away)) + 8 * spread / (np.hypot(*speed) * both)
    return 2 * np.pi * spread * both / slowed


print("aerosolpy", version("aerosolpy"), "- coagulation kernels over Fuchs's, by the order of the two particles")
ratios = {}
for one, other in ((10, 10), (1000, 1000), (1, 10), (10, 100), (10, 1000), (2, 500), (50, 5000)):
    exact = fuchs(one, other)
    assert abs(fuchs(other, one) / exact - 1) < 1e-12, "Fuchs's kernel is symmetric"
    ratios[one, other] = found = [float(air.coll_kernel_pp(*pair)) / exact for pair in ((one, other), (other, one))]
    print(f"{one:5d} and {other:5d} nm: {exact:.3e} m^3/s, {found[0]:.4f} and {found[1]:.4f}")
assert abs(np.array([ratios[10, 10], ratios[1000, 1000]]) - 1).max() < 1e-5, "equal sizes"
assert ratios[10, 100][0] / ratios[10, 100][1] > 1.03 and ratios[2, 500][1] / ratios[2, 500][0] > 1.2, "changed: order"
assert min(ratios[2, 500]) > 1.5 and min(ratios[10, 100]) > 1.05, "changed: kernels"

mobility = elementary_charge * air.slipcorr(100.0) / (3 * np.pi * air.airvisc * 100e-9)
print(f"mobility of 100 nm with one charge: {air.dp_to_zp(100.0) / mobility:.4f} of e C / (3 pi mu d)")
assert abs(air.dp_to_zp(100.0) / mobility - 1.0043) < 2e-4, "changed: the charge"
PY
