"""A model file drawn at random: refused with a sentence, or right by three engines, its derivatives included."""

import math
from collections.abc import Mapping
from pathlib import Path
from random import Random

from wetdoublet.solvers import ComputationError, InputError, Scene, collide, sensitivities
from wetdoublet.solvers.scene.user_model_source import derived_package

from .random_laws import random_model

ENGINES = ("taylor", "cvodes", "rosenbrock")
_PRESETS = ("granulation", "granulation", "granulation", "granulation-dry-bridge", "pendulum")


def scene_of(number: int, folder: Path) -> tuple[Scene, dict[str, object]] | str:
    """The scene and impact of a model by its number; the sentence with which it is refused."""
    random, path = Random(number + 10_000), folder / f"model_{number}.py"
    text = random_model(number)
    path.write_text(text)
    preset = random.choice(_PRESETS)
    try:
        derived = derived_package(path, None)
        if not derived.files:
            return next(line for line in derived.report.splitlines() if line.startswith("FAIL"))
        found = Scene.load(preset)
        if 'law("attraction"' in text:
            found = found.with_entries({"attraction.hamaker": "1e-11 J"})
        if "soft" in text:
            found = found.with_entries({"liquid.glass_transition_pressure": "2 GPa"})
        if preset != "pendulum" and random.random() < 0.15:
            found = found.with_entries(
                random.choice([{"partner.wall": True}, {"partner.radius": "150 um", "partner.density": "2500 kg/m^3"}])
            )
        found = found.with_model(path)
    except InputError as error:
        return str(error)
    stokes = random.uniform(0.5, 3.0) if preset == "pendulum" else 10 ** random.uniform(-1.7, 0)
    return found, {"stokes": stokes, "angle": "0 deg" if random.random() < 0.1 else f"{random.uniform(20, 75)} deg"}


def judged(number: int, folder: Path) -> tuple[str, str]:
    """What is found of a model: "refused", "undecided", "right" or "WRONG", and how."""
    drawn = scene_of(number, folder)
    return ("refused", drawn) if isinstance(drawn, str) else compared(*drawn)


def compared(scene: Scene, impact: Mapping[str, object]) -> tuple[str, str]:
    """What is found of a scene with a model, as of `judged`."""
    found, silent = {}, ""
    for engine in ENGINES:
        try:
            found[engine] = collide(scene, rtol=1e-11, engine=engine, **impact)
        except InputError as error:
            return "refused", str(error)
        except ComputationError as error:
            if engine == "taylor":
                return "undecided", str(error)
            silent = f", {error}"  # an engine that cannot repeat hundreds of rebounds says so
    first, *others = (each.to_dict() for each in found.values())
    for engine, other in zip(found, (first, *others), strict=True):
        if (first["outcome"], first["reversal"]) != (other["outcome"], other["reversal"]):
            return "WRONG", f"outcome by taylor and {engine}: {first['outcome']}, {other['outcome']}"
        for name in ("restitution", "contact_time", "smallest_gap", "final_rotation_rate", "final_spin", "rotation"):
            one, two = first[name], other[name]
            if one is not None and not math.isclose(one, two, rel_tol=1e-6, abs_tol=1e-9):
                return "WRONG", f"{name} by taylor and {engine}: {one}, {two}"
    largest = max(abs(each.energy.residual) / each.energy.largest for each in found.values())
    if largest > 1e-7:
        return "WRONG", f"the ledger is open by {largest:.1e}"
    if first["outcome"] == "stick":
        return "right", f"stick, certified {first['certified']}, ledger {largest:.0e}{silent}"
    try:
        worst = _slopes(scene, impact)
    except ComputationError as error:
        return "right", f"{first['outcome']}, ledger {largest:.0e}, no derivative: {error}{silent}"
    return (
        "right" if worst < 2e-5 else "WRONG"
    ), f"{first['outcome']}, ledger {largest:.0e}, slopes {worst:.0e}{silent}"


def _slopes(scene: Scene, impact: Mapping[str, object]) -> float:
    """The largest difference of derivatives by an engine from extrapolated differences, over 1 + the derivative."""
    wrt = ["liquid.viscosity", *(f"custom.{name}" for name in scene.package.quantities)]
    speed, angle = scene.with_impact(impact["stokes"], None, impact["angle"], None).need_impact()
    values, worst, expected = dict(scene.si), 0.0, {}
    for name in wrt:

        def at(part: float, name: str = name) -> float:
            moved = scene.with_si({name: values[name] * (1 + part)}, "speed")
            return float(collide(moved, speed=speed, angle=angle, rtol=1e-12, engine="taylor").restitution)

        wide, near = ((at(h) - at(-h)) / (2 * h) for h in (2e-4, 1e-4))
        expected[name] = ((4 * near - wide) / 3, abs(near - wide))
    for engine, method in (("taylor", "forward"), ("rosenbrock", "forward"), ("cvodes", "adjoint")):
        if engine == "taylor" and scene.package.events:
            continue  # which the kernel does not differentiate
        slopes = sensitivities(scene, wrt=wrt, rtol=1e-11, engine=engine, method=method, hold="speed", **impact)
        for name, (slope, error) in expected.items():
            miss = abs(slopes.gradient["restitution"][name] * values[name] - slope) - 0.1 * error
            worst = max(worst, miss / (1 + abs(slope)))
    return worst
