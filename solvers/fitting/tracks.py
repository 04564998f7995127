"""`tracks()`: two tracked centres over time become the table of impacts that `fit` reads.

Before the films touch and after the pair has separated the relative motion is uniform (gravity is common to both), so a
straight line is fitted to each part. Its covariance, from the noise of the positions, is carried to every result.
"""

import math
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from ...generated.automaton import STICK
from ..errors import InputError
from ..formatting.markdown import aligned
from ..scene import units
from ..scene.columns import Column, row_name
from ..scene.scene import Scene
from ..scene.values import with_unit
from .flights import FLIGHT
from .measurements import CORRELATION, OBSERVED, UNITS
from .straight import LEAST, REACH, Flight, near_contact, uneven
from .trackers import PLACES, read_film, with_one_clock

_ACCEPTED = {
    "rate": 'a frequency > 0, as 4000 or "150 kHz"',
    "scale": 'a length of a pixel > 0, as "12.5 um", "2 um/px", "80 px/mm"',
    "noise": 'a number > 0 in the unit of the columns, or with a unit, as "0.2 px", "0.4 um"',
    "near": 'a gap >= 0, as "0.1 mm" or "8 px"',
}
_SIGNED = ("tangential_restitution", "rotation")
_NAMES = ("speed", "angle", *OBSERVED)  # at the scene's gaps
_WITH_SD = ("", "_sd")
_UNITS = {name: unit.replace("rad", "deg") for name, unit in (UNITS | {"speed": "m/s", "angle": "rad"}).items()}
_HIDDEN = (*FLIGHT, CORRELATION)  # written, for `fit`, and not printed
_CLEAR = 4.0  # standard deviations of the noise by which a pair is apart
_WIDER, _MANY = 0.25, 20  # share by which gaps are widened, beyond which frames are free flight, where so many remain
_BLURRED = 0.1  # noise of a relative coordinate, over the distance of touching solids
_LITTLE = 1e-99  # of a variance
_STRAY = 10.0  # times the usual distance from a line, which a frame of a film that is tracked well does not reach
_PIXELS = (None, "px", "pixel", "pixels", "css_pixel", "")
_PER_PIXEL = re.compile(r"(.+)/(?:css_)?(?:px|pixels?)")
_PIXELS_PER = re.compile(r"(?:css_)?(?:px|pixels?)/(.+)")
_BY_DIRECTION = (
    "count by the direction of their line of centres only: they lie off the straight path of the others, as of a "
    "tracker that displaces near discs"
)
_ROUNDING = 1e-9  # of positions, over the distance of the centres
_SIDEWAYS = 3.0  # standard deviations from which an impact is oblique
_NAMED = 6  # frames in a sentence
_STEP = 1e-2  # of differences, over the standard deviation of a parameter
_FEW = 4  # places at which frames are lost that explain a path better than a tracker does
_REFITS = 3  # of a line whose frames near contact are those before it meets
_RESTING = 0.01  # of the distance of touching solids, within which a distance no longer changes
_FASTEST = math.pi / 2  # rotation between two frames from which turns may have been missed


@dataclass(frozen=True)
class Tracks:
    """Impacts measured on films.

    Attributes:
        labels: what names the impacts.
        columns: `speed` (normal), `angle`, `restitution`, ... and their `_sd`, SI, at the scene's gaps; `outcome`
            ("stick", or "" of impacts that separate); and what `fit` takes: `relative_speed`, `impact_parameter`,
            `exit_speed`, `exit_parameter`, `delay`, `turn` of the free flight, with `_sd` and `correlation`.
        noise: standard deviation of a centre's coordinate, m, by impact.
        remarks: sentences.
    """

    labels: tuple[str, ...]
    columns: Mapping[str, list[Any]]
    noise: tuple[float, ...]
    remarks: tuple[str, ...] = field(default=())

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
        scale: length of a pixel, in m or with its unit, as "12.5 um"; or as "2 um/px", "80 px/mm".
        scale_sd: its relative standard deviation.
        noise: standard deviation of a tracked coordinate, in the unit of the columns, or with its own, as "0.2 px";
            None: from the scatter about the straight paths.
        near: frames of a smaller gap between the spheres are left out; in m or with a unit, as "0.1 mm", "8 px". None:
            of those off the straight path of the others the direction alone counts. 0: all count.
        particles: of several the two, as "3,7" or (3, 7); "3+8,7" if the tracker went on with 3 as 8. None: those that
            meet.

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
    rounding = _rounding(positions / unit) * unit * math.sqrt(2)  # of a relative coordinate

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
        path = Flight(times, (positions[:, 2:] - positions[:, :2])[which[first]], names)
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                values, sigma, remark = _impact(
                    f"impact {label}", path, repeated, reaches, given, scale_sd, gap, per_frame, rounding
                )
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
    if scale is not None and columns["x1"].unit not in _PIXELS:
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


