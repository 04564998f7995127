"""A regime map: outcome and other quantities over a grid of impacts and of entries that vary."""

from __future__ import annotations

import io
import math
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..engines.settings import MOST, MOST_STORED, RTOL, SMALL, check_engine, check_rtol, most_collisions
from ..errors import InputError
from ..formatting.labelled import Column
from ..host import files
from ..host.arguments import check_function
from ..host.files import check_file
from ..host.progress import Progress
from ..model.validity import flag_words
from ..results import BY_DEFAULT, FAILED, IMPACT, REVERSALS, VALIDITY, attributes
from ..scene.groups import formulas
from ..scene.items import csv
from ..scene.origin import release
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPEEDS
from ..scene.user_model import Package
from .arguments import check_outputs, checked_columns
from .blocks import check_scheduler, check_store, into_memory, into_store
from .impacts import Impacts

if TYPE_CHECKING:
    import xarray

_WORDS = {"outcome": {**dict(enumerate(OUTCOMES)), FAILED: "failed"}, "reversal": dict(enumerate(REVERSALS))}
IMPACTS = tuple(name.partition(".")[2] for name in SPEEDS)


class Grid(Impacts):
    """Impacts over the impact angle, the Stokes number or a speed, and entries that vary, in this order.

    Each argument has one of them, and all have coordinates.
    """

    def order(self) -> np.ndarray:
        """Flat indices in the order of computation: the collisions of one scene follow one another."""
        indices = np.arange(self.size).reshape(self.shape)
        return np.moveaxis(indices, [0, 1], [-2, -1]).ravel()

    def about(self) -> dict[str, Any]:
        """Attributes of the Dataset."""
        return {
            "Conventions": "CF-1.11",
            "title": f"Outcomes of oblique wet collisions: {self.scene.name or 'unnamed scene'}",
            "source": f"wetdoublet {release()}",
            **super().about(),
        }

    def coordinates(self) -> dict[str, Column]:
        """The axes; speed and Stokes number if they are none, and with a bridge the centrifugal number."""
        dims: tuple[str, ...] = tuple(map(str, self.dims))
        coordinates: dict[str, Column] = {}
        for dim, (name, (_, axis)) in zip(dims, self.columns.items(), strict=True):
            unit = {"units": self.scene.fields[name].unit or "1", "long_name": name.replace(".", ", ", 1)}
            coordinates[dim] = (dim,), axis, attributes(dim) if dim in IMPACT else unit
        values = self.all_quantities
        for name in ("speed", "stokes"):
            column = np.reshape(values[name], self.shape)
            if dims[1] == "relative_speed":
                coordinates[name] = dims, column, attributes(name)
            elif name != dims[1]:  # the same at every angle
                coordinates[name] = dims[1:], column[0], attributes(name)
        if self.scene.bridge is not None:
            formula, arguments = formulas(self.scene)["centrifugal"]
            with np.errstate(all="ignore"):
                number = np.asarray(formula(*(values[name] for name in arguments))).reshape(-1)  # of arrays a DM
            label = {"units": "1", "long_name": "centrifugal number m omega0^2/sigma"}
            coordinates["centrifugal"] = dims, np.broadcast_to(number, self.size).reshape(self.shape), label
        return coordinates


