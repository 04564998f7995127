"""What derivatives cost, beside the collision itself: gradients to twelve parameters by every method, in one run."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.casadi.integrators import tolerance_for
from wetdoublet.solvers.engines.casadi.locate import locate
from wetdoublet.solvers.formatting.markdown import ms, table
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.sensitivity.derivatives import evaluate
from wetdoublet.solvers.sensitivity.parameters import known
from wetdoublet.solvers.sensitivity.sensitivities import sensitivities
from wetdoublet.solvers.sensitivity.trajectory_expression import Course, course_of, trajectory_expression

COUNT = 12  # parameters
RTOL = 1e-10
Runs = dict[str, Callable[[Scene], np.ndarray | None]]
_STEP = 1e-5  # of central differences, near the best one for values good to 1e-10
IMPACTS = {  # collisions that separate: Stokes number, degrees
    "granulation": ((0.03, 65.0), (0.14, 40.0), (0.02, 75.0)),
    "pendulum": ((1.0, 60.0), (1.55, 35.0)),
}


@dataclass(frozen=True)
class Gradient:
    """Gradients of e_n: CPU time (s) of one, summed over a preset's collisions, its ratio to their collisions, and the
    largest error over the largest elasticity.

    Arguments:
        method: "collision" itself (`collide` without ledger), "its trajectory alone" (the located phases integrated
            once more, which is part of it), "adjoint", "forward", "central differences".
        first: the first call's, with everything that is built once; None where that was not measured.
    """

    preset: str
    engine: str
    method: str
    collisions: int
    parameters: int
    cpu: float
    ratio: float
    error: float | None
    first: float | None


def gradients(preset: str, repeats: int = 3, impacts: Sequence[tuple[float, float]] | None = None) -> list[Gradient]:
    """The rows of a preset: both engines, every method.

    Arguments:
        impacts: Stokes numbers and angles (degrees) of collisions that separate.
    """
    scenes = [_scene(preset, stokes, angle) for stokes, angle in impacts or IMPACTS[preset]]
    names = _parameters(scenes[0])
    truth = [_elasticities(scene, names, "adjoint", "rosenbrock", 1e-12) for scene in scenes]
    found = []
    for engine in ("rosenbrock", "cvodes"):
        runs: Runs = {
            "collision": partial(_collided, engine=engine),
            "its trajectory alone": partial(_replay_alone, engine=engine),
            "adjoint": partial(_elasticities, names=names, method="adjoint", engine=engine),
            "forward": partial(_elasticities, names=names, method="forward", engine=engine),
            "central differences": partial(_differences, names=names, engine=engine),
        }
        found += _measured(preset, engine, runs, scenes, truth, len(names), repeats)
    return found


def _measured(
    preset: str,
    engine: str,
    runs: Runs,
    scenes: Sequence[Scene],
    truth: Sequence[np.ndarray],
    count: int,
    repeats: int,
) -> list[Gradient]:
    first: dict[str, float] = {}
    best = dict.fromkeys(runs, float("inf"))
    errors: dict[str, float | None] = dict.fromkeys(runs)
    for turn in range(repeats + 1):
        for method, run in runs.items():
            if method == "central differences" and turn > 1:
                continue  # it takes as long as all others together; one run after the first does
            start = time.process_time()
            results = [run(scene) for scene in scenes]
            taken = time.process_time() - start
            if turn == 0:
                first[method] = taken
            else:
                best[method] = min(best[method], taken)
            apart = [
                float(np.max(np.abs(row - right)) / np.max(np.abs(right)))
                for row, right in zip(results, truth, strict=True)
                if row is not None
            ]
            errors[method] = max(apart, default=None)
    return [
        Gradient(
            preset=preset,
            engine=engine,
            method=method,
            collisions=len(scenes),
            parameters=count if errors[method] is not None else 0,
            cpu=best[method],
            ratio=best[method] / best["collision"],
            error=errors[method],
            first=None if method == "central differences" else first[method],
        )
        for method in runs
    ]


def _scene(preset: str, stokes: float, degrees: float) -> Scene:
    scene = Scene.load(preset).with_impact(stokes=stokes, angle=float(np.radians(degrees)))
    return scene.with_impact(speed=scene.speed)


def _parameters(scene: Scene) -> tuple[str, ...]:
    """Twelve parameters, those that are zero left out."""
    names = [name for name in known(scene) if name != "impact.stokes" and scene.entries.get(name)]
    return tuple(names[-COUNT:])


def _collided(scene: Scene, engine: str) -> None:
    collide(scene, rtol=RTOL, engine=engine, ledger=False)


@lru_cache(maxsize=32)
def _known(scene: Scene) -> tuple[Course, np.ndarray, np.ndarray, dict[str, float]]:
    """Course, durations and groups of a collision, located once."""
    n = nondimensionalise(scene, *scene.need_impact())
    path = locate(load(select_model(scene, n.oblique)), n.groups, RTOL)
    course = course_of(path, path.model.choice)
    return course, path.p, np.array([step.duration for step in path.steps]), n.groups


def _replay_alone(scene: Scene, engine: str) -> None:
    course, p, durations, groups = _known(scene)
    evaluate(
        trajectory_expression(course, ("restitution",), engine, tolerance_for(RTOL, engine, groups)).function,
        p,
        durations,
    )


def _elasticities(scene: Scene, names: tuple[str, ...], method: str, engine: str, rtol: float = RTOL) -> np.ndarray:
    found = sensitivities(scene, ["restitution"], names, method=method, engine=engine, rtol=rtol)
    return np.array([found.elasticity["restitution"][name] for name in names], dtype=float)


def _differences(scene: Scene, names: tuple[str, ...], engine: str) -> np.ndarray:
    """Two collisions a parameter."""
    base = collide(scene, rtol=RTOL, engine=engine, ledger=False).restitution
    rows = []
    for name in names:
        p = float(scene.entries[name])
        up, down = (
            collide(scene.with_entries({name: p * part}), rtol=RTOL, engine=engine, ledger=False).restitution
            for part in (1 + _STEP, 1 - _STEP)
        )
        rows.append((up - down) / (2 * _STEP) / base)
    return np.array(rows)


NOTE = (
    "CPU time of a collision at rtol 1e-10, mean over the preset's, and its ratio to the collision itself on the same "
    "engine (`collide` without ledger: located, then replayed), all in one run. Errors of the elasticities of e_n over "
    "the largest. `first` is the first call's, which builds integrators and their derivatives."
)


def gradient_table(found: Sequence[Gradient]) -> str:
    """Cost and error of the gradient of e_n to twelve parameters, as Markdown."""
    rows = []
    for row in found:
        what = row.method + (f", {row.parameters} parameters" if row.parameters else "")
        first = "-" if row.first is None else ms(row.first / row.collisions)
        error = "-" if row.error is None else f"{row.error:.1e}"
        cpu = ms(row.cpu / row.collisions)
        rows.append([f"{row.preset}, {row.collisions}", row.engine, what, cpu, f"{row.ratio:.2f}", error, first])
    return table(["collisions", "engine", "what", "ms", "times the collision", "largest error", "first ms"], rows)
