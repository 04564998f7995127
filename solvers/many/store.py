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

from ..errors import ComputationError, InputError, install_extra
from ..host import bounded
from ..host.interrupts import held
from ..host.outputs import check_file
from .scan import Scan, without

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
        attributes = json.loads(bounded.read(folder / _META, _LARGEST_META))["attributes"]
    except (OSError, ValueError, KeyError, TypeError, bounded.NotRead):
        return False
    return {"scene", "rtol", "engine"} <= {*attributes}


def opened(path: Path) -> xarray.Dataset:
    """The Dataset of a complete store; values are read when they are used."""
    import xarray as xr

    return xr.open_dataset(path, engine="zarr", chunks=None, consolidated=True)


class Store:
    """The unfinished store of one request; what an earlier run has left is continued.

    It is written through Zarr itself: xarray's region writes open the store anew for every chunk, and the template that
    they need is loaded whole where it is text.

    Arguments:
        path: where it appears when it is complete.
        key: of the request.
    """

    def __init__(self, path: Path, key: str) -> None:
        self.target = Path(os.path.realpath(path))
        self.place = self.target.with_name(f"{self.target.name}.{key[:12]}.unfinished")
        self._group: Any = None
        self._dims: dict[str, list[str]] = {}  # array -> its dimensions

    @held()  # Zarr's tasks, interrupted, would write tracebacks later
    def open(self, scan: Scan, first: xarray.Dataset) -> str:
        """Open or create the arrays; returns a token that only this folder has.

        Arguments:
            first: the first chunk, which is none of the smaller ones, with any values.
        """
        variables = dict(first.variables)
        beside = {} if scan.beside is None else dict(without(scan.beside, {*map(str, variables)}).variables)
        self._dims = {str(name): [str(dim) for dim in each.dims] for name, each in variables.items()}
        with _unwarned():
            if (self.place / _TOKEN).is_file():
                token = (self.place / _TOKEN).read_text(errors="replace")
                with self._undamaged():
                    if not token.endswith(self._description()):
                        raise ValueError("its description is not what was written")
                    self._group = _zarr().open_group(self.place, mode="r+", zarr_format=3)
            else:
                if self.place.exists():  # an earlier run was killed before the arrays were complete
                    shutil.rmtree(self.place)
                self._group = _zarr().open_group(self.place, mode="w", zarr_format=3)
                sizes = dict(zip(map(str, scan.dims), scan.shape, strict=True))
                for name, variable in (variables | beside).items():
                    self._create(str(name), variable, sizes)
                others = [str(name) for name in (*first.coords, *beside) if name not in sizes]
                about = {**_plain(first.attrs), **({"coordinates": " ".join(others)} if others else {})}
                self._group.attrs.update(about)
                for name, variable in beside.items():
                    self._group[str(name)][...] = _values(name, variable)
                token = f"{uuid.uuid4().hex} {self._description()}"
                (self.place / _TOKEN).write_text(token)
        return token

    def _description(self) -> str:
        """Digest of the descriptions of the store and of its arrays."""
        files = [self.place / _META, *sorted(self.place.glob(f"*/{_META}"))]
        return hashlib.sha256(b"\n".join(file.read_bytes() for file in files)).hexdigest()

    def _create(self, name: str, variable: Any, sizes: Mapping[str, int]) -> None:
        """An array for a variable of which a chunk is known, or all."""
        variable = _encoded(variable)
        kind = "string" if variable.dtype.kind in "OUT" else variable.dtype
        self._group.create_array(
            name,
            shape=tuple(sizes.get(str(dim), size) for dim, size in variable.sizes.items()),
            chunks=tuple(max(1, size) for size in variable.shape),
            dtype=kind,
            compressors=(_zarr().codecs.ZstdCodec(), _zarr().codecs.Crc32cCodec()),  # reading a damaged chunk fails
            fill_value=np.nan if variable.dtype.kind == "f" else "" if kind == "string" else 0,
            dimension_names=[str(dim) for dim in variable.dims],
            attributes=_plain(variable.attrs),
        )

    @held()
    def write(self, at: tuple[slice, ...], chunk: xarray.Dataset) -> None:
        """Write a chunk; what has not all dimensions is written with the first chunk along those that it lacks."""
        place = dict(zip(map(str, chunk["outcome"].dims), at))
        for name, dims in self._dims.items():
            if any(place[dim].start for dim in place if dim not in dims):
                continue
            with self._undamaged():
                array = self._group[name]
            array[tuple(place[dim] for dim in dims)] = _values(name, chunk.variables[name])

    def holds(self, at: tuple[slice, ...]) -> bool:
        """True if a chunk can be read: no checksum differs."""
        place = dict(zip(self._dims["outcome"], at))
        try:
            for name, dims in self._dims.items():
                self._group[name][tuple(place[dim] for dim in dims)]
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
        (self.place / _TOKEN).unlink()
        with _unwarned():
            _zarr().consolidate_metadata(self._group.store)
        former = self.place.with_suffix(".former")
        if self.target.exists():
            self.target.rename(former)
        self.place.rename(self.target)
        if former.exists():
            shutil.rmtree(former)


def _zarr() -> Any:
    try:
        import zarr
    except ImportError:
        raise ComputationError(f"writing {SUFFIX} needs zarr", advice=install_extra("cluster")) from None
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