def regime_map(
    scene: Scene | str | Path,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    relative_speed: Any = None,
    vary: Mapping[str, Any] | None = None,
    hold: str | None = None,
    rtol: float = RTOL,
    engine: str | None = None,
    of: Sequence[str] = (*BY_DEFAULT, VALIDITY),
    progress: Progress | None = None,
    client: Any = None,
    store: str | Path | None = None,
    resume: str | Path | None = None,
) -> xarray.Dataset:
    """Outcomes over a grid.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed, relative_speed: Stokes numbers, normal speeds in m/s, or magnitudes of the relative velocity in
            m/s: an axis, or a single number; default the scene's.
        angle: impact angles in rad, an axis or a single number; default the scene's.
        vary: other entries by dotted name (SI), each an axis of its own.
        hold: what the scene's impact keeps where it is no argument, as for `collide_many`.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default), or "rosenbrock" or "cvodes", which integrate the phases that taylor has found.
        of: results as for `collide_many`; by default restitution, tangential_restitution, rotation, contact_time,
            smallest_gap and validity (flags of where the model leaves its range).
        progress: called with (collisions done, collisions in all) after every block.
        client: a `dask.distributed.Client` whose workers compute the map, or as text a scheduler's address, its file,
            "local" or "local:N" (N processes here, started and ended by this call). The result is the same.
        store: a Zarr store to write block by block (`map.zarr`); memory does not grow with the map. Whatever ends this
            call, the same one computes what is missing. The Dataset that is returned reads from it.
        resume: without a store, where an interrupt leaves what is finished: in RESUME.KEY.partial, which the same call
            reads, and removes when it has computed the rest.

    Returns:
        Dataset over angle, the one of these three and what varies: outcome (int8: 0 stick, 1 stick-rotate-separate,
        2 bounce, -1 failed), certified, reason (of a failure, else "") and what `of` names; NaN where a stick leaves
        a quantity undefined. The Stokes number and speed that are no axis and, with a bridge, the centrifugal number
        are coordinates as well. The scene is among the attributes.

    Raises:
        InputError: an invalid name or value. A collision that fails raises nothing; it is marked.

    Example:
        >>> from wetdoublet.solvers import regime_map
        >>> regime_map("granulation", stokes=[0.01, 0.02, 0.2], angle=["30 deg", "75 deg"]).outcome.values
        array([[0, 0, 2],
               [0, 1, 2]], dtype=int8)
    """
    check_function(progress, "progress")
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    if client is not None:
        check_scheduler(client, "client")
    file = None if store is None else check_store(store, "store")
    beside = None if resume is None else check_file(resume, "resume", replaced=True)
    loaded, arrays, held = checked_columns(scene, impact, vary, hold)
    axes = _axes(arrays, MOST if file is None else MOST_STORED)
    rtol, engine, names = check_rtol(rtol), check_engine(engine) or "taylor", check_outputs(of)
    dims = tuple(name.partition(".")[2] if name in MEETING else name for name in axes)
    columns = {name: ((dim,), axis) for dim, (name, axis) in zip(dims, axes.items(), strict=True)}
    shape = tuple(axis.size for axis in axes.values())
    grid = Grid(loaded, columns, dims, shape, rtol, engine, names, held, small=math.prod(shape) <= SMALL)
    grid.check()
    if file is not None:
        return into_store(grid, file, client, progress)
    return into_memory(grid, client, progress, beside)


def _axes(columns: Mapping[str, np.ndarray], most: int) -> dict[str, np.ndarray]:
    """The axes by dotted name: angle, impact, what varies; InputError for a repetition, or for too many collisions."""
    axes = {name: array.reshape(-1) for name, array in columns.items()}
    if math.prod(axis.size for axis in axes.values()) > most:
        longest = max(axes, key=lambda name: axes[name].size)
        sizes = " x ".join(str(axis.size) for axis in axes.values())
        raise InputError(longest, None, most_collisions(most), f"makes {sizes} collisions")
    for name, axis in axes.items():
        if np.unique(axis).size != axis.size:
            raise InputError(name, axis, "an axis without repetitions", "has a value twice")
    return {"impact.angle": axes.pop("impact.angle"), **axes}


def impact_axis(data: xarray.Dataset) -> str:
    """The dimension of a map that is the impact's, beside the angle."""
    return next(name for name in IMPACTS if name in data["outcome"].dims)


def scene_of(data: xarray.Dataset) -> Scene:
    """The scene of a map, read from its attributes."""
    model = data.attrs.get("model")
    return Scene.from_toml(data.attrs["scene"], package=None if model is None else Package(str(model)))


def write(data: xarray.Dataset, path: str | Path) -> None:
    """Write a map as NetCDF4, or a table (.csv), atomically. OSError if it cannot be written."""
    if Path(path).suffix.lower() == ".csv":
        files.write(path, to_csv(data))
        return
    encoding = {name: {"zlib": True} for name in data.data_vars if data[name].dtype.kind == "f"}
    files.write(path, netcdf(data, encoding))


def to_csv(data: xarray.Dataset) -> str:
    """The table of a map: coordinates, then the outcome and results, the reason of a failure last.

    Numbers are in SI units and round-trip; a field is empty where a result is not defined.
    """
    dims = [str(dim) for dim in data["outcome"].dims]
    results = sorted(map(str, data.data_vars), key=lambda name: (name == "reason", name != "outcome"))
    names = [*dims, *(str(name) for name in data.coords if name not in dims), *results]
    frame = data.to_dataframe(dim_order=dims).reset_index()[names]
    for name, column in frame.items():
        if name in _WORDS:
            frame[name] = column.map(_WORDS[name])
        elif name == VALIDITY:
            frame[name] = column.map({code: flag_words(code) for code in set(column)})
        elif column.dtype == bool:
            frame[name] = column.map({True: "true", False: "false"})
        elif column.dtype == object:
            frame[name] = column.str.split().str.join(" ")
    return csv(frame, {name: data[name].attrs.get("units", "1") for name in names})


def netcdf(data: xarray.Dataset, encoding: Mapping[Hashable, Any] | None = None) -> memoryview:
    """A Dataset as NetCDF4, built in memory: on a full disk HDF5 aborts the process."""
    from h5netcdf import File
    from xarray.backends import H5NetCDFStore

    content = io.BytesIO()
    with File(content, "w") as file:
        data.dump_to_store(H5NetCDFStore(file), encoding=encoding)
    return content.getbuffer()
