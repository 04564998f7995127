"""`critical()`: the speed up to which impacts stick, and the speed from which on they bounce; by material and angle."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from ...generated import scaling
from ...generated.automaton import BOUNCE, OUTCOMES, STICK
from ..boundaries.boundary import boundary
from ..boundaries.brackets import locate
from ..boundaries.changes import Change
from ..boundaries.experiment import Rows
from ..collision.collide import collide
from ..engines.settings import RTOL, check_rtol
from ..errors import ComputationError, InputError
from ..formatting.tables import aligned
from ..host.arguments import check_function, check_mapping, check_whole
from ..host.pictures import Drawn
from ..many.arguments import checked_numbers
from ..many.collide_many import collide_many
from ..scene.items import cells, csv, item, units
from ..scene.origin import Record, Result
from ..scene.scene import Scene
from ..scene.schema import SPEEDS
from .boundaries import check_boundary_wrt, moving
from .materials import Material, materials_of
from .parameters import cell
from .uncertainty import LEVELS, check_samples, deviations, drawn, normal_deviates, value_of

_NEAR, _FINE, _COARSE = 3.0, 100, 12  # factor about the speed within which draws are searched finely; samples a decade
_SHOWN = ("material", "angle", "relative_speed", "interval", "speed", "stokes", "to", "bounces_above")
_WIDTH = 1e-5  # to which the speed of a draw is enclosed, relative
_BEYOND = 1e-4  # by which the impact that is looked at is faster than the change
_REACH, _PLACES = 10.0, 21  # factor up to which an entry is followed for an extreme, and number of its values
_STICK = OUTCOMES.index(STICK)
Interval = tuple[float | None, float | None]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g}"


def _interval(interval: Interval | None) -> str:
    if interval is None:
        return ""
    low, high = interval
    if low is None or high is None:
        return "open" if low == high else f"below {high:.4g}" if low is None else f"above {low:.4g}"
    return f"{low:.4g} to {high:.4g}"


class CriticalSpeed(Record):
    """The speed up to which impacts of one material stick at one angle; None where the slowest do not, or all do."""

    material: str = item("its name", head="material")
    angle: float = item("impact angle", "rad", "angle (deg)", _degrees)
    searched: tuple[float, float] = item("range of Stokes numbers of the search")
    relative_speed: float | None = item(
        "magnitude of the relative velocity up to which all impacts of the range stick", "m/s",
        "sticks up to relative speed (m/s)", _number, default=None,
    )  # fmt: skip
    speed: float | None = item("normal component of that", "m/s", "normal speed (m/s)", _number, default=None)
    stokes: float | None = item("Stokes number of that", "1", "St", _number, default=None)
    to: str | None = item("outcome just beyond", "", "then", lambda word: word or "-", default=None)
    bounces_above: float | None = item(
        "relative speed from which on all of the range bounce; None if the fastest do not, or all do", "m/s",
        "bounces above relative speed (m/s)", _number, default=None,
    )  # fmt: skip
    slowest: str = item('outcome at the lower end of the range; "" if it could not be computed', default="")
    sticks: tuple[tuple[float, float], ...] = item(
        "intervals of relative speeds that stick; the first and the last may end where the range does", "m/s",
        default=(),
    )  # fmt: skip
    interval: Interval | None = item(
        "95 % interval of `relative_speed`; None for an end that is not in the range. None without uncertain entries",
        "m/s", "95 % interval", _interval, default=None,
    )  # fmt: skip
    gradient: Mapping[str, Any] = item("derivatives of `relative_speed` by parameter, SI", default_factory=dict)
    elasticity: Mapping[str, Any] = item("the same as d ln/d ln p", default_factory=dict)
    sentences: tuple[str, ...] = item("what the numbers leave out", default=())
    validity: tuple[str, ...] = item(
        "where an impact just above that speed, or else the slowest, leaves the model's range", default=()
    )
    failed: bool = item("whether there is no answer; the first sentence says why", default=False)


class Critical(Result, Drawn):
    """Critical speeds, a row for each material and angle.

    `plot` draws the relative speed up to which they stick over the angle, or by material.

    Example:
        >>> from wetdoublet.solvers import critical
        >>> critical("granulation", angle=[0.0, 0.3]).to_dict()["rows"][1]["to"]
        'bounce'
    """

    _picture = "sensitivity.plots.draw_critical"
    _keys = "rows rtol units"

    rows: tuple[CriticalSpeed, ...]
    scene: Scene | None = item("the scene, unless there are several materials")
    rtol: float
    units: ClassVar = units(CriticalSpeed)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet critical --json`: the row itself if there is one, else `rows`."""
        result = super().to_dict()
        return result.pop("rows")[0] | result if len(self.rows) == 1 else result

    def __str__(self) -> str:
        head, rows = cells(self.rows, _SHOWN)
        where = [f"{row.material} {_degrees(row.angle)} deg".strip() for row in self.rows]
        lines = aligned([head, *rows])
        lines += [f"{at}: {text}" for at, row in zip(where, self.rows, strict=True) for text in row.sentences]
        for text in dict.fromkeys(text for row in self.rows for text in row.validity):
            outside = [at for at, row in zip(where, self.rows, strict=True) if text in row.validity]
            lines.append(f"{', '.join(outside) if len(outside) < len(where) else 'throughout'}: {text}")
        names = dict.fromkeys(name for row in self.rows for name in row.gradient)
        if names:
            lines += ["", "d ln(relative speed)/d ln p (* its derivative, SI, where p is zero)"]
            slopes = [
                [name, *(cell(row.elasticity.get(name), row.gradient.get(name), "0") for row in self.rows)]
                for name in names
            ]
            lines += aligned([["", *where], *slopes])
        return "\n".join(lines)

    __repr__ = __str__  # at the prompt

    def columns(self) -> dict[str, list[Any]]:
        """A value for each material and angle (rad) by name; speeds in m/s."""
        names = ("material", "angle", "relative_speed", "low", "high", "speed", "stokes", "to", "bounces_above")
        records = [vars(row) | dict(zip(("low", "high"), row.interval or (None, None))) for row in self.rows]
        return {name: [record[name] for record in records] for name in names}

    def to_csv(self) -> str:
        """A row for each material and angle: speeds in m/s, angles in rad; empty where there is none."""
        return csv(self.columns(), self.units | {"low": "m/s", "high": "m/s"})


