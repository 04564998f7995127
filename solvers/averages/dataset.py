"""Averages as a labelled Dataset, and as CSV with a row for each pair."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..many.impacts import Block
from ..scene.items import csv
from ..scene.origin import provenance, release
from ..scene.scene import Scene
from .geometry import BOUNCES, ENERGY, LOST, NORMAL, ROTATES, STICKS, TANGENTIAL, TURNING

if TYPE_CHECKING:
    import xarray


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
_SIZES = {"radius": "radius (um)", "partner_radius": "partner (um)"}
_AXES = {"radius": "radius of the first sphere", "partner_radius": "radius of the second sphere"}


def dataset(
    scene: Scene, axes: Mapping[str, np.ndarray], columns: Block, attributes: Mapping[str, Any]
) -> xarray.Dataset:
    """The Dataset of flat columns, one row for each pair."""
    import xarray as xr

    dims, shape = tuple(axes), tuple(axis.size for axis in axes.values())
    means = {name: _averaged(quantity, columns) for name, quantity in _TABLE.items()}
    variables: dict[str, Any] = {}
    for name, (value, error) in means.items():
        variables[name] = dims, value.reshape(shape), {"units": "1", "long_name": _TABLE[name].meaning}
        meaning = f"estimated error of the quadrature of {name}"
        variables[f"{name}_error"] = dims, error.reshape(shape), {"units": "1", "long_name": meaning}
    rate = {"units": "m s-1" if scene.wall else "m3 s-1", "long_name": "collisions per time and number densities"}
    variables["collision_rate"] = dims, columns["rate"].reshape(shape), rate
    coordinates: dict[str, Any] = {
        name: (name, axis, {"units": "m", "long_name": _AXES[name]}) for name, axis in axes.items()
    }
    variables["reason"] = dims, columns["reason"].astype(str).reshape(shape), {"long_name": "why it failed"}
    all_attributes = {
        "Conventions": "CF-1.11",
        "title": f"Collision averages: {scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {release()}",
        "geometry": "isotropic relative velocities: density sin(2 theta) of impact angles",
        **attributes,
        **provenance(scene),
        **({} if scene.package is None else {"model": scene.package.text}),
    }
    return xr.Dataset(variables, coordinates, all_attributes)


def _averaged(quantity: Quantity, columns: Block) -> tuple[np.ndarray, np.ndarray]:
    """A quantity and its error, (pairs,)."""
    value = quantity.constant + quantity.factor * columns["mean"][:, quantity.column]
    error = abs(quantity.factor) * columns["error"][:, quantity.column]
    if not quantity.separated:
        return value, error
    separate, of_share = columns["mean"][:, [ROTATES, BOUNCES]].sum(axis=1), columns["error"][:, STICKS]
    share = np.where(separate > np.maximum(of_share, 1e-12), separate, np.nan)
    ratio = value / share
    return ratio, (error + np.abs(ratio) * of_share) / share


def to_csv(data: xarray.Dataset) -> str:
    """The table of averages: a row for each pair, SI.

    The column `relative_speeds` names the speed, as text. Numbers round-trip; a field is empty where a result is not
    defined.
    """
    dims = data["stick_probability"].dims
    plain = sorted((name for name in data.data_vars if data[name].dims == dims), key="reason".__eq__)
    frame = _frame(data[plain])
    frame.insert(len(dims), "relative_speeds", data.attrs["speeds"])
    return csv(frame, dict.fromkeys(dims, "m"))


def table(data: xarray.Dataset) -> str:
    """The averages for a person: a line for each pair below names and units."""
    sizes = {name: head for name, head in _SIZES.items() if name in data.dims}
    rate = data["collision_rate"].attrs["units"].replace("m s-1", "m/s").replace("m3 s-1", "m^3/s")
    heads = {name: entry.head for name, entry in _TABLE.items() if entry.head} | {"collision_rate": f"rate ({rate})"}
    data = data.assign_coords({name: 1e6 * data[name] for name in sizes}).rename(sizes)
    text = _frame(data[list(heads)].rename(heads)).to_string(index=False, na_rep="-", float_format="{:.5g}".format)
    return f"{data.attrs['speeds']}, all impact angles\n\n{text}\n"


def _frame(data: xarray.Dataset) -> Any:
    """The DataFrame of a Dataset, its coordinates in the first columns; one row without dimensions."""
    if data.dims:
        return data.to_dataframe().reset_index()
    return data.expand_dims("pair").to_dataframe().reset_index(drop=True)
