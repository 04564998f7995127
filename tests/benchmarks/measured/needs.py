"""What a scene pays for having it: strings, a bridge, both; and what a gradient adds to a collision."""

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.settings import ENGINES, RTOL
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.sensitivity.gradients_many import gradients_many
from wetdoublet.solvers.sensitivity.sensitivities import sensitivities

from .peers.engines import in_bulk

Record = dict[str, Any]

MANY = 1000  # collisions in a call of the kernel whose gradients are asked for
COUNT, REPEATS = 120, 3  # collisions in a call; the best of so many calls counts
STOKES, DEGREES = (0.2, 2.0), (45.0, 80.0)  # all of them separate, with or without bridge and strings
STRINGS = {"pendulum.length": 0.05, "pendulum.gravity": 9.81}
PARAMETERS = (
    "liquid.viscosity", "impact.speed", "impact.angle", "particles.reduced_radius", "particles.reduced_mass",
    "particles.roughness", "particles.dry_restitution", "liquid.film_thickness", "liquid.glass_transition_pressure",
    "bridge.surface_tension", "bridge.volume", "bridge.contact_angle",
)  # fmt: skip
GRADIENTS = (1, 4, 12)


def scenes() -> dict[str, Scene]:
    """The same spheres and liquid with nothing else, and with what may be added."""
    bare, bridged = Scene.load("granulation-dry-bridge"), Scene.load("granulation")
    return {
        "film alone": bare,
        "strings": bare.with_entries(STRINGS),
        "bridge": bridged,
        "bridge and strings": bridged.with_entries(STRINGS),
    }


def impacts() -> tuple[np.ndarray, np.ndarray]:
    """Stokes numbers and angles (rad), spread evenly."""
    along = (np.arange(COUNT) + 0.5) / COUNT
    turned = (along * 0.6180339887498949 * COUNT) % 1.0
    return STOKES[0] * (STOKES[1] / STOKES[0]) ** along, np.radians(DEGREES[0] + (DEGREES[1] - DEGREES[0]) * turned)


def structures() -> list[Record]:
    """CPU time of a collision (s) by scene and engine of `collide_many`, over that of the film alone."""
    stokes, angle = impacts()
    found: list[Record] = []
    for engine in (name for name in ENGINES if name != "cvodes"):
        bare = math.nan
        for name, scene in scenes().items():
            counts: Record = {}

            def run(scene: Scene = scene, engine: str = engine, counts: Record = counts) -> None:
                data = collide_many(scene, stokes=stokes, angle=angle, rtol=RTOL, engine=engine)
                counts["separated"] = int((data["outcome"].values > 0).sum())
                counts["failed"] = int((data["outcome"].values < 0).sum())

            cpu = _best(run) / COUNT
            bare = cpu if name == "film alone" else bare
            found.append({"engine": in_bulk(engine), "scene": name, "cpu": cpu, "ratio": cpu / bare, **counts})
    return found


def gradients() -> list[Record]:
    """CPU time of a gradient of e_n by number of parameters, over the collision's on the same engine.

    One collision by Rosenbrock; many in a call by the kernel.
    """
    asked: dict[str, Any] = {"stokes": 0.05, "angle": math.radians(75.0), "engine": "rosenbrock"}
    found: list[Record] = []
    value = _best(lambda: collide("granulation", **asked, ledger=False))
    found.append({"method": "value", "parameters": 0, "cpu": value, "ratio": 1.0})
    for method in ("forward", "adjoint"):
        for count in GRADIENTS:
            wrt: Sequence[str] = PARAMETERS[:count]

            def run(method: str = method, wrt: Sequence[str] = wrt) -> None:
                sensitivities("granulation", of=["restitution"], wrt=list(wrt), method=method, **asked)

            cpu = _best(run)
            found.append({"method": method, "parameters": count, "cpu": cpu, "ratio": cpu / value})
    impact = {name: asked[name] for name in ("stokes", "angle")}
    cpu = _best(lambda: differences(PARAMETERS, **impact))
    found.append({"method": "central differences", "parameters": len(PARAMETERS), "cpu": cpu, "ratio": cpu / value})
    return found + (_by_kernel(**impact) if compiler() else [])


def _by_kernel(stokes: float, angle: float) -> list[Record]:
    """The kernel's, MANY collisions in a call, over the same without derivatives."""
    many: dict[str, Any] = {"stokes": np.full(MANY, stokes), "angle": angle, "engine": "taylor"}
    value = _best(lambda: collide_many("granulation", **many)) / MANY
    found: list[Record] = [{"method": f"{MANY} by the kernel: value", "parameters": 0, "cpu": value, "ratio": 1.0}]
    for count in GRADIENTS:
        wrt = list(PARAMETERS[:count])
        cpu = _best(lambda wrt=wrt: gradients_many("granulation", **many, wrt=wrt)) / MANY  # type: ignore[misc]  # bound at once
        found.append({"method": f"{MANY} by the kernel", "parameters": count, "cpu": cpu, "ratio": cpu / value})
    return found


def differences(names: Sequence[str], stokes: float, angle: float, step: float = 1e-4) -> dict[str, float]:
    """D e_n/d parameter of granulation by central differences, at fixed speed; what has no derivative there is 0."""
    scene = Scene.load("granulation").with_impact(stokes=stokes, angle=angle)
    speed, theta = scene.need_impact()
    fixed = scene.with_impact(speed=speed)
    found = {}
    for name in names:
        value = {"impact.speed": speed, "impact.angle": theta}.get(name) or float(dict(fixed.si).get(name, 0.0))
        if value == 0.0:
            found[name] = 0.0
            continue
        ends = []
        for factor in (1 - step, 1 + step):
            changed = fixed.with_impact(speed=value * factor) if name == "impact.speed" else None
            changed = fixed.with_impact(angle=value * factor) if name == "impact.angle" else changed
            changed = changed or fixed.with_entries({name: value * factor})
            ends.append(collide(changed, rtol=1e-12, engine="rosenbrock", ledger=False).restitution)
        found[name] = (ends[1] - ends[0]) / (2 * step * value)
    return found


def _best(run: Callable[[], object]) -> float:
    """Least CPU time of some calls, after one that builds."""
    run()
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return min(times)