def _impact(
    label: str,
    path: Flight,
    repeated: list[str],
    reaches: tuple[float, ...],
    noise: float | None,
    scale_sd: float,
    near: float | None,
    per_frame: float | None,
    rounding: float,
) -> tuple[dict[str, Any], float, list[str]]:
    """Results of one impact, the noise of a relative coordinate (m), and remarks.

    Arguments:
        repeated: names of frames, or times, that several rows have.
        noise: of a relative coordinate, m.
        per_frame: s; None where times are given.
        rounding: standard deviation of a relative coordinate from the digits that are written, m.
    """
    time, relative, names, (solids, touch, apart) = path.time, path.places, path.names, reaches
    where, within, remarks = f"tracks, {label}", "two centres that come within the film", list[str]()
    if repeated and per_frame is None:
        several = f"{', '.join(repeated[:_NAMED])}{' ...' * (len(repeated) > _NAMED)}"
        raise InputError(where, several, "rising times, or a column frame and its rate", "is shared by several rows")
    if time.size < LEAST:
        raise InputError(where, None, f"at least {LEAST} frames before the impact", f"has {time.size} in all")
    distance = np.linalg.norm(relative, axis=1)
    jitter = np.abs(np.diff(relative, 2, axis=0))  # of a uniform motion noise alone
    sigma = noise or (float(np.median(jitter)) / (0.6745 * math.sqrt(6)) if jitter.size else 0.0)
    nearest = int(np.argmin(distance))
    nearly = distance[nearest] + _RESTING * solids  # a tracker may never see them touch
    met = np.append(np.flatnonzero(distance[:nearest] <= max(touch, nearly) + _CLEAR * sigma), nearest)
    nearby = np.append(nearest, nearest + np.flatnonzero(distance[nearest:] <= max(apart, nearly) + _CLEAR * sigma))
    rest = _rests_from(time, distance, max(_CLEAR * sigma, _RESTING * solids))
    first, last = int(min(met[0], rest)), int(nearby[-1])
    before, after = np.arange(time.size) < first, (np.arange(time.size) > last) & (rest == time.size)
    sticks, rests, apart_still = not after.any(), rest < time.size, distance[nearest] > touch + _CLEAR * sigma

    def check_count() -> None:
        for flags, side in ((before, "before the impact"), (after | sticks, "after the separation")):
            if flags.sum() < LEAST:
                problem = f"has {int(flags.sum())} frames {side}" + ": is the scale off?" * (not flags.any())
                raise InputError(where, None, f"at least {LEAST} frames {side}", problem)

    check_count()
    sure = solids + (1 + _WIDER) * (apart - solids)
    if not sticks and distance[-LEAST:].max() < sure:
        problem = f"ends {distance[-1]:.4g} m apart, where the scene's rupture is at {apart:.4g} m: is it a stick?"
        raise InputError(where, None, f"a film that goes on until the spheres are {sure:.4g} m apart", problem)
    floor, interval = max(rounding, noise or 0.0, _ROUNDING * touch), per_frame or float(np.median(np.diff(time)))

    def free(gap: float) -> list[Flight]:
        """Both flights, or the approach to a stick, where the spheres are farther apart than a gap."""
        flights = [path.subset(flags & (distance >= solids + gap)) for flags in (before, after) if flags.any()]
        return flights if min(piece.time.size for piece in flights) >= LEAST else []

    def check_times(gap: float, most: float = math.inf) -> None:
        text, lost = uneven(free(gap), interval, floor)
        faults = [f"has {', '.join(repeated[:_NAMED])} more than once"] if repeated else []
        faults += [text] if text and lost <= most else []
        if faults:
            raise InputError(where, None, "frames numbered as they were filmed, each once", "; ".join(faults))

    for flight in free(0.0):
        back = np.flatnonzero((flight.places[1:] * flight.places[:-1]).sum(axis=1) < 0)
        if back.size:
            problem = f"turn by more than 90 deg after {flight.names[back[0]]}: are the two spheres exchanged?"
            raise InputError(where, None, "a uniform motion", problem)
    gap = near
    if gap is None:
        displaced, gap = near_contact(free(0.0), solids, floor)
        if not repeated:
            check_times(REACH * solids)
        # frames that are lost near contact displace the others inward; a tracker that pushes looks like many lost
        check_times(0.0, math.inf if displaced <= 0 or repeated else _FEW if gap >= REACH * solids else sys.maxsize)
        if math.isinf(gap):
            problem = "lie off a straight path the more, the nearer the spheres are: does the tracker bend it?"
            raise InputError(where, None, f"at least {LEAST} frames of a uniform approach", problem)
        if rests and apart_still and free(REACH * solids):
            gap = max(gap, REACH * solids)
    near_frames = distance < solids + gap
    for mask, reach in ((before, touch), (after, apart)):  # the scene's gaps may be too small
        wide = distance > solids + (1 + _WIDER) * (reach - solids)
        if (mask & wide & ~near_frames).sum() >= _MANY:
            mask &= wide
    turned_only = [flag & near_frames & (near is None) for flag in (before, after)]  # if free: contact is hidden there
    if blank := int(((before | after) & near_frames).sum()):
        use = "are left out" if near is not None else _BY_DIRECTION
        remarks.append(f"{blank} frames in which the gap is below {gap:.3g} m {use}")
    before, after = before & ~near_frames, after & ~near_frames
    check_count()
    time = time - time[first]
    lines, used = list[tuple[np.ndarray, np.ndarray, float, int]](), [before, after]
    for k, (mask, reach, side) in enumerate([(before, touch, -1), (after, apart, 1)][: 1 if sticks else 2]):
        for _ in range(_REFITS):
            line = _line(time, relative, mask, used[k] & ~mask)
            used[k] = mask | (turned_only[k] & (side * (time - _state(line[0], reach, side)[3]) > 0))
        lines.append(line)
    first, last = int(np.flatnonzero(used[0])[-1]) + 1, int(np.flatnonzero(used[1])[0]) - 1 if not sticks else last
    sigma = noise or math.sqrt(sum(line[2] for line in lines) / sum(line[3] for line in lines))
    if sigma > _BLURRED * solids:
        problem = f"scatter by {sigma / math.sqrt(2):.3g} m about their lines: look at the scale and the tracker"
        raise InputError(where, None, f"centres to {_BLURRED / math.sqrt(2):.2g} of the touching distance", problem)
    turned = np.unwrap(np.arctan2(relative[:, 1], relative[:, 0]))
    for mask, reach, (course, *_) in zip((before, after), (touch, sure), lines):
        passing = abs(course[0, 0] * course[1, 1] - course[0, 1] * course[1, 0]) / np.linalg.norm(course[1])
        if passing >= reach:
            problem = f"pass each other at {passing:.4g} m, beyond {reach:.4g} m: is the scale or the diameter off?"
            raise InputError(where, None, within, problem)
        frames = np.flatnonzero(mask)
        off = np.linalg.norm(relative[mask] - course[0] - time[mask, None] * course[1], axis=1)
        worst, usual = int(np.argmax(off)), max(float(np.median(off)), noise or 0.0)
        beside = distance[frames[worst]] - solids
        if off[worst] > _STRAY * usual + _ROUNDING * touch and near is None and beside < REACH * solids:
            wider = float(beside + _RESTING * solids)  # of a tracker that takes part of the other disc for this one
            return _impact(label, path, repeated, reaches, noise, scale_sd, wider, per_frame, rounding)
        if off[worst] > _STRAY * usual + _ROUNDING * touch:
            problem = f"{off[worst]:.3g} m off its line at {names[frames[worst]]}, others {usual:.2g} m"
            raise InputError(where, None, "positions along straight lines", problem)
    check_times(gap)
    end = float(np.median(distance[max(first, time.size - LEAST) :]) if sticks else distance[nearest])
    if sticks:
        if apart_still and not (rests and end < (1 + REACH) * solids):
            problem = f"end {end:.4g} m apart, before the films meet at {touch:.4g} m"
            problem += ", and stay there: is the scale, the diameter or the tracker off?" * rests
            raise InputError(where, None, within, problem)
        if time.size - first < LEAST:
            problem = f"has {time.size - first} after they meet"
            raise InputError(where, None, f"at least {LEAST} frames after the films meet", problem)
        remarks.append(f"together to the end, {time[-1] - time[first]:.3g} s after they met: taken for a stick")
    if (sticks and apart_still) or end < (1 - 2 * _RESTING) * solids - _CLEAR * sigma:
        remarks.append(
            f"its distance {'no longer changes' if sticks else 'is least'} at {end:.4g} m, where solids touch at "
            f"{solids:.4g} m and films at {touch:.4g} m: look at the scale, the diameter and the tracker"
        )

    sense = math.copysign(1.0, _flight(lines[0][0])[1])

    def results(parameters: np.ndarray) -> np.ndarray:
        lines = (1 + parameters[-1]) * parameters[:-1].reshape(-1, 2, 2)
        at, normal, sideways, since = _state(lines[0], touch, -1)
        # the angle of the model, whose rotation rate is v0 tan(theta0)/(4a): that of touching solids
        row = [normal, math.atan2(abs(sideways) * solids / touch, normal)]
        if not sticks:
            then, opening, along, until = _state(lines[1], apart, 1)
            turn = then - at - 2 * math.pi * round((then - at - (turned[last + 1] - turned[first - 1])) / (2 * math.pi))
            tangential = along / sideways if sideways else math.nan
            row += [-opening / normal, tangential, until - since, turn * math.copysign(1, sideways)]
        speed, parameter, time_before, direction = _flight(lines[0])
        free = [speed, sense * parameter]
        if not sticks:
            exit_speed, exit_parameter, time_after, direction_after = _flight(lines[1])
            coming = math.remainder(at - direction - math.pi, 2 * math.pi)
            going = math.remainder(direction_after - then, 2 * math.pi)
            free += [exit_speed, sense * exit_parameter, time_after - time_before, sense * (coming + turn + going)]
        return np.array([*free, *row])

    centre = np.array([*(number for estimate in lines for number in estimate[0].ravel()), 0.0])
    blocks = [np.linalg.cholesky(covariance) * sigma for _, covariance, *_ in lines]
    steps = block_diag(*blocks, [[scale_sd]]).T  # independent deviations of the parameters
    moved = [(results(centre + _STEP * step) - results(centre - _STEP * step)) / (2 * _STEP) for step in steps]
    covariance = np.array(moved).T @ np.array(moved)
    sd = np.sqrt(np.diag(covariance))
    values = dict.fromkeys((name + suffix for name in (*_NAMES, *FLIGHT) for suffix in _WITH_SD), math.nan)
    unknown, count = tuple[str, ...](), 2 if sticks else len(FLIGHT)
    for name, value, error in zip([*list(FLIGHT)[:count], *_NAMES], results(centre), sd):
        values |= {name: float(value), f"{name}_sd": float(error)}
    correlation = (covariance / np.maximum(np.outer(sd, sd), _LITTLE))[:count, :count][np.tril_indices(count, -1)]
    if not sticks and abs(values["exit_parameter"]) >= apart:
        unknown = OBSERVED
        remarks.append("its line after separation passes the other centre beyond the scene's rupture gap: no e_n there")
    elif not sticks and not values["contact_time"] > 0:
        problem = f"last {values['contact_time']:.3g} s: is the scale or the rate off?"
        raise InputError(f"tracks, {label}", None, "contacts that take time", problem)
    if values["angle"] <= _SIDEWAYS * values["angle_sd"] and not sticks:
        unknown += _SIGNED
        remarks.append("head-on within its uncertainty, so that e_t and the sense of the rotation are not known")
    elif not sticks and np.abs(np.diff(turned[first - 1 : last + 2])).max() > _FASTEST:
        unknown += ("rotation", "turn")
        remarks.append("it turns by more than 90 deg between two frames, so that its turns cannot be counted")
    values |= {name + suffix: math.nan for name in unknown for suffix in _WITH_SD}
    written = "" if sticks else " ".join(f"{number:.6f}" for number in correlation)
    return values | {"outcome": STICK if sticks else "", CORRELATION: written}, sigma, remarks


