"""Answers of a table as a labelled Dataset, and a table in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..formatting.labelled import labelled
from ..many.results import attributes, outcome_attributes
from .read import Read

if TYPE_CHECKING:
    import xarray

    from .data import Law


def answers(table: Law, columns: list[np.ndarray], results: Read, slopes: bool) -> xarray.Dataset:
    """The Dataset of answers at impacts."""
    along = ("collision",)
    units = ["1", "rad", *(table.scene.fields[name].unit or "1" for name in table.variables[2:])]
    names = ["stokes", "angle", *table.variables[2:]]
    axes: dict[str, tuple[str, ...]] = {}
    coordinates: dict[str, Any] = {
        name: (along, column, {"units": unit}) for name, column, unit in zip(names, columns, units, strict=True)
    }
    outcome = outcome_attributes() | {"long_name": "outcome; failed: outside the table"}
    variables: dict[str, Any] = {"outcome": (along, results.outcome, outcome)}
    for k, name in enumerate(table.of):
        variables[name] = along, results.values[:, k], attributes(name)
    if slopes:
        axes = {"wrt": tuple(names)}
        third = results.slopes[0] / columns[2][:, None] if table.range.logarithmic else results.slopes[0]
        parts = [results.slopes[2] / columns[0][:, None], results.slopes[1], third][: len(names)]
        for k, name in enumerate(table.of):
            unit = attributes(name)["units"]
            text = {"long_name": f"derivative of {name}", "units": f"{unit} per unit of wrt"}
            variables[f"d_{name}"] = ("collision", "wrt"), np.stack([one[:, k] for one in parts], axis=1), text
    return labelled(variables, coordinates, {"scene": table.scene.to_toml(), "error": table.error}, axes)


def text(table: Law) -> str:
    """A table in words: ranges, size, error and where the largest was found."""
    data, attack = table.data, table.found
    lines = [f"table of {table.scene.name or 'a scene'}: {', '.join(table.of)}"]
    (least, most), (low, high) = table.range.stokes, map(math.degrees, table.range.angle)
    lines.append(f"  St {least:g} to {most:g}, angle {low:g} to {high:g} deg")
    if table.range.third is not None:
        unit = table.scene.fields[table.range.third].unit or ""
        low, high = table.range.ends
        lines[-1] += f", {table.range.third} {low:g} to {high:g} {unit}".rstrip()
    cells = int((data.root >= 0).sum())
    lines.append(f"  {data.maps.size} panels, {cells} cells, {data.results.size.shape[0]} patches, {data.bytes} bytes")
    lines.append(
        f"  error asked for {table.error:g}; largest of {attack.queries} queries {attack.largest:.3g}{where(table)}"
    )
    return "\n".join(lines)


def where(table: Law) -> str:
    """Where the largest error was found, in words."""
    third, angle, stokes = table.found.at
    if not table.found.largest:
        return ""
    more = "" if table.range.third is None else f", {table.range.third} {third:.6g} (SI)"
    return f" at St {stokes:.8g}, {math.degrees(angle):.8g} deg{more}"
