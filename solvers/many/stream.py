"""Requests computed chunk by chunk: here or on a cluster, into memory or into a Zarr store, and continued later."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import scaling
from ..engines.arithmetic import arithmetic
from .chunks import Chunks
from .cluster import Task, agreed, check_scheduler, computed, connected, one_at_a_time
from .journal import Journal, beside
from .results import Block
from .store import Store, check_store, opened

if TYPE_CHECKING:
    import xarray

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Scan:
    """A request as its chunks.

    Arguments:
        cut: chunks of its array of collisions.
        engine: of all of them.
        task: the computation of chunk k.
        dataset: chunk k and its results as a Dataset.
        blank: results of no meaning, for the layout of a store.
        fixed: coordinates that are known beforehand.
        identity: everything that the results depend on, as JSON values.
    """

    cut: Chunks
    engine: str
    task: Callable[[int], Task]
    dataset: Callable[[int, Block], xarray.Dataset]
    blank: Callable[[int], Block]
    fixed: Callable[[], xarray.Dataset]
    identity: Mapping[str, Any]


def check_places(client: object, store: object) -> Path | None:
    """Check the arguments `client` and `store`, either of which may be None; returns the store's path.

    Raises:
        InputError: one of them is not what it has to be.
    """
    if client is not None:
        check_scheduler(client, "client")
    return None if store is None else check_store(store, "store")


@contextmanager
def _blocks(scan: Scan, client: Any, label: str) -> Iterator[tuple[Mapping[str, str], Callable[..., Any]]]:
    """The arithmetic of a run, and a function that yields the chunks of a list with their results."""
    if client is None:
        yield arithmetic(), lambda todo: one_at_a_time(scan.task, todo)
        return
    with connected(client, label) as cluster:
        expected = agreed(cluster, scan.engine)
        yield expected, lambda todo: computed(cluster, scan.task, todo, expected)


def into_memory(
    scan: Scan,
    client: Any,
    done: np.ndarray,
    finished: Callable[[np.ndarray, Block], None],
    label: str = "client",
) -> None:
    """Compute what is missing on a cluster; `finished` is called with flat indices and results of each chunk.

    Arguments:
        done: mask of finished collisions, flat.
    """
    todo = [k for k in range(len(scan.cut)) if not done[scan.cut.flat(k)].all()]
    with _blocks(scan, client, label) as (_, blocks):
        for k, block in blocks(todo):
            finished(scan.cut.flat(k), block)


def into_store(
    scan: Scan,
    path: Path,
    client: Any = None,
    progress: Progress = lambda _done, _total: None,
    journal: Journal | None = None,
    label: str = "client",
) -> xarray.Dataset:
    """Compute a request into a Zarr store, continuing an interrupted run; returns the Dataset, its values on disk.

    Arguments:
        client: of a cluster; None for this process.
        progress: called with (collisions done, collisions in all) after every chunk.
        journal: of the store, if the caller has it.
    """
    kept = beside(path) if journal is None else journal
    with _blocks(scan, client, label) as (digits, blocks), kept.held("store", path):
        identity = {**scan.identity, "arithmetic": dict(digits)}
        store = Store(path, hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest(), scan.cut)
        fixed = scan.fixed()
        token = store.open(fixed, scan.dataset(0, scan.blank(0)))
        kept.under({**identity, "store": token})  # what another folder held is not in this one
        done, total = {k for k in kept.chunks() if store.holds(k)}, math.prod(scan.cut.shape)
        count = sum(math.prod(scan.cut.extent(k)) for k in done)
        progress(count, total)
        for k, block in blocks([k for k in range(len(scan.cut)) if k not in done]):
            store.write(k, scan.dataset(k, block), fixed)
            size = block["outcome"].size
            kept.note(k, size)
            count += size
            progress(count, total)
        store.finish()
        kept.remove()
    return opened(path)


def digest(values: np.ndarray) -> str:
    """Digest of an array, for the identity of a request."""
    text = "\0".join(map(str, values.tolist())).encode() if values.dtype.kind == "U" else values.tobytes()
    return hashlib.sha256(text).hexdigest()


def software() -> dict[str, str]:
    """Version and equations, for the identity of a request."""
    from importlib.metadata import version

    return {
        "version": version("wetdoublet"),
        "equations": Path(scaling.__file__).with_name("manifest.json").read_text(),
    }
