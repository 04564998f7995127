"""Boundaries as a labelled Dataset: lines, curves and points, padded where they differ in length."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from .found import Curves, Lines
from .plane import ANGLE

if TYPE_CHECKING:
    import xarray


NONE = -1  # outcome code of padding, where there is no change


def dataset(found: Lines) -> xarray.Dataset:
    """The Dataset of `Boundaries.to_dataset()`.

    Over (line, change): stokes, centrifugal, before, after, kind; over line: failure, and angle as a coordinate. An
    Atlas also has curves over (curve, vertex) and points over point. Padded with NaN, -1 and "".
    """
    import xarray as xr

    most = max((len(line) for line in found.changes), default=0)
    variables: dict[str, Any] = {
        "stokes": (("line", "change"), _padded([[one.stokes for one in line] for line in found.changes], most),
                   {"units": "1", "long_name": "Stokes number at which the outcome changes"}),
        "centrifugal": (("line", "change"), _padded(
            [[np.nan if one.centrifugal is None else one.centrifugal for one in line] for line in found.changes], most),
            {"units": "1", "long_name": "centrifugal number there"}),
        "kind": (("line", "change"), _texts([[one.kind for one in line] for line in found.changes], most),
                 {"long_name": "what happens there"}),
        "failure": ("line", np.array(found.failures or [""] * len(found.angles), dtype=str),
                    {"long_name": "why a line could not be traced"}),
    }  # fmt: skip
    for side, meaning in (("before", "outcome below"), ("after", "outcome above")):
        rows = [[OUTCOMES.index(getattr(one, side)) for one in line] for line in found.changes]
        variables[side] = ("line", "change"), _padded(rows, most, NONE).astype(np.int8), _flags(meaning)
    coordinates: dict[str, Any] = {
        "angle": ("line", np.array(found.angles), {"units": "rad", "long_name": "impact angle"})
    }
    attributes: dict[str, Any] = {
        "resolution": found.resolution,
        "collisions": found.collisions,
        "searched": found.range_text,
    }
    if found.scene is not None:
        attributes["scene"] = found.scene.to_toml()
    if isinstance(found, Curves):
        _add_atlas(found, variables, coordinates)
        attributes |= {"over": found.over} | {f"sought_{name}": value for name, value in found.sought.items()}
    return xr.Dataset(variables, coordinates, attributes)


def _add_atlas(found: Curves, variables: dict[str, Any], coordinates: dict[str, Any]) -> None:
    unit = "rad"
    if found.over != ANGLE and found.scene is not None:
        unit = found.scene.fields[found.over].unit or "1"
    x: dict[str, Any] = {"units": unit, "long_name": found.over}
    stokes = {"units": "1", "long_name": "Stokes number"}
    coordinates["x"] = "line", np.array(found.at), x
    most = max((len(one.x) for one in found.curves), default=0)
    variables["curve_x"] = ("curve", "vertex"), _padded([one.x for one in found.curves], most), x
    variables["curve_stokes"] = ("curve", "vertex"), _padded([one.stokes for one in found.curves], most), stokes
    for side, meaning in (("before", "outcome below the curve"), ("after", "outcome above the curve")):
        values = np.array([OUTCOMES.index(getattr(one, side)) for one in found.curves], dtype=np.int8)
        variables[f"curve_{side}"] = "curve", values, _flags(meaning)
    variables["curve_kind"] = "curve", np.array([one.kind for one in found.curves], dtype=str), {}
    variables["point_kind"] = "point", np.array([one.kind for one in found.points], dtype=str), {}
    variables["point_x"] = "point", np.array([one.x for one in found.points], dtype=float), x
    variables["point_stokes"] = "point", np.array([one.stokes for one in found.points], dtype=float), stokes


def _padded(rows: Sequence[Sequence[float]], most: int, filler: float = np.nan) -> np.ndarray:
    full = np.full((len(rows), most), filler)
    for k, row in enumerate(rows):
        full[k, : len(row)] = row
    return full


def _texts(rows: Sequence[Sequence[str]], most: int) -> np.ndarray:
    return np.array([[*row, *[""] * (most - len(row))] for row in rows], dtype=str).reshape(len(rows), most)


def _flags(meaning: str) -> dict[str, Any]:
    return {
        "long_name": meaning,
        "flag_values": np.array([NONE, 0, 1, 2], dtype=np.int8),
        "flag_meanings": "none " + " ".join(name.replace("-", "_") for name in OUTCOMES),
    }
