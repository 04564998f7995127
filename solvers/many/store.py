"""A Zarr store that is filled chunk by chunk and appears under its name when it is complete.

Until then it lies beside, as NAME.KEY.unfinished with the key of its request, and a journal says which chunks it has.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import uuid
import warnings
from collections.abc import Hashable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ComputationError, InputError
from ..host import bounded
from ..host.interrupts import held
from ..host.outputs import check_file
from .chunks import Chunks

if TYPE_CHECKING:
    import xarray

SUFFIX = ".zarr"
_META = "zarr.json"
_TOKEN = "token"
_LARGEST_META = 1 << 26  # bytes of a store's description


def check_store(path: object, label: str) -> Path:
    """Return the path of a Zarr store to write; InputError naming `label` if it cannot be, or is something else's."""
    file = check_file(path, label, (SUFFIX,), replaced=True, folder=True)
    if bounded.exists(file) and not _is_ours(file):
        accepted = f"a name ending in {SUFFIX} that is free, or that of a store written here before"
        raise InputError(
            label, str(file), accepted, "exists and is no map or batch of wetdoublet: it is not overwritten"
        )
    return file


def _is_ours(folder: Path) -> bool:
    try:
        said = json.loads(bounded.read(folder / _META, _LARGEST_META))["attributes"]
    except (OSError, ValueError, KeyError, TypeError, bounded.NotRead):
        return False
    return {"scene", "rtol", "engine"} <= {*said}


def opened(path: Path) -> xarray.Dataset:
    """The Dataset of a complete store; values are read when they are used."""
    import xarray as xr

    return xr.open_dataset(path, engine="zarr", chunks=None, consolidated=True)


