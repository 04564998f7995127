"""Films as trackers write them: their tables become columns `x1`, `y1`, `x2`, `y2` over frames or times.

A table is long, with a row for each particle and frame, or wide, with a row for each frame. Y may point either way: the
mirror image of a collision has the same results.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
from scipy.spatial import KDTree

from ..errors import InputError, several
from ..scene.columns import Column, columns_from_text, columns_of, text_of, without_index
from ..scene.units import COMMON
from .straight import LEAST

if TYPE_CHECKING:
    import pandas as pd

PLACES = ("x1", "y1", "x2", "y2")
Units = Callable[[Column], float]
"""The factor of a column of lengths or times to SI; InputError if it has no unit."""

_ACCEPTED = (
    "columns x1, y1, x2, y2, as x1 or x1 [mm], and frame or time [s]; or a long table of x, y, frame, particle "
    "(trackpy, LapTrack, napari), TrackMate's CSV or XML, an export of Tracker or DLTdv, or ImageJ's Results"
)
_SPELT = {  # as trackers name columns, in small letters and underscores; of several the first
    "frame": "frame slice image picture frame_number slice_n axis_0 frame_y",
    "time": "time t position_t",
    "impact": "impact film video",
    "x": "x position_x x_position pos_x axis_2 xm",
    "y": "y position_y y_position pos_y axis_1 ym",
    "z": "z position_z z_position pos_z",
    "particle": "particle track_id trackid particle_id track trajectory track_n id",
}
_KINDS = {  # columns by which a table is known, of several kinds the first
    "TrackMate's table of spots": {"position_x", "visibility"},
    "a table of LapTrack": {"tree_id"},
    "a table of trackpy": {"particle"},
    "a table of napari": {"track_id", "t"},
    "tracks of napari": {"id", "t"},
    "points of napari": {"axis_0"},
    "ImageJ's Results": {"slice", "x"},
    "an export of DLTdv, a row for each frame": {"pt1_cam1_x"},
}
_TRACKER, _XML = "an export of Tracker", "TrackMate's XML"
_BEHIND = {"inch": ("m",), "inches": ("m",), "ns": ("s",), "min": ("s",)}  # units that may stand behind a name, too
_UNITS = {"sec": "s", "seconds": "s", "msec": "ms", "micron": "um", "microns": "um"}  # as Fiji writes them
_BODY = re.compile(r"([xy])_?(\d+)|(\w*?)_?([xy])")  # x1, x_1, pt1_cam1_x, mass_a_x
_UNIT_BEHIND = re.compile(r"((?:(\w*?[xyz](?:_?\d+)?)|time|t))_([A-Za-z]+)", re.IGNORECASE)  # x1_mm, pos_x_px, time_ms
_NEAR = (0.7, 1.2)  # closest approach of two that meet, over the distance of touching solids
_OFF = 1.3  # of times that are rounded, from a rate that is given beside them
_AVI, _MATROSKA = 600.0, 1e-3  # 1/s of an AVI header for every faster film; s, the clock of Matroska


@dataclass(frozen=True)
class Film:
    """Paths of two particles.

    Attributes:
        columns: `x1`, `y1`, `x2`, `y2`, `frame`, `time`, `impact`, where they are known.
        lines: of each row in its file.
        remark: a sentence that says what the table was taken for.
        header: the names of all columns of the table.
    """

    columns: dict[str, Column]
    lines: list[int]
    remark: str
    header: str


def read_film(source: Any, particles: Any, solids: float, lengths: Units) -> Film:
    """The paths of two particles in a tracker's table.

    Arguments:
        source: a file, a DataFrame or a mapping of columns.
        particles: the two, as "3,7", a sequence, or "3+8,7" where a tracker went on with another number; None: those
            that meet.
        solids: distance of the centres of touching solids, m.

    Raises:
        InputError: a table of no such kind; particles that are not there, or several pairs that meet.
    """
    kind, columns, lines = _table(source)
    columns = [_with_unit(column) for column in columns]
    header = ", ".join(column.name for column in columns)
    words = [re.sub(r"\W+", "_", column.name.strip().lower()).strip("_") for column in columns]
    if "axis_3" in words:  # of napari: t, z, y, x
        words = [{"axis_1": "z", "axis_2": "y", "axis_3": "x"}.get(word, word) for word in words]
    by_word: dict[str, Column] = {}
    for word, column in zip(words, columns):
        by_word[word] = _same(by_word.get(word, column), column)
    by_name = {name: replace(by_word[word], name=name) for name, spelt in _SPELT.items()
             for word in [next((alias for alias in spelt.split() if alias in by_word), None)] if word}  # fmt: skip
    if not kind:
        kind = next((name for name, some in _KINDS.items() if some <= by_word.keys()), "")
    if long := {"x", "y"} <= by_name.keys():
        by_name, lines = _below_names(by_name, lines)
        if not {"frame", "time"} & by_name.keys():
            raise InputError("tracks", header, _ACCEPTED, "has no frame and no time")
        kind = kind or "a long table, a row for each particle and frame"
        names = by_name["particle"].cells if "particle" in by_name else None
        table = _as_long(by_name, {"": ("x", "y")}, names, lines)
    else:
        bodies = _bodies(words)
        if len(bodies) < 2:
            lack = [f"has no {name}" for name in PLACES if name not in words]
            raise InputError("tracks", header, _ACCEPTED, lack[0] if 1 <= len(lack) < 4 else "is none of these")
        if not {"frame", "time"} & by_name.keys() and len(words) == 2 * len(bodies):
            by_name["frame"] = Column("frame", None, list(range(len(lines))))
    every = [name for name in dict.fromkeys(table.particle) if name] if long else list(bodies)
    linked = long and ("particle" not in by_name or len(every) == 1)  # TrackMate's track of two that merge
    if long and len(every) == 1:
        table, every = _linked(table), ["1", "2"]
    pair, of_films = _chosen(every, particles), ""
    if pair is None:
        if not long:
            long, (by_name, lines) = True, _side_by_side(by_name, by_word, bodies, lines)
            table = _as_long(by_name, {"": ("x", "y")}, by_name["particle"].cells, lines)
        table, pair, of_films = _meeting(table, solids / lengths(by_name["x"]))
        if "of_pair" in table:
            films_of = by_name["impact"].cells if "impact" in by_name else [""] * len(lines)
            names = [f"{film} {of_pair}".strip() for film, of_pair in zip(films_of, table.of_pair)]
            by_name["impact"] = Column("impact", None, names)
    shared: dict[str, Column] = {name: by_name[name] for name in ("frame", "time", "impact") if name in by_name}
    if long:
        first, second = (table[table.particle.isin(labels)] for labels in pair)
        both = first.merge(second, how="outer", on=["at", "film"], suffixes=("1", "2"))
        both = both.iloc[np.argsort(both.row1.fillna(both.row2))]  # films as they come in the table
        rows = both.row1.fillna(both.row2).astype(int).tolist()
        shared = {name: replace(entry, cells=[entry.cells[k] for k in rows]) for name, entry in shared.items()}
        for place in PLACES:
            cells = [None if k != k else by_name[place[0]].cells[int(k)] for k in both[f"row{place[1]}"]]
            shared[place] = replace(by_name[place[0]], name=place, cells=cells)
        lines = [lines[k] for k in rows]
        depth = [by_name["z"].cells[k] for body in (first, second) for k in body.row] if "z" in by_name else []
    else:
        four = [word for body in pair for word in bodies[body[0]]]
        depth = [cell for word in map(_depth, four[::2]) if word in by_word for cell in by_word[word].cells]
        shared |= {place: replace(by_word[word], name=place) for place, word in zip(PLACES, four)}
    if len({z for z in map(_number, depth) if z == z}) > 1:
        raise InputError("tracks, header", header, "x and y in the plane of the collision", "has a z that changes")
    if kind == _TRACKER:
        shared = _calibrated(shared, solids)
    which = ", particles " + (of_films or " and ".join("+".join(ids) for ids in pair)) if long or len(every) > 2 else ""
    how = ", linked from frame to frame by their distance" if linked else ""
    written = " and ".join(dict.fromkeys(shared[place].unit or "px" for place in PLACES))
    where = f", positions in {written}" * (written != "px")
    remark = f"the table was taken for {kind or 'two paths side by side'}{which}{how}{where}"
    return Film(shared, lines, remark, header)


def with_one_clock(film: Film, rate: float | None, times: Units) -> Film:
    """The film with its frames alone, or with times that can be those of a camera.

    Arguments:
        rate: frames per second, if they are given.

    Raises:
        InputError: the times cannot be true, and no rate is given.
    """
    columns, time, frame = dict(film.columns), film.columns.get("time"), film.columns.get("frame")
    if time is None or not time.cells or (frame is None and time.unit is None):
        return film
    written = np.array([_number(cell) for cell in time.cells])
    at = written * (times(time) if time.unit else 1.0)
    impact = np.array([_name(cell) for cell in columns["impact"].cells] if "impact" in columns else [""] * at.size)
    films = [np.unique(at[(impact == name) & np.isfinite(at)]) for name in np.unique(impact)]
    ticks, steps = np.concatenate(films), np.concatenate([np.diff(film) for film in films])
    problem, counts = "", None
    if frame is not None and np.array_equal(written, [_number(cell) for cell in frame.cells]):
        problem = "are the numbers of the frames"
    elif steps.size and abs(float(np.median(steps)) * _AVI - 1) < 1e-3:
        problem = f"come at {_AVI:g} frames/s, which an AVI says of every film above 1000 frames/s"
        counts = np.rint(at * _AVI)
    elif steps.size and np.ptp(steps) > 0.5 * _MATROSKA and np.abs((ticks / _MATROSKA + 0.5) % 1 - 0.5).max() < 1e-6:
        problem = "are whole milliseconds, as Matroska writes them, and not evenly spaced"
        counts = np.rint(at * rate) if rate and rate * _MATROSKA < 1 else None
    if problem and rate is None:
        raise InputError("rate", None, "the camera's frames per second (--rate)", f"is not known: the times {problem}")
    if frame is None and counts is not None:
        frame = Column("frame", None, counts.tolist())
    step = float(np.median(steps)) if steps.size else 0.0
    shared = at.size > ticks.size  # times that several frames have are named later
    if frame is None and rate and step and not shared and not 1 / _OFF < step * rate < _OFF:
        problem = f"is not that of the times, which come at {1 / step:.4g} 1/s"
        raise InputError("rate", f"{rate:g} 1/s", "no rate beside times, or a column frame", problem)
    if frame is None or rate is None:
        columns.pop("frame" if time.unit else "time", None)
        return replace(film, columns=columns)
    why = f" {problem} and" if problem else ""
    columns = {name: column for name, column in columns.items() if name != "time"} | {"frame": frame}
    return replace(film, columns=columns, remark=f"{film.remark}; the times{why} are not used")


def _table(source: Any) -> tuple[str, list[Column], list[int]]:
    """What kind of file it is, if its form says so; its columns, and the line of each row."""
    if isinstance(source, (str, Path)):
        text = text_of(source, "tracks", _ACCEPTED)
        if text.lstrip().startswith("<"):
            return (_XML, *columns_of(_from_xml(text, str(source)), "tracks"))
        kind, text = _one_header(text)
        columns, lines = columns_from_text(text, "tracks", str(source), _ACCEPTED)
        return kind, without_index(columns, "tracks"), lines
    index = [name for name in getattr(getattr(source, "index", None), "names", ()) if name is not None]
    if getattr(getattr(source, "columns", None), "nlevels", 1) > 1:  # of DeepLabCut
        kind, text = _one_header(source.to_csv())
        return kind, *columns_from_text(text, "tracks", "columns", _ACCEPTED)
    if fresh := [name for name in index if name not in source.columns]:
        source = source.reset_index(fresh)
    return ("", *columns_of(source, "tracks"))


def _one_header(text: str) -> tuple[str, str]:
    """The kind of a table whose header has several rows, and its text with one row of names instead."""
    lines = text.splitlines()
    rows = [k for k, line in enumerate(lines) if line.strip(" \t,;") and not line.lstrip().startswith("#")][:5]
    separator = max(",;\t", key=lines[rows[0]].count) if rows else ","
    above: list[str] = []
    for k in rows:
        cells = [cell.strip().strip('"') for cell in lines[k].split(separator)]
        axes = [re.sub(r"\W.*", "", cell.lower()) for cell in cells]
        axes = axes if "x" in axes else [axis.removeprefix("pixel") for axis in axes]  # Tracker's in pixels
        if k > rows[0] and axes.count("x") > 1 and axes.count("y") > 1:
            names = [f"{body}_{cell.lower().removeprefix('pixel')}" if axis in ("x", "y") else
                     "frame" if axis == "coords" else cell if axis in ("t", "frame") else f"{cell}_{j}" * bool(cell)
                     for j, (body, cell, axis) in enumerate(zip(above, cells, axes))]  # fmt: skip
            kind = _TRACKER if text.lstrip().lower().startswith("#multi") else "bodies side by side"
            return kind, "\n".join([*[""] * k, separator.join(names), *lines[k + 1 :]])
        filled = [next((cell for cell in cells[j::-1] if cell), "") for j in range(len(cells))]
        above = [
            re.sub(r"\W+", "_", f"{name}_{cell}".strip("_")) for name, cell in zip(above or [""] * len(filled), filled)
        ]
    return "", text


def _from_xml(text: str, source: str) -> dict[str, list[Any]]:
    """A long table of the spots of TrackMate's tracks: hidden spots are in none, and edges come in any order."""
    accepted = "a file of TrackMate, with tracks"
    try:
        root = ET.fromstring(text)
    except ET.ParseError as reason:
        raise InputError("tracks", source, accepted, f"is no XML ({reason})") from None
    model = root.find(".//Model")
    rows: list[tuple[Any, ...]] = []
    if model is not None:
        length, clock = model.get("spatialunits", "px"), model.get("timeunits", "frame")
        spots = {spot.get("ID"): spot for spot in model.iter("Spot")}
        listed = {item.get("TRACK_ID") for item in model.findall("FilteredTracks/TrackID")}
        for track in model.iter("Track"):
            number, names = track.get("TRACK_ID"), ("FRAME", "POSITION_T", "POSITION_X", "POSITION_Y")
            ends = {edge.get(f"SPOT_{end}_ID") for edge in track.iter("Edge") for end in ("SOURCE", "TARGET")}
            if not listed or number in listed:
                rows += [(number, *map(spots[key].get, names)) for key in sorted(ends & spots.keys(), key=str)]
    else:
        length, clock = root.get("spaceUnits", "px"), root.get("timeUnits", "frame")
        interval = _number(root.get("frameInterval", 1))
        for k, path in enumerate(root.iter("particle")):
            for spot in path.iter("detection"):
                rows.append((k, spot.get("t"), interval * _number(spot.get("t")), spot.get("x"), spot.get("y")))
    if not rows:
        raise InputError("tracks", source, accepted, "has none")
    length, clock = (_UNITS.get(unit.lower(), unit) for unit in (length, clock))
    header = ("track_id", "frame", f"t [{clock}]", f"x [{length}]", f"y [{length}]")
    return {name: list(column) for name, column in zip(header, zip(*rows)) if name != "t [frame]"}


