"""Computation of scans: here or on a cluster, into memory or chunk by chunk into a Zarr store, resumable."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.arithmetic import arithmetic
from ..host.cores import usable_cores
from ..host.interrupts import check
from ..host.progress import Progress
from .cluster import Task, agreed, check_scheduler, computed, connected
from .columns import validity
from .compute import Slow, complete
from .journal import Journal, beside
from .results import VALIDITY, Block, empty, fill
from .scan import Place, Scan
from .store import Store, check_store, opened

if TYPE_CHECKING:
    import xarray

_Blocks = Callable[[list[int]], Iterator[tuple[int, Block]]]
_NUMBERS = 1 << 19  # in the request of a chunk, 4 MB; Dask warns of much more
LARGEST = 65536  # collisions in a chunk: some 0.1 s by the kernel, some 10 MB
_SHARES = 64  # chunks of a smaller request, for as many workers
_LEAST = {"taylor": 2048}  # collisions in a chunk that outweigh sending it
_LEAST_SLOW = 64


def check_places(client: object, store: object) -> Path | None:
    """Check the arguments `client` and `store`, either of which may be None; returns the store's path."""
    if client is not None:
        check_scheduler(client, "client")
    return None if store is None else check_store(store, "store")


def _computed_part(part: Scan, cores: int) -> Block:
    """Results of a part of a scan, computed here or by a worker, which gets the columns of the scan."""
    request = replace(part.batch(), partial=True)
    results = empty(request.size, request.of)
    complete(request, results, cores=cores)
    return results


@contextmanager
def _chunkwise(scan: Scan, client: Any, cut: list[Place]) -> Iterator[tuple[Mapping[str, str], _Blocks]]:
    """The arithmetic of a run, and a function that yields the chunks of a list with their results."""

    def task(k: int) -> Task:
        return partial(_computed_part, scan.part(cut[k]))

    def one_at_a_time(todo: list[int]) -> Iterator[tuple[int, Block]]:
        for k in todo:
            check()
            yield k, task(k)(usable_cores())

    if client is None:
        yield arithmetic(), one_at_a_time
        return
    with connected(client) as cluster:
        expected = agreed(cluster, "taylor" if "taylor" in scan.engines.values() else "")
        yield expected, lambda todo: computed(cluster, task, todo, expected)


def chunks(shape: tuple[int, ...], engine: str, most: int = LARGEST) -> list[tuple[slice, ...]]:
    """Where the chunks of a request of this shape lie: of equal extent along all dimensions, as far as these reach.

    Those at the far ends are smaller; the last dimension varies fastest. Neither the number of cores or workers nor
    what an earlier run has finished moves them: a chunk holds the same collisions wherever and whenever it is computed.

    Arguments:
        most: collisions in a chunk.
    """
    left = min(max(math.prod(shape) // _SHARES, _LEAST.get(engine, _LEAST_SLOW)), most)
    block = [1] * len(shape)
    by_length = sorted(range(len(shape)), key=lambda axis: shape[axis])
    for place, axis in enumerate(by_length):  # what a short dimension cannot take falls to the longer ones
        share = math.floor(left ** (1 / (len(shape) - place)) + 1e-9)
        block[axis] = max(1, min(shape[axis], share))
        left //= block[axis]
    corners = np.ndindex(*(-(-size // length) for size, length in zip(shape, block, strict=True)))
    return [
        tuple(slice(i * length, min((i + 1) * length, size)) for i, length, size in zip(corner, block, shape))
        for corner in corners
    ]


def _cut(scan: Scan) -> list[Place]:
    """The chunks of a scan, each small enough to be sent."""
    numbers = sum(3 if values.dtype.kind == "U" else 1 for _, values in scan.columns.values())
    return chunks(scan.shape, next(iter(scan.engines.values()), "rosenbrock"), min(LARGEST, _NUMBERS // numbers))


def into_memory(
    scan: Scan,
    client: Any = None,
    kept: Journal | None = None,
    progress: Progress | None = None,
    slow: Slow | None = None,
) -> xarray.Dataset:
    """Compute a scan here or on a cluster, continuing what a journal holds.

    Arguments:
        progress: called with (collisions done, collisions in all) at the start and after every block.
        slow: called with the number of collisions left to slower engines, once the kernel has done all others.
    """
    request = scan.batch()
    results = empty(scan.size, scan.of)
    done = np.zeros(scan.size, bool)

    def finished(where: np.ndarray, block: Block) -> None:
        done[where] = True
        fill(results, where, block)
        if progress is not None:
            progress(int(np.count_nonzero(done)), scan.size)

    def keep(where: np.ndarray, block: Block) -> None:
        if kept is not None:
            kept.add(where, {name: values for name, values in block.items() if name != VALIDITY})
        finished(where, block)

    for where, block in kept.read() if kept else ():
        done[where] = True
        fill(results, where, block)
    finished(np.zeros(0, int), {})
    if client is None:
        order = scan.order()
        complete(request, results, order[~done[order]], keep, slow)
    else:
        cut, flat = _cut(scan), np.arange(scan.size).reshape(scan.shape)
        with _chunkwise(scan, client, cut) as (_, blocks):
            for k, block in blocks([k for k in range(len(cut)) if not done[flat[cut[k]]].all()]):
                keep(flat[cut[k]].ravel(), block)
        if kept is not None and VALIDITY in scan.of:
            results[VALIDITY] = validity(request, results)
    return scan.dataset(results, request)


def into_store(
    scan: Scan, path: Path, client: Any = None, progress: Progress | None = None, journal: Journal | None = None
) -> xarray.Dataset:
    """Compute a scan into a Zarr store, continuing an interrupted run; returns the Dataset, its values on disk.

    Arguments:
        client: of a cluster; None for this process.
        progress: called with (collisions done, collisions in all) after every chunk.
        journal: of the store, if the caller has it.
    """
    kept, cut = journal or beside(path), _cut(scan)
    sizes = [math.prod(one.stop - one.start for one in at) for at in cut]
    with _chunkwise(scan, client, cut) as (digits, blocks), kept.locked("store", path):
        identity = {**scan.identity(), "arithmetic": dict(digits)}
        store = Store(path, hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest())
        token = store.open(scan, scan.part(cut[0]).dataset(empty(sizes[0], scan.of)))
        kept.set_request({**identity, "store": token})  # what another folder held is not in this one
        done = {k for k in kept.chunks() if store.holds(cut[k])}

        def report() -> None:
            if progress is not None:
                progress(sum(sizes[k] for k in done), scan.size)

        report()
        for k, block in blocks([k for k in range(len(cut)) if k not in done]):
            store.write(cut[k], scan.part(cut[k]).dataset(block))
            kept.note(k, sizes[k])
            done.add(k)
            report()
        store.finish()
        kept.remove()
    return opened(path)
