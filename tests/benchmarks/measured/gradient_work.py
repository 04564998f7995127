"""Run time and achieved error of gradients of e_n to twelve parameters: ours, heyoka's, and differences, in one run."""

import math
from collections.abc import Sequence
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
from .tasks import Task, columns
from .timing import Call, Engine, Tell, measured

Record = dict[str, Any]

HEYOKA, HEYOKA_ALONE = "heyoka, variational equations", "heyoka's, without callbacks"
FINE = tuple(10.0**-k for k in (6, 7, 7.5, 8, 8.5, *range(9, 14)))
COARSE = (1e-8, 1e-10)
DIFFERENCES = 1e-13  # tolerance of collisions whose differences are taken; then steps take the part of tolerances
STEPS = (1e-3, 1e-4, 1e-5)


def methods() -> tuple[Engine, ...]:
    """All of them, those that are missing here included; their calls return derivatives in theta by collision."""
    heyoka = "" if find_spec("heyoka") else "heyoka is not installed (pip install wetdoublet[bench])"
    no_compiler = "" if compiler() else "no C compiler (cc, gcc, clang)"
    return (
        Engine("gradients_many", _gradients_many, FINE, missing=no_compiler),
        Engine("taylor, kernel alone", _kernel, FINE, missing=no_compiler),
        Engine("rosenbrock, forward", partial(_casadi, "forward"), COARSE, many=False),
        Engine("rosenbrock, adjoint", partial(_casadi, "adjoint"), COARSE, many=False),
        Engine(HEYOKA, partial(variational_heyoka, alone=False), FINE, missing=heyoka),
        Engine(HEYOKA_ALONE, partial(variational_heyoka, alone=True), FINE, missing=heyoka),
        Engine("central differences of taylor", _differences, STEPS, missing=no_compiler),
    )


def _gradients_many(asked: Gradients, copies: int, rtol: float) -> Call:
    """`gradients_many` by the kernel, as a user calls it."""
    stokes, angle = columns(asked.impacts, copies)
    units, wrt = np.tile(asked.units, (copies, 1)), list(asked.names)
    given: dict[str, Any] = {"stokes": stokes, "angle": angle, "wrt": wrt, "of": "restitution", "rtol": rtol}
    return Call(lambda: gradients_many(asked.scene, **given, engine="taylor")["gradient"].values[0] * units)


def _kernel(asked: Gradients, copies: int, rtol: float) -> Call:
    """The kernel's derivatives in the parameters, without what `gradients_many` adds: boundaries too near, labels."""
    stokes, angle = columns(asked.impacts, copies)
    impacts = Impacts(asked.scene, stokes / asked.scene.stokes_per_speed, angle, {})
    units = np.tile(asked.units, (copies, 1))

    def run() -> np.ndarray:
        found = gradients_by_kernel(impacts, asked.kind, asked.names, ("restitution",), rtol, backward=True)
        assert found is not None  # there is a compiler
        rows: np.ndarray = found[2][0] * units
        return rows

    return Call(run)


def _casadi(method: str, asked: Gradients, _: int, rtol: float) -> Call:
    """`sensitivities`, as a user calls it."""
    return Call(lambda: asked.by_casadi(method, "rosenbrock", rtol))


def variational_heyoka(asked: Gradients, copies: int, rtol: float, alone: bool) -> Call:
    """By heyoka's variational equations.

    Arguments:
        alone: the time in Python's callbacks does not count.
    """
    from .peers.heyoka_callbacks import Inside
    from .peers.heyoka_gradient import prepare

    inside = Inside()
    batch = prepare(asked.numbers * copies, np.tile(asked.slopes, (copies, 1, 1)), rtol, inside if alone else None)

    def run() -> np.ndarray:
        inside.reset()
        batch.run()
        return batch.gradient

    return Call(run, left_out=inside.left_out) if alone else Call(run)


def _differences(asked: Gradients, copies: int, step: float) -> Call:
    """Two collisions a parameter, all of them in one call a parameter."""
    stokes, angle = columns(asked.impacts)
    speed = np.tile(stokes / asked.scene.stokes_per_speed, 2 * copies)
    angle = np.tile(angle, 2 * copies)
    factor = np.repeat([1 + step, 1 - step], copies * stokes.size)
    entries = asked.scene.entries

    def run() -> np.ndarray:
        columns = []
        for name in asked.names:
            own = float(entries.get(name) or 0.0)
            # one that is zero, with a unit of one, may not be less: forward, to first order
            moved = own * factor if own else np.maximum(2 * (factor - 1), 0)
            vary = {} if name.startswith("impact.") else {name: moved}
            data = collide_many(
                asked.scene, speed=speed * (factor if name == "impact.speed" else 1.0),
                angle=angle * (factor if name == "impact.angle" else 1.0), vary=vary, rtol=DIFFERENCES, engine="taylor",
            )  # fmt: skip
            up, down = np.split(data["restitution"].values, 2)
            columns.append((up - down) / (2 * step))
        return np.array(columns).T

    return Call(run)


def gradient_work(tasks: Sequence[Task], repeats: int, tell: Tell) -> list[Record]:
    """Of each task what was asked, and a row a method and tolerance."""
    return [_of(Gradients.of(task), task.preset, repeats, tell) for task in tasks]


def _of(asked: Gradients, preset: str, repeats: int, tell: Tell) -> Record:
    size, rows, which = len(asked.impacts), [], methods()
    for method, rtol, least in measured(which, asked, size, repeats, lambda what: tell(f"{preset}: gradients, {what}")):
        errors = asked.errors(least.found[:size])
        largest = float(errors.max())
        rows.append({
            "method": method.name, "rtol": rtol, "cpu": least.cpu,
            "error_largest": largest if math.isfinite(largest) else None,  # JSON has no NaN
            "failed": int(np.isnan(errors).sum()),
        })  # fmt: skip
    return {
        "preset": preset, "collisions": size, "parameters": list(asked.names), "count": COUNT,
        "missing": {method.name: method.missing for method in which if method.missing}, "rows": rows,
    }  # fmt: skip
