"""`boundary_sensitivities()`: derivatives of every change of outcome in the scene's parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..boundaries.boundary import boundary
from ..boundaries.brackets import Brackets, enclose
from ..boundaries.changes import Change
from ..boundaries.experiment import Experiment, Rows
from ..boundaries.result import Boundaries
from ..boundaries.slopes import Lines, normals, outcomes_along, places_again, slopes
from ..engines.settings import RTOL, check_rtol
from ..errors import ComputationError, InputError
from ..formatting.tables import numbers_aligned
from ..host.arguments import check_function
from ..host.pictures import Drawn
from ..scene.items import item
from ..scene.origin import Record, Result, provenance
from ..scene.scene import Scene
from ..scene.schema import DEFAULTS, MEETING, SPEEDS
from .parameters import Row, cell, check_wrt, elasticities, kind_of, numbers, parameter_map, references

if TYPE_CHECKING:
    import xarray

_OF = ("stokes", "speed", "relative_speed", "centrifugal")
_SYMBOLS = {"stokes": "St*", "speed": "v*", "centrifugal": "Ce*"}
_STEP = 1e-4  # rad, of the angle where no gradient grows
_REACH = 3e-3  # in ln St, about the change
_SHARPEST = 1e-11  # tolerance of the differentiated trajectories, which pass the saddle
_ERROR = 1e-6  # of the derivatives beside the largest: smaller ones are 0
_ASIDE, _NARROW = 1e-8, 1e-10  # of St*: where both sides must have their outcomes, and to which the change is enclosed


class Moving(Record):
    """A change of outcome and its derivatives; St* is that of the change, Ce* is None without a bridge."""

    change: Change
    gradient: Mapping[str, Row] = item(
        '"stokes", "speed", "relative_speed", "centrifugal" -> parameter -> dSt*/dp, dv*/dp, dCe*/dp, SI',
        default_factory=dict,
    )
    elasticity: Mapping[str, Row] = item("the same as d ln/d ln p; None where either is zero", default_factory=dict)
    reason: str = item("the reason if there are no derivatives; then both are empty", default="")

    @property
    def results(self) -> tuple[str, ...]:
        """Quantities that texts and pictures show, the preferred one last; Ce* vanishes head-on."""
        return ("stokes", "speed", "centrifugal") if self.change.centrifugal else ("stokes", "speed")

    def to_dict(self) -> dict[str, Any]:
        """What `boundary --wrt` adds to a change: its "sensitivities", null if there are none."""
        both = {of: {"gradient": self.gradient[of], "elasticity": self.elasticity[of]} for of in self.gradient}
        return {"sensitivities": both or None}


class BoundarySensitivities(Result, Drawn):
    """The changes of outcome at each angle (rad), ascending in St, with their derivatives.

    `plot` draws the elasticities of every change of outcome as bars.

    Example:
        >>> from wetdoublet.solvers import boundary_sensitivities
        >>> found = boundary_sensitivities("granulation", angle=0.785, wrt=["liquid.viscosity"])
        >>> found.parameters
        ('liquid.viscosity',)
    """

    _picture = "sensitivity.plots.draw_boundaries"

    boundaries: Boundaries
    changes: tuple[tuple[Moving, ...], ...]
    parameters: tuple[str, ...]

    @property
    def angles(self) -> tuple[float, ...]:
        return self.boundaries.angles

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --wrt NAMES --json`."""
        changes = [
            [self.boundaries.change_dict(shift.change, angle) | shift.to_dict() for shift in line]
            for angle, line in zip(self.angles, self.changes, strict=True)
        ]
        fields = self.boundaries.scene.fields
        units = {name: fields[name].unit or "1" for name in self.parameters}
        return {"angles": list(self.angles), "changes": changes} | self.boundaries.origin(angles="rad", **units)

    def to_dataset(self) -> xarray.Dataset:
        """Gradients and elasticities over (change, parameter); `change` has angle (rad), stokes, before and after.

        NaN where there is no derivative, for the `reason` given.
        """
        import xarray as xr

        pairs, over = self.pairs, ("change", "parameter")
        data: dict[str, Any] = {"reason": ("change", np.array([shift.reason for _, shift in pairs], dtype=str))}
        for of in _OF:
            for kind in ("gradient", "elasticity"):
                rows = [[getattr(shift, kind).get(of, {}).get(name) for name in self.parameters] for _, shift in pairs]
                data[f"{of}_{kind}"] = over, np.array(rows, dtype=float).reshape(len(pairs), len(self.parameters))
        angles = np.array([angle for angle, _ in pairs], dtype=float)
        columns = {name: ("change", np.array([getattr(shift.change, name) for _, shift in pairs]))
                   for name in ("stokes", "before", "after")}  # fmt: skip
        coordinates = {"angle": ("change", angles, {"units": "rad"}), **columns, "parameter": list(self.parameters)}
        return xr.Dataset(data, coordinates, provenance(self.boundaries.scene))

    @property
    def pairs(self) -> list[tuple[float, Moving]]:
        """Every change with its angle."""
        return [(angle, shift) for angle, line in zip(self.angles, self.changes, strict=True) for shift in line]

    def __str__(self) -> str:
        return "\n\n".join([str(self.boundaries), *self._tables()])

    __repr__ = __str__  # at the prompt

    def _tables(self) -> list[str]:
        tables = []
        for angle, shift in self.pairs:
            title = f"{np.degrees(angle):.6g} deg, {shift.change.before} -> {shift.change.after}"
            if shift.reason:
                tables.append(f"{title}: {shift.reason}")
                continue
            rows = [["", *(f"d ln {_SYMBOLS[of]}" for of in shift.results)]]
            rows += [
                [name, *(cell(shift.elasticity[of][name], shift.gradient[of][name]) for of in shift.results)]
                for name in self.parameters
            ]
            what = "elasticities by p (where it is zero *: dSt*/dp, dv*/dp, dCe*/dp, SI); v* is the normal speed"
            tables.append("\n  ".join([f"{title}: {what}", *map(str.rstrip, numbers_aligned(rows))]))
        return tables


