"""Run time and achieved error of gradients of e_n to twelve parameters: ours, heyoka's, and differences, in one run."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from wetdoublet.solvers.engines.taylor.call import Impacts
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.sensitivity.by_kernel import gradients_by_kernel
from wetdoublet.solvers.sensitivity.gradients_many import gradients_many

from .gradient_task import COUNT, Gradients
from .peers.bulk import Partly, left_out
from .tasks import TASKS, Task
from .work import OFTEN, REPEATS, Tell

Record = dict[str, Any]
Run = Callable[[], np.ndarray]

HEYOKA, HEYOKA_ALONE = "heyoka, variational equations", "heyoka's, without callbacks"
FINE = tuple(10.0**-k for k in (6, 7, 7.5, 8, 8.5, *range(9, 14)))
COARSE = (1e-8, 1e-10)
DIFFERENCES = 1e-13  # tolerance of collisions whose differences are taken; then steps take the part of tolerances
STEPS = (1e-3, 1e-4, 1e-5)
COPIES = 40  # of the set in one call of those that take many: 1000 collisions
LONG = 0.5  # seconds of a call, which is then not repeated at once


@dataclass(frozen=True)
class Method:
    """A way to a gradient.

    Arguments:
        prepare: from the task, copies of each collision and a tolerance, the call that is timed; it returns derivatives
            in theta, (collisions, parameters).
        copies: the whole set so many times in one call.
        tolerances: what it is asked at; for differences, steps.
        missing: why it cannot be used here; empty if it can.
    """

    name: str
    prepare: Callable[[Gradients, int, float], Run]
    copies: int = 1
    tolerances: tuple[float, ...] = COARSE
    missing: str = ""


def methods() -> tuple[Method, ...]:
    """All of them, those that are missing here included."""
    heyoka = "" if find_spec("heyoka") else "heyoka is not installed (pip install wetdoublet[bench])"
    no_compiler = "" if compiler() else "no C compiler (cc, gcc, clang)"
    return (
        Method("gradients_many", _gradients_many, COPIES, FINE, no_compiler),
        Method("taylor, kernel alone", _kernel, COPIES, FINE, no_compiler),
        Method("rosenbrock, forward", partial(_casadi, "forward")),
        Method("rosenbrock, adjoint", partial(_casadi, "adjoint")),
        Method(HEYOKA, partial(variational_heyoka, alone=False), COPIES, FINE, heyoka),
        Method(HEYOKA_ALONE, partial(variational_heyoka, alone=True), COPIES, FINE, heyoka),
        Method("central differences of taylor", _differences, COPIES, STEPS, no_compiler),
    )


def _gradients_many(asked: Gradients, copies: int, rtol: float) -> Run:
    """`gradients_many` by the kernel, as a user calls it."""
    stokes, angle = (np.array([getattr(each, name) for each in asked.impacts] * copies) for name in ("stokes", "angle"))
    units = np.tile(asked.units, (copies, 1))

    def run() -> np.ndarray:
        found = gradients_many(
            asked.scene, stokes=stokes, angle=angle, wrt=list(asked.names), of="restitution", rtol=rtol, engine="taylor"
        )
        rows: np.ndarray = found["gradient"].values[0] * units
        return rows

    return run


def _kernel(asked: Gradients, copies: int, rtol: float) -> Run:
    """The kernel's derivatives in the parameters, without what `gradients_many` adds: boundaries too near, labels."""
    stokes, angle = (np.array([getattr(each, name) for each in asked.impacts] * copies) for name in ("stokes", "angle"))
    impacts = Impacts(asked.scene, stokes / asked.scene.stokes_per_speed, angle, {})
    units = np.tile(asked.units, (copies, 1))

    def run() -> np.ndarray:
        found = gradients_by_kernel(impacts, asked.kind, asked.names, ("restitution",), rtol, backward=True)
        assert found is not None  # there is a compiler
        rows: np.ndarray = found[2][0] * units
        return rows

    return run


def _casadi(method: str, asked: Gradients, _: int, rtol: float) -> Run:
    """`sensitivities`, as a user calls it."""
    return lambda: asked.by_casadi(method, "rosenbrock", rtol)


