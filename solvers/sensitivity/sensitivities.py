"""`sensitivities()`: derivatives of the results of a scene's collision."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path as FilePath

import numpy as np

from ..engines.settings import check_engine, check_rtol
from ..errors import ComputationError, InputError
from ..host.arguments import check_name
from ..results import DEFINITIONS, SPENT, check_differentiated
from ..scene.held import held_quantity
from ..scene.scene import Scene
from . import by_casadi, by_kernel
from .boundary_distance import checked, courses_of, explained
from .parameters import SIDEWAYS, check_wrt
from .problem import Problem, Query, Slopes
from .result import Sensitivities

METHODS = ("forward", "adjoint")


def check_method(method: object, label: str = "method") -> str:
    """The method, "forward" or "adjoint"; InputError otherwise."""
    return check_name(method, METHODS, label)


def sensitivities(
    scene: Scene | str | FilePath,
    of: Sequence[str] | str = ("restitution",),
    wrt: Sequence[str] | str | None = None,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    method: str = "forward",
    rtol: float = 1e-9,
    engine: str | None = None,
    relative_speed: float | str | None = None,
    hold: str | None = None,
) -> Sensitivities:
    """Exact derivatives of a collision's results, through its events.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        of: results by name: `restitution`, `contact_time`, ..., `energy.capillary`.
        wrt: parameters by dotted name; None for every numeric entry, and `impact.speed`, `.stokes` and `.angle`.
        stokes, speed, angle, relative_speed: the impact, as for `collide`.
        method: "forward" has a cost proportional to the number of parameters, "adjoint" to that of results.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "cvodes", "rosenbrock", or "taylor" (forward; what the kernel does not know is
            rosenbrock's); None: taylor where it can answer, else rosenbrock, which is more accurate than
            cvodes.
        hold: quantity held when another parameter varies, the impact's "speed", "stokes" number or "relative_speed";
            None for the relative speed where the scene gives that, else the speed.

    Returns:
        Sensitivities: value, gradient and elasticity by name.

    Raises:
        InputError: a name or option is not acceptable.
        ComputationError: the trajectory could not be completed, or is too near a boundary for derivatives.

    Example:
        >>> from wetdoublet.solvers import sensitivities
        >>> found = sensitivities("granulation", of=["restitution"], stokes=0.02, angle="75 deg")
        >>> found.gradient["restitution"]["bridge.surface_tension"] < 0
        True
    """
    of, method = check_differentiated(of), check_method(method)
    rtol, requested = check_rtol(rtol), check_engine(engine)
    if requested == "taylor" and method != "forward":
        raise InputError("method", method, "forward with engine taylor", "is not the kernel's")
    loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
    held = held_quantity(loaded, hold)
    names = check_wrt(loaded, wrt)
    v0, angle_ = loaded.need_impact()
    problem = Problem.of(loaded, v0, angle_, names, held)
    n, courses = problem.n, partial(courses_of, loaded, problem.n)
    try:
        separated = problem.path.separated
    except ComputationError as error:
        raise explained(courses, error, rtol) from None
    near = checked(courses, separated, rtol)
    todo = tuple(filter(problem.defined, dict.fromkeys(part for name in of for part in _parts(name))))
    odd = np.array([DEFINITIONS[name].odd for name in todo], dtype=bool)
    sideways = np.isin(names, SIDEWAYS)
    tilts = bool(todo and sideways.any() and odd.any()) and not n.oblique
    plugin = requested or "rosenbrock"
    if requested is None and method == "forward" and by_kernel.offers(loaded, of, {n.oblique, n.oblique or tilts}):
        plugin = "taylor"
    query = Query(todo, method, rtol, near)
    slopes, plugin = _slopes(problem, query, plugin) if todo else (None, plugin)
    if tilts and slopes is not None:
        tilted, plugin = _slopes(problem.tilted(), query, plugin)
        slopes = Slopes(slopes.value, np.where(odd[:, None] & sideways, tilted.first, slopes.first))
    rows = {name: _combined(name, todo, slopes, len(names)) for name in of}
    values = {name: row[0] for name, row in rows.items()}
    reference = {name: problem.value_of(name) for name in names}
    return Sensitivities(
        value=values,
        gradient={name: _row(names, row[1]) for name, row in rows.items()},
        elasticity={name: _elasticities(name, reference, *row) for name, row in rows.items()},
        reference=reference,
        outcome=problem.path.outcome,
        method=method,
        engine=plugin,
        hold=held,
        rtol=rtol,
        near=near,
        scene=loaded,
    )


def _slopes(problem: Problem, query: Query, engine: str) -> tuple[Slopes, str]:
    """Derivatives by the parameters, SI, and the engine that computed them: Rosenbrock where the kernel cannot."""
    slopes = by_kernel.slopes(problem, query) if engine == "taylor" else None
    if slopes is None:
        engine = "rosenbrock" if engine == "taylor" else engine
        slopes = by_casadi.slopes(problem, query, engine)
    return Slopes(slopes.value, slopes.first / problem.units()), engine


def _combined(
    name: str, todo: tuple[str, ...], slopes: Slopes | None, size: int
) -> tuple[float | None, np.ndarray | None]:
    """Value and gradient (n,) of a quantity, from the computed ones."""
    parts = _parts(name)
    if slopes is None or any(part not in todo for part in parts):
        if name == "restitution":  # the restitution of a stick
            return 0.0, np.zeros(size)
        return None, None
    weights = np.array([parts.get(term, 0.0) for term in todo])
    return float(weights @ slopes.value) + 0.0, weights @ slopes.first


def _parts(name: str) -> dict[str, float]:
    """A quantity as a weighted sum of computed quantities; the residual requires all terms of the ledger."""
    if name != "energy.residual":
        return {name: 1.0}
    return {"energy.initial": 1.0, "energy.final": -1.0} | dict.fromkeys(SPENT, -1.0)


def _row(names: tuple[str, ...], row: np.ndarray | None) -> dict[str, float | None]:
    return {name: None if row is None else float(row[k]) + 0.0 for k, name in enumerate(names)}


def _elasticities(
    name: str, reference: Mapping[str, float], value: float | None, row: np.ndarray | None
) -> dict[str, float | None]:
    """Elasticities d ln y/d ln p; None where y or p is zero, and for the ledger's residual, which is rounding error."""
    none = row is None or not value or name == "energy.residual"
    return {
        p: None if none or not at else float(row[k]) * at / value + 0.0  # type: ignore[index, operator]  # `none` says so
        for k, (p, at) in enumerate(reference.items())
    }