def boundary_sensitivities(
    scene: Scene | str | FilePath,
    *,
    angle: Any = None,
    stokes: tuple[float, float] | None = None,
    wrt: Sequence[str] | str | None = None,
    rtol: float = RTOL,
    traced: Boundaries | None = None,
    progress: Callable[[int], None] | None = None,
) -> BoundarySensitivities:
    """Derivatives of the Stokes and centrifugal numbers of every change of outcome in the scene's parameters.

    They are exact, by the implicit function theorem for functions that are smooth through the change. Each parameter
    varies alone; the speed follows the boundary.

    Arguments:
        scene: a Scene, a path or a preset's name.
        angle: impact angles in rad, a number or 1-D; default the scene's.
        stokes: lowest and highest Stokes number of the search, as for `boundary`.
        wrt: parameters by dotted name; None for every numeric entry of the scene, and the impact's angle.
        rtol: relative tolerance of the tracing.
        traced: the boundaries, if already computed.
        progress: called with the number of angles done, once they are traced.

    Returns:
        BoundarySensitivities: gradients (SI) and elasticities, change by change.

    Raises:
        InputError: an invalid angle, Stokes number or name. A change without a smooth function, or that cannot be
            followed, raises nothing; see its `reason`.

    Example:
        >>> from wetdoublet.solvers import boundary_sensitivities
        >>> [line] = boundary_sensitivities("granulation", angle=0.785, wrt=["particles.reduced_radius"]).changes
        >>> line[0].elasticity["centrifugal"]["particles.reduced_radius"] > 0
        True
    """
    loaded = Scene.load(scene)
    names = check_boundary_wrt(loaded, wrt)
    rtol = check_rtol(rtol)
    check_function(progress, "progress")
    if traced is not None and not isinstance(traced, Boundaries):
        raise InputError("traced", traced, "what boundary() has returned, or None", "is neither")
    traced_lines = boundary(loaded, angle=angle, stokes=stokes, rtol=rtol) if traced is None else traced
    lines: list[tuple[Moving, ...]] = []
    for at, line in zip(traced_lines.angles, traced_lines.changes, strict=True):
        lines.append(tuple(moving(loaded, at, change, names, rtol) for change in line))
        if progress:
            progress(len(lines))
    return BoundarySensitivities(traced_lines, tuple(lines), names)


def check_boundary_wrt(scene: Scene, wrt: Sequence[str] | str | None) -> tuple[str, ...]:
    """The requested parameters; InputError for one that the scene does not have, and for speed and Stokes number."""
    names = check_wrt(scene, wrt)
    for name in names:
        if wrt is not None and name in SPEEDS:
            accepted = ", ".join(entry for entry in check_wrt(scene, None) if entry not in SPEEDS)
            raise InputError("wrt", name, accepted, "is what a boundary is followed in")
    return tuple(name for name in names if name not in SPEEDS)


