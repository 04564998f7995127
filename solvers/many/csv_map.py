"""A regime map as CSV: one row for each collision, units in the header, outcomes as words."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..formatting.markdown import csv_text
from ..host import files
from ..model.validity import FLAGS
from ..results import FAILED, REVERSALS

if TYPE_CHECKING:
    import xarray

_WORDS = {"outcome": {**dict(enumerate(OUTCOMES)), FAILED: "failed"}, "reversal": dict(enumerate(REVERSALS))}


def to_csv(data: xarray.Dataset) -> str:
    """The table of a map or of `collide_many`: coordinates, then results, the reason of a failure last.

    Numbers are in SI units and round-trip; a field is empty where a result is not defined.
    """
    dims, shape = data["outcome"].dims, data["outcome"].shape
    results = sorted(map(str, data.data_vars), key=lambda name: (name == "reason", name != "outcome"))
    columns: dict[str, list[Any]] = {}
    for name in (*_coordinates(data), *results):
        values = data[name].broadcast_like(data["outcome"]).transpose(*dims).values
        unit = data[name].attrs.get("units", "1")
        cells = np.broadcast_to(values, shape).ravel()
        label = name if unit == "1" else f"{name} [{unit}]"
        columns[label] = _flags(cells) if name == "validity" else _words(name, cells)
    return csv_text(columns, zip(*columns.values(), strict=True))


def write_csv(data: xarray.Dataset, path: str | Path) -> None:
    """Write the table, complete or not at all. OSError if it cannot be written."""
    files.write(path, to_csv(data))


def _coordinates(data: xarray.Dataset) -> list[str]:
    """Dimensions first, in their order, then what depends on them."""
    dims = [str(dim) for dim in data["outcome"].dims if dim in data.coords]
    return dims + [str(name) for name in data.coords if name not in dims]


def _flags(values: np.ndarray) -> list[str]:
    """The names of the limits that are passed, as `film_reynolds fly_by`; empty within the model's range."""
    words = {code: " ".join(name for bit, name in enumerate(FLAGS) if code >> bit & 1) for code in set(values.tolist())}
    return [words[code] for code in values.tolist()]


def _words(name: str, values: np.ndarray) -> list[Any]:
    return [_WORDS[name].get(int(code), "") for code in values] if name in _WORDS else cells_of(values)


def cells_of(values: np.ndarray) -> list[Any]:
    """Values as cells: numbers that round-trip, empty for NaN; text on one line."""
    if values.dtype.kind == "b":
        return ["true" if value else "false" for value in values.tolist()]
    if values.dtype.kind == "f":
        return ["" if math.isnan(value) else repr(value) for value in values.tolist()]
    return [" ".join(str(value).split()) for value in values.tolist()]
