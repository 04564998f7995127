"""Fast construction of labelled Datasets: the layout of variables of one shape is built once and cached.

Building a Dataset takes xarray longer than the kernel takes for a hundred collisions; copying one with other numbers
is cheap.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray

Column = tuple[tuple[str, ...], np.ndarray, Mapping[str, Any]]  # dimensions, values, attributes
_Shape = tuple[str, tuple[str, ...], tuple[int, ...]]


def labelled(
    variables: Mapping[str, Column],
    coordinates: Mapping[str, Column],
    attributes: Mapping[str, Any],
    axes: Mapping[str, tuple[str, ...]] | None = None,
) -> xarray.Dataset:
    """The Dataset that `xarray.Dataset` would build of these variables and coordinates.

    Arguments:
        axes: names along a dimension, its index.
    """
    columns = {**variables, **coordinates}
    shapes = tuple((name, dims, values.shape) for name, (dims, values, _) in columns.items())
    data = _laid_out(shapes, tuple(coordinates), tuple((axes or {}).items())).copy()
    for name, (_, values, attrs) in columns.items():
        variable = data.variables[name]
        variable.data = values
        variable.attrs = attrs  # a copy, so that arrays among the attributes are not shared
    data.attrs = attributes
    return data


@lru_cache(maxsize=32)
def _laid_out(
    shapes: tuple[_Shape, ...], coordinates: tuple[str, ...], axes: tuple[tuple[str, tuple[str, ...]], ...]
) -> xarray.Dataset:
    """The Dataset's layout, with placeholder values that take no memory."""
    import xarray as xr

    blank = {name: (dims, np.broadcast_to(0.0, shape)) for name, dims, shape in shapes}
    return xr.Dataset(blank, {name: list(names) for name, names in axes}).set_coords(coordinates)


def variable(name: str, dims: tuple[str, ...], values: np.ndarray, attributes: Mapping[str, Any]) -> xarray.Variable:
    """A column as xarray has it, which from a bare array imports dask where that is installed: 0.5 s."""
    import pandas as pd
    import xarray as xr

    is_index = tuple(dims) == (name,) and values.dtype.kind == "f"
    return xr.Variable(dims, pd.Index(values) if is_index else values, attributes, fastpath=True)
