"""Finished blocks of a scan on disk, so that an interrupted run computes only what is missing.

A journal is a text file, a line a block, each under the key of the request that it belongs to and with its own
checksum: a line that was torn, or is another request's, is passed over.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .files import write, write_all
from .many import Block


class Journal:
    """The journal of one request.

    Arguments:
        path: the file; it need not exist yet.
        request: everything that the results depend on, as JSON values; None: `under` says it later.
    """

    def __init__(self, path: Path, request: Mapping[str, Any] | None = None) -> None:
        self.path = path
        self.key = b""
        if request is not None:
            self.under(request)

    def under(self, request: Mapping[str, Any]) -> None:
        """Make this the journal of a request."""
        self.key = hashlib.sha256(json.dumps(request, sort_keys=True).encode()).hexdigest()[:32].encode()

    def read(self) -> list[tuple[np.ndarray, Block]]:
        """The blocks of this request that are done."""
        return [_block(record) for key, record in self._records() if key == self.key and record is not None]

    def count(self) -> int:
        """Collisions of this request that are done."""
        return sum(len(record["where"]) for key, record in self._records() if key == self.key and record is not None)

    def others(self) -> tuple[int, int]:
        """How much of the file is not this request's: collisions of others, and lines that are no collisions."""
        strange = [record for key, record in self._records() if key != self.key]
        return sum(len(one["where"]) for one in strange if one is not None), sum(one is None for one in strange)

    def _records(self) -> Iterator[tuple[bytes, dict[str, Any] | None]]:
        """Key and content of every line, None for a line that is not whole."""
        if not self.path.is_file():
            return
        with self.path.open("rb") as file:
            for line in file:
                key, checksum, text = (*line.rstrip(b"\n").split(b" ", 2), b"", b"")[:3]
                if line.strip():
                    yield key, json.loads(text) if text and checksum == _checksum(text) else None

    def add(self, where: np.ndarray, block: Block) -> None:
        """Put down a block, in a single write."""
        columns = {name: values.tolist() for name, values in block.items()}
        text = json.dumps({"where": where.tolist(), "columns": columns}).encode()
        try:
            with self.path.open("ab", buffering=0) as file:
                # begins a line of its own, should the last one be torn
                write_all(file.fileno(), b"\n%s %s %s\n" % (self.key, _checksum(text), text))
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(self.path)) from error

    def remove(self) -> None:
        """Remove what is kept of this request; the file too, unless another request's work is in it."""
        if not self.path.is_file():
            return
        lines = self.path.read_bytes().split(b"\n")
        others = [line for line in lines if line and not line.startswith(self.key + b" ")]
        if not others:
            self.path.unlink(missing_ok=True)
            return
        write(self.path, b"\n".join(others) + b"\n")


def _checksum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def _block(record: Mapping[str, Any]) -> tuple[np.ndarray, Block]:
    kinds: dict[str, Any] = {"outcome": np.int8, "certified": bool, "reason": object}
    columns = {name: np.array(values, dtype=kinds.get(name, float)) for name, values in record["columns"].items()}
    return np.array(record["where"], dtype=int), columns
