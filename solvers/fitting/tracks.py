"""`tracks()`: two tracked centres over time become the table of impacts that `fit` reads."""

import math
import re
from collections.abc import Mapping
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..formatting.tables import aligned
from ..scene import units
from ..scene.columns import Column, row_name
from ..scene.items import item
from ..scene.origin import Result
from ..scene.scene import Scene
from ..scene.values import with_unit
from .filmed_impact import FilmedImpact
from .flights import FLIGHT
from .measurements import CORRELATION, UNITS
from .straight import Flight
from .trackers import PLACES, read_film, with_one_clock

_ACCEPTED = {
    "rate": 'a frequency > 0, as 4000 or "150 kHz"',
    "scale": 'a length of a pixel > 0, as "12.5 um", "2 um/px", "80 px/mm", "1 mm = 80 px"',
    "noise": 'a number > 0 in the unit of the columns, or with a unit, as "0.2 px", "0.4 um"',
    "near": 'a gap >= 0, as "0.1 mm" or "8 px"',
}
_UNITS = {name: unit.replace("rad", "deg") for name, unit in (UNITS | {"speed": "m/s", "angle": "rad"}).items()}
_HIDDEN = (*FLIGHT, CORRELATION)  # written, for `fit`, and not printed
_PIXELS = (None, "px", "pixel", "pixels", "css_pixel", "")
_ALIKE = 1e-9  # difference of two positions that are one number, over all that there are
_COUNT = re.compile(r"(\S*?)\s*(?:css_)?(?:px|pixels?)")


