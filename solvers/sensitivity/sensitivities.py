"""`sensitivities()`: derivatives of the results of a scene's collision."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path as FilePath

import numpy as np

from ..engines.settings import CASADI_ENGINES, check_engine, check_rtol
from ..errors import ComputationError, InputError
from ..host.arguments import check_name
from ..results import DEFINITIONS, SPENT, check_differentiated
from ..scene.held import held_quantity
from ..scene.scene import Scene
from . import by_casadi, by_kernel
from .boundary_distance import checked, courses_of, explained
from .parameters import SIDEWAYS, check_wrt, elasticities, numbers
from .problem import Problem, Query, Slopes
from .result import Near, Sensitivities

METHODS = ("forward", "adjoint")


def check_method(method: object) -> str:
    """The method, "forward" or "adjoint"; InputError otherwise."""
    return check_name(method, METHODS, "method")


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
        engine: "cvodes", "rosenbrock", or "taylor" (forward); None: taylor where it can answer. What the kernel
            does not know is rosenbrock's, or cvodes' with a law of a liquid or of one's own: its force may have no
            bounded slope where its rate vanishes, and cvodes controls the errors of derivatives as well.
        hold: quantity held when another parameter varies, the impact's "speed", "stokes" number or "relative_speed";
            None for the relative speed where the scene gives that, else the speed.

    Returns:
        Sensitivities: value, gradient and elasticity by name.

    Raises:
        InputError: a name or option is not acceptable.
        ComputationError: the trajectory could not be completed, or is too near a boundary for derivatives.

    Example:
        >>> from wetdoublet.solvers import sensitivities
        >>> result = sensitivities("granulation", of=["restitution"], stokes=0.02, angle="75 deg")
        >>> result.gradient["restitution"]["bridge.surface_tension"] < 0
        True
    """
    of, method = check_differentiated(of), check_method(method)
    rtol, requested = check_rtol(rtol), check_engine(engine)
    if requested == "taylor" and method != "forward":
        raise InputError("method", method, "forward with engine taylor", "is not the kernel's")
    loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
    held = held_quantity(loaded, hold)
    names = check_wrt(loaded, wrt)
    problem = Problem.of(loaded, *loaded.need_impact(), names, held)
    result, reference = derivatives(problem, of, method, rtol, requested), problem.reference(names)
    reference[[name == "impact.stokes" for name in names]] = problem.n.stokes  # as given, without rounding
    elasticity = elasticities(result.value, result.gradient, reference)
    elasticity[[name == "energy.residual" for name in of]] = np.nan  # it is rounding error
    return Sensitivities(
        value=numbers(of, result.value),
        gradient={name: numbers(names, slopes) for name, slopes in zip(of, result.gradient, strict=True)},
        elasticity={name: numbers(names, slopes) for name, slopes in zip(of, elasticity, strict=True)},
        reference=dict(zip(names, reference.tolist(), strict=True)),
        outcome=result.outcome,
        method=method,
        engine=result.engine,
        hold=held,
        rtol=rtol,
        near=result.near,
        scene=loaded,
    )


@dataclass(frozen=True)
class Derivatives:
    """Results of one collision, (results,), and their derivatives, (results, parameters), SI; NaN where undefined."""

    outcome: str
    engine: str
    near: Near | None
    value: np.ndarray
    gradient: np.ndarray


def derivatives(problem: Problem, of: tuple[str, ...], method: str, rtol: float, engine: str | None) -> Derivatives:
    """The derivatives of results `of` of a collision by its parameters; arguments and errors as of `sensitivities`."""
    scene, n, names = problem.scene, problem.n, problem.wrt
    courses = partial(courses_of, scene, n)
    try:
        separated = problem.path.separated
    except ComputationError as error:
        raise explained(courses, error, rtol) from None
    near = checked(courses, separated, rtol)
    todo = tuple(filter(problem.defined, dict.fromkeys(term for name in of for term in _terms(name))))
    odd = np.array([DEFINITIONS[name].odd for name in todo], dtype=bool)
    sideways = np.isin(names, SIDEWAYS)
    tilts = bool(todo and sideways.any() and odd.any()) and not n.oblique
    # a package's forces may have slopes that only CVODES resolves at any tolerance
    engines: tuple[str, ...] = ("rosenbrock",) if scene.package is None else ("cvodes", "rosenbrock")
    if engine in CASADI_ENGINES:
        engines = (str(engine),)
    elif engine or (method == "forward" and by_kernel.offers(scene, of, {n.oblique, n.oblique or tilts})):
        engines = ("taylor", *engines)
    values, slopes = np.full(len(of), np.nan), np.full((len(of), len(names)), np.nan)
    query = Query(todo, method, rtol, near)
    if todo:
        (value, first), engines = _slopes(problem, query, engines)
        if tilts:
            (_, tilted), engines = _slopes(problem.tilted(), query, engines)
            first = np.where(odd[:, None] & sideways, tilted, first)
    for k, terms in enumerate(map(_terms, of)):
        if {*terms} <= {*todo}:
            weights = np.array([terms.get(term, 0.0) for term in todo])
            values[k], slopes[k] = weights @ value + 0.0, weights @ first + 0.0
        elif of[k] == "restitution":  # of a stick
            values[k], slopes[k] = 0.0, 0.0
    return Derivatives(problem.path.outcome, engines[0], near, values, slopes)


def _slopes(problem: Problem, query: Query, engines: tuple[str, ...]) -> tuple[Slopes, tuple[str, ...]]:
    """Derivatives by the first engine that has them, and the engines from that one on."""
    for k, engine in enumerate(engines):
        try:
            slopes = (
                by_kernel.slopes(problem, query) if engine == "taylor" else by_casadi.slopes(problem, query, engine)
            )
        except ComputationError:
            if engine != "cvodes" or engine == engines[-1]:
                raise
            continue
        if slopes is not None:
            return slopes, engines[k:]
    raise AssertionError("CasADi's engines answer or raise")


def _terms(name: str) -> dict[str, float]:
    """A quantity as a weighted sum of computed quantities; the residual requires all terms of the ledger."""
    if name != "energy.residual":
        return {name: 1.0}
    return {"energy.initial": 1.0, "energy.final": -1.0} | dict.fromkeys(SPENT, -1.0)