def _below_names(by_name: dict[str, Column], lines: list[int]) -> tuple[dict[str, Column], list[int]]:
    """The columns of a long table without TrackMate's three rows of names, the last of which has the units."""
    clocks = [by_name[name].cells for name in ("x", "frame", "time") if name in by_name]
    names = 0
    while names < min(3, len(lines)) and all(math.isnan(_number(clock[names])) for clock in clocks):
        names += 1
    for name, column in by_name.items():
        below = re.fullmatch(r"\s*\((.+)\)\s*", str(column.cells[names - 1])) if names else None
        unit = below[1] if below else column.unit
        by_name[name] = replace(column, cells=column.cells[names:], unit=_UNITS.get((unit or "").lower(), unit))
    time = by_name.get("time")
    whole = (
        time and time.unit is None and "frame" not in by_name and not any(_number(cell) % 1 > 0 for cell in time.cells)
    )
    if time and (time.unit == "frame" or whole):  # napari
        del by_name["time"]
        by_name.setdefault("frame", replace(time, name="frame", unit=None))
    return by_name, lines[names:]


def _with_unit(column: Column) -> Column:
    """A column whose unit stands behind its name without brackets, as x1_mm or time_ms."""
    match = _UNIT_BEHIND.fullmatch(column.name.strip()) if column.unit is None else None
    if match is None:
        return column
    unit = _UNITS.get(match[3].lower(), match[3])
    pixels = unit.lower() in ("px", "pixel", "pixels")
    fits = pixels if match[2] and pixels else (COMMON | _BEHIND).get(unit, ("",))[0] == ("m" if match[2] else "s")
    return replace(column, name=match[1], unit=None if pixels else unit) if fits else column


