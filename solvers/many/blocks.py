"""A map in blocks: computed here or on a Dask cluster, in memory or by region in a Zarr store that xarray writes.

What is finished survives: of a store all blocks that were written, whatever ends the run; in memory what an interrupt
finds, in a file that the same call reads. The same call computes what is missing.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import math
import os
import re
import shutil
import signal
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np

from ..engines.arithmetic import arithmetic, difference, has_kernel
from ..errors import ComputationError, InputError, install_extra
from ..host import bounded
from ..host.files import check_file, write
from ..host.interrupts import check, held
from ..host.progress import Progress
from ..host.remarks import say, silence_workers
from ..host.workers import undisturbed, usable_cores
from .compute import complete
from .impacts import Block, Impacts, Place, empty, fill

if TYPE_CHECKING:
    import xarray
    from distributed import Client

SUFFIX = ".zarr"
ACCEPTED = "tcp://HOST:PORT of a running Dask scheduler, the .json file that it wrote, local, or local:WORKERS"
_ADDRESS = re.compile(r"(tcp|tls|ucx|ws|wss)://[^\s/]+:[0-9]+")
_LOCAL = re.compile(r"local(:[1-9][0-9]{0,3})?", re.ASCII)
_HERE: dict[str, Any] = {
    "host": "127.0.0.1",
    "dashboard_address": "127.0.0.1:0",  # None would take Dask's usual port, with a warning where that is in use
    "scheduler_kwargs": {"dashboard": False},
    "memory_limit": 0,
    "preload": [__name__],
}
_LARGEST_FILE = 1 << 24  # bytes of a scheduler's file, which lists its workers, or of a store's description
LARGEST = 65536  # collisions in a block: some 0.1 s by the kernel, some 10 MB
_SHARES = 64  # blocks of a smaller map, for as many workers
_LEAST = {"taylor": 2048}  # collisions in a block that outweigh sending it
_LEAST_SLOW = 64
_MISSING = -2  # outcome of what is not computed

Task = Callable[[int], Block]
"""A block's computation, given the number of cores that it may use; a worker receives it pickled."""
_Blocks = Callable[[Sequence[int]], Iterator[tuple[int, Block]]]


