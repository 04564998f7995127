#!/usr/bin/env bash
# binmod1d 1.0.10: which of two drops that collide coalesce, and into how many pieces others break
#
# Guess: `straub_efficiency` is the law of Straub and others (2010) it cites, exp(-1.15 We), and `Straub_params` has
#   their numbers of fragments: drops of 1 and 3 mm at their speeds of fall coalesce in 11 % of collisions, and the
#   others leave less than three fragments beside the rest. `long_kernel` is the same whichever drop is named first.
# What happens: 4e-112 in place of 11 %, 1e-42 for drops of 0.1 and 3 mm, of which 99 % do by that law: from 1 mm on
#   nothing coalesces. The number of fragments is 437. With Long's kernel a drop of 3 mm meets one of 0.05 mm 0.28
#   times as often as the one of 0.05 mm meets that of 3 mm. No message.
# Why: that law's Weber number is the energy of the collision over the surface energy of the drop that both would make,
#   1.9 here, as PySDM has it too; taken is density times diameter of the smaller drop times speed squared over surface
#   tension, 223. The efficiency of Long looks at the second drop for the larger one.
# Why it matters here: Weber numbers of several definitions, apart by a factor of a hundred, decide in the same way
#   whether wet particles stick. Compute the energies, and name the larger drop second.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'binmod1d==1.0.10' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from binmod1d.collection_kernels import Straub_params, hydro_kernel, long_kernel, straub_efficiency

DENSITY, TENSION = 1000.0, 0.0728  # kg/m3, N/m
SPEEDS = {0.05: 0.07, 0.1: 0.25, 0.3: 1.17, 0.5: 2.06, 1.0: 4.03, 2.0: 6.49, 3.0: 8.06}  # mm, m/s: water in air


def energies(one, other):
    """Energy of the collision in microjoules, and over the surface energy of one drop of both volumes."""
    cube, other_cube = (1e-3 * one) ** 3, (1e-3 * other) ** 3
    collision = math.pi / 12 * DENSITY * cube * other_cube / (cube + other_cube) * (SPEEDS[one] - SPEEDS[other]) ** 2
    return 1e6 * collision, collision / (math.pi * TENSION * (cube + other_cube) ** (2 / 3))


def arguments(one, other):
    return np.array([one]), np.array([other]), np.array([SPEEDS[one]]), np.array([SPEEDS[other]])


def efficiency(kernel, one, other):
    """Share of the collisions by size and speed alone that a kernel counts."""
    pair = arguments(one, other)
    areas = [math.pi / 4 * diameter**2 for diameter in pair[:2]]
    return float(kernel(*pair, *areas)[0, 0] / hydro_kernel(*pair[2:], *areas)[0, 0])


print("binmod1d", version("binmod1d"), "- drops of water at their speeds of fall")
print("diameters, mm      share that coalesces    by the law cited   Weber number of the law, of the smaller drop")
for one, other in ((0.3, 0.1), (1.0, 0.1), (1.0, 0.5), (2.0, 1.0), (3.0, 0.1), (3.0, 1.0)):
    found, weber = efficiency(straub_efficiency, one, other), energies(one, other)[1]
    taken = DENSITY * 1e-3 * min(one, other) * (SPEEDS[one] - SPEEDS[other]) ** 2 / TENSION
    print(f"{one:4g} and {other:4g} {found:20.1e} {math.exp(-1.15 * weber):20.3f} {weber:22.4f} {taken:18.1f}")
    assert math.isclose(found, math.exp(-1.15 * taken), rel_tol=1e-9), "changed: share that coalesces"
    assert found < 0.3 * math.exp(-1.15 * weber), "Weber numbers"

energy, weber = energies(3.0, 1.0)
found = Straub_params(*arguments(3.0, 1.0))
numbers = [float(found[part]["N"][0]) for part in ("dist1", "dist2", "dist3")]
product = energy * weber  # microjoules; below 21 there are no fragments of the second kind and one of the third
right = [0.088 * (3 * product - 7), 0.0, 1.0]
print("fragments of 3 and 1 mm: " + " ".join(f"{number:.1f}" for number in numbers), end="")
print(", by the law " + " ".join(f"{number:.1f}" for number in right))
assert 7 / 3 < product < 21, "the law's range"
assert sum(numbers) > 400 and sum(right) < 3, "changed: fragments"

for one, other in ((3.0, 0.05), (0.1, 0.05)):
    first, second = efficiency(long_kernel, one, other), efficiency(long_kernel, other, one)
    print(f"Long's kernel, {one:g} mm before {other:g} mm: {first:.3f}, after it: {second:.3f}")
    assert first < 0.3 < 0.9 < second, "changed: order of the drops"
PY