def moving(scene: Scene, angle: float, change: Change, names: tuple[str, ...], rtol: float = RTOL) -> Moving:
    """Derivatives of one change at an angle (rad) in the named parameters."""
    try:
        by_parameter = _of_logarithm(scene, angle, change, names, min(rtol, _SHARPEST))
    except ComputationError as error:
        return Moving(change, reason=str(error))
    speed, kind = scene.speed_of(change.stokes), kind_of(scene, "stokes")
    values = {"stokes": change.stokes, "speed": speed, "relative_speed": speed / math.cos(angle)}
    groups: tuple[str, ...] = ("speed",)
    if change.centrifugal is not None:
        values["centrifugal"], groups = change.centrifugal, ("speed", "centrifugal")
    mapping = parameter_map(kind, (*names, "impact.stokes"), groups)
    _, by_theta, units = mapping.at(references(scene, kind.entries, speed, angle))
    units = units[:-1]
    along = _without_errors((speed * _without_errors(by_parameter * units) - by_theta[0, :-1]) / by_theta[0, -1])
    # `along` is d ln St*/dtheta
    rows = dict(zip(groups, by_theta[:, :-1] + by_theta[:, -1:] * along)) | {"stokes": along * change.stokes}
    turned = units * [name == "impact.angle" for name in names]
    rows["relative_speed"] = (rows["speed"] + speed * math.tan(angle) * turned) / math.cos(angle)
    gradient = np.array([rows[of] for of in values]) / units + 0.0
    elasticity = elasticities(np.array([*values.values()]), gradient, references(scene, names, speed, angle))
    return Moving(
        change,
        gradient={of: numbers(names, row) for of, row in zip(values, gradient)},
        elasticity={of: numbers(names, row) for of, row in zip(values, elasticity)},
    )


def _without_errors(slopes: np.ndarray) -> np.ndarray:
    return np.where(np.abs(slopes) < _ERROR * np.abs(slopes).max(initial=0.0), 0.0, slopes)


def _of_logarithm(scene: Scene, angle: float, change: Change, names: tuple[str, ...], rtol: float) -> np.ndarray:
    """Derivatives of ln v* of a change by the parameters, each alone; ComputationError where it has none."""
    given, entries = DEFAULTS | dict(scene.entries), tuple(name for name in names if name not in MEETING)
    rows = Rows(scene, entries, {}, 1, rtol)
    experiment = rows.unchecked(np.array([float(given[name]) for name in entries]))
    speed, row = scene.speed_of(change.stokes), np.zeros(1, int)
    line = Lines(row, np.array([[speed, speed]]), np.array([[angle, 0.0]]), row - 0.5, row + 0.5, relative=False)
    labels = outcomes_along(experiment, line)
    before, after = labels(np.zeros(2, int), np.array([-_ASIDE, _ASIDE]))
    sides = [OUTCOMES[int(k)] if k >= 0 else "nothing certain" for k in (before, after)]
    if sides != [change.before, change.after]:
        seen = " and ".join(sides)
        raise ComputationError(f"collisions beside St {change.stokes:.10g} end in {seen}: not differentiated")
    bracket = Brackets(row, row - _ASIDE, row + _ASIDE, row + int(before), row + int(after))
    bracket = enclose(labels, bracket, _NARROW)
    by_entry = dict(zip(entries, slopes(experiment, line, bracket)[0].tolist(), strict=True))
    if "impact.angle" in names:
        normal = normals(experiment, line, bracket, approximate=False)
        by_entry["impact.angle"] = float(-normal.angle[0] / normal.along[0])
        is_even = angle < _STEP and not scene.turns(0.0)  # beside head-on: the mirror image
        if not math.isfinite(by_entry["impact.angle"]) and (is_even or angle >= _STEP):  # no gradient grows there
            by_entry["impact.angle"] = _by_angle(experiment, speed, angle, change)
    by_parameter = np.array([by_entry[name] for name in names])
    if not np.isfinite(by_parameter).all():
        lost = ", ".join(name for name in names if not math.isfinite(by_entry[name]))
        raise ComputationError(f"no derivative of the change at St {change.stokes:.10g} by {lost} was found")
    return by_parameter


def _by_angle(experiment: Experiment, speed: float, angle: float, change: Change) -> float:
    """Derivative of ln v* of a change by the angle, from its places at angles beside.

    Raises:
        ComputationError: it is not there.
    """
    row, end = np.zeros(2, int), np.full(2, np.expm1(_REACH))
    aside = Lines(row, np.full((2, 2), speed), np.array([[angle - _STEP, 0.0], [angle + _STEP, 0.0]]), -end, end, False)
    outcomes = [np.full(2, OUTCOMES.index(name)) for name in (change.before, change.after)]
    places = places_again([experiment], aside, Brackets(np.arange(2), row, row, *outcomes), _STEP)
    if not np.isfinite(places).all():
        raise ComputationError("it is not found at angles beside")
    return float(np.diff(np.log1p(places))[0]) / (2 * _STEP)
