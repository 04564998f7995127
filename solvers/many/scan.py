"""A scan: collisions over several dimensions, over which its arguments are broadcast as by numpy or xarray."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import scaling
from ..engines.choice import collision_engine
from ..errors import InputError
from ..formatting.labelled import Column, labelled
from ..host.pictures import register
from ..model.validity import flag_attributes, warn
from ..results import FAILED, REQUESTED, VALIDITY, attributes, outcome_attributes
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .batch import Batch, batch, check_any_possible, of_one_length
from .results import Block

if TYPE_CHECKING:
    import xarray

Dims = tuple[Hashable, ...]
Place = tuple[slice, ...]


@dataclass
class Scan:
    """Collisions of one scene over several dimensions.

    Arguments:
        columns: dotted name of an argument -> its dimensions, and its checked values (SI) along these.
        engine: the requested engine; None for the best of each scene.
        held: which quantity of the scene's impact all collisions share, in words.
        beside: further coordinates, of DataArrays among the arguments.
        engines: the engine for each combination of choices (`check`).
    """

    scene: Scene
    dims: Dims
    shape: tuple[int, ...]
    columns: Mapping[str, tuple[Dims, np.ndarray]]
    rtol: float
    engine: str | None
    of: tuple[str, ...]
    held: str = ""
    beside: xarray.Dataset | None = None
    engines: dict[tuple[str, ...], str] = field(default_factory=dict)

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    @property
    def answered_by(self) -> str:
        """The engines that compute the collisions, as text."""
        return ", ".join(dict.fromkeys(self.engines.values())) or self.engine or "rosenbrock"

    def order(self) -> np.ndarray:
        return np.arange(self.size)

    def part(self, at: Place) -> Scan:
        """A block of the scan."""
        columns = {
            name: (column_dims, values[tuple(at[self.dims.index(dim)] for dim in column_dims)])
            for name, (column_dims, values) in self.columns.items()
        }
        return replace(self, shape=tuple(one.stop - one.start for one in at), columns=columns, beside=None)

    def batch(self) -> Batch:
        """All collisions, in one dimension."""
        columns = {}
        for name, (column_dims, values) in self.columns.items():
            if column_dims == self.dims:
                columns[name] = values.ravel()
                continue
            full = values.transpose([column_dims.index(dim) for dim in self.dims if dim in column_dims])
            full = full.reshape([n if dim in column_dims else 1 for dim, n in zip(self.dims, self.shape, strict=True)])
            columns[name] = np.broadcast_to(full, self.shape).ravel()
        engine = self.engines.get((), "rosenbrock")
        return batch(self.scene, columns, self.rtol, engine, self.of, self.engines)

    def check(self) -> None:
        """Determine the engines; InputError if the entries that vary make every scene impossible.

        Warnings about scenes are given here, not by the processes that compute them.
        """
        if not set(self.columns) - {*MEETING}:  # one scene
            warn(self.scene)
            self.engines[()] = collision_engine(self.scene, self.engine)
            return
        varied = {dim for name, (column_dims, _) in self.columns.items() if name not in MEETING for dim in column_dims}
        lengths = zip(self.dims, self.shape, strict=True)
        scenes = self.part(tuple(slice(0, size if dim in varied else min(size, 1)) for dim, size in lengths)).batch()
        errors = []
        for where, part in scenes.by_text() if scenes.texts else ((np.arange(1), scenes),):
            try:
                if isinstance(part, InputError):
                    raise part
                check_any_possible(part)
                choices = tuple(str(values[where[0]]) for values in scenes.texts.values())
                self.engines[choices] = collision_engine(part.scene, self.engine)
                warn(part.scene)
            except InputError as error:
                errors.append(error)
        if errors and not self.engines:
            raise errors[0]

    def coordinates(self, request: Batch) -> dict[str, Column]:
        """Impacts and entries that vary, each over its own dimensions; `beside` excepted."""
        labels: dict[str, tuple[np.ndarray | None, Mapping[str, Any]]] = {
            name: (getattr(request, name), attributes(name)) for name in ("stokes", "speed", "angle")
        }
        fields = self.scene.fields
        labels |= {name: (values, {"units": fields[name].unit or "1"}) for name, values in request.vary.items()}
        labels |= {name: (values, {"long_name": fields[name].what}) for name, values in request.texts.items()}
        coordinates: dict[str, Column] = {}
        for label, (flat, attrs) in labels.items():
            if flat is not None:  # a speed that follows from other arguments has all dimensions
                every = self.dims, flat.reshape(self.shape)
                coordinates[label] = *self.columns.get(label if "." in label else f"impact.{label}", every), attrs
        return coordinates

    def about(self) -> dict[str, Any]:
        """Attributes of the Dataset."""
        attrs = {
            "scene": self.scene.to_toml(),
            "rtol": self.rtol,
            "engine": self.answered_by,
            "held": self.held,
            "model": self.scene.package and self.scene.package.text,
        }
        return {name: value for name, value in attrs.items() if value not in ("", None)}

    def dataset(self, results: Block, request: Batch | None = None) -> xarray.Dataset:
        """Results as a labelled Dataset; `request` is the batch of the scan, if the caller has it."""
        import xarray as xr

        register()
        failed = results["outcome"] == FAILED
        reason = results["reason"].astype(str) if failed.any() else np.zeros(failed.size, "<U1")
        columns = {
            "outcome": (results["outcome"], outcome_attributes()),
            "certified": (results["certified"], {"long_name": "the stick is proved"}),
            "reason": (reason, {"long_name": "why it failed"}),
        }
        for name, values in results.items():
            if name not in columns:
                columns[name] = values, flag_attributes() if name == VALIDITY else attributes(name)
        variables: Any = {
            name: (self.dims, values.reshape(self.shape), attrs) for name, (values, attrs) in columns.items()
        }
        coordinates, about = self.coordinates(request or self.batch()), self.about()
        if self.dims == ("collision",) and self.beside is None:
            return labelled(variables, coordinates, about)
        data = xr.Dataset(variables, coordinates, about)
        if self.beside is None:
            return data
        return data.assign_coords(without(self.beside, {*variables, *coordinates}).coords)

    def identity(self) -> dict[str, Any]:
        """Everything that the results depend on, as JSON values."""
        columns = {
            name: [list(map(str, column_dims)), _digest(values)] for name, (column_dims, values) in self.columns.items()
        }
        return {
            "scene": self.scene.si,
            "volume": self.scene.ways.volume,
            "columns": columns,
            "shape": self.shape,
            "rtol": self.rtol,
            "engine": self.answered_by,
            "of": sorted(set(self.of)),
            **software(),
            "model": self.scene.package and self.scene.package.digest,
        }


def software() -> dict[str, str]:
    """Version and equations, for the identity of a request."""
    manifest = Path(scaling.__file__).with_name("manifest.json").read_text()
    return {"version": version("wetdoublet"), "equations": manifest}


def _digest(values: np.ndarray) -> str:
    text = "\0".join(map(str, values.ravel().tolist())).encode() if values.dtype.kind == "U" else values.tobytes()
    return hashlib.sha256(text).hexdigest()


def laid_out(
    arrays: Mapping[str, np.ndarray], arguments: Mapping[str, Any]
) -> tuple[Dims, tuple[int, ...], dict[str, tuple[Dims, np.ndarray]], xarray.Dataset | None]:
    """Dimensions, shape, columns and further coordinates of a scan, with its arguments broadcast.

    The dimension is `collision` if all arguments have at most one dimension, without a name.

    Arguments:
        arrays: checked values by dotted name.
        arguments: the arguments as passed, of which DataArrays have dimensions and coordinates.

    Raises:
        InputError: a shape that does not fit, naming the argument.
    """
    named = {name: arguments[name] for name in arrays if hasattr(arguments.get(name), "coords")}
    dims_of: dict[str, Dims] = {name: tuple(value.dims) for name, value in named.items()}
    if not any(dims_of.values()) and all(array.ndim < 2 for array in arrays.values()):
        columns = of_one_length(arrays)
        size = next(iter(columns.values())).size
        return ("collision",), (size,), {name: (("collision",), values) for name, values in columns.items()}, None
    sizes: dict[Hashable, int] = {}
    for name, column_dims in dims_of.items():
        for dim, size in zip(column_dims, arrays[name].shape, strict=True):
            if sizes.setdefault(dim, size) != size:
                raise InputError(name, f"{size} values", f"{sizes[dim]} values along {dim}", "differs in length")
    if not sizes:
        shape: tuple[int, ...] = ()
        for name, array in arrays.items():
            shape = _broadcast(name, array, shape)
        sizes = {f"dim_{k}": size for k, size in enumerate(shape)}
    dims, shape = tuple(sizes), tuple(sizes.values())
    columns_of = {}
    for name, array in arrays.items():
        if name not in dims_of:
            if _broadcast(name, array, shape) != shape:
                raise _misfit(name, array, shape)
            kept = [axis for axis in range(-array.ndim, 0) if array.shape[axis] == shape[axis]]
            array = array.reshape([array.shape[axis] for axis in kept])
            dims_of[name] = tuple(dims[axis] for axis in kept)
        columns_of[name] = dims_of[name], array
    _check_dims(dims, dims_of)
    return dims, shape, columns_of, _beside(named)


def _check_dims(dims: Dims, dims_of: Mapping[str, Dims]) -> None:
    """InputError for a dimension with the name of a result, or of an argument that has other dimensions too."""
    for dim in dims:
        if dim in REQUESTED:
            raise InputError("dims", dim, "dimensions that are not named as a result", "is the name of a result")
    for name, column_dims in dims_of.items():
        label = name.removeprefix("impact.")
        if label in dims and column_dims != (label,):
            problem = f"is the name of a dimension, along which {name} does not lie alone"
            raise InputError("dims", label, "a dimension of another name", problem)


def _broadcast(name: str, array: np.ndarray, shape: tuple[int, ...]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(array.shape, shape)
    except ValueError:
        raise _misfit(name, array, shape) from None


def _misfit(name: str, array: np.ndarray, shape: tuple[int, ...]) -> InputError:
    return InputError(name, f"shape {array.shape}", f"what numpy broadcasts to {shape}", "does not fit the others")


def _beside(named: Mapping[str, Any]) -> xarray.Dataset | None:
    """Coordinates of all DataArrays; contradictory ones are left out, or are an InputError if they are an index."""
    import xarray as xr

    if not named:
        return None
    try:
        return xr.merge([one.coords.to_dataset() for one in named.values()], compat="minimal", join="exact")
    except ValueError as error:
        problem = f"is not aligned: {' '.join(str(error).split())[:120]}"
        raise InputError([*named][-1], None, "DataArrays with the same coordinates", problem) from None


def without(beside: xarray.Dataset, taken: set[str]) -> xarray.Dataset:
    """The coordinates without those that have the names of results, and without the indices of which these are part."""
    drop: set[Hashable] = set()
    for name in taken & set(beside.coords):
        drop |= set(beside.xindexes.get_all_coords(name, errors="ignore")) | {name}
    return beside.drop_vars(drop)