def _rests_from(time: np.ndarray, distance: np.ndarray, tolerance: float) -> int:
    """Frame from which the distance no longer changes, and has not been smaller; the number of frames if it does."""
    end = float(np.median(distance[-LEAST:]))
    since = int(np.append(-1, np.flatnonzero(np.abs(distance - end) > tolerance))[-1]) + 1
    if since == 0 or time.size - since < LEAST or (distance[:since] < end).any():
        return time.size
    would_go = (distance[0] - end) / (time[since] - time[0]) * (time[-1] - time[since])  # as fast as before
    return since if would_go > 4 * tolerance else time.size


def _line(
    time: np.ndarray, relative: np.ndarray, mask: np.ndarray, turned_only: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float, int]:
    """Position at time 0 and velocity, (2, 2); their covariance over the noise's variance; sum of squares; freedom.

    Arguments:
        turned_only: frames of which the direction counts: by symmetry a tracker displaces near discs along their line.
    """
    across = relative[turned_only] @ [[0, 1], [-1, 0]] / np.linalg.norm(relative[turned_only], axis=1)[:, None]
    whole = np.kron(np.stack([np.ones(int(mask.sum())), time[mask]], axis=1), np.eye(2))
    design = np.concatenate([whole, np.hstack([across, time[turned_only, None] * across])])
    values = np.append(relative[mask].ravel(), np.zeros(len(across)))
    solution = np.linalg.lstsq(design, values, rcond=None)[0]
    squares = float(((values - design @ solution) ** 2).sum())
    return solution.reshape(2, 2), np.linalg.inv(design.T @ design), squares, values.size - 4


