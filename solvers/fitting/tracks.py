"""`tracks()`: two tracked centres over time become the table of impacts that `fit` reads.

Before the films touch and after the pair has separated the relative motion is uniform (gravity is common to both), so a
straight line is fitted to each part. Its covariance, from the noise of the positions, is carried to every result.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from ...generated.automaton import STICK
from ..errors import InputError
from ..formatting.markdown import aligned
from ..scene import units
from ..scene.columns import Column, columns_of, row_name
from ..scene.scene import Scene
from .measurements import OBSERVED

_SIGNED = ("tangential_restitution", "rotation")
_NAMES = ("speed", "angle", *OBSERVED)
_UNITS = {"speed": "m/s", "angle": "deg", "contact_time": "s", "rotation": "deg"}
_CLEAR = 4.0  # standard deviations of the noise by which a pair is apart
_LEAST = 4  # frames of a line
_STRAY = 10.0  # times the usual distance from a line, which a frame of a film that is tracked well does not reach
_QUANTUM = 0.3  # pixels: jitter of positions in whole pixels
_PIXELS = (None, "px", "pixel", "pixels", "")
_ROUNDING = 1e-9  # of positions, over the distance of the centres
_SIDEWAYS = 3.0  # standard deviations from which an impact is oblique
_STEP = 1e-2  # of differences, over the standard deviation of a parameter
_FASTEST = math.pi / 2  # rotation between two frames from which turns may have been missed


@dataclass(frozen=True)
class Tracks:
    """Impacts measured on films.

    Attributes:
        labels: what names the impacts.
        columns: `speed` (normal), `angle`, `restitution`, ... and their `_sd`, SI, and `outcome` ("stick", or "" of
            impacts that separate); as `fit` takes them.
        noise: standard deviation of a centre's coordinate, m, by impact.
        remarks: sentences.
    """

    labels: tuple[str, ...]
    columns: Mapping[str, list[Any]]
    noise: tuple[float, ...]
    remarks: tuple[str, ...] = field(default=())

    def _shown(self) -> tuple[list[str], list[list[str]]]:
        """Header and cells, angles in degrees."""
        unit = {name: _UNITS.get(name.removesuffix("_sd"), "") for name in self.columns}
        head = [f"{name} [{unit[name]}]" if unit[name] else name for name in self.columns]
        scale = {name: math.degrees(1) if unit[name] == "deg" else 1.0 for name in self.columns}
        rows = [
            [each if isinstance(each, str) else "" if math.isnan(each) else f"{scale[name] * each:.6g}"
             for name, each in zip(self.columns, row, strict=True)]
            for row in zip(*self.columns.values(), strict=True)
        ]  # fmt: skip
        return head, rows

    def to_csv(self) -> str:
        """The table that `fit` reads."""
        head, rows = self._shown()
        lines = [f"{','.join(row)} # {label}" for row, label in zip(rows, self.labels, strict=True)]
        return "\n".join([",".join(head), *lines]) + "\n"

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet tracks --json`: SI, null where there is none."""
        columns = {
            name: [None if each == "" or each != each else each for each in values]
            for name, values in self.columns.items()
        }
        return {"labels": list(self.labels), **columns, "noise": list(self.noise), "remarks": list(self.remarks)}

    def __str__(self) -> str:
        head, rows = self._shown()
        head = [f"normal {each}" if each.startswith("speed") else each for each in head]
        return "\n".join([*aligned([["impact", *head], *([n, *r] for n, r in zip(self.labels, rows))]), *self.remarks])


