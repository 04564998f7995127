"""Many impacts as one table, over the dimensions over which numpy or xarray broadcasts their columns."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import scaling
from ..errors import InputError
from ..formatting.labelled import Column, labelled, variable
from ..host.pictures import register
from ..model.validity import flag_attributes, warn
from ..results import ALWAYS, FAILED, NONE, REQUESTED, VALIDITY, attributes, outcome_attributes
from ..scene.origin import provenance, release
from ..scene.quantities import normal_speed, quantities
from ..scene.scene import Scene
from ..scene.schema import LEAST_ANGLE, MEETING
from .arguments import first_accepted, of_one_length

if TYPE_CHECKING:
    import xarray

Block = dict[str, np.ndarray]  # columns of results, by name
Dims = tuple[Hashable, ...]
Place = tuple[slice, ...]
LISTED: Dims = ("collision",)
"""The dimension of impacts that are given in one, without a name."""


@dataclass(frozen=True)
class Impacts:
    """Many impacts: a scene, what differs from one to the next, and the results that are requested.

    Arguments:
        columns: dotted name of an entry -> its dimensions, and its checked values along these: SI, or names of choices.
        held: which quantity of the scene's impact all collisions share, in words.
        beside: further coordinates, of DataArrays among the arguments.
        small: the whole request, of which these may be a part, has few collisions (`Variant`).
    """

    scene: Scene
    columns: Mapping[str, tuple[Dims, np.ndarray]]
    dims: Dims
    shape: tuple[int, ...]
    rtol: float
    engine: str
    of: tuple[str, ...] = ()
    held: str = ""
    beside: xarray.Dataset | None = None
    small: bool = False

    @classmethod
    def listed(cls, scene: Scene, columns: Mapping[str, np.ndarray], rtol: float) -> Impacts:
        """Impacts in one dimension, from columns of one length."""
        size = next(iter(columns.values())).size
        return cls(scene, {name: (LISTED, values) for name, values in columns.items()}, LISTED, (size,), rtol, "taylor")

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    def order(self) -> np.ndarray | range:
        """The order in which the impacts are computed."""
        return range(self.size)

    def _flat(self, name: str) -> np.ndarray | None:
        """The values of an entry for all impacts, in one dimension; None if it is no column."""
        if name not in self.columns:
            return None
        dims, values = self.columns[name]
        if dims == self.dims:
            return values.ravel()
        full = values.transpose([dims.index(dim) for dim in self.dims if dim in dims])
        full = full.reshape([n if dim in dims else 1 for dim, n in zip(self.dims, self.shape, strict=True)])
        return np.broadcast_to(full, self.shape).ravel()

    @cached_property
    def angle(self) -> np.ndarray:
        angle = np.asarray(self._flat("impact.angle"))
        head_on = angle < LEAST_ANGLE
        return np.where(head_on, 0.0, angle) if head_on.any() else angle

    @cached_property
    def stokes(self) -> np.ndarray | None:
        return self._flat("impact.stokes")

    @cached_property
    def speed(self) -> np.ndarray | None:
        """Normal speeds, m/s; None where Stokes numbers are given."""
        relative = self._flat("impact.relative_speed")
        return self._flat("impact.speed") if relative is None else np.asarray(normal_speed(relative, self.angle))

    def _entries(self, numbers: bool) -> dict[str, np.ndarray]:
        names = (name for name, (_, values) in self.columns.items() if (values.dtype.kind == "f") == numbers)
        return {name: np.asarray(self._flat(name)) for name in names if name not in MEETING}

    @cached_property
    def vary(self) -> dict[str, np.ndarray]:
        """Entries that are numbers, beside the impact's."""
        return self._entries(numbers=True)

    @cached_property
    def texts(self) -> dict[str, np.ndarray]:
        """Entries that are choices; the impacts are split by them before they are computed (`by_text`)."""
        return self._entries(numbers=False)

    @property
    def quantities(self) -> dict[str, np.ndarray]:
        """Quantities by vocabulary name, SI, one value for each impact; without speed and angle."""
        entries: dict[str, Any] = {name: value for name, value in self.scene.si if name not in MEETING}
        values = quantities(entries | dict(self.vary), self.scene.ways)
        return {name: np.broadcast_to(np.asarray(value, dtype=float), self.size) for name, value in values.items()}

    @property
    def all_quantities(self) -> dict[str, Any]:
        """Quantities with speed, Stokes number and angle, which are arrays; others only if entries vary."""
        values: dict[str, Any] = self.quantities if self.vary else dict(self.scene.material)
        with np.errstate(all="ignore"):
            per_speed = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
            speed = np.asarray(self.stokes) / per_speed if self.speed is None else self.speed
            stokes = speed * per_speed if self.stokes is None else self.stokes
        return values | {"speed": speed, "stokes": stokes, "angle": self.angle}

    def scene_of(self, k: int) -> Scene:
        """The scene of impact k; InputError if the varied entries make it impossible."""
        if not self.vary:
            return self.scene
        return _varied(self.scene, tuple((name, float(values[k])) for name, values in self.vary.items()))

    def impact(self, k: int) -> tuple[Scene, float, float]:
        """Scene, speed (m/s) and angle (rad) of impact k."""
        scene = self.scene_of(k)
        if self.speed is not None:
            return scene, float(self.speed[k]), float(self.angle[k])
        assert self.stokes is not None
        return scene, scene.speed_of(float(self.stokes[k])), float(self.angle[k])

    def subset(self, which: np.ndarray) -> Impacts:
        """These impacts alone, in one dimension."""
        columns = {name: (LISTED, np.asarray(self._flat(name))[which]) for name in self.columns}
        return replace(self, columns=columns, dims=LISTED, shape=which.shape, beside=None)

    def block(self, at: Place) -> Impacts:
        """A block of the impacts, with their dimensions."""
        columns = {
            name: (dims, values[tuple(at[self.dims.index(dim)] for dim in dims)])
            for name, (dims, values) in self.columns.items()
        }
        return replace(self, shape=tuple(span.stop - span.start for span in at), columns=columns, beside=None)

    def by_text(self) -> Iterator[tuple[np.ndarray, Impacts | InputError]]:
        """Indices of impacts with the same choices, and these impacts, or the InputError of the scene."""
        columns = np.array(list(self.texts.values())).T
        for row in dict.fromkeys(map(tuple, columns.tolist())):
            which = np.flatnonzero((columns == np.array(row)).all(axis=1))
            try:
                scene = self.scene.with_entries(dict(zip(self.texts, row, strict=True)))
            except InputError as error:
                yield which, error
            else:
                group = self.subset(which)
                numbers = {name: column for name, column in group.columns.items() if name not in self.texts}
                yield which, replace(group, scene=scene, columns=numbers)

    def check(self) -> None:
        """Raise InputError if the entries that vary make every scene impossible.

        Warnings about scenes are given here, not by the processes that compute them.
        """
        if not set(self.columns) - {*MEETING}:  # one scene
            warn(self.scene)
            return
        varied = {dim for name, (dims, _) in self.columns.items() if name not in MEETING for dim in dims}
        lengths = zip(self.dims, self.shape, strict=True)
        scenes = self.block(tuple(slice(0, size if dim in varied else min(size, 1)) for dim, size in lengths))
        errors, possible = [], False
        for _, group in scenes.by_text() if scenes.texts else ((np.arange(1), scenes),):
            try:
                if isinstance(group, InputError):
                    raise group
                if group.vary and group.size:
                    first_accepted(partial(group.scene_of, k) for k in range(group.size))
                possible = True
                warn(group.scene)
            except InputError as error:
                errors.append(error)
        if errors and not possible:
            raise errors[0]

    def coordinates(self) -> dict[str, Column]:
        """Impacts and entries that vary, each over its own dimensions; `beside` excepted."""
        labels: dict[str, tuple[np.ndarray | None, Mapping[str, Any]]] = {
            name: (getattr(self, name), attributes(name)) for name in ("stokes", "speed", "angle")
        }
        fields = self.scene.fields
        labels |= {name: (values, {"units": fields[name].unit or "1"}) for name, values in self.vary.items()}
        labels |= {name: (values, {"long_name": fields[name].what}) for name, values in self.texts.items()}
        coordinates: dict[str, Column] = {}
        for label, (flat, attrs) in labels.items():
            if flat is not None:  # a speed that follows from other arguments has all dimensions
                every = self.dims, flat.reshape(self.shape)
                coordinates[label] = *self.columns.get(label if "." in label else f"impact.{label}", every), attrs
        return coordinates

    def about(self) -> dict[str, Any]:
        """Attributes of the Dataset."""
        attrs = {
            **provenance(self.scene),
            "rtol": self.rtol,
            "engine": self.engine,
            "held": self.held,
            "model": self.scene.package and self.scene.package.text,
        }
        return {name: value for name, value in attrs.items() if value not in ("", None)}

    def dataset(self, results: Block) -> xarray.Dataset:
        """Results as a labelled Dataset; takes the column of reasons, whose objects need more memory than its text."""
        import xarray as xr

        register()
        reason, failed = results.pop("reason"), (results["outcome"] == FAILED).any()
        reason = reason.astype(str) if failed else np.zeros(reason.size, "<U1")
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
        coordinates, about = self.coordinates(), self.about()
        if self.dims == LISTED and self.beside is None:
            return labelled(variables, coordinates, about)
        data_variables, labels = (
            {name: variable(name, *column) for name, column in columns.items()} for columns in (variables, coordinates)
        )
        data = xr.Dataset(data_variables, labels, about)
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
            "columns": columns,
            "shape": self.shape,
            "rtol": self.rtol,
            "engine": self.engine,
            "of": sorted(set(self.of)),
            **software(self.scene),
        }


