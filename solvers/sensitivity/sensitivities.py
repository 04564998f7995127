"""`sensitivities()`: derivatives of the results of a scene's collision."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import STICK
from ..engines.settings import CASADI_ENGINES, check_engine, check_rtol
from ..errors import ComputationError, InputError
from ..formatting.tables import numbers_aligned
from ..host.arguments import check_name
from ..host.pictures import Drawn
from ..results import DEFINITIONS, check_differentiated
from ..scene.held import NAMES, held_quantity
from ..scene.items import item
from ..scene.origin import Result, provenance
from ..scene.scene import Scene
from . import by_casadi, by_kernel
from .boundary_distance import Near, checked, courses_of, explained
from .parameters import SIDEWAYS, Row, cell, check_wrt, elasticities, numbers
from .problem import Problem, Query, Slopes

if TYPE_CHECKING:
    import xarray

METHODS = ("forward", "adjoint")
_STICK_NOTES = (
    "a stick: its restitution is 0, and nothing else of it is defined, up to the boundary of sticking;",
    "that boundary and its sensitivities: `wetdoublet boundary SCENE --angle A --wrt NAMES`, `boundary_sensitivities`",
)
_ABOUT = ("outcome", "method", "engine", "hold")
_SHOWN = 5  # most quantities side by side
_ROUNDING = 1e-13  # relative to the largest elasticity; smaller ones are rounding errors of cancelling contributions


class Sensitivities(Result, Drawn, kw_only=True):
    """Derivatives of a collision's results; SI and radians; None where undefined.

    `plot` draws a tornado chart of the elasticities.

    Example:
        >>> from wetdoublet.solvers import sensitivities
        >>> found = sensitivities("granulation", wrt=["liquid.viscosity"], stokes=0.02, angle="75 deg")
        >>> round(found.elasticity["restitution"]["liquid.viscosity"], 3)
        -0.003
    """

    _picture = "sensitivity.plots.draw"
    _keys = "value gradient elasticity outcome method engine hold nearest=near rtol units"

    value: Mapping[str, float | None] = item("each quantity's value")
    gradient: Mapping[str, Row] = item("quantity -> parameter -> dy/dp, all others held")
    elasticity: Mapping[str, Row] = item("quantity -> parameter -> d ln y/d ln p; None where y or p is zero")
    reference: Mapping[str, float] = item("values of the parameters")
    outcome: str = item("outcome of the collision")
    method: str
    engine: str
    hold: str
    rtol: float = item("relative tolerance that was asked for")
    near: Near | None = item("the nearest boundary found from the trajectory, None if there is none", default=None)
    scene: Scene = field(repr=False, compare=False)

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.reference)

    @property
    def units(self) -> dict[str, str]:
        """Units of the quantities and the parameters."""
        entries = self.scene.fields
        return {y: DEFINITIONS[y].unit for y in self.value} | {p: entries[p].unit or "1" for p in self.parameters}

    def to_dataset(self) -> xarray.Dataset:
        """Dataset of value, gradient and elasticity over `quantity` and `parameter`; NaN for None. Imports xarray."""
        import xarray as xr

        def array(rows: Iterable[Row]) -> np.ndarray:
            return np.array([list(row.values()) for row in rows], dtype=float)  # None is NaN

        over = ("quantity", "parameter")
        variables: dict[str, Any] = {
            "value": ("quantity", array([self.value])[0]),
            "gradient": (over, array(self.gradient.values())),
            "elasticity": (over, array(self.elasticity.values())),
        }
        coordinates: dict[str, Any] = {
            "quantity": list(self.value),
            "parameter": list(self.parameters),
            "units": ("quantity", [DEFINITIONS[name].unit for name in self.value]),
            "reference": ("parameter", list(self.reference.values())),
        }
        about = {name: getattr(self, name) for name in _ABOUT}
        return xr.Dataset(variables, coordinates, provenance(self.scene, **about))

    def __str__(self) -> str:
        names = list(self.value)
        blocks = [self._block(names[k : k + _SHOWN]) for k in range(0, len(names), _SHOWN)]
        notes = [f"{self.outcome}; {self.method} derivatives by {self.engine}; {NAMES[self.hold]} held"]
        notes += [f"scene {self.scene.held}"] if self.scene.held else []
        rows = [row.values() for row in self.elasticity.values()]
        if any(value == 0 for row in rows for value in row):
            notes.append("none: the parameter has no influence here")
        if any(self._rounded(y, p) for y in names for p in self.parameters):
            notes.append("~0: contributions cancel but for rounding")
        notes += [f"nearest: {self.near}"] if self.near else []
        notes += [*_STICK_NOTES] if self.outcome == STICK else []
        return "\n\n".join([*blocks, "\n".join(notes)])

    def _block(self, names: list[str]) -> str:
        largest = {p: max((abs(self.elasticity[y][p] or 0.0) for y in names), default=0.0) for p in self.parameters}
        order = sorted(self.parameters, key=lambda p: -largest[p])
        head = ["", *names]
        units = ["value", *(_number(self.value[y], DEFINITIONS[y].unit) for y in names)]
        rows = [[p, *(self._cell(y, p) for y in names)] for p in order]
        title = "elasticities d ln y/d ln p (* dy/dp where y or p is zero)"
        lines = numbers_aligned([head, units, *rows])
        return "\n".join([*lines[:2], "", title, *lines[2:]])

    def _cell(self, y: str, p: str) -> str:
        return "~0" if self._rounded(y, p) else cell(self.elasticity[y][p], self.gradient[y][p])

    def _rounded(self, y: str, p: str) -> bool:
        """True if a nonzero elasticity is only rounding error."""
        largest = max((abs(value or 0.0) for value in self.elasticity[y].values()), default=0.0)
        return 0 < abs(self.elasticity[y][p] or 0.0) < _ROUNDING * largest


def _number(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" + ("" if unit == "1" else f" {unit}")


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
    of, method = check_differentiated(of), check_name(method, METHODS, "method")
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
    todo = tuple(filter(problem.defined, of))
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
        places = [of.index(name) for name in todo]
        values[places], slopes[places] = value + 0.0, first + 0.0
    if not problem.path.separated and "restitution" in of:
        values[of.index("restitution")], slopes[of.index("restitution")] = 0.0, 0.0
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
