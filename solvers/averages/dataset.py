"""Averages as a labelled Dataset, and as CSV with a row for each pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from ..formatting.markdown import csv_text
from ..many.csv_map import cells_of
from ..scene.scene import Scene
from .geometry import BOUNCES, ENERGY, LOST, NORMAL, ROTATES, SLOPES, STICKS, TANGENTIAL, TURNING

if TYPE_CHECKING:
    import xarray

Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Quantity:
    """What is averaged: constant + factor * column, and of `separated` ones over the share of the collisions that do.

    Attributes:
        head: of its column in a table for a person; "" leaves it out.
    """

    column: int
    meaning: str
    head: str = ""
    separated: bool = False
    factor: float = 1.0
    constant: float = 0.0


_NORMAL, _TANGENTIAL = "mean normal restitution", "mean tangential restitution"
_TABLE = {
    "stick_probability": Quantity(STICKS, "share of collisions that stick", "stick"),
    "rotate_probability": Quantity(ROTATES, "share of collisions that stick, rotate and separate", "rotate"),
    "bounce_probability": Quantity(BOUNCES, "share of collisions that bounce", "bounce"),
    "restitution_all": Quantity(NORMAL, f"{_NORMAL} of all collisions; a stick counts as 0", "e_n of all"),
    "tangential_restitution_all": Quantity(
        TANGENTIAL, f"{_TANGENTIAL} of all collisions; a stick counts as 0", "e_t of all"
    ),
    "restitution_separated": Quantity(NORMAL, f"{_NORMAL} of the collisions that separate", "e_n apart", True),
    "tangential_restitution_separated": Quantity(
        TANGENTIAL, f"{_TANGENTIAL} of the collisions that separate", "e_t apart", True
    ),
    "normal_dissipation": Quantity(
        ENERGY, "1 - normal kinetic energy after over before, of all collisions; negative where others feed it",
        factor=-2.0, constant=1.0,
    ),
    "kinetic_energy_loss": Quantity(
        LOST, "loss of kinetic energy, rotation included, over the kinetic energy of the relative motion", "energy lost"
    ),
    "energy_into_rotation": Quantity(
        TURNING, "gain of the energy of rotation over the kinetic energy of all collisions"
    ),
}  # fmt: skip
QUANTITIES = tuple(name for name, each in _TABLE.items() if each.column < SLOPES)
"""What has derivatives, in this order."""
_SIZES = {"radius": "radius (um)", "partner_radius": "partner (um)"}
_AXES = {"radius": "radius of the first sphere", "partner_radius": "radius of the second sphere"}


def dataset(
    scene: Scene, axes: Mapping[str, np.ndarray], columns: Columns, attributes: Mapping[str, Any], wrt: Sequence[str]
) -> xarray.Dataset:
    """The Dataset of flat columns, one row for each pair."""
    import xarray as xr

    dims, shape = tuple(axes), tuple(axis.size for axis in axes.values())
    found = {name: _averaged(each, columns) for name, each in _TABLE.items()}
    variables: dict[str, Any] = {}
    for name, (value, error, *_) in found.items():
        variables[name] = dims, value.reshape(shape), {"units": "1", "long_name": _TABLE[name].meaning}
        meaning = f"estimated error of the quadrature of {name}"
        variables[f"{name}_error"] = dims, error.reshape(shape), {"units": "1", "long_name": meaning}
    rate = {"units": "m s-1" if scene.wall else "m3 s-1", "long_name": "collisions per time and number densities"}
    variables["collision_rate"] = dims, columns["rate"].reshape(shape), rate
    coordinates: dict[str, Any] = {
        name: (name, axis, {"units": "m", "long_name": _AXES[name]}) for name, axis in axes.items()
    }
    if wrt:
        over, sizes = (*dims, "quantity", "parameter"), (*shape, len(QUANTITIES), len(wrt))
        slope, slope_error = (np.stack([found[name][k] for name in QUANTITIES], axis=1) for k in (2, 3))
        variables["gradient"] = over, slope.reshape(sizes), {"long_name": "derivatives by entries of the scene, SI"}
        variables["gradient_error"] = over, slope_error.reshape(sizes), {"long_name": "estimated errors of gradient"}
        coordinates |= {"quantity": list(QUANTITIES), "parameter": list(wrt)}
    variables["reason"] = dims, columns["reason"].astype(str).reshape(shape), {"long_name": "why it failed"}
    all_attributes = {
        "Conventions": "CF-1.11",
        "title": f"Collision averages: {scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {version('wetdoublet')}",
        "geometry": "isotropic relative velocities: density sin(2 theta) of impact angles",
        **attributes,
        "scene": scene.to_toml(),
        **({} if scene.package is None else {"model": scene.package.text}),
    }
    return xr.Dataset(variables, coordinates, all_attributes)


def _averaged(quantity: Quantity, columns: Columns) -> tuple[np.ndarray, ...]:
    """A quantity and its error, (pairs,), and its derivatives and their errors, (pairs, parameters)."""

    def column(name: str, k: int) -> np.ndarray:
        values = columns[name]
        return values[:, k] if name in ("mean", "error") else values.reshape(len(values), SLOPES, -1)[:, k]

    k = quantity.column
    value = quantity.constant + quantity.factor * column("mean", k)
    error = abs(quantity.factor) * column("error", k)
    if k >= SLOPES:
        return value, error
    slope, slope_error = column("gradient", k), column("gradient_error", k)
    if not quantity.separated:
        return value, error, slope, slope_error
    separate, of_share = column("mean", ROTATES) + column("mean", BOUNCES), column("error", STICKS)
    share = np.where(separate > np.maximum(of_share, 1e-12), separate, np.nan)
    ratio = value / share
    slope = (slope + ratio[:, None] * column("gradient", STICKS)) / share[:, None]
    slope_error = (slope_error + np.abs(ratio)[:, None] * column("gradient_error", STICKS)) / share[:, None]
    return ratio, (error + np.abs(ratio) * of_share) / share, slope, slope_error


def to_csv(data: xarray.Dataset) -> str:
    """The table of averages: a row for each pair; derivatives in columns `d(QUANTITY)/d(ENTRY)`, SI.

    The column `relative_speeds` names the speed, as text. Numbers round-trip; a field is empty where a result is not
    defined.
    """
    dims = [str(name) for name in data["stick_probability"].dims]
    sizes = np.meshgrid(*(data[name].values for name in dims), indexing="ij")
    columns: dict[str, np.ndarray] = {f"{name} [m]": size.ravel() for name, size in zip(dims, sizes, strict=True)}
    columns["relative_speeds"] = np.full(data["stick_probability"].size, data.attrs["speeds"])
    plain = [str(name) for name in data.data_vars if data[name].dims == data["stick_probability"].dims]
    columns |= {name: data[name].values.ravel() for name in sorted(plain, key=lambda name: name == "reason")}
    for variable, suffix in (("gradient", ""), ("gradient_error", " error")) if "gradient" in data else ():
        values = data[variable].transpose("quantity", "parameter", *dims).values
        for quantity, row in zip(data["quantity"].values, values, strict=True):
            for parameter, cells in zip(data["parameter"].values, row, strict=True):
                columns[f"d({quantity})/d({parameter}){suffix}"] = cells.ravel()
    return csv_text(columns, zip(*map(cells_of, columns.values()), strict=True))


def table(data: xarray.Dataset) -> str:
    """The averages for a person: a line for each pair below names and units, and below them the derivatives (SI)."""
    sizes = {name: head for name, head in _SIZES.items() if name in data.dims}
    rate = data["collision_rate"].attrs["units"].replace("m s-1", "m/s").replace("m3 s-1", "m^3/s")
    heads = {name: each.head for name, each in _TABLE.items() if each.head} | {"collision_rate": f"rate ({rate})"}
    data = data.assign_coords({name: 1e6 * data[name] for name in sizes}).rename(sizes)
    blocks = [data[list(heads)].rename(heads).expand_dims([] if sizes else ["pair"])]
    blocks += [data["gradient"].to_dataset("parameter")] if "gradient" in data else []
    frames = [each.to_dataframe().reset_index(drop="pair" in each.dims) for each in blocks]
    texts = [each.to_string(index=False, na_rep="-", float_format="{:.5g}".format) for each in frames]
    return "\n\n".join([f"{data.attrs['speeds']}, all impact angles", *texts]) + "\n"
