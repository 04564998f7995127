"""Finished blocks of a scan on disk, so that an interrupted run computes only what is missing.

A journal is a text file with one block per line. Each line has the key of its request and a checksum; incomplete lines
and lines of other requests are skipped. NetCDF cannot take its place, as a kill in mid-write spoils the whole file.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..host import bounded
from ..host.files import write, write_all
from .results import Block


def checked_journal(value: object) -> Journal | None:
    """A journal of what a caller passes: a file's name, a journal, or None; InputError for anything else."""
    if value is None or isinstance(value, Journal):
        return value
    if not isinstance(value, (str, os.PathLike)) or not str(value).strip():
        raise InputError("journal", value, "a file name, or None", "is not a file name")
    return Journal(Path(value))


def beside(file: Path) -> Journal:
    """The journal of a file that is being made."""
    return Journal(file.with_name(file.name + ".partial"))


class Journal:
    """The journal of one request (one map or scan).

    Arguments:
        path: the file; it need not exist yet.
        request: everything that the results depend on, as JSON values; None if `set_request` sets it later.
    """

    def __init__(self, path: Path, request: Mapping[str, Any] | None = None) -> None:
        self.path = path
        self.key = b""
        self._descriptor: int | None = None
        if request is not None:
            self.set_request(request)

    def set_request(self, request: Mapping[str, Any]) -> None:
        """Set the request whose blocks this journal reads and adds."""
        self.key = hashlib.sha256(json.dumps(request, sort_keys=True).encode()).hexdigest()[:32].encode()

    @contextmanager
    def locked(self, label: str = "journal", file: Path | None = None) -> Iterator[None]:
        """Lock the journal for this run, and so keep other runs off the file that it serves.

        The lock is on the journal's file, so the operating system releases it when this process ends. There is none
        on file systems without locks. If this object holds it already, nothing happens. An empty journal is removed.

        Arguments:
            label: option or argument that names the file.
            file: the file that the journal serves, for error messages; None for the journal itself.

        Raises:
            InputError: another run holds the lock, or the journal cannot be written.
        """
        if self._descriptor is not None:  # by the caller, through this object
            yield
            return
        named = str(file or self.path)
        if bounded.exists(self.path) and not bounded.is_file(self.path):
            raise InputError(label, str(self.path), "a file", "is none")
        try:
            self._descriptor = self._open_locked()
        except (OSError, ValueError) as error:
            accepted, reason = "a file in a folder that can be written to", getattr(error, "strerror", None) or error
            raise InputError(label, named, accepted, f"cannot be kept ({reason})") from None
        if self._descriptor is None:
            accepted = "a file of its own for each run, or this one when that has ended"
            raise InputError(label, named, accepted, "is being written by another run")
        try:
            yield
        finally:
            if self.path.is_file() and self.path.stat().st_size == 0:
                self.path.unlink(missing_ok=True)
            os.close(self._descriptor)
            self._descriptor = None

    def _open_locked(self) -> int | None:
        """The journal's file, open and locked; None if it is locked by another run."""
        from filelock import lock_descriptor  # slow import

        while True:
            opened = os.open(self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_NONBLOCK", 0), 0o666)
            try:
                with suppress(OSError):  # a file system without locks
                    if not lock_descriptor(opened, blocking=False):
                        os.close(opened)
                        return None
                if self.path.exists() and os.path.samestat(os.fstat(opened), self.path.stat()):
                    return opened
            except BaseException:
                os.close(opened)
                raise
            os.close(opened)  # another run removed the file between opening and locking

    def read(self) -> list[tuple[np.ndarray, Block]]:
        return [_block(record) for record in self._of_this_request() if "columns" in record]

    def chunks(self) -> list[int]:
        """The finished chunks of this request whose results are stored elsewhere."""
        return [record["chunk"] for record in self._of_this_request() if "chunk" in record]

    def count(self) -> int:
        """Number of finished collisions of this request."""
        return sum(map(_collisions, self._of_this_request()))

    def _of_this_request(self) -> Iterator[dict[str, Any]]:
        return (record for key, record in self._records() if key == self.key and record is not None)

    def others(self) -> tuple[int, int]:
        """Content that is not this request's: number of collisions of others, number of lines that are no blocks."""
        strange = [record for key, record in self._records() if key != self.key]
        return sum(map(_collisions, filter(None, strange))), strange.count(None)

    def _records(self) -> Iterator[tuple[bytes, dict[str, Any] | None]]:
        """Key and content of every line; the content is None for an incomplete line."""
        if not self.path.is_file():
            return
        with self.path.open("rb") as file:
            for line in file:
                key, checksum, text = (*line.rstrip(b"\n").split(b" ", 2), b"", b"")[:3]
                if line.strip():
                    yield key, json.loads(text) if text and checksum == _checksum(text) else None

    def add(self, where: np.ndarray, block: Block) -> None:
        """Append a block in a single write."""
        columns = {name: values.tolist() for name, values in block.items()}
        self._append({"where": where.tolist(), "columns": columns})

    def note(self, chunk: int, collisions: int) -> None:
        """Append a chunk whose results have been stored elsewhere."""
        self._append({"chunk": chunk, "collisions": collisions})

    def _append(self, record: Mapping[str, Any]) -> None:
        text = json.dumps(record).encode()
        try:
            with self.path.open("ab", buffering=0) as file:
                # starts with a newline in case the last line is incomplete
                write_all(file.fileno(), b"\n%s %s %s\n" % (self.key, _checksum(text), text))
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(self.path)) from error

    def remove(self) -> None:
        """Remove the blocks of this request, and the file unless it holds blocks of another request."""
        if not self.path.is_file():
            return
        lines = self.path.read_bytes().split(b"\n")
        others = [line for line in lines if line and not line.startswith(self.key + b" ")]
        if others:
            write(self.path, b"\n".join(others) + b"\n")
        else:
            self.path.unlink(missing_ok=True)


def _collisions(record: Mapping[str, Any]) -> int:
    return int(record["collisions"]) if "chunk" in record else len(record["where"])


def _checksum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def _block(record: Mapping[str, Any]) -> tuple[np.ndarray, Block]:
    kinds: dict[str, Any] = {"outcome": np.int8, "certified": bool, "reason": object}
    columns = {name: np.array(values, dtype=kinds.get(name, float)) for name, values in record["columns"].items()}
    return np.array(record["where"], dtype=int), columns