def tracks(
    film: Any,
    scene: Scene | str | Path,
    *,
    rate: float | None = None,
    scale: float | str | None = None,
    scale_sd: float = 0.0,
    noise: float | None = None,
) -> Tracks:
    """Impacts from the tracked centres of two spheres.

    Arguments:
        film: a CSV file, a DataFrame or a mapping with columns `x1`, `y1`, `x2`, `y2` (pixels, or a unit of length) and
            `frame`, or `time` with its unit; `impact` tells several films apart.
        scene: gives the radii, the film thickness and the rupture gap.
        rate: frames per second.
        scale: length of a pixel, in m or with its unit, as "12.5 um".
        scale_sd: its relative standard deviation.
        noise: standard deviation of a tracked coordinate, in pixels or the unit of the columns; None: from the scatter
            about the straight paths.

    Returns:
        Tracks: normal speed, angle, e_n, e_t, contact time and rotation, with standard deviations.

    Raises:
        InputError: a wrong column; a film with fewer than four frames before the impact, or on which they do not meet.

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
    columns, lines = columns_of(film, "tracks")
    known = {column.name: column for column in columns}
    for name in [each for each in ("x1", "y1", "x2", "y2") if each not in known]:
        raise InputError("tracks", ", ".join(known), "columns x1, y1, x2, y2, and frame or time", f"has no {name}")
    if isinstance(scale, str):
        scale = units.quantity(scale, "m", "scale", '"12.5 um"')
    coordinates = [_numbers(known[name], lines, "m", scale, "scale", gaps=True) for name in ("x1", "y1", "x2", "y2")]
    positions = np.stack(coordinates, axis=1)
    unit = _factor(known["x1"], "m", scale, "scale")
    least = _QUANTUM * unit if known["x1"].unit in _PIXELS else 0.0
    if "time" in known:
        time = _numbers(known["time"], lines, "s", None, "")
    elif "frame" in known:
        time = _numbers(known["frame"], lines, "s", 1 / rate if rate else None, "rate")
    else:
        raise InputError("tracks", ", ".join(known), "a column frame, or time [s]", "has no time")
    films = [str(each) for each in known["impact"].cells] if "impact" in known else ["1"] * time.size
    radii = 2 * loaded.particles.reduced_radius * (1 + loaded.radius_ratio)
    reaches = radii, radii + loaded.liquid.film_thickness, radii + loaded.rupture_gap
    rows, sigmas, remarks, labels, left_out = [], [], [], list[str](), list[InputError]()
    for label in dict.fromkeys(films):
        frames = np.flatnonzero([each == label for each in films])
        which = frames[np.isfinite(positions[frames]).all(axis=1)]
        which = which[np.argsort(time[which], kind="stable")]
        if lost := frames.size - which.size:
            remarks.append(f"impact {label}: {lost} of {frames.size} frames lack a position and are not used")
        relative = positions[which, 2:] - positions[which, :2]
        given = None if noise is None else math.sqrt(2) * noise * unit
        try:
            values, sigma, said = _impact(f"impact {label}", time[which], relative, reaches, given, scale_sd, least)
        except InputError as error:
            left_out.append(error)
            remarks.append(f"left out: {error}")
            continue
        labels.append(label)
        rows.append(values)
        sigmas.append(sigma / math.sqrt(2))
        remarks += [f"impact {label}: {said}"] if said else []
    if not rows:
        raise left_out[0]
    gaps = f"x0 = {1e6 * loaded.liquid.film_thickness:.4g} um and x_f = {1e6 * loaded.rupture_gap:.4g} um"
    remarks.append(
        f"Speed, angle, contact time and rotation are those at the scene's gaps, {gaps}; no standard deviation holds "
        "an error of these. Do not fit the film or the bridge to this contact time and rotation."
    )
    results = {name: [row[name] for row in rows] for name in rows[0]}
    always = ("speed", "angle", "speed_sd", "angle_sd", "outcome")
    kept = {name: each for name, each in results.items() if name in always or any(one == one for one in each)}
    return Tracks(tuple(labels), kept, tuple(sigmas), tuple(remarks))


def _impact(
    label: str,
    time: np.ndarray,
    relative: np.ndarray,
    reaches: tuple[float, ...],
    noise: float | None,
    scale_sd: float,
    least: float,
) -> tuple[dict[str, Any], float, str]:
    """Results of one impact, the noise of a relative coordinate (m), and a remark.

    Arguments:
        least: jitter from frame to frame that rounding to pixels makes, m.
    """
    distance, (solids, touch, apart) = np.linalg.norm(relative, axis=1), reaches
    jitter = np.abs(np.diff(relative, 2, axis=0))  # of a uniform motion noise alone
    sigma = noise or (float(np.median(jitter)) / (0.6745 * math.sqrt(6)) if jitter.size else 0.0)
    nearest = int(np.argmin(distance))
    met = np.append(np.flatnonzero(distance[:nearest] <= touch + _CLEAR * sigma), nearest)
    left = np.append(nearest, nearest + np.flatnonzero(distance[nearest:] <= apart + _CLEAR * sigma))
    first, last = int(met[0]), int(left[-1])
    before, after = np.arange(time.size) < first, np.arange(time.size) > last
    sticks, within = not after.any(), "two centres that come within the film"
    if sticks and distance[nearest] > touch + _CLEAR * sigma:
        problem = f"end {distance[nearest]:.4g} m apart, before the films meet at {touch:.4g} m"
        raise InputError(f"tracks, {label}", None, within, problem)
    if sticks and time.size - first < _LEAST:
        frames = f"at least {_LEAST} frames after the films meet"
        raise InputError(f"tracks, {label}", None, frames, f"end {time.size - first} frames after it")
    for part, side in ((before, "before the impact"), (after | sticks, "after the separation")):
        if part.sum() < _LEAST:
            problem = f"has {int(part.sum())} {side}"
            raise InputError(f"tracks, {label}", None, f"at least {_LEAST} frames {side}", problem)
    since_first, time = float(time[first]), time - time[first]
    lines = [_line(time, relative, part) for part in ((before,) if sticks else (before, after))]
    freedom = sum(2 * int(each.sum()) - 4 for each in (before, after) if each.any())
    sigma = noise or math.sqrt(sum(one[2] for one in lines) / freedom)
    turned = np.unwrap(np.arctan2(relative[:, 1], relative[:, 0]))
    places = [(before, touch, lines[0])] + ([] if sticks else [(after, apart, lines[1])])
    for part, reach, (line, _, _) in places:
        passing = abs(line[0, 0] * line[1, 1] - line[0, 1] * line[1, 0]) / np.linalg.norm(line[1])
        if passing >= reach:
            problem = f"pass each other at {passing:.4g} m, beyond {reach:.4g} m: is the scale or the diameter off?"
            raise InputError(f"tracks, {label}", None, within, problem)
        off = np.linalg.norm(relative[part] - line[0] - time[part, None] * line[1], axis=1)
        worst, usual = int(np.argmax(off)), max(float(np.median(off)), noise or 0.0)
        if off[worst] > _STRAY * usual + _ROUNDING * touch:
            problem = (
                f"{off[worst]:.3g} m off its line at {since_first + time[part][worst]:.6g} s, others {usual:.2g} m"
            )
            raise InputError(f"tracks, {label}", None, "positions along straight lines", problem)
        steps, times = np.diff(relative[part], axis=0), np.diff(time[part])
        jumps = np.linalg.norm(steps - times[:, None] * np.median(steps / times[:, None], axis=0), axis=1)
        worst, usual = int(np.argmax(jumps)), max(float(np.median(jumps)), noise or 0.0, least)
        if jumps[worst] > _STRAY * usual + _ROUNDING * touch:
            problem = (
                f"jump by {jumps[worst]:.3g} m after {since_first + time[part][worst]:.6g} s, others by {usual:.2g} m: "
                "is a frame missing that the numbers of the frames do not count, or are the two spheres exchanged?"
            )
            raise InputError(f"tracks, {label}", None, "a uniform motion", problem)

    def results(parameters: np.ndarray) -> np.ndarray:
        lines = (1 + parameters[-1]) * parameters[:-1].reshape(-1, 2, 2)
        at, normal, sideways, since = _state(lines[0], touch, -1)
        # the angle of the model, whose rotation rate is v0 tan(theta0)/(4a): that of touching solids
        found = [normal, math.atan2(abs(sideways) * solids / touch, normal)]
        if not sticks:
            then, opening, along, until = _state(lines[1], apart, 1)
            turn = then - at - 2 * math.pi * round((then - at - (turned[last + 1] - turned[first - 1])) / (2 * math.pi))
            tangential = along / sideways if sideways else math.nan
            found += [-opening / normal, tangential, until - since, turn * math.copysign(1, sideways)]
        return np.array(found)

    centre = np.array([*(each for one in lines for each in one[0].ravel()), 0.0])
    blocks = [np.kron(np.linalg.cholesky(one[1]), np.eye(2)) * sigma for one in lines]
    steps = block_diag(*blocks, [[scale_sd]]).T  # independent deviations of the parameters
    moved = [(results(centre + _STEP * step) - results(centre - _STEP * step)) / (2 * _STEP) for step in steps]
    sd = np.sqrt((np.array(moved) ** 2).sum(axis=0))
    values = dict.fromkeys((*_NAMES, *(f"{name}_sd" for name in _NAMES)), math.nan)
    for name, value, error in zip(_NAMES, results(centre), sd):
        values |= {name: float(value), f"{name}_sd": float(error)}
    if not sticks and not values["contact_time"] > 0:
        problem = f"last {values['contact_time']:.3g} s: is the scale or the rate off?"
        raise InputError(f"tracks, {label}", None, "contacts that take time", problem)
    remark = ""
    if values["angle"] <= _SIDEWAYS * values["angle_sd"] and not sticks:
        values |= dict.fromkeys((*_SIGNED, *(f"{name}_sd" for name in _SIGNED)), math.nan)
        remark = "head-on within its uncertainty, so that e_t and the sense of the rotation are not known"
    elif not sticks and np.abs(np.diff(turned[first - 1 : last + 2])).max() > _FASTEST:
        values |= dict.fromkeys(("rotation", "rotation_sd"), math.nan)
        remark = "it turns by more than 90 deg between two frames, so that its turns cannot be counted"
    if sticks:
        remark = f"together to the end of the film, {time[-1] - time[first]:.3g} s after they met: taken for a stick"
    ordered = {name: values[name] for each in _NAMES for name in (each, f"{each}_sd")}
    return ordered | {"outcome": STICK if sticks else ""}, sigma, remark


def _line(time: np.ndarray, relative: np.ndarray, part: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Position at time 0 and velocity, (2, 2); their covariance over the noise's variance; sum of squared residuals."""
    design = np.stack([np.ones(int(part.sum())), time[part]], axis=1)
    solution = np.linalg.lstsq(design, relative[part], rcond=None)[0]
    return solution, np.linalg.inv(design.T @ design), float(((relative[part] - design @ solution) ** 2).sum())


def _state(line: np.ndarray, distance: float, side: int) -> tuple[float, float, float, float]:
    """Angle of the line of centres, approach and tangential speed, and time, where a path crosses a distance.

    Arguments:
        side: -1 for the earlier crossing, 1 for the later one.
    """
    start, velocity = line
    speed, along = float(velocity @ velocity), float(start @ velocity)
    root = max(along**2 - speed * (float(start @ start) - distance**2), 0.0)
    time = (-along + side * math.sqrt(root)) / speed
    place = start + time * velocity
    normal = place / np.linalg.norm(place)
    sideways = normal[0] * velocity[1] - normal[1] * velocity[0]
    return math.atan2(place[1], place[0]), -float(normal @ velocity), float(sideways), time


def _factor(column: Column, si: str, plain: float | None, option: str) -> float:
    if column.unit in _PIXELS:
        if plain is None:
            accepted = f"{option}, or a unit in the column's name" if option else "a unit in the column's name"
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