@lru_cache(maxsize=64)
def _varied(scene: Scene, entries: tuple[tuple[str, float], ...]) -> Scene:
    return scene.with_si(dict(entries))


def empty(size: int, of: Sequence[str]) -> Block:
    """All columns of a result before anything is computed: outcome -2, reasons empty."""
    columns: Block = {"outcome": np.full(size, -2, np.int8), "certified": np.zeros(size, bool)}
    columns["reason"] = np.full(size, "", object)
    for name in dict.fromkeys(("restitution", *of)):
        if name == "reversal":
            columns[name] = np.full(size, NONE, np.int8)
        elif name == VALIDITY:
            columns[name] = np.zeros(size, np.int16)
        elif name not in ALWAYS:
            columns[name] = np.full(size, np.nan)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def software(scene: Scene) -> dict[str, Any]:
    """Version, equations, and how a scene's entries are read, for the identity of a request."""
    manifest = Path(scaling.__file__).with_name("manifest.json").read_text()
    reads = {"volume": scene.ways.volume, "model": scene.package and scene.package.digest}
    return {"version": release(), "equations": manifest, **reads}


def _digest(values: np.ndarray) -> str:
    text = "\0".join(map(str, values.ravel().tolist())).encode() if values.dtype.kind == "U" else values.tobytes()
    return hashlib.sha256(text).hexdigest()