def variational_heyoka(asked: Gradients, copies: int, rtol: float, alone: bool) -> Run:
    """By heyoka's variational equations.

    Arguments:
        alone: the time in Python's callbacks does not count.
    """
    from .peers.heyoka_callbacks import Inside
    from .peers.heyoka_gradient import prepare

    inside = Inside()
    slopes = np.tile(asked.slopes, (copies, 1, 1))
    batch = prepare(asked.numbers * copies, slopes, rtol, watch=inside if alone else None)

    def run() -> np.ndarray:
        inside.reset()
        batch.run()
        return batch.gradient

    return Partly(run, inside.left_out) if alone else run


def _differences(asked: Gradients, copies: int, step: float) -> Run:
    """Two collisions a parameter, all of them in one call a parameter."""
    stokes, angle = (np.array([getattr(each, name) for each in asked.impacts]) for name in ("stokes", "angle"))
    speed = np.tile(stokes / asked.scene.stokes_per_speed, 2 * copies)
    angle = np.tile(angle, 2 * copies)
    factor = np.repeat([1 + step, 1 - step], copies * stokes.size)
    entries = asked.scene.entries

    def run() -> np.ndarray:
        columns = []
        for name in asked.names:
            own = float(entries.get(name) or 0.0)
            # one that is zero, with a unit of one, may not be less: forward, to first order
            vary = (
                {} if name.startswith("impact.") else {name: own * factor if own else np.maximum(2 * (factor - 1), 0)}
            )
            data = collide_many(
                asked.scene,
                speed=speed * (factor if name == "impact.speed" else 1.0),
                angle=angle * (factor if name == "impact.angle" else 1.0),
                vary=vary,
                rtol=DIFFERENCES,
                engine="taylor",
            )
            up, down = np.split(data["restitution"].values, 2)
            columns.append((up - down) / (2 * step))
        return np.array(columns).T

    return run


def gradient_work(
    tasks: Sequence[Task] = TASKS,
    repeats: int = REPEATS,
    tell: Tell = lambda _: None,
    which: Sequence[Method] | None = None,
) -> list[Record]:
    """Of each task what was asked, and a row a method and tolerance."""
    return [
        _of(Gradients.of(task), task.preset, repeats, tell, methods() if which is None else which) for task in tasks
    ]


def _of(asked: Gradients, preset: str, repeats: int, tell: Tell, which: Sequence[Method]) -> Record:
    ready: list[tuple[Method, Record, Run]] = []
    for method, rtol in ((each, rtol) for each in which for rtol in each.tolerances):
        if method.missing:
            continue
        tell(f"{preset}: gradients by {method.name}, {rtol:.1e}")
        run = method.prepare(asked, method.copies, rtol)
        found = run()  # builds and caches
        errors = asked.errors(found[: len(asked.impacts)])
        row: Record = {"method": method.name, "rtol": rtol, "cpu": math.inf, "wall": math.inf}
        row |= {"error_largest": _number(errors.max()), "error_median": _number(np.median(errors))}
        row["failed"] = int(np.isnan(errors).sum())
        ready.append((method, row, run))
    for method, row, run in (each for _ in range(repeats) for each in ready):
        for _ in range(OFTEN if method.copies > 1 else 1):
            cpu, wall, count = time.process_time(), time.perf_counter(), method.copies * len(asked.impacts)
            run()
            cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
            long = wall > LONG
            cpu, wall = (cpu - left_out(run)) / count, (wall - left_out(run)) / count
            row["cpu"], row["wall"] = min(row["cpu"], cpu), min(row["wall"], wall)
            if long:
                break
    return {
        "preset": preset,
        "collisions": len(asked.impacts),
        "parameters": list(asked.names),
        "count": COUNT,
        "missing": {method.name: method.missing for method in which if method.missing},
        "rows": [row for _, row, _ in ready],
    }


def _number(value: float) -> float | None:
    """None for what is none: JSON has no NaN."""
    return float(value) if math.isfinite(value) else None
