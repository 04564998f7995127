"""Two spheres in LIGGGHTS: `REFEREE_JOB=job.json python in_liggghts.py` writes the results beside the job.

Any Python 3 runs it; `REFEREE_LIGGGHTS` names the program (Debian: liggghts). Meaning of the parameters: the pages
`gran model hertz`, `gran model hooke` and `gran cohesion easo/capillary/viscous` of LIGGGHTS's manual, and
src/cohesion_model_easo_capillary_viscous.h and src/normal_model_hooke.h.
"""

import json
import math
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

EVERY = 5  # steps between records


def easo(law: dict[str, Any]) -> str:
    """Damped Hertzian contact, and a bridge with viscosity from contact to rupture."""
    return f"""
fix p1 all property/global coefficientRestitution peratomtypepair 1 {law["restitution"]}
fix p2 all property/global minSeparationDistanceRatio scalar {law["min_separation"]}
fix p3 all property/global maxSeparationDistanceRatio scalar {law["max_separation"]}
fix p4 all property/global surfaceLiquidContentInitial scalar {law["liquid_content"]}
fix p5 all property/global surfaceTension scalar {law["surface_tension"]}
fix p6 all property/global fluidViscosity scalar {law["viscosity"]}
fix p7 all property/global contactAngle peratomtype {law["contact_angle"]}
pair_style gran model hertz tangential no_history cohesion easo/capillary/viscous
"""


def viscous(law: dict[str, Any]) -> str:
    """Linear contact whose damping depends on the Stokes number of the moment."""
    return f"""
fix p1 all property/global characteristicVelocity scalar {law["speed"]}
fix p2 all property/global FluidViscosity peratomtypepair 1 {law["viscosity"]}
fix p3 all property/global CriticalStokes peratomtypepair 1 {law["critical_stokes"]}
fix p4 all property/global MaximumRestitution peratomtypepair 1 {law["maximum_restitution"]}
pair_style gran model hooke tangential no_history viscous on
"""


LAWS = {"easo": easo, "viscous": viscous}


def records(path: Path) -> Iterator[tuple[list[float], list[float], float, float]]:
    """(position, velocity, spins) of the pair, record by record."""
    lines = path.read_text().splitlines()
    for start in range(0, len(lines), 11):  # nine lines of head, two of atoms
        low, top = sorted([float(word) for word in line.split()] for line in lines[start + 9 : start + 11])
        yield [b - a for a, b in zip(low[1:4], top[1:4])], [b - a for a, b in zip(low[4:7], top[4:7])], low[7], top[7]


def collide(job: dict[str, Any], speed: float, tangential: float, dt: float) -> tuple[str, dict[str, Any]]:
    """LIGGGHTS's version, and of one collision the state at the first record beyond the end."""
    law = job["parameters"]
    box = 10 * (law["radius"] + job["end"])
    half = law["radius"] + job["start"] / 2
    steps = EVERY * math.ceil(job["longest"] / dt / EVERY)
    Path("in.referee").write_text(f"""
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
hard_particles yes
region all block {-box} {box} {-box} {box} {-box} {box} units box
create_box 1 all
neighbor {law["radius"]} bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {law["youngs_modulus"]}
fix m2 all property/global poissonsRatio peratomtype {law["poisson_ratio"]}
fix m3 all property/global coefficientFriction peratomtypepair 1 0.0
{LAWS[job["law"]](law)}
pair_coeff * *
timestep {dt!r}
create_atoms 1 single {-half!r} 0 0 units box
create_atoms 1 single {half!r} 0 0 units box
set atom 1 diameter {2 * law["radius"]!r} density {law["density"]!r} vx {speed / 2!r} vy {-tangential / 2!r}
set atom 2 diameter {2 * law["radius"]!r} density {law["density"]!r} vx {-speed / 2!r} vy {tangential / 2!r}
fix moves all nve/sphere
thermo_modify lost ignore
dump records all custom {EVERY} referee.dump id x y z vx vy vz omegaz
dump_modify records format "%d %.15g %.15g %.15g %.15g %.15g %.15g %.15g" sort id
run {steps}
""")
    program = os.environ.get("REFEREE_LIGGGHTS", "liggghts")
    done = subprocess.run([program, "-in", "in.referee", "-log", "none"], capture_output=True, text=True, check=False)
    if done.returncode or "ERROR" in done.stdout:
        raise SystemExit(done.stdout[-1500:] + done.stderr[-500:])
    smallest, version = math.inf, done.stdout.partition("(Version ")[2].partition(",")[0]
    for step, (apart, moving, spin, partner) in enumerate(records(Path("referee.dump"))):  # noqa: B007 -- the last too
        gap = math.hypot(*apart) - 2 * law["radius"]
        smallest = min(smallest, gap)
        if gap > job["end"] and sum(a * b for a, b in zip(apart, moving)) > 0:
            break
    return version, {
        "position": apart, "velocity": moving, "spin": spin, "partner_spin": partner, "time": step * EVERY * dt,
        "smallest_gap": smallest, "touched": smallest <= 0,
    }  # fmt: skip


def main() -> None:
    """Run the job."""
    path = Path(os.environ["REFEREE_JOB"])
    job = json.loads(path.read_text())
    answers = [collide(job, *impact) for impact in job["collisions"]]
    answer = {"version": answers[0][0], "found": [state for _, state in answers]}
    path.with_suffix(".out.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    main()