class Tracks(Result):
    """Impacts measured on films."""

    labels: tuple[str, ...] = item("what names the impacts")
    columns: Mapping[str, list[Any]] = item(
        '`speed` (normal), `angle`, `restitution`, ... and their `_sd`, SI, at the scene\'s gaps; `outcome` ("stick", '
        'or "" of impacts that separate); and what `fit` takes: `relative_speed`, `impact_parameter`, `exit_speed`, '
        "`exit_parameter`, `delay`, `turn` of the free flight, with `_sd` and `correlation`"
    )
    noise: tuple[float, ...] = item("standard deviation of a centre's coordinate, m, by impact")
    remarks: tuple[str, ...] = item("sentences", default=())

    def _shown(self, columns: Mapping[str, list[Any]]) -> tuple[list[str], list[list[str]]]:
        """Header and cells, angles in degrees."""
        unit = {name: _UNITS.get(name.removesuffix("_sd"), "") for name in columns}
        head = [f"{name} [{unit[name]}]" if unit[name] else name for name in columns]
        scale = {name: math.degrees(1) if unit[name] == "deg" else 1.0 for name in columns}
        rows = [
            [cell if isinstance(cell, str) else "" if math.isnan(cell) else f"{scale[name] * cell:.6g}"
             for name, cell in zip(columns, row, strict=True)]
            for row in zip(*columns.values(), strict=True)
        ]  # fmt: skip
        return head, rows

    def to_csv(self) -> str:
        """The table that `fit` reads."""
        head, rows = self._shown(self.columns)
        lines = [f"{','.join(row)} # {label}" for row, label in zip(rows, self.labels, strict=True)]
        return "\n".join([",".join(head), *lines]) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet tracks --json`: SI, null where there is none."""
        columns = {
            name: [None if value == "" or value != value else value for value in values]
            for name, values in self.columns.items()
        }
        return {"labels": list(self.labels), **columns, "noise": list(self.noise), "remarks": list(self.remarks)}

    def __str__(self) -> str:
        columns = {name: column for name, column in self.columns.items() if name.removesuffix("_sd") not in _HIDDEN}
        head, rows = self._shown(columns)
        head = [f"normal {name}" if name.startswith("speed") else name for name in head]
        return "\n".join([*aligned([["impact", *head], *([n, *r] for n, r in zip(self.labels, rows))]), *self.remarks])


def tracks(
    film: Any,
    scene: Scene | str | Path,
    *,
    rate: Any = None,
    scale: Any = None,
    scale_sd: float = 0.0,
    noise: Any = None,
    near: Any = None,
    particles: Any = None,
) -> Tracks:
    """Impacts from the tracked centres of two spheres.

    Arguments:
        film: a file, a DataFrame or a mapping with columns `x1`, `y1`, `x2`, `y2` (pixels, or a unit of length) and
            `frame`, or `time` with its unit; `impact` tells several films apart. Or what trackpy, TrackMate (CSV, XML),
            Tracker, DLTdv, ImageJ, LapTrack or napari write; a remark says what it was taken for.
        scene: gives the radii, the film thickness and the rupture gap.
        rate: frames per second, or with a unit, as "150 kHz".
        scale: length of a pixel, in m or with its unit, as "12.5 um"; or as "2 um/px", "80 px/mm", "1 mm = 80 px".
        scale_sd: its relative standard deviation.
        noise: standard deviation of a tracked coordinate, in the unit of the columns, or with its own, as "0.2 px";
            default from the scatter about the straight paths.
        near: frames of a smaller gap between the spheres are left out; in m or with a unit, as "0.1 mm", "8 px". None:
            of those off the straight path of the others the direction alone counts. 0: all count.
        particles: of several the two, as "3,7"; "3+8,7" if the tracker went on with 3 as 8. Default those that meet.

    `rate`, `scale`, `noise` and `near` may be quantities of pint.

    Returns:
        Tracks: normal speed, angle, e_n, e_t, contact time and rotation, with standard deviations.

    Raises:
        InputError: a wrong column; a film with fewer than four frames before the impact, on which they do not meet, or
            of which frames are missing or given twice.

    Example:
        >>> import numpy as np
        >>> from wetdoublet.solvers import tracks
        >>> k = np.arange(120)
        >>> apart = np.where(k < 46, 300 - 2 * k, 162 + k)  # px: head-on, and back with half the speed
        >>> film = {"frame": k, "x1": 0 * k, "y1": 0 * k, "x2": apart, "y2": 0 * k}
        >>> found = tracks(film, "granulation", rate=1000, scale="1 um", noise=0.01)
        >>> round(found.columns["restitution"][0], 3)
        0.5
    """
    loaded = Scene.load(scene)
    if loaded.radius_ratio is None or loaded.pendulum is not None:
        raise InputError("tracks", loaded.name, "two spheres in free flight", "has a wall or strings")
    if not (isinstance(scale_sd, Real) and 0 <= scale_sd < 1):
        raise InputError("scale_sd", scale_sd, "a number from 0 to below 1, as 0.005")
    pixel = None if scale is None else _size(scale, "m", "scale", plain=None)
    per_frame = None if rate is None else 1 / _size(rate, "1/s", "rate")
    radii = 2 * loaded.particles.reduced_radius * (1 + loaded.radius_ratio)
    paths = read_film(film, particles, radii, lambda column: _factor(column, "m", pixel, "scale"))
    paths = with_one_clock(paths, per_frame and 1 / per_frame, lambda column: _factor(column, "s", None, ""))
    columns, lines = paths.columns, paths.lines
    per_frame = None if "time" in columns else per_frame
    coordinates = [_numbers(columns[name], lines, "m", pixel, "scale", gaps=True) for name in PLACES]
    positions = np.stack(coordinates, axis=1)
    unit = _factor(columns["x1"], "m", pixel, "scale")
    rounding = 2 * _rounding(positions / unit) * unit  # of a relative coordinate: those of both may be the same

    given = None if noise is None else math.sqrt(2) * _size(noise, "m", "noise", pixel=pixel, plain=unit)
    gap = None if near is None else _size(near, "m", "near", pixel=pixel, plain=None)
    clock = columns.get("time") or columns.get("frame")
    if clock is None:
        raise InputError("tracks", paths.header, "a column frame, or time [s]", "has no time")
    time = _numbers(clock, lines, "s", per_frame, "rate" * (clock.name == "frame"))
    unit_of_clock = f" {clock.unit}" if clock.unit and clock.name == "time" else ""
    films = np.array(
        [str(cell) for cell in columns["impact"].cells] if "impact" in columns else ["1"] * time.size, object
    )
    reaches = radii, radii + loaded.liquid.film_thickness, radii + loaded.rupture_gap
    rows, sigmas, remarks, labels, left_out = [], [], [], list[str](), list[InputError]()
    for label in dict.fromkeys(films.tolist() or ["1"]):
        frames = np.flatnonzero(films == label)
        which = frames[np.isfinite(positions[frames]).all(axis=1)]
        if lost := frames.size - which.size:
            remarks.append(f"impact {label}: {lost} of {frames.size} frames lack a position and are not used")
        times, first, count = np.unique(time[which], return_index=True, return_counts=True)
        names = [f"{clock.name} {str(clock.cells[k]).strip()}{unit_of_clock}" for k in which[first]]
        repeated = [names[k] for k in np.flatnonzero(count > 1).tolist()]
        path = Flight(times, positions[which[first]], names)
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                values, sigma, remark = FilmedImpact(
                    f"impact {label}", path, repeated, *reaches, given, scale_sd, gap, per_frame, rounding
                ).measured()
        except (InputError, FloatingPointError, ZeroDivisionError) as reason:
            if not isinstance(reason, InputError):
                reason = InputError(f"tracks, impact {label}", None, "centres that move and meet", f"has {reason}")
            left_out.append(reason)
            remarks.append(f"left out: {reason}")
            continue
        labels.append(label)
        rows.append(values)
        sigmas.append(sigma / math.sqrt(2))
        remarks += [f"impact {label}: {text}" for text in remark]
    if not rows:
        raise left_out[0]
    remarks.append(paths.remark)
    if rate is not None and per_frame is None:
        why = "the times are those of the column time. With a column frame the rate counts"
        remarks.append(f"the rate {rate} is not used: {why}")
    if scale is not None and not any(columns[name].unit in _PIXELS for name in PLACES):
        remarks.append(f"the scale {scale} is not used for the positions: these are in {columns['x1'].unit}")
    gaps = f"x0 = {1e6 * loaded.liquid.film_thickness:.4g} um and x_f = {1e6 * loaded.rupture_gap:.4g} um"
    remarks.append(
        f"Speed, angle, e_n, e_t, contact time and rotation are those at the scene's gaps, {gaps}; no standard "
        "deviation holds an error of these. `fit` takes what was measured in free flight, which needs no gap."
    )
    results = {name: [row[name] for row in rows] for name in rows[0]}
    always = ("speed", "angle", "speed_sd", "angle_sd", "outcome", CORRELATION)
    chosen = {name: cells for name, cells in results.items() if name in always or any(cell == cell for cell in cells)}
    return Tracks(tuple(labels), chosen, tuple(sigmas), tuple(remarks))


def _size(value: Any, si: str, option: str, *, pixel: float | None = None, plain: float | None = 1.0) -> float:
    """An option in SI, given as a number, a text or a quantity of another library.

    Arguments:
        pixel: length of a pixel, m, for a length in pixels.
        plain: what a number without a unit is in; None if a text must have one.
    """
    accepted, text, count = _ACCEPTED[option], with_unit(value), 1.0
    if option == "scale" and isinstance(text, str):
        sides = [side.strip() for side in re.split(r"/|=|\bper\b", text.replace("dpi", "px/inch"))]
        pixels = next((match for side in sides if (match := _COUNT.fullmatch(side))), None)
        if pixels and len(sides) == 2:
            length, number = sides[pixels[0] == sides[0]], pixels[1] or "1"
            count = (float(number) or math.nan) if units.is_number(number) else math.nan
            text = length if units.unit_of(length) else f"1 {length}"
    written = units.unit_of(text) if isinstance(text, str) else ""
    digits = text.strip().removesuffix(written) if isinstance(text, str) else text
    unit = re.sub(r"\b(k?)fps\b", r"\1Hz", units.spelling(written.replace(" per ", "/")))
    unit = re.sub(r"\bframes?/", "1/", unit)
    try:
        size = math.nan if isinstance(digits, bool) else float(digits) / count
    except (TypeError, ValueError):
        size = math.nan
    if not (math.isfinite(size) and (size > 0 or (size == 0 and option == "near"))):
        raise InputError(option, value, accepted)
    if unit not in _PIXELS or (isinstance(text, str) and plain is None and not unit):
        try:
            return units.quantity(f"{str(digits).strip()} {unit}", si, option, accepted) / count
        except InputError as reason:
            raise InputError(option, value, accepted, reason.problem) from None
    factor = pixel if unit else plain
    if unit and (option in ("scale", "rate") or factor is None):
        raise InputError(option, value, accepted, "is in pixels" + ", and no scale is given" * (factor is None))
    return size * (1.0 if factor is None else factor)


def _rounding(positions: np.ndarray) -> float:
    """Standard deviation that steps make in which positions (n, 4) come: decimal ones, or any in which values recur."""
    positions = np.unique(positions[np.isfinite(positions).all(axis=1)], axis=0)  # a picture that recurs tells nothing
    scaled = ((step, positions / step) for step in (1, 0.5, 0.1, 0.05, 0.01, 1e-3, 1e-4))
    decimal = next((step for step, values in scaled if np.allclose(values, np.rint(values), rtol=0, atol=1e-6)), 0.0)
    steps = np.diff(np.sort(positions, axis=0), axis=0)
    steps = steps[:, steps.any(axis=0)]
    alike = steps <= _ALIKE * np.ptp(positions) if steps.size else steps > 0
    return max(decimal, steps[~alike].min() if alike.any() else 0.0) / math.sqrt(12)


def _factor(column: Column, si: str, plain: float | None, option: str) -> float:
    if column.unit in _PIXELS:
        if plain is None:
            accepted = f"--{option}, {option}=, or a unit" if option else "a unit"
            accepted += " in the column's name"
            raise InputError("tracks, header", column.name, accepted, "has no unit")
        return plain
    return units.factor(column.unit, si, "tracks, header", f"{column.name} in {si}", column.name)


def _numbers(
    column: Column, lines: list[int], si: str, plain: float | None, option: str, *, gaps: bool = False
) -> np.ndarray:
    """A column in SI; with `gaps` empty cells and "nan", which trackers write for a lost sphere, are NaN."""
    factor, numbers = _factor(column, si, plain, option), []
    for row, cell in enumerate(column.cells):
        try:
            number = math.nan if gaps and cell in (None, "") else float(cell)
        except (TypeError, ValueError):
            number = math.inf
        if not (math.isfinite(number) or (gaps and math.isnan(number))):
            where = f"tracks, {row_name(row + 1, lines[row])}, column {column.name}"
            raise InputError(where, cell, "a number")
        numbers.append(number)
    return factor * np.array(numbers)