def critical(
    scene: Any,
    *,
    angle: Any = None,
    uncertainty: Mapping[str, Any] | None = None,
    wrt: Sequence[str] | str | None = None,
    stokes: tuple[float, float] | None = None,
    samples: int = 256,
    rtol: float = RTOL,
    progress: Callable[[int, int], None] | None = None,
) -> Critical:
    """The speed up to which impacts stick, for each angle and material.

    The boundaries of all lines are traced over the range of Stokes numbers, and every change of outcome is confirmed by
    collisions just below and just above it (`boundary`).

    Arguments:
        scene: a Scene, a path or a preset's name; or a table of materials: a CSV file, a DataFrame, or a mapping of
            columns, which are entries by dotted name (see `materials_of`).
        angle: impact angles in rad, a number or 1-D; default the scene's, or head-on.
        uncertainty: standard deviations of entries by dotted name, as {"liquid.viscosity": "5 %"}; a table of materials
            may have its own, as columns `liquid.viscosity_sd`.
        wrt: parameters by which the relative speed is differentiated; "all" for those of the scene. Of parameters that
            are named, a sentence says where the speed has a maximum or minimum within a factor of ten.
        stokes: lowest and highest Stokes number of the search, as for `boundary`.
        samples: draws of the uncertain entries, a power of two: independent normal distributions, truncated to values
            that the entries may have.
        rtol: relative tolerance of the integrations.
        progress: called with (materials done, materials in all).

    Returns:
        Critical: a row for each material and angle.

    Raises:
        InputError: an invalid entry, name or number. A line that fails raises nothing; its row says why.

    Example:
        >>> import wetdoublet as wd
        >>> row = wd.critical("granulation", angle="30 deg").rows[0]
        >>> round(row.relative_speed, 3), row.to
        (1.795, 'stick-rotate-separate')
    """
    rtol, samples = check_rtol(rtol), check_samples(check_whole(samples, "samples", 2, 2**16))
    check_function(progress, "progress")
    check_mapping({} if uncertainty is None else uncertainty, "uncertainty", "standard deviations by dotted name")
    materials = materials_of(scene)
    rows: list[CriticalSpeed] = []
    for done, material in enumerate(materials, 1):
        spread = {**material.uncertainty, **(uncertainty or {})}
        rows += _of_material(material, angle, spread, wrt, stokes, samples, rtol)
        if progress:
            progress(done, len(materials))
    return Critical(tuple(rows), materials[0].scene if len(materials) == 1 else None, rtol)


