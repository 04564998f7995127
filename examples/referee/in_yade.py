"""Two spheres in YADE: `REFEREE_JOB=job.json yade -n -x in_yade.py` writes the results beside the job.

Runs in YADE's own Python and needs nothing else. Meaning of the parameters: documentation of the classes in YADE (Class
reference, Lubrication and ViscoelasticCapillarPM) and, where that is silent, pkg/dem/Lubrication.cpp.
"""

import json
import os
from pathlib import Path
from typing import Any


def lubrication(law: dict[str, Any]) -> tuple[Any, Any, Any]:
    """Elastic spheres with lubrication between them; contact where the gap is down to 2 eps R."""
    from yade.wrapper import FrictMat, Ip2_FrictMat_FrictMat_LubricationPhys, Law2_ScGeom_ImplicitLubricationPhys

    material = FrictMat(
        density=law["density"], young=law["youngs_modulus"], poisson=law["poisson_ratio"], frictionAngle=law["friction"]
    )
    physics = Ip2_FrictMat_FrictMat_LubricationPhys(eta=law["viscosity"], eps=law["eps"])
    # resolution 0 and theta 0.55 are YADE's defaults; MaxDist is in radii
    return material, physics, Law2_ScGeom_ImplicitLubricationPhys(MaxDist=law["cutoff"] / law["radius"])


def capillary(law: dict[str, Any]) -> tuple[Any, Any, Any]:
    """Linear damped contact and, from the first contact on, a liquid bridge of constant volume."""
    from yade.wrapper import Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys, Law2_ScGeom_ViscElCapPhys_Basic, ViscElCapMat

    material = ViscElCapMat(
        density=law["density"], tc=law["contact_time"], en=law["restitution"], et=1.0, frictionAngle=law["friction"],
        Capillar=True, Vb=law["volume"], gamma=law["surface_tension"], theta=law["contact_angle_deg"],
        CapillarType=law["bridge"],
    )  # fmt: skip
    return material, Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys(), Law2_ScGeom_ViscElCapPhys_Basic()


LAWS = {"lubrication": lubrication, "capillary": capillary}


def collide(job: dict[str, Any], speed: float, tangential: float, dt: float) -> dict[str, Any]:
    """One collision; the state at the last step, and whether the solids touched."""
    import yade
    from yade.utils import sphere
    from yade.wrapper import (
        Bo1_Sphere_Aabb,
        ForceResetter,
        Ig2_Sphere_Sphere_ScGeom,
        InsertionSortCollider,
        InteractionLoop,
        NewtonIntegrator,
    )

    world = yade.Omega()
    law = job["parameters"]
    material, physics, force = LAWS[job["law"]](law)
    reach = 1 + law["cutoff"] / law["radius"]
    world.reset()
    world.materials.append(material)
    half = law["radius"] + job["start"] / 2
    for side in (-1, 1):
        ball = sphere((side * half, 0, 0), law["radius"], material=world.materials[0])
        world.bodies.append(ball)
        ball.state.vel = (-side * speed / 2, side * tangential / 2, 0)
    world.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach)], [physics], [force]),
        NewtonIntegrator(damping=0),
    ]
    world.dt = dt
    first, two = world.bodies[0].state, world.bodies[1].state
    touched = False
    smallest = job["start"]
    while True:
        world.step()
        apart = two.pos - first.pos
        gap = apart.norm() - 2 * law["radius"]
        if gap < smallest:
            smallest = gap
            touched = touched or gap <= 0
        if world.interactions.has(0, 1) and not touched:
            touched = bool(getattr(world.interactions[0, 1].phys, "contact", False))
        if gap > job["end"] or world.time > job["longest"]:
            break
    moving = two.vel - first.vel
    return {
        "position": list(apart),
        "velocity": list(moving),
        "spin": first.angVel[2],
        "partner_spin": two.angVel[2],
        "time": world.time,
        "smallest_gap": smallest,
        "touched": touched,
    }


def main() -> None:
    """Run the job."""
    from yade import config

    path = Path(os.environ["REFEREE_JOB"])
    job = json.loads(path.read_text())
    states = [collide(job, *impact) for impact in job["collisions"]]
    answer = {"version": f"YADE {config.version}", "found": states}
    path.with_suffix(".out.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    main()
