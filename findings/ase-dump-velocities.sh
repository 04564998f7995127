#!/usr/bin/env bash
# ase 3.29.0: velocities, radii and spins of LAMMPS dumps
#
# Guess: `ase.io.read(..., format="lammps-dump-text")` returns the columns of the file: positions, velocities, and
#   the further ones (radius, omega) as arrays.
# What happens: positions are those of the file, velocities are divided by 98.2: a grain that moves by 0.45 mm within
#   a millisecond has a velocity of 0.00458. Radius and omega are gone, each grain is a hydrogen atom, and the
#   kinetic energy is that of atoms. With `units="si"` the velocity is right in ASE's own units (and positions are
#   multiplied by 10^10); `units="lj"`, in which many granular decks run, is an error.
# Why: a dump does not say its units; the reader assumes "metal" (Angstrom, picoseconds), and converts velocities to
#   ASE's time unit. Its default for positions is a conversion by 1, so that nothing is noticed.
# Why it matters here: speeds from two frames and speeds from the column disagree by 98; their *ratios* (restitution)
#   are right, so that only Stokes numbers are off.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'ase==3.29.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import ase
import ase.io
import ase.units

FRAME = """ITEM: TIMESTEP
{step}
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS ff ff ff
-0.0015 0.0015
-0.0001 0.0001
-0.0001 0.0001
ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius
1 1 0.001 0 0 0 0 0 0 0 5 0.00005
2 1 {place} 0 0 -0.45 0 0 0 0 7 0.00005
"""
with open("grains.dump", "w") as dump:
    for frame in range(3):
        dump.write(FRAME.format(step=1000 * frame, place=-0.00045 * frame))  # frames a millisecond apart

frames = ase.io.read("grains.dump", ":", format="lammps-dump-text")
travelled = (frames[1].positions - frames[0].positions)[1, 0] / 1e-3
column = frames[0].get_velocities()[1, 0]
si = ase.io.read("grains.dump", 0, format="lammps-dump-text", units="si").get_velocities()[1, 0]
metres_a_second = si / (ase.units.m / ase.units.s)
print("ase", ase.__version__)
print(f"velocity from two frames {travelled:.4f}, from the column {column:.6f}: ratio {travelled / column:.2f}")
print(f'with units="si", converted back by ase.units: {metres_a_second:.4f} m/s')
print(f"what is kept: {sorted(frames[0].arrays)}; symbols {frames[0].get_chemical_formula()}")
try:
    ase.io.read("grains.dump", 0, format="lammps-dump-text", units="lj")
    refused = False
except KeyError as error:
    refused = True
    print(f'units="lj": KeyError {error}')
assert abs(travelled + 0.45) < 1e-9, "the dump itself"
assert 98.1 < travelled / column < 98.3, "changed: velocities"
assert abs(metres_a_second + 0.45) < 1e-6, 'changed: units="si"'
assert not {"radius", "omegaz"} & set(frames[0].arrays), "changed: radius and omega"
assert refused, 'changed: units="lj"'
PY
