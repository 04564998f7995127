#!/usr/bin/env bash
# Adhesion 0.93: the adhesive contact of a sphere (JKR), in different units
#
# Guess: the force at a penetration is the same in each consistent set of units, with the largest tension of 3/2 pi w R
#   where the sphere is drawn off. `peak_pressure` is a pressure, without adhesion that of Hertz.
# What happens: in newtons and metres the force of a bead of 1 mm is right. In millinewtons and micrometres, which make
#   moduli gigapascals, a rubber bead that is drawn has the force 0: it does not stick at all. In newtons and metres
#   again, a glass bead of 10 micrometres is up to 31 % off, one of a micrometre has a fifth of its largest tension.
#   `peak_pressure` of a glass bead pressed with 1 N is 2.7e-5, in fact a length, for 0.62 GPa; without adhesion it is
#   the radius of contact.
# Why: the radius of the contact where the sphere comes off is multiplied by the modulus where it should be divided, so
#   that it is right only where the reduced modulus is 1. Newton's iteration starts there, and ends at steps of 1.5e-8,
#   whatever the unit of length is. `peak_pressure` is the other root of the contact radius's equation.
# Why it matters here: this force decides whether soft or fine beads stay together after a slow impact. Take units in
#   which the contact is about 1 wide and the modulus at least 1; the pressure is in `stress_distribution`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'Adhesion==0.93' 'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import importlib.util
from importlib.metadata import distribution

import numpy as np

# the whole package needs six others, this file of it does not
package = distribution("Adhesion")
spec = importlib.util.spec_from_file_location("JKR", package.locate_file("Adhesion/ReferenceSolutions/JKR.py"))
JKR = importlib.util.module_from_spec(spec)
spec.loader.exec_module(JKR)

WORK = 0.05  # J/m^2
UNITS = {"N, m": (1.0, 1.0), "mN, mm": (1e-3, 1e-3), "mN, um": (1e-3, 1e-6)}  # of force and length
BEADS = {  # radius in m, modulus in Pa
    "glass 1 mm": (1e-3, 35e9),
    "glass 10 um": (1e-5, 35e9),
    "glass 1 um": (1e-6, 35e9),
    "rubber 1 mm": (1e-3, 1e6),
}
DRAWN = np.array([1.1, 1.5, 9 ** (1 / 3)])  # radius of contact over that at the tear; the last has the largest tension


def exact(radius, modulus):
    """Penetrations in m and forces in N of the theory, from the radius of contact."""
    contact = DRAWN * (np.pi * WORK * radius**2 / 8 / modulus) ** (1 / 3)
    penetration = contact**2 / radius - np.sqrt(2 * np.pi * WORK * contact / modulus)
    return penetration, 4 * modulus * contact**3 / 3 / radius - np.sqrt(8 * np.pi * WORK * modulus * contact**3)


print("Adhesion", package.version, "- forces over pi w R, at three places from the tear to the largest tension")
print(f"{'bead':13s}{'units':8s}{'modulus':>9s}{'':4s}{'found':28s}{'exact':28s}")
worst = {}
for bead, (radius, modulus) in BEADS.items():
    penetration, force = exact(radius, modulus)
    for units, (one_force, one_length) in UNITS.items():
        found = np.array([
            JKR.force(
                penetration=each / one_length,
                radius=radius / one_length,
                contact_modulus=modulus / one_force * one_length**2,
                work_of_adhesion=WORK / one_force * one_length,
            )
            for each in penetration
        ]) * one_force  # fmt: skip
        worst[bead, units] = abs(found / force - 1).max()
        texts = (" ".join(f"{value / np.pi / WORK / radius:8.4f}" for value in each) for each in (found, force))
        print(f"{bead:13s}{units:8s}{modulus / one_force * one_length**2:9.2g}    {'  '.join(texts)}")
assert all(worst[bead, "mN, mm"] < 0.01 for bead in BEADS), "in millinewtons and millimetres"
assert worst["glass 1 mm", "N, m"] < 0.01 and worst["rubber 1 mm", "N, m"] < 0.01, "beads of a millimetre"
assert worst["rubber 1 mm", "mN, um"] == 1, "changed: force 0"
assert worst["glass 10 um", "N, m"] > 0.1 and worst["glass 1 um", "N, m"] > 0.2, "changed: fine beads"

radius, modulus = BEADS["glass 1 mm"]
print("peak pressure of the glass bead of 1 mm in GPa: exact, and what `peak_pressure` gives")
for load, adhesion in ((1.0, WORK), (1.0, 0.0), (0.01, WORK)):
    given = {"radius": radius, "contact_modulus": modulus, "work_of_adhesion": adhesion}
    found, contact = JKR.peak_pressure(force=load, **given), JKR.contact_radius(force=load, **given)
    pressure = 2 * modulus * contact / np.pi / radius - np.sqrt(2 * modulus * adhesion / np.pi / contact)
    middle = -JKR.stress_distribution(np.array([1e-6 * contact]), contact, radius, modulus, adhesion)[0]
    assert abs(middle / pressure - 1) < 1e-6, "the pressure in the middle"
    print(f"{load:5g} N, {adhesion:4g} J/m^2: {pressure / 1e9:.4f} {found / 1e9:12.2g}")
    assert found < 1e-4, "changed: peak_pressure"
PY