class Store:
    """The unfinished store of one request; what an earlier run has left is continued.

    Arguments:
        path: where it appears when it is complete.
        key: of the request.
        cut: chunks of the request; those of the store are the same.
    """

    def __init__(self, path: Path, key: str, cut: Chunks) -> None:
        self.target = Path(os.path.realpath(path))
        self.place = self.target.with_name(f"{self.target.name}.{key[:12]}.unfinished")
        self.cut = cut
        self._group: Any = None

    @held()  # Zarr's tasks, interrupted, would write tracebacks later
    def open(self, fixed: xarray.Dataset, first: xarray.Dataset) -> str:
        """Open or create the arrays; returns a token that only this folder has.

        Arguments:
            fixed: coordinates that are known beforehand.
            first: the first chunk, with any values: names, dimensions, kinds and attributes of all other variables.
        """
        zarr = _zarr()
        with _unwarned():
            if (self.place / _TOKEN).is_file():
                token = (self.place / _TOKEN).read_text(errors="replace")
                with self._undamaged():
                    if not token.endswith(self._description()):
                        raise ValueError("its description is not what was written")
                    self._group = zarr.open_group(self.place, mode="r+", zarr_format=3)
                for name, variable in fixed.variables.items():
                    self._group[str(name)][...] = _values(name, variable)
                return token
            if self.place.exists():  # an earlier run was killed before the arrays were complete
                shutil.rmtree(self.place)
            self._group = zarr.open_group(self.place, mode="w", zarr_format=3)
            dims = tuple(map(str, first["outcome"].dims))
            sizes, block = (dict(zip(dims, lengths)) for lengths in (self.cut.shape, self.cut.block))
            for name, variable in fixed.variables.items():
                self._create(name, variable, sizes, block)[...] = _values(name, variable)
            for name in (name for name in first.variables if name not in fixed.variables):
                self._create(name, first.variables[name], sizes, block)
            more = [str(name) for name in {**fixed.coords, **first.coords} if name not in dims]
            self._group.attrs.update({**_plain(first.attrs), **({"coordinates": " ".join(more)} if more else {})})
        token = f"{uuid.uuid4().hex} {self._description()}"
        (self.place / _TOKEN).write_text(token)
        return token

    def _description(self) -> str:
        """Digest of the descriptions of the store and of its arrays."""
        files = [self.place / _META, *sorted(self.place.glob(f"*/{_META}"))]
        return hashlib.sha256(b"\n".join(file.read_bytes() for file in files)).hexdigest()

    def _create(self, name: Hashable, variable: Any, sizes: Mapping[str, int], block: Mapping[str, int]) -> Any:
        """An array for a variable that a chunk or all of it is known of."""
        variable = _encoded(variable)
        shape = tuple(sizes.get(str(dim), size) for dim, size in variable.sizes.items())
        kind = "string" if variable.dtype.kind in "OUT" else variable.dtype
        return self._group.create_array(
            str(name),
            shape=shape,
            chunks=tuple(max(1, block.get(str(dim), size)) for dim, size in variable.sizes.items()),
            dtype=kind,
            compressors=(_zarr().codecs.ZstdCodec(), _zarr().codecs.Crc32cCodec()),  # reading a damaged chunk fails
            fill_value=np.nan if variable.dtype.kind == "f" else "" if kind == "string" else 0,
            dimension_names=[str(dim) for dim in variable.dims],
            attributes=_plain(variable.attrs),
        )

    @held()
    def write(self, k: int, chunk: xarray.Dataset, fixed: xarray.Dataset) -> None:
        """Write chunk k; what has not all dimensions is written with the first chunk along those that it lacks."""
        at = dict(zip(map(str, chunk["outcome"].dims), self.cut.slices(k)))
        for name, variable in chunk.variables.items():
            dims = [str(dim) for dim in variable.dims]
            if name in fixed.variables or any(at[dim].start for dim in at if dim not in dims):
                continue
            with self._undamaged():
                array = self._group[str(name)]
            array[tuple(at[dim] for dim in dims)] = _values(name, variable)

    def holds(self, k: int) -> bool:
        """True if chunk k can be read: no checksum differs."""
        arrays = [self._group[file.parent.name] for file in self.place.glob(f"*/{_META}")]
        at = dict(zip(self._group["outcome"].metadata.dimension_names, self.cut.slices(k)))
        try:
            for array in arrays:
                array[tuple(at[dim] for dim in array.metadata.dimension_names)]
        except (ValueError, RuntimeError):  # of the checksum, or of the decompression before it
            return False
        return True

    @contextmanager
    def _undamaged(self) -> Iterator[None]:
        """Say in one line that an array or the description is not there, or not what was written."""
        try:
            yield
        except (KeyError, ValueError, OSError) as error:
            why = f"{self.place} is damaged ({type(error).__name__}: {' '.join(str(error).split())[:80]})"
            raise ComputationError(why, advice="remove it and compute again") from error

    @held()
    def finish(self) -> None:
        """Move the store to its name, in place of a complete one that was there."""
        zarr = _zarr()
        (self.place / _TOKEN).unlink()
        with _unwarned():
            zarr.consolidate_metadata(self._group.store)
        former = None
        if self.target.exists():
            former = self.place.with_suffix(".former")
            self.target.rename(former)
        self.place.rename(self.target)
        if former is not None:
            shutil.rmtree(former)


def _zarr() -> Any:
    try:
        import zarr
    except ImportError:
        raise ComputationError(f"writing {SUFFIX} needs zarr", advice="pip install 'wetdoublet[cluster]'") from None
    return zarr


@contextmanager
def _unwarned() -> Iterator[None]:
    """Ignore what Zarr says of text and consolidated metadata in its format 3: xarray reads both."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def _encoded(variable: Any) -> Any:
    """A variable whose values a Zarr array can hold."""
    if variable.dtype.kind in "mM":
        from xarray.conventions import encode_cf_variable

        return encode_cf_variable(variable)
    return variable


def _values(name: Hashable, variable: Any) -> np.ndarray:
    values = np.asarray(_encoded(variable).values)
    if values.dtype.kind not in "OUT":
        return values
    if not all(isinstance(value, str) for value in values.ravel().tolist()):
        raise InputError(str(name), None, "coordinates that are numbers, times or text", "cannot be stored")
    return values.astype(object)


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Attributes as JSON holds them."""

    def plain(value: Any) -> Any:
        if isinstance(value, (np.ndarray, np.generic)):
            return value.tolist()
        return value if isinstance(value, (str, int, float, bool, list, type(None))) else str(value)

    return {str(name): plain(value) for name, value in attributes.items()}