def blocks(shape: tuple[int, ...], engine: str) -> list[Place]:
    """Where the blocks of a map lie: of equal extent along all dimensions, as far as these reach.

    Those at the far ends are smaller; the last dimension varies fastest. Neither the number of cores or workers nor
    what an earlier run has finished moves them: a block holds the same collisions wherever and whenever it is computed.
    """
    room = min(max(math.prod(shape) // _SHARES, _LEAST.get(engine, _LEAST_SLOW)), LARGEST)
    block = [1] * len(shape)
    by_length = sorted(range(len(shape)), key=lambda axis: shape[axis])
    for place, axis in enumerate(by_length):  # what a short dimension cannot take falls to the longer ones
        share = math.floor(room ** (1 / (len(shape) - place)) + 1e-9)
        block[axis] = max(1, min(shape[axis], share))
        room //= block[axis]
    corners = np.ndindex(*(-(-size // length) for size, length in zip(shape, block, strict=True)))
    return [
        tuple(slice(i * length, min((i + 1) * length, size)) for i, length, size in zip(corner, block, shape))
        for corner in corners
    ]


def _computed(impacts: Impacts, cores: int) -> Block:
    """Results of a block, computed here or by a worker."""
    results = empty(impacts.size, impacts.of)
    complete(impacts, results, cores=cores)
    return results


@contextmanager
def _computing(impacts: Impacts, client: Any, cut: Sequence[Place]) -> Iterator[tuple[Mapping[str, str], _Blocks]]:
    """The arithmetic of a run, and a function that yields the blocks of a list with their results."""

    def task(k: int) -> Task:
        return partial(_computed, impacts.block(cut[k]))

    def one_at_a_time(todo: Sequence[int]) -> Iterator[tuple[int, Block]]:
        for k in todo:
            check()
            yield k, task(k)(usable_cores())

    if client is None:
        yield arithmetic(), one_at_a_time
        return
    with connected(client) as cluster:
        expected = _agreed(cluster, impacts.engine == "taylor")
        yield expected, lambda todo: _distributed(cluster, task, todo, expected)


def into_memory(
    impacts: Impacts, client: Any = None, progress: Progress | None = None, resume: Path | None = None
) -> xarray.Dataset:
    """Compute impacts here or on a cluster.

    Arguments:
        progress: called with (collisions done, collisions in all) at the start and after every block.
        resume: as of `checkpoint`.
    """
    results, done = empty(impacts.size, impacts.of), np.zeros(impacts.size, bool)

    def finished(where: np.ndarray, block: Block) -> None:
        fill(results, where, block)
        done[where] = True
        if progress is not None:
            progress(int(np.count_nonzero(done)), impacts.size)

    with checkpoint(resume, impacts.identity, results, done, "collisions"):
        finished(np.zeros(0, int), {})
        if client is None:
            order = impacts.order()
            complete(impacts, results, np.asarray(order)[~done[order]] if done.any() else order, finished)
        else:
            cut, flat = blocks(impacts.shape, impacts.engine), np.arange(impacts.size).reshape(impacts.shape)
            with _computing(impacts, client, cut) as (_, computed):
                for k, block in computed([k for k in range(len(cut)) if not done[flat[cut[k]]].all()]):
                    finished(flat[cut[k]].ravel(), block)
    return impacts.dataset(results)


def into_store(impacts: Impacts, path: Path, client: Any = None, progress: Progress | None = None) -> xarray.Dataset:
    """Compute impacts into a Zarr store that appears when it is complete; returns its Dataset, with values on disk.

    Arguments:
        client: of a cluster; None for this process.
        progress: called with (collisions done, collisions in all) at the start and after every block.
    """
    cut = blocks(impacts.shape, impacts.engine)
    sizes = [math.prod(span.stop - span.start for span in at) for at in cut]
    with _computing(impacts, client, cut) as (digits, computed):
        key = _digest({**impacts.identity(), "arithmetic": dict(digits)})
        target = Path(os.path.realpath(path))
        place = target.with_name(f"{target.name}.{key[:12]}.unfinished")
        done = _written(place, cut)
        if done is None:
            done = set()
            _lay_out(place, impacts, impacts.block(cut[0]).dataset(empty(sizes[0], impacts.of)))

        def report() -> None:
            if progress is not None:
                progress(sum(sizes[k] for k in done), impacts.size)

        report()
        for k, block in computed([k for k in range(len(cut)) if k not in done]):
            _write(place, dict(zip(map(str, impacts.dims), cut[k])), impacts.block(cut[k]).dataset(block))
            done.add(k)
            report()
    former = place.with_suffix(".former")
    shutil.rmtree(former, ignore_errors=True)  # of a run that ended between the renames below
    if target.exists():
        target.rename(former)
    place.rename(target)
    shutil.rmtree(former, ignore_errors=True)
    return _opened(target)


# ---- what is finished


def check_store(path: object, label: str) -> Path:
    """Return the path of a Zarr store to write; InputError naming `label` if it cannot be, or is something else's."""
    file = check_file(path, label, (SUFFIX,), replaced=True, folder=True)
    try:
        attributes = json.loads(bounded.read(file / "zarr.json", _LARGEST_FILE, label, ACCEPTED))["attributes"]
        ours = {"scene", "rtol", "engine"} <= {*attributes}
    except (ValueError, KeyError, TypeError):  # an InputError too
        ours = False
    if bounded.exists(file) and not ours:
        accepted = f"a name ending in {SUFFIX} that is free, or that of a map written here before"
        raise InputError(label, str(file), accepted, "exists and is no map of wetdoublet: it is not overwritten")
    return file


def _opened(path: Path) -> xarray.Dataset:
    import xarray as xr

    return xr.open_dataset(path, engine="zarr", chunks=None, consolidated=True)


def _written(place: Path, cut: Sequence[Place]) -> set[int] | None:
    """The blocks that an unfinished store has; None if none was begun."""
    _codecs()
    try:
        outcome = _opened(place)["outcome"]
    except (FileNotFoundError, ValueError, KeyError):  # consolidated metadata are written last
        shutil.rmtree(place, ignore_errors=True)
        return None
    done = set()
    for k, at in enumerate(cut):
        with suppress(ValueError, RuntimeError):  # of the checksum, or of the decompression before it
            if (outcome[at].values != _MISSING).all():
                done.add(k)
    return done


@held()  # Zarr's tasks, interrupted, would write tracebacks later
def _lay_out(place: Path, impacts: Impacts, first: xarray.Dataset) -> None:
    """Write the axes and the descriptions of all variables, whose values come by block; `first` is of one block."""
    import dask.array as da
    import xarray as xr

    sizes = dict(zip(impacts.dims, impacts.shape, strict=True))
    axes = {dim: axis for dim, (_, axis) in zip(impacts.dims, impacts.columns.values(), strict=True)}
    variables = {}
    encoding: dict[str, Any] = {"outcome": {"fill_value": _MISSING}}
    for name, variable in _encoded(first).variables.items():
        shape, extent = tuple(sizes[dim] for dim in variable.dims), variable.shape
        values = axes[name] if name in axes else da.zeros(shape, dtype=variable.dtype, chunks=extent)
        variables[name] = variable.dims, values, variable.attrs
        # reading a damaged chunk fails
        encoding.setdefault(str(name), {})["compressors"] = (_codecs().ZstdCodec(), _codecs().Crc32cCodec())
    data = xr.Dataset(variables, attrs=first.attrs).set_coords([*first.coords])
    with _unwarned():
        data.to_zarr(place, mode="w", compute=False, zarr_format=3, consolidated=True, encoding=encoding)


@held()
def _write(place: Path, region: Mapping[str, slice], block: xarray.Dataset) -> None:
    """Write a block, its outcomes after all else: where they are, the block is complete."""
    data = _encoded(block).drop_vars([*region])
    with _unwarned():
        data.drop_vars("outcome").to_zarr(place, region=dict(region))
        data[["outcome"]].drop_vars([*data.coords]).to_zarr(place, region=dict(region))


def _encoded(data: xarray.Dataset) -> xarray.Dataset:
    """The Dataset with its text as Zarr holds it: of no fixed length."""
    return data.assign(reason=data["reason"].astype(np.dtypes.StringDType()))


def _codecs() -> Any:
    """Zarr's codecs, where Zarr and Dask are installed."""
    try:
        import_module("dask.array")
        return import_module("zarr.codecs")
    except ImportError:
        raise ComputationError(f"writing {SUFFIX} needs zarr and dask", advice=install_extra("cluster")) from None


@contextmanager
def _unwarned() -> Iterator[None]:
    """Ignore what Zarr says of text and consolidated metadata in its format 3: xarray reads both."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@contextmanager
def checkpoint(
    resume: Path | None, identity: Callable[[], Mapping[str, Any]], columns: Block, done: np.ndarray, unit: str
) -> Iterator[None]:
    """Keep what an interrupt finds finished: in RESUME.KEY.partial, which is read here by the same request.

    Arguments:
        resume: the file that is being made; None keeps nothing.
        identity: everything that the results depend on, as JSON values.
        columns, done: results and which of them are finished: filled from the file if there is one, and by the block.
        unit: what is counted.
    """
    if resume is None:
        yield
        return
    file = resume.with_name(f"{resume.name}.{_digest(identity())[:12]}.partial")
    with suppress(OSError, ValueError, KeyError, EOFError, BadZipFile):  # there is none, or it is damaged
        arrays = dict(np.load(io.BytesIO(file.read_bytes()), allow_pickle=False))
        where = np.flatnonzero(arrays[".done"])
        fill(columns, where, {name: arrays[name][where] for name in columns})
        done[where] = True
    try:
        yield
    except KeyboardInterrupt:
        if not (count := int(np.count_nonzero(done))):
            raise
        with held():
            content = io.BytesIO()
            plain: dict[str, Any] = {
                name: values.astype(str) if values.dtype.kind == "O" else values for name, values in columns.items()
            }
            np.savez_compressed(content, **plain | {".done": done})
            write(file, content.getbuffer())
        rest = f"{count} of {done.size} {unit} are kept in {file}; the same command computes the rest"
        raise KeyboardInterrupt(f"interrupted: {rest}") from None
    file.unlink(missing_ok=True)


def _digest(request: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(request, sort_keys=True).encode()).hexdigest()


# ---- on a Dask cluster


def check_scheduler(scheduler: object, label: str) -> Any:
    """Return a client, or the text that names a scheduler; InputError for anything else."""
    if isinstance(scheduler, str):
        if scheduler.endswith(".json"):
            if not bounded.exists(scheduler):  # Dask would wait for it
                raise InputError(label, scheduler, ACCEPTED, "is a file that does not exist")
            if not _names_an_address(scheduler):
                raise InputError(label, scheduler, ACCEPTED, "is not the file of a scheduler")
        if _LOCAL.fullmatch(scheduler) or _ADDRESS.fullmatch(scheduler) or scheduler.endswith(".json"):
            return scheduler
        raise InputError(label, scheduler, ACCEPTED, "is no address of a scheduler")
    if not all(hasattr(scheduler, name) for name in ("submit", "nthreads", "scheduler_info")):
        raise InputError(label, scheduler, f"a dask.distributed.Client, or as text {ACCEPTED}", "is no client")
    if getattr(scheduler, "status", "") == "closed":
        raise InputError(label, scheduler, "a client that is open", "is closed")
    if getattr(scheduler, "asynchronous", False):
        raise InputError(label, scheduler, "a client that is not asynchronous", "is asynchronous")
    return scheduler


def _names_an_address(file: str) -> bool:
    try:
        content = json.loads(bounded.read(file, _LARGEST_FILE, "client", ACCEPTED))
    except ValueError:  # an InputError too
        return False
    return isinstance(content, dict) and isinstance(content.get("address"), str)


@contextmanager
def connected(scheduler: Any) -> Iterator[Client]:
    """A client of the scheduler; what is opened or started for it is closed at the end.

    Arguments:
        scheduler: a client, which stays open; an address; a scheduler's file; `local` or `local:N` for N processes on
            this machine, by default one for each core.

    Raises:
        InputError: it is no scheduler, or is not reachable.
        ComputationError: dask.distributed is not installed.
    """
    checked = check_scheduler(scheduler, "client")
    if not isinstance(checked, str):
        yield checked
        return
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise ComputationError("client needs dask.distributed", advice=install_extra("cluster")) from None
    from multiprocessing.resource_tracker import ensure_running

    with ExitStack() as opened:
        opened.enter_context(_quiet())
        if _LOCAL.fullmatch(checked):
            count = int(checked.partition(":")[2] or usable_cores())
            ensure_running()  # which is started by the first worker else, and lets interrupts through again
            with undisturbed():
                try:
                    cluster = LocalCluster(
                        n_workers=count, threads_per_worker=1, silence_logs=logging.CRITICAL, **_HERE
                    )
                except RuntimeError as error:  # Dask's processes import the caller's script
                    raise ComputationError(
                        f"the local workers did not start ({' '.join(str(error).split())[:120]})",
                        advice='in a script, start them below `if __name__ == "__main__":`',
                    ) from None
            checked = opened.enter_context(cluster)
            with suppress(ImportError):  # other versions have it elsewhere
                from distributed.gc import disable_gc_diagnosis

                disable_gc_diagnosis()  # an interrupt during its callbacks would be lost
        try:
            file = isinstance(checked, str) and checked.endswith(".json")
            client = opened.enter_context(Client(scheduler_file=checked) if file else Client(checked))
        except (OSError, ValueError) as error:
            message = " ".join(str(error).split())
            raise InputError("client", scheduler, ACCEPTED, f"is not reachable ({message[:120]})") from None
        yield client


@contextmanager
def _quiet() -> Iterator[None]:
    """Silence Dask's log, which repeats on standard error what is reported in one line, or is not an error here."""
    logs = [logging.getLogger(name) for name in ("distributed", "distributed.client")]  # Dask gives each its own level
    before = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for log, level in zip(logs, before):
            log.setLevel(level)


def dask_setup(_worker: object) -> None:
    """Prepare a worker of a local cluster, which Dask lets preload this file.

    Only its parent handles an interrupt and writes remarks.
    """
    silence_workers()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})


def _agreed(client: Client, by_kernel: bool) -> Mapping[str, str]:
    """The arithmetic of all workers, of which there is one at least: another would compute other last digits."""
    waits = False
    while not (answers := client.run(arithmetic, on_error="return")):
        if not waits:
            say("the scheduler has no workers yet: waiting for one")
        waits = True
        client.wait_for_workers(1)
    workers = {address: answer for address, answer in answers.items() if isinstance(answer, dict)}
    if not workers:
        raise _translated(next(iter(answers.values())))
    address, chosen = min(workers.items())
    for answer in workers.values():
        if other := difference(answer, chosen):
            raise ComputationError(f"workers differ: beside {address} {other}", advice="use workers of one kind")
    if by_kernel and not has_kernel(chosen):
        raise ComputationError(
            "the workers have neither the kernel nor a C compiler", advice="install gcc or clang there"
        )
    return chosen


def _distributed(
    client: Client, task: Callable[[int], Task], todo: Sequence[int], expected: Mapping[str, str]
) -> Iterator[tuple[int, Block]]:
    """The blocks `todo` and their results, in the order in which they finish.

    What a lost worker had is computed by others. Few blocks are under way at once, so that memory stays bounded.
    """
    from distributed import as_completed

    waiting: dict[Any, int] = {}
    finished, rest = as_completed(), iter(todo)
    try:
        while True:
            most = 2 + 2 * sum(client.nthreads().values())
            while len(waiting) < most and (k := next(rest, None)) is not None:
                future = client.submit(_answered, task(k), dict(expected), pure=False)
                waiting[future] = k
                finished.add(future)
            if not waiting:
                return
            future = next(finished)
            check()
            yield waiting.pop(future), future.result()
    except Exception as error:
        raise _translated(error) from error
    finally:
        with suppress(Exception):  # the connection may be lost
            client.cancel([*waiting])


def _answered(task: Task, expected: Mapping[str, str]) -> Block:
    """A block's results, on a worker; one thread, as Dask runs several tasks side by side."""
    if why := difference(arithmetic(), expected):  # a worker that came later
        raise ComputationError(f"a worker would compute other digits: {why}", advice="use workers of one kind")
    return task(1)


def _translated(error: BaseException) -> BaseException:
    """The error in our words, where Dask or a worker's installation is the cause."""
    from asyncio import CancelledError
    from concurrent.futures import CancelledError as Cancelled

    from distributed import KilledWorker

    if isinstance(error, KilledWorker):
        return ComputationError("workers died of one block again and again", advice="they may be out of memory")
    if isinstance(error, ModuleNotFoundError):
        return ComputationError(
            f"a worker has no module {error.name}", advice="install the same version of wetdoublet where workers run"
        )
    if isinstance(error, (CancelledError, Cancelled, OSError)):  # of the connection: nothing here opens files
        message = f" ({' '.join(str(error).split())[:120]})" if isinstance(error, OSError) else ""
        return ComputationError(f"the connection to the scheduler is lost{message}", advice="the same call goes on")
    return error