def laid_out(
    arrays: Mapping[str, np.ndarray], arguments: Mapping[str, Any]
) -> tuple[Dims, tuple[int, ...], dict[str, tuple[Dims, np.ndarray]], xarray.Dataset | None]:
    """Dimensions, shape, columns and further coordinates of many impacts, with their arguments broadcast.

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
        return LISTED, (size,), {name: (LISTED, values) for name, values in columns.items()}, None
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
            axes = [axis for axis in range(-array.ndim, 0) if array.shape[axis] == shape[axis]]
            array = array.reshape([array.shape[axis] for axis in axes])
            dims_of[name] = tuple(dims[axis] for axis in axes)
        columns_of[name] = dims_of[name], array
    _check_dims(dims, dims_of)
    return dims, shape, columns_of, _coordinates(named)


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


def _coordinates(named: Mapping[str, Any]) -> xarray.Dataset | None:
    """Coordinates of all DataArrays; contradictory ones are left out, or are an InputError if they are an index."""
    import xarray as xr

    if not named:
        return None
    try:
        return xr.merge([array.coords.to_dataset() for array in named.values()], compat="minimal", join="exact")
    except ValueError as error:
        problem = f"is not aligned: {' '.join(str(error).split())[:120]}"
        raise InputError([*named][-1], None, "DataArrays with the same coordinates", problem) from None


def without(beside: xarray.Dataset, taken: set[str]) -> xarray.Dataset:
    """The coordinates without those that have the names of results, and without the indices of which these are part."""
    drop: set[Hashable] = set()
    for name in taken & set(beside.coords):
        drop |= set(beside.xindexes.get_all_coords(name, errors="ignore")) | {name}
    return beside.drop_vars(drop)