def _flight(line: np.ndarray) -> tuple[float, float, float, float]:
    """Speed of a line, its least distance from the origin, signed by the sense of rotation, when; and direction."""
    (x, y), (u, v) = line
    speed = math.hypot(u, v)
    return speed, (x * v - y * u) / speed, -(x * u + y * v) / speed**2, math.atan2(v, u)


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


def _size(value: Any, si: str, option: str, *, pixel: float | None = None, plain: float | None = 1.0) -> float:
    """An option in SI, given as a number, a text or a quantity of another library.

    Arguments:
        pixel: length of a pixel, m, for a length in pixels.
        plain: what a number without a unit is in; None if a text must have one.
    """
    accepted, text = _ACCEPTED[option], with_unit(value)
    written = units.unit_of(text) if isinstance(text, str) else ""
    digits = text.strip().removesuffix(written) if isinstance(text, str) else text
    unit = re.sub(r"\b(k?)fps\b", r"\1Hz", units.spelling(written.replace(" per ", "/").replace("dpi", "px/inch")))
    unit = re.sub(r"\bframes?/", "1/", unit)
    try:
        size = math.nan if isinstance(digits, bool) else float(digits)
    except (TypeError, ValueError):
        size = math.nan
    if not (math.isfinite(size) and (size > 0 or (size == 0 and option == "near"))):
        raise InputError(option, value, accepted)
    per_pixel, pixels_per = (form.fullmatch(unit) if option == "scale" else None for form in (_PER_PIXEL, _PIXELS_PER))
    if pixels_per:
        return units.quantity(f"1 {pixels_per[1]}", si, option, accepted) / size
    if unit not in _PIXELS or (isinstance(text, str) and plain is None and not unit):
        return units.quantity(f"{str(digits).strip()} {per_pixel[1] if per_pixel else unit}", si, option, accepted)
    factor = pixel if unit else plain
    if unit and (option in ("scale", "rate") or factor is None):
        raise InputError(option, value, accepted, "is in pixels" + ", and no scale is given" * (factor is None))
    return size * (1.0 if factor is None else factor)


def _rounding(values: np.ndarray) -> float:
    """Standard deviation that the digits make with which values are written."""
    values = values[np.isfinite(values)]
    steps = (step for step in (1, 0.5, 0.1, 0.05, 0.01, 1e-3, 1e-4) if np.allclose(values / step % 1, 0, atol=1e-6))
    return next(steps, 0.0) / math.sqrt(12)


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
