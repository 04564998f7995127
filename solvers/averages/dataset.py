"""Averages as a labelled Dataset, and as CSV with a row for each pair."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..host import files
from ..scene.scene import Scene
from .geometry import BOUNCES, COLUMNS, NORMAL, ROTATES, STICKS, TANGENTIAL

if TYPE_CHECKING:
    import xarray

Columns = dict[str, np.ndarray]
_MEANS = {
    "stick_probability": (STICKS, "share of collisions that stick"),
    "rotate_probability": (ROTATES, "share of collisions that stick, rotate and separate"),
    "bounce_probability": (BOUNCES, "share of collisions that bounce"),
    "restitution_all": (NORMAL, "mean normal restitution of all collisions; a stick counts as 0"),
    "tangential_restitution_all": (TANGENTIAL, "mean tangential restitution of all collisions; a stick counts as 0"),
}
_SEPARATED = {
    "restitution_separated": (NORMAL, "mean normal restitution of the collisions that separate"),
    "tangential_restitution_separated": (TANGENTIAL, "mean tangential restitution of the collisions that separate"),
}
QUANTITIES = (*_MEANS, *_SEPARATED)
"""What is averaged, in this order."""

_AXES = {"radius": "radius of the first sphere", "partner_radius": "radius of the second sphere"}


def dataset(
    scene: Scene, axes: Mapping[str, np.ndarray], found: Columns, attributes: Mapping[str, Any], wrt: Sequence[str]
) -> xarray.Dataset:
    """The Dataset of flat columns, one row for each pair."""
    import xarray as xr

    dims, shape = tuple(axes), tuple(axis.size for axis in axes.values())
    mean, error = _quantities(found["mean"], found["error"])
    variables: dict[str, Any] = {}
    for k, (name, (_, said)) in enumerate({**_MEANS, **_SEPARATED}.items()):
        variables[name] = dims, mean[:, k].reshape(shape), {"units": "1", "long_name": said}
        told = {"units": "1", "long_name": f"estimated error of the quadrature of {name}"}
        variables[f"{name}_error"] = dims, error[:, k].reshape(shape), told
    coordinates: dict[str, Any] = {
        name: (name, axis, {"units": "m", "long_name": _AXES[name]}) for name, axis in axes.items()
    }
    if wrt:
        over = (*dims, "quantity", "parameter")
        slopes, doubts = _gradients(found, len(wrt))
        sizes = (*shape, len(QUANTITIES), len(wrt))
        variables["gradient"] = over, slopes.reshape(sizes), {"long_name": "derivatives by entries of the scene, SI"}
        variables["gradient_error"] = over, doubts.reshape(sizes), {"long_name": "estimated errors of gradient"}
        coordinates |= {"quantity": list(QUANTITIES), "parameter": list(wrt)}
    variables["reason"] = dims, found["reason"].astype(str).reshape(shape), {"long_name": "why it failed"}
    told = {
        "Conventions": "CF-1.11",
        "title": f"Collision averages: {scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {version('wetdoublet')}",
        "geometry": "isotropic relative velocities: density sin(2 theta) of impact angles",
        **attributes,
        "scene": scene.to_toml(),
        **({} if scene.package is None else {"model": scene.package.text}),
    }
    return xr.Dataset(variables, coordinates, told)


def _quantities(mean: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means and errors of `QUANTITIES`, (pairs, quantities)."""
    apart, doubt = _apart(mean), error[:, [STICKS]]
    some = np.where(apart > np.maximum(doubt, 1e-12), apart, np.nan)
    both = [place for place, _ in _SEPARATED.values()]
    ratio = mean[:, both] / some
    return np.hstack([mean, ratio]), np.hstack([error, (error[:, both] + np.abs(ratio) * doubt) / some])


def _gradients(found: Columns, parameters: int) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of `QUANTITIES` and their errors, (pairs, quantities, parameters)."""
    mean, doubt = found["mean"], found["error"][:, [STICKS]]
    slope, error = (found[name].reshape(-1, COLUMNS, parameters) for name in ("gradient", "gradient_error"))
    apart = _apart(mean)
    some = np.where(apart > np.maximum(doubt, 1e-12), apart, np.nan)[:, :, None]
    both = [place for place, _ in _SEPARATED.values()]
    ratio = mean[:, both, None] / some
    of_ratio = (slope[:, both] + ratio * slope[:, [STICKS]]) / some
    errors = (error[:, both] + np.abs(ratio) * error[:, [STICKS]]) / some
    return np.concatenate([slope, of_ratio], axis=1), np.concatenate([error, errors], axis=1)


def _apart(mean: np.ndarray) -> np.ndarray:
    """The share of collisions that separate, (pairs, 1)."""
    found: np.ndarray = mean[:, [ROTATES]] + mean[:, [BOUNCES]]
    return found


def to_csv(data: xarray.Dataset) -> str:
    """The table of averages: a row for each pair; derivatives in columns `d(QUANTITY)/d(ENTRY)`, SI.

    The column `relative_speeds` names the speed, as text. Numbers round-trip; a field is empty where a result is not
    defined.
    """
    dims = [str(name) for name in data["stick_probability"].dims]
    shape = data["stick_probability"].shape
    columns: dict[str, np.ndarray] = {}
    for k, name in enumerate(dims):
        axis = data[name].values.reshape([-1 if j == k else 1 for j in range(len(dims))])
        columns[f"{name} [m]"] = np.broadcast_to(axis, shape).ravel()
    columns["relative_speeds"] = np.full(data["stick_probability"].size, data.attrs["speeds"])
    plain = [str(name) for name in data.data_vars if data[name].dims == data["stick_probability"].dims]
    columns |= {name: data[name].values.ravel() for name in sorted(plain, key=lambda name: name == "reason")}
    for variable, said in (("gradient", ""), ("gradient_error", " error")) if "gradient" in data else ():
        values = data[variable].transpose("quantity", "parameter", *dims).values
        for quantity, row in zip(data["quantity"].values, values, strict=True):
            for parameter, own in zip(data["parameter"].values, row, strict=True):
                columns[f"d({quantity})/d({parameter}){said}"] = own.ravel()
    made = io.StringIO()
    table = csv.writer(made, lineterminator="\n")
    table.writerow(columns)
    table.writerows(zip(*(_cells(values) for values in columns.values()), strict=True))
    return made.getvalue()


def _cells(values: np.ndarray) -> list[Any]:
    if values.dtype.kind == "f":
        return ["" if math.isnan(value) else repr(value) for value in values.tolist()]
    return [" ".join(str(value).split()) for value in values.tolist()]


def write_csv(data: xarray.Dataset, path: str | Path) -> None:
    """Write the table, complete or not at all. OSError if it cannot be written."""
    files.write(path, to_csv(data))