def _of_material(
    material: Material, angle: Any, uncertainty: Mapping[str, Any], wrt: Sequence[str] | str | None,
    stokes: tuple[float, float] | None, samples: int, rtol: float,
) -> list[CriticalSpeed]:  # fmt: skip
    scene = material.scene
    for name in [entry for entry in uncertainty if entry in SPEEDS]:
        raise InputError("uncertainty", name, "entries other than the speed", "is what is sought")
    names = () if wrt is None else check_boundary_wrt(scene, None if wrt == "all" else wrt)
    if uncertainty:
        deviations(scene, uncertainty)
    angles = checked_numbers("impact.angle", (scene.angle or 0.0) if angle is None else angle).reshape(-1)
    traced = boundary(scene, angle=angles, stokes=stokes, rtol=rtol)
    rows = []
    for k, (at, changes) in enumerate(zip(traced.angles, traced.changes, strict=True)):
        row = CriticalSpeed(material.label, at, traced.window)
        if traced.failures[k]:
            row = replace(row, sentences=(traced.failures[k],), failed=True)
        else:
            row = _row(scene, row, changes, traced.range_text, rtol)
        if row.stokes is not None and uncertainty:
            row = _with_interval(scene, row, uncertainty, samples, rtol, traced.range_text)
        if row.stokes is not None and names:
            slopes = moving(scene, at, changes[0], names, rtol)
            gradient, elasticity = (table.get("relative_speed", {}) for table in (slopes.gradient, slopes.elasticity))
            sentences = [f"no derivatives: {slopes.reason}"] if slopes.reason else []
            sentences += [text for name in names if wrt != "all" for text in _extremes(scene, row, name, rtol)]
            row = replace(row, gradient=gradient, elasticity=elasticity, sentences=(*row.sentences, *sentences))
        if not row.failed:
            row = replace(row, validity=_validity(scene, row, rtol))
        rows.append(replace(row, sentences=(*row.sentences, *[material.remark] * bool(material.remark))))
    return rows


def _row(scene: Scene, row: CriticalSpeed, changes: Sequence[Change], searched: str, rtol: float) -> CriticalSpeed:
    """The row with what its changes of outcome mean, or why nothing is known where there are none."""
    if changes:
        slowest = changes[0].before
    else:
        seen = collide_many(scene, stokes=row.searched[0], angle=row.angle, rtol=rtol, of=("outcome",))
        if seen.outcome.item() < 0:
            reason = f"no collision could be computed at the slowest: {seen.reason.item()}"
            return replace(row, sentences=(reason,), failed=True)
        slowest = OUTCOMES[seen.outcome.item()]
    per_stokes = 1 / scene.stokes_per_speed / math.cos(row.angle)
    outcomes = [slowest, *(change.after for change in changes)]
    ends = [edge * per_stokes for edge in (row.searched[0], *(change.stokes for change in changes), row.searched[1])]
    sticks = tuple((ends[k], ends[k + 1]) for k, outcome in enumerate(outcomes) if outcome == STICK)
    above = ends[-2] if changes and outcomes[-1] == BOUNCE else None
    row, sentences = replace(row, slowest=slowest, sticks=sticks, bounces_above=above), []
    if not changes:
        sentences = [f"no change in the range that was searched: {slowest} for all of {searched}"]
    elif slowest == STICK:
        speed = changes[0].stokes / scene.stokes_per_speed
        row = replace(row, stokes=changes[0].stokes, speed=speed, relative_speed=ends[1], to=changes[0].after)
    else:
        sentences = [f"the slowest do not stick: {slowest} from the lower end of the range on, {searched}"]
    if changes:
        again = "again " if slowest == STICK else ""
        sentences += [f"sticks {again}from {a:.4g} to {b:.4g} m/s (relative speed)" for a, b in sticks[bool(again) :]]
        sentences += [] if above else [f"no speed from which on all bounce, {searched}"]
    return replace(row, sentences=tuple(sentences))


def _validity(scene: Scene, row: CriticalSpeed, rtol: float) -> tuple[str, ...]:
    stokes = row.searched[0] if row.stokes is None else row.stokes * (1 + _BEYOND)
    try:
        return collide(scene, stokes=stokes, angle=row.angle, rtol=rtol, ledger=False).validity
    except ComputationError:  # undecided, so near the boundary
        return ()