def _bodies(words: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Names of the bodies of a wide table, and those of their columns x and y."""
    places: dict[str, dict[str, str]] = {}
    for word in words:
        if match := _BODY.fullmatch(word):
            places.setdefault(match[2] or match[3] or "", {}).setdefault(match[1] or match[4], word)
    return {body: (both["x"], both["y"]) for body, both in places.items() if len(both) == 2}


def _side_by_side(
    by_name: Mapping[str, Column],
    by_word: Mapping[str, Column],
    bodies: Mapping[str, tuple[str, str]],
    lines: list[int],
) -> tuple[dict[str, Column], list[int]]:
    """The columns of a wide table as those of a long one, a body below the other, and the line of each row."""
    shared = (name for name in ("frame", "time", "impact") if name in by_name)
    columns = {name: replace(by_name[name], cells=by_name[name].cells * len(bodies)) for name in shared}
    places = {"x": [x for x, _ in bodies.values()], "y": [y for _, y in bodies.values()]}
    if (deep := [_depth(x) for x in places["x"]]) and by_word.keys() >= set(deep):
        places["z"] = deep
    for axis, words in places.items():
        below = [by_word[word] for word in words]
        if len({column.unit for column in below}) > 1:
            names = ", ".join(column.name for column in below)
            raise InputError("tracks, header", names, "one unit for all bodies", "differ in their units")
        columns[axis] = replace(below[0], name=axis, cells=[*chain(*(column.cells for column in below))])
    columns["particle"] = Column("particle", None, [body for body in bodies for _ in lines])
    return columns, lines * len(bodies)


def _depth(word: str) -> str:
    """The name of the column z beside a column x of a body."""
    return re.sub(r"^x(?=_?\d+$)|x$", "z", word)


def _as_long(
    by_name: Mapping[str, Column], bodies: Mapping[str, tuple[str, str]], names: list[Any] | None, lines: list[int]
) -> pd.DataFrame:
    """A row for each particle and frame: film, at, particle, x, y, and the row of the table."""
    import pandas as pd

    rows = range(len(lines))
    clock = by_name.get("frame") or by_name.get("time") or Column("", None, list(rows))
    at = [_number(cell) for cell in clock.cells]
    for k in (k for k in rows if not math.isfinite(at[k])):
        raise InputError(f"tracks, line {lines[k]}, column {clock.name}", clock.cells[k], "a number")
    films = pd.factorize(np.array([_name(cell) for cell in by_name["impact"].cells]))[0] if "impact" in by_name else 0
    parts = [
        pd.DataFrame({"film": films, "at": at, "particle": body if names is None else [_name(cell) for cell in names],
                      **{axis: [_number(cell) for cell in by_name[word].cells] for axis, word in zip("xy", both)},
                      "row": rows}) for body, both in bodies.items()
    ]  # fmt: skip
    table = pd.concat(parts)
    return _linked(table) if names is None and "" in bodies else table


def _linked(table: pd.DataFrame) -> pd.DataFrame:
    """The table with names "1" and "2": two rows on a frame, each the nearer to where it was; "" on others."""
    names = np.full(len(table), "", object)
    for _, film in table.groupby("film"):
        before = None
        for at, rows in film.groupby("at"):
            if len(rows) > 2:
                problem = f"has {len(rows)} rows on frame {at:g}, and no column names the particle"
                raise InputError("tracks", None, "two rows for each frame, or a column particle or track_id", problem)
            if len(rows) == 2:
                here = rows[["x", "y"]].to_numpy()
                swapped = before is not None and ((here[::-1] - before) ** 2).sum() < ((here - before) ** 2).sum()
                before = here[::-1] if swapped else here
                names[rows.row] = ("2", "1") if swapped else ("1", "2")
    return table.assign(particle=names)


def _chosen(names: list[str], particles: Any) -> tuple[list[str], list[str]] | None:
    """The two particles that are asked for, each with the numbers under which a tracker followed it."""
    if particles is None:
        return ([names[0]], [names[1]]) if len(names) == 2 else None
    parts = re.split(r"[,;]", particles) if isinstance(particles, str) else list(np.atleast_1d(particles))
    pair = [[_name(number) for number in str(particle).split("+")] for particle in parts]
    every = [number for numbers in pair for number in numbers]
    if len(pair) != 2 or len(set(every)) < len(every) or not set(every) <= set(names):
        accepted = f'two of {several(names)}, as "A,B"'
        raise InputError("particles", str(particles), accepted)
    return pair[0], pair[1]


def _meeting(table: pd.DataFrame, solids: float) -> tuple[pd.DataFrame, tuple[list[str], list[str]], str]:
    """The pair that meets, in all films or in each its own, then renamed and told; InputError if none do.

    Several pairs of one film that are apart are films of their own, named in a column `of_pair`.
    """
    parts = [rows for _, rows in table.groupby("film")]
    films = [_near(rows, solids) for rows in parts]
    if len(meet := sorted(set().union(*films))) == 1:
        return table, ([meet[0][0]], [meet[0][1]]), ""
    if all(films) and all(map(_apart, parts, films)):
        every = [(film, pair) for film, pairs in enumerate(films) for pair in pairs]
        number = {(film, name): (j, str(k + 1)) for j, (film, pair) in enumerate(every) for k, name in enumerate(pair)}
        chosen = [number.get(key, (-1, "")) for key in zip(table.film, table.particle)]
        text = several([" and ".join(pair) for _, pair in every], "; ")
        if len(every) > len(films):
            table = table.assign(of_pair=["-".join(every[j][1]) if j >= 0 else "" for j, _ in chosen])
        films_of, names = zip(*chosen)
        return table.assign(film=films_of, particle=names), (["1"], ["2"]), text
    accepted = 'two that meet, a column impact, or particles="A,B" (--particles); "A+C,B" if A goes on as C'
    nowhere = "come near each other nowhere: do their tracks break, or is the scale off?"
    near = several([",".join(pair) for pair in meet], "; ")
    problem = f"may be several that come near each other: {near}" if meet else nowhere
    raise InputError("particles", None, accepted, problem)


def _near(table: pd.DataFrame, solids: float) -> list[tuple[str, str]]:
    """The pairs of a film that come near each other."""
    table = table[(table.particle != "") & np.isfinite(table.x) & np.isfinite(table.y)]
    low, high = (share * solids for share in _NEAR)
    frames = {name: set(rows["at"]) for name, rows in table.groupby("particle")}
    nearest: dict[tuple[str, str], float] = {}
    for _, rows in table.groupby("at"):
        places, names = rows[["x", "y"]].to_numpy(), rows.particle.tolist()
        for j, k in KDTree(places).query_pairs(high):
            pair = (min(names[j], names[k]), max(names[j], names[k]))
            nearest[pair] = min(float(math.dist(places[j], places[k])), nearest.get(pair, math.inf))
    meet = [pair for pair, distance in nearest.items() if distance >= low]
    return [pair for pair in meet if len(frames[pair[0]] & frames[pair[1]]) >= LEAST]


def _apart(table: pd.DataFrame, pairs: list[tuple[str, str]]) -> bool:
    """True if no particle is in two of the pairs, and all are on one frame: tracks that break make a later pair."""
    frames = {name: set(rows["at"]) for name, rows in table[np.isfinite(table.x)].groupby("particle")}
    every = [*chain(*pairs)]
    return len({*every}) == len(every) and bool(set.intersection(*(frames[name] for name in every)))


def _calibrated(columns: dict[str, Column], solids: float) -> dict[str, Column]:
    """Tracker writes seconds, and metres if it was calibrated: then the solids touch at the scene's distance."""
    x1, y1, x2, y2 = (np.array([_number(cell) for cell in columns[place].cells]) for place in PLACES)
    nearest = np.nanmin(np.hypot(x2 - x1, y2 - y1), initial=math.inf)
    unit = {"time": "s"} | dict.fromkeys(PLACES if 0.5 < nearest / solids < 2 else (), "m")
    return {name: replace(column, unit=column.unit or unit.get(name)) for name, column in columns.items()}


def _same(first: Column, again: Column) -> Column:
    """A column that is written twice: trackpy's frame is index and column, and Tracker's stands with each mass."""
    cells = [(cell, other) if str(cell).strip() else (other, cell) for cell, other in zip(first.cells, again.cells)]
    if any(str(other).strip() not in ("", str(cell).strip()) for cell, other in cells):
        raise InputError("tracks, header", again.name, "each column once", "is given twice, with different cells")
    return replace(first, cells=[cell for cell, _ in cells])


def _number(cell: Any) -> float:
    try:
        return float(cell)
    except (TypeError, ValueError):
        return math.nan


def _name(cell: Any) -> str:
    """What names a particle: 3 of pandas' 3.0; "" of none."""
    text, number = str(cell).strip().lower(), _number(cell)
    if text in ("", "none", "nan", "<na>"):
        return ""
    return str(int(number)) if math.isfinite(number) and number == int(number) else text
