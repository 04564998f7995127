"""Averages as a labelled Dataset, and as CSV with a row for each pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
"""What is averaged and has derivatives, in this order."""
_ENERGIES = {  # name: column, factor and constant, meaning
    "normal_dissipation": (
        ENERGY,
        -2.0,
        1.0,
        "1 - normal kinetic energy after over before, of all collisions; negative where others feed it",
    ),
    "kinetic_energy_loss": (
        LOST,
        1.0,
        0.0,
        "loss of kinetic energy, rotation included, over the kinetic energy of the relative motion",
    ),
    "energy_into_rotation": (
        TURNING,
        1.0,
        0.0,
        "gain of the energy of rotation over the kinetic energy of all collisions",
    ),
}

_SHOWN = {  # name: head of its column in a table
    "stick_probability": "stick", "rotate_probability": "rotate", "bounce_probability": "bounce",
    "restitution_all": "e_n of all", "tangential_restitution_all": "e_t of all", "restitution_separated": "e_n apart",
    "tangential_restitution_separated": "e_t apart", "kinetic_energy_loss": "energy lost",
}  # fmt: skip
_SIZES = {"radius": "radius (um)", "partner_radius": "partner (um)"}
_AXES = {"radius": "radius of the first sphere", "partner_radius": "radius of the second sphere"}


def dataset(
    scene: Scene, axes: Mapping[str, np.ndarray], columns: Columns, attributes: Mapping[str, Any], wrt: Sequence[str]
) -> xarray.Dataset:
    """The Dataset of flat columns, one row for each pair."""
    import xarray as xr

    dims, shape = tuple(axes), tuple(axis.size for axis in axes.values())
    mean, error, slope, slope_error = _quantities(columns, len(wrt))
    variables: dict[str, Any] = {}
    for k, (name, (_, meaning)) in enumerate({**_MEANS, **_SEPARATED}.items()):
        variables[name] = dims, mean[:, k].reshape(shape), {"units": "1", "long_name": meaning}
        meaning = f"estimated error of the quadrature of {name}"
        variables[f"{name}_error"] = dims, error[:, k].reshape(shape), {"units": "1", "long_name": meaning}
    for name, (column, factor, constant, meaning) in _ENERGIES.items():
        value, its_error = constant + factor * columns["mean"][:, column], abs(factor) * columns["error"][:, column]
        variables[name] = dims, value.reshape(shape), {"units": "1", "long_name": meaning}
        meaning = f"estimated error of the quadrature of {name}"
        variables[f"{name}_error"] = dims, its_error.reshape(shape), {"units": "1", "long_name": meaning}
    rate = {"units": "m s-1" if scene.wall else "m3 s-1", "long_name": "collisions per time and number densities"}
    variables["collision_rate"] = dims, columns["rate"].reshape(shape), rate
    coordinates: dict[str, Any] = {
        name: (name, axis, {"units": "m", "long_name": _AXES[name]}) for name, axis in axes.items()
    }
    if wrt:
        over, sizes = (*dims, "quantity", "parameter"), (*shape, len(QUANTITIES), len(wrt))
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


def _quantities(columns: Columns, parameters: int) -> tuple[np.ndarray, ...]:
    """Means and errors of `QUANTITIES`, (pairs, quantities), and their derivatives, (pairs, quantities, parameters).

    The means over the collisions that separate are those over all, divided by the share of the former, s = 1 - stick.
    """
    mean, error = columns["mean"][:, :SLOPES], columns["error"][:, :SLOPES]
    slope, slope_error = (
        columns[name].reshape(len(mean), SLOPES, parameters) for name in ("gradient", "gradient_error")
    )
    separate, of_share = mean[:, [ROTATES]] + mean[:, [BOUNCES]], error[:, [STICKS]]
    share = np.where(separate > np.maximum(of_share, 1e-12), separate, np.nan)
    both = [place for place, _ in _SEPARATED.values()]
    ratio = mean[:, both] / share
    ratio_error = (error[:, both] + np.abs(ratio) * of_share) / share
    ratio_slope = (slope[:, both] + ratio[..., None] * slope[:, [STICKS]]) / share[..., None]
    ratio_slope_error = (slope_error[:, both] + np.abs(ratio)[..., None] * slope_error[:, [STICKS]]) / share[..., None]
    pairs = (mean, ratio), (error, ratio_error), (slope, ratio_slope), (slope_error, ratio_slope_error)
    return tuple(np.concatenate(each, axis=1) for each in pairs)


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
    heads = {**_SHOWN, "collision_rate": f"rate ({rate})"}
    data = data.assign_coords({name: 1e6 * data[name] for name in sizes}).rename(sizes)
    blocks = [data[list(heads)].rename(heads).expand_dims([] if sizes else ["pair"])]
    blocks += [data["gradient"].to_dataset("parameter")] if "gradient" in data else []
    frames = [each.to_dataframe().reset_index(drop="pair" in each.dims) for each in blocks]
    texts = [each.to_string(index=False, na_rep="-", float_format="{:.5g}".format) for each in frames]
    return "\n\n".join([f"{data.attrs['speeds']}, all impact angles", *texts]) + "\n"