def _with_interval(
    scene: Scene, row: CriticalSpeed, uncertainty: Mapping[str, Any], samples: int, rtol: float, searched: str
) -> CriticalSpeed:
    """The row with the 95 % interval of its relative speed: from draws of the entries, each located by collisions."""
    at = scene.with_impact(angle=row.angle)
    columns = drawn(at, uncertainty, normal_deviates(samples, len(uncertainty)))
    try:
        speeds = _speeds(at, row, columns, samples, rtol)
    except ComputationError as error:  # no compiled kernel
        return replace(row, sentences=(*row.sentences, f"no interval: {error}"))
    speeds = speeds[~np.isnan(speeds)]
    below, above = (float(np.quantile(speeds, LEVELS[0], method="lower")),
                    float(np.quantile(speeds, LEVELS[1], method="higher")))  # fmt: skip
    interval, sentences = (below or None, above if np.isfinite(above) else None), list(row.sentences)
    if None in interval:
        which = "all stick" if interval[1] is None else "not even the slowest stick"
        sentences.append(f"in more than 2.5 % of the draws {which} in the range, {searched}")
    if lost := samples - speeds.size:
        sentences.append(f"{lost} of {samples} draws make no scene and are left out")
    return replace(row, interval=interval, sentences=tuple(sentences))


def _speeds(at: Scene, row: CriticalSpeed, columns: dict[str, np.ndarray], count: int, rtol: float) -> np.ndarray:
    """The relative speeds up to which scenes stick whose entries vary; NaN for one that is impossible.

    Infinite for one that sticks throughout the range, and 0 for one that does not where it is slowest.
    """
    angle = np.abs(columns.pop("impact.angle", np.full(count, row.angle)))
    experiment = Rows(at, (), columns, count, rtol).unchecked(np.zeros(0))
    possible = np.flatnonzero(np.broadcast_to(experiment.possible, count))
    radius, mass, viscosity = (experiment.columns[name] for name in ("reduced_radius", "reduced_mass", "viscosity"))
    per_speed = np.broadcast_to(scaling.stokes(radius, mass, viscosity, 1.0), count)
    centre, (low, high) = row.stokes, row.searched
    assert centre is not None

    def labels(line: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        which = possible[line]
        outcome = experiment.outcomes(which, stokes / per_speed[which], angle[which])
        return np.where(outcome < 0, -1, outcome != _STICK)

    near = max(low, centre / _NEAR), min(high, centre * _NEAR)
    parts = ((low, near[0], _COARSE), (*near, _FINE), (near[1], high, _COARSE))
    grids = [np.geomspace(a, b, 2 + int(density * np.log10(b / a))) for a, b, density in parts if b > a]
    grid = np.unique(np.concatenate(grids))
    changes = locate(labels, np.tile(grid, (possible.size, 1)), lambda brackets: _WIDTH * brackets.low, unknown=-1)
    ends = np.where(changes.first == 0, np.inf, 0.0)
    first = np.flatnonzero((changes.before == 0) & (np.append(-1, changes.line[:-1]) != changes.line))
    ends[changes.line[first]] = changes.place[first]
    speeds = np.full(count, np.nan)
    speeds[possible] = ends / per_speed[possible] / np.cos(angle[possible])
    return speeds


def _extremes(scene: Scene, row: CriticalSpeed, name: str, rtol: float) -> list[str]:
    """Where the critical speed has a maximum or a minimum over an entry, within a factor of `_REACH` of its value."""
    at = scene.with_impact(angle=row.angle)
    entry, value = at.fields[name], value_of(at, name)
    grid = np.array([place for place in value * np.geomspace(1 / _REACH, _REACH, _PLACES) if entry.range.holds(place)])
    try:
        speeds, texts = _speeds(at, row, {name: grid}, grid.size, rtol), []
    except ComputationError:  # no compiled kernel
        return []
    if not (valid := speeds[~np.isnan(speeds)]).size:
        return []
    for word, sign in (("maximum", 1), ("minimum", -1)):
        k = int(np.nanargmax(sign * speeds))
        if not (0 < k < grid.size - 1 and speeds[k] > 0 and np.isfinite(speeds[k - 1 : k + 2]).all()):
            continue
        if (sign * (speeds[k] - 10 * sign * _WIDTH * speeds[k]) > sign * valid[[0, -1]]).all():  # not at an end
            places = np.linspace(grid[k - 1], grid[k + 1], 2 * _PLACES)
            fine = _speeds(at, row, {name: places}, places.size, rtol)
            best = int(np.nanargmax(sign * fine))
            where = f"{places[best]:.3g} {entry.unit or ''}".rstrip()
            texts.append(f"over {name} it has a {word}, {fine[best]:.4g} m/s (relative speed) at {where}")
    return texts
