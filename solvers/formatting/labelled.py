"""Columns of numbers as labelled Datasets, quickly: what has the same shape is laid out once.

xarray takes longer to put a Dataset together than a hundred collisions take; a copy with other numbers is soon made.
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
    """What `xarray.Dataset` makes of them.

    Arguments:
        axes: names along a dimension, its index.
    """
    columns = {**variables, **coordinates}
    shapes = tuple((name, dims, values.shape) for name, (dims, values, _) in columns.items())
    blank = _laid_out(shapes, tuple((axes or {}).items()))
    found = blank.copy(data={name: values for name, (_, values, _) in columns.items()}).set_coords(coordinates)
    for name, (_, _, said) in columns.items():
        found.variables[name].attrs = said  # its own: an array among them must not be shared
    found.attrs = attributes
    return found


@lru_cache(maxsize=32)
def _laid_out(shapes: tuple[_Shape, ...], axes: tuple[tuple[str, tuple[str, ...]], ...]) -> xarray.Dataset:
    """The variables without their numbers, which takes no memory."""
    import xarray as xr

    blank = {name: (dims, np.broadcast_to(0.0, shape)) for name, dims, shape in shapes}
    return xr.Dataset(blank, {name: list(names) for name, names in axes})
