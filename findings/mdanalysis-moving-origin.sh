#!/usr/bin/env bash
# MDAnalysis 2.11.0: positions of LAMMPS dumps with a shrink-wrapped box ("boundary s", usual for grains)
#
# Guess: the reader of dumps returns the positions of the file, perhaps in single precision.
# What happens: it subtracts the lower corner of the box from each position, frame by frame. Where the box is
#   shrink-wrapped the corner follows the outermost grain, which therefore stands still, and a grain at rest moves
#   as fast the other way. Here, with frames a millisecond apart, one grain rests and one flies at -0.45 m/s: read
#   back, the first flies at +0.45 m/s and the second rests. (Velocities that the file has are left as they are.) No
#   message.
# Why: since version 2.4 the reader "translates the box to the origin": for a box of constant bounds a constant
#   shift.
# Why it matters here: speeds before and after an impact that are differences of positions change from grain to
#   grain. ASE returns what the file has. Add the corner again, or dump with a box of constant bounds.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'MDAnalysis==2.11.0' 'ase==3.29.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import ase
import ase.io
import MDAnalysis
import numpy as np

FRAME = """ITEM: TIMESTEP
{step}
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS ss ss ss
{low} 0.0015
-0.0001 0.0001
-0.0001 0.0001
ITEM: ATOMS id type x y z vx vy vz radius
1 1 0.001 0 0 0 0 0 0.00005
2 1 {place} 0 0 -0.45 0 0 0.00005
"""
places = np.array([0.0, -0.00045, -0.0009])
with open("grains.dump", "w") as dump:
    for frame, place in enumerate(places):
        dump.write(FRAME.format(step=1000 * frame, low=place - 0.00005, place=place))

resting, flying = np.full(3, 0.001), places
universe = MDAnalysis.Universe("grains.dump", format="LAMMPSDUMP")
shifted = np.array([universe.atoms.positions[:, 0].astype(float) for _ in universe.trajectory])
plain = np.array([atoms.positions[:, 0] for atoms in ase.io.read("grains.dump", ":", format="lammps-dump-text")])
print("x of the two grains in three frames [mm]")
print(f"file                 resting {resting * 1e3}   flying {flying * 1e3}")
print(f"ASE {ase.__version__}           resting {plain[:, 0] * 1e3}   flying {plain[:, 1] * 1e3}")
millimetres = shifted.round(8) * 1e3
print(f"MDAnalysis {MDAnalysis.__version__}    resting {millimetres[:, 0]}   flying {millimetres[:, 1]}")
assert np.allclose(plain, np.column_stack([resting, flying]), rtol=0, atol=1e-9), "changed: ASE"
assert np.allclose(np.diff(shifted[:, 0]), 0.00045, rtol=1e-3), "changed: the grain at rest"
assert np.allclose(np.diff(shifted[:, 1]), 0, atol=1e-8), "changed: the grain in flight"
PY
