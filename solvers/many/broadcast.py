"""Arguments of several shapes laid against each other: numpy's rule for arrays, names of dimensions for DataArrays."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..host.pictures import register
from .results import RESULTS

if TYPE_CHECKING:
    import xarray

    from ..formatting.labelled import Column

Dims = tuple[Hashable, ...]


@dataclass(frozen=True)
class Layout:
    """How a request of several dimensions, or of named ones, is laid out.

    Attributes:
        dims, shape: of the results.
        columns: the arguments by dotted name, broadcast and flat.
        own: argument by dotted name -> the dimensions that it has, and its values along these.
        beside: coordinates that DataArrays bring along.
    """

    dims: Dims
    shape: tuple[int, ...]
    columns: dict[str, np.ndarray]
    own: Mapping[str, tuple[Dims, np.ndarray]]
    beside: xarray.Dataset | None

    def dataset(
        self, variables: Mapping[str, Column], coordinates: Mapping[str, Column], attributes: Mapping[str, Any]
    ) -> xarray.Dataset:
        """The Dataset of flat columns: variables over all dimensions, coordinates over those that they have."""
        import xarray as xr

        register()
        named: dict[str, Any] = {}
        for label, (_, flat, said) in coordinates.items():
            name = label if "." in label else f"impact.{label}"
            # a speed that follows from other arguments has all dimensions
            dims, values = self.own.get(name, (self.dims, flat.reshape(self.shape)))
            named[label] = dims, values, said
        shaped = {name: (self.dims, values.reshape(self.shape), said) for name, (_, values, said) in variables.items()}
        made = xr.Dataset(shaped, named, attributes)
        return made if self.beside is None else made.assign_coords(_others(self.beside, {*variables, *named}).coords)


def laid_out(arrays: Mapping[str, np.ndarray], given: Mapping[str, Any]) -> Layout | None:
    """How the arguments are broadcast; None where all have one dimension or none, without a name.

    Arguments:
        arrays: checked values by dotted name.
        given: what they were read from, with dimensions and coordinates if these are DataArrays.

    Raises:
        InputError: a shape that does not fit, naming the argument.
    """
    dims_of: dict[str, Dims] = {name: tuple(given[name].dims) for name in arrays if _named(given.get(name))}
    if not any(dims_of.values()) and all(array.ndim < 2 for array in arrays.values()):
        return None
    sizes = _sizes(arrays, dims_of)
    if not sizes:
        shape: tuple[int, ...] = ()
        for name, array in arrays.items():
            shape = _broadcast(name, array, shape)
        sizes = {f"dim_{k}": size for k, size in enumerate(shape)}
    dims, shape = tuple(sizes), tuple(sizes.values())
    own, columns = {}, {}
    for name, array in arrays.items():
        if name not in dims_of:
            if array.ndim > len(shape) or _broadcast(name, array, shape) != shape:
                raise _misfit(name, array, shape)
            kept = [axis for axis in range(-array.ndim, 0) if array.shape[axis] == shape[axis]]
            array = array.reshape([array.shape[axis] for axis in kept])
            dims_of[name] = tuple(dims[axis] for axis in kept)
        own[name] = dims_of[name], array
        columns[name] = _filled(array, dims_of[name], dims, shape)
    _check_names(dims, dims_of)
    return Layout(
        dims, shape, columns, own, _beside([given[name] for name in arrays if _named(given.get(name))], given)
    )


def _check_names(dims: Dims, dims_of: Mapping[str, Dims]) -> None:
    """InputError for a dimension that is named as a result, or as an argument that is not along it alone."""
    for dim in dims:
        if dim in RESULTS:
            raise InputError("dims", dim, "dimensions that are not named as a result", "is the name of a result")
    for name, own in dims_of.items():
        label = name.removeprefix("impact.")
        if label in dims and own != (label,):
            problem = f"is the name of a dimension, along which {name} does not lie alone"
            raise InputError("dims", label, "a dimension of another name", problem)


def _named(value: object) -> bool:
    return isinstance(getattr(value, "dims", None), tuple) and hasattr(value, "coords")


def _sizes(arrays: Mapping[str, np.ndarray], dims_of: Mapping[str, Dims]) -> dict[Hashable, int]:
    sizes: dict[Hashable, int] = {}
    for name, dims in dims_of.items():
        for dim, size in zip(dims, arrays[name].shape, strict=True):
            if sizes.setdefault(dim, size) != size:
                raise InputError(name, f"{size} values", f"{sizes[dim]} values along {dim}", "differs in length")
    return sizes


def _broadcast(name: str, array: np.ndarray, shape: tuple[int, ...]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(array.shape, shape)
    except ValueError:
        raise _misfit(name, array, shape) from None


def _misfit(name: str, array: np.ndarray, shape: tuple[int, ...]) -> InputError:
    return InputError(name, f"shape {array.shape}", f"what numpy broadcasts to {shape}", "does not fit the others")


def _filled(array: np.ndarray, own: Dims, dims: Dims, shape: tuple[int, ...]) -> np.ndarray:
    """Values over some of the dimensions, over all of them, flat."""
    order = [own.index(dim) for dim in dims if dim in own]
    full = array.transpose(order).reshape([size if dim in own else 1 for dim, size in zip(dims, shape, strict=True)])
    return np.broadcast_to(full, shape).ravel()


def _beside(named: list[Any], given: Mapping[str, Any]) -> xarray.Dataset | None:
    """Coordinates of all DataArrays; those that contradict each other are left out, unless it is an index."""
    import xarray as xr

    if not named:
        return None
    try:
        return xr.merge([one.coords.to_dataset() for one in named], compat="minimal", join="exact")
    except ValueError as error:
        labels = [name for name, value in given.items() if _named(value)]
        said = " ".join(str(error).split())[:120]
        raise InputError(labels[-1], None, "DataArrays with the same coordinates", f"is not aligned: {said}") from None


def _others(beside: xarray.Dataset, taken: set[str]) -> xarray.Dataset:
    """The coordinates without those whose names the results take, and without indices that these are part of."""
    drop: set[Hashable] = set()
    for name in taken & set(beside.coords):
        drop |= set(beside.xindexes.get_all_coords(name, errors="ignore")) | {name}
    return beside.drop_vars(drop)
