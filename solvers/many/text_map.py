"""A regime map as characters for a terminal: outcomes over impact angle and Stokes number, at most 88 columns."""

from __future__ import annotations

import math
import re
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from ...generated.automaton import OUTCOMES
from ..collision.text import WIDTH, name_of, quantity
from ..model.validity import counted
from ..results import FAILED, VALIDITY
from ..scene.held import NAMES
from .regime_map import IMPACTS, impact_axis, scene_of

if TYPE_CHECKING:
    import xarray

CHARACTERS = "SRB!"  # characters in the order of the outcomes; the last is FAILED, -1
_LABEL = 10  # width left of the map, characters
_ROWS, _MAPS = 32, 4
_TICK = 10  # distance between labels of the angle, characters


def table(data: xarray.Dataset) -> str:
    """The map as text, subsampled where it is too large; one map for each value of a further entry."""
    varied = [str(name) for name in data["outcome"].dims if name not in ("angle", *IMPACTS)]
    legend = "   ".join(f"{letter} {name}" for letter, name in zip(CHARACTERS, (*OUTCOMES, "failed"), strict=True))
    lines = [f"{name_of(scene_of(data))}: {data['outcome'].size} collisions", legend]
    sizes = [data.sizes[name] for name in varied]
    chosen = _some(math.prod(sizes), _MAPS)
    for number in chosen:
        index = [int(k) for k in np.unravel_index(number, sizes)] if varied else []
        panel = data.isel(dict(zip(varied, index, strict=True)))
        lines += ["", *([", ".join(_value(panel, name) for name in varied)] if varied else []), *_map(panel)]
    lines += _subsampled(data, len(chosen), math.prod(sizes))
    if VALIDITY in data and data[VALIDITY].values.any():
        limits = ", ".join(f"{words} in {count}" for words, count in counted(data[VALIDITY].values))
        lines += ["", *wrap(f"outside the model's range: {limits}", WIDTH, subsequent_indent="  ")]
    return "\n".join(lines)


def _map(data: xarray.Dataset) -> list[str]:
    impact = impact_axis(data)
    outcome = data["outcome"].transpose(impact, "angle").values
    rows, columns = _some(outcome.shape[0], _ROWS), _some(outcome.shape[1], WIDTH - _LABEL)
    values, angles = data[impact].values, np.degrees(data["angle"].values)
    head = "St" if impact == "stokes" else "m/s"
    lines = [f"{head:>{_LABEL - 2}}  {NAMES[impact]}"]
    for row in rows[::-1]:
        text = "".join(CHARACTERS[outcome[row, column]] for column in columns)
        lines.append(f"{values[row]:>{_LABEL - 2}.3g}  {text}")
    last = len(columns) - 1
    apart = last > _TICK // 2  # room for a label at the last column, too
    ticks = [*range(0, max(1, last - _TICK // 2), _TICK), *[last] * apart]
    marks, labels = "", ""
    for tick in ticks:
        marks += " " * (_LABEL + tick - len(marks)) + "|"
        labels += " " * (_LABEL + tick - len(labels)) + f"{angles[columns[tick]]:.3g}"
    labels += f" to {angles[-1]:.3g}" * (last > 0 and not apart)
    name = f"{'deg':>{_LABEL - 2}}"
    return [*lines, marks, name + labels[len(name) :]]


def _some(size: int, most: int) -> list[int]:
    """All indices, or `most` of them evenly spread with both ends."""
    return sorted({round(k) for k in np.linspace(0, size - 1, min(size, most)).tolist()})


def _value(panel: xarray.Dataset, name: str) -> str:
    unit = panel[name].attrs.get("units", "1")
    value = float(panel[name])
    if unit == "rad":
        return f"{name} = {math.degrees(value):.4g} deg"
    return f"{name} = {value:.4g}" if unit == "1" else f"{name} = {quantity(value, unit)}"


def _subsampled(data: xarray.Dataset, maps: int, total: int) -> list[str]:
    impact = impact_axis(data)
    parts = []
    for count, size, what in (
        (min(data.sizes[impact], _ROWS), data.sizes[impact], "rows"),
        (min(data.sizes["angle"], WIDTH - _LABEL), data.sizes["angle"], "columns"),
        (maps, total, "maps"),
    ):
        if count < size:
            parts.append(f"{count} of {size} {what}")
    if not parts:
        return []
    return ["", f"shown: {', '.join(parts)}", "-o FILE.nc or .csv keeps all, --plot FILE.png draws them"]


def failures(data: xarray.Dataset) -> str | None:
    """One line with the number of failures and their reasons; None without failures."""
    dim, size = data["outcome"].dims[0], data["outcome"].shape[0]
    length = (data["outcome"].encoding.get("chunks") or (size,))[0]  # strip by strip, as it lies in chunks on disk
    kinds: dict[str, list[str]] = {}
    for first in range(0, size, max(1, length)):
        strip = data.isel({dim: slice(first, first + length)})
        failed = strip["outcome"].values == FAILED
        for reason in strip["reason"].values[failed].tolist() if failed.any() else ():
            kind = re.sub(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", "#", reason.partition("; state ")[0])
            kinds.setdefault(kind, []).append(reason)
    if not kinds:
        return None
    alike = sorted(kinds.values(), key=len, reverse=True)
    parts = [f"{len(reasons)} x {reasons[0]}" for reasons in alike[:3]]
    more = f", and {len(alike) - 3} other reasons" if len(alike) > 3 else ""
    return f"{sum(map(len, alike))} of {data['outcome'].size} collisions failed: {' | '.join(parts)}{more}"
