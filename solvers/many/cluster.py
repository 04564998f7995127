"""Chunks of a request on a Dask cluster: which scheduler, which workers may answer, and what becomes of lost ones."""

from __future__ import annotations

import json
import logging
import re
import signal
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engines.arithmetic import arithmetic, difference, has_kernel
from ..errors import ComputationError, InputError, install_extra
from ..host import bounded
from ..host.cores import usable_cores
from ..host.interrupts import check
from ..host.remarks import say, silence_workers
from ..host.workers import undisturbed
from .results import Block

if TYPE_CHECKING:
    from distributed import Client

Task = Callable[[int], Block]
"""A chunk's computation, given the number of cores that it may use; a worker receives it pickled."""

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
_LARGEST_FILE = 1 << 24  # bytes of a scheduler's file, which lists its workers
_REFUSALS = 3  # of one chunk, by workers of another arithmetic


@dataclass(frozen=True)
class Refused:
    """The answer of a worker that would compute other digits."""

    worker: str
    why: str


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
        content = json.loads(bounded.read(Path(file), _LARGEST_FILE))
    except (OSError, ValueError, bounded.NotRead):
        return False
    return isinstance(content, dict) and isinstance(content.get("address"), str)


@contextmanager
def connected(scheduler: Any, label: str = "client") -> Iterator[Client]:
    """A client of the scheduler; what is opened or started for it is closed at the end.

    Arguments:
        scheduler: a client, which stays open; an address; a scheduler's file; `local` or `local:N` for N processes on
            this machine, by default one for each core.
        label: argument or option that names the scheduler.

    Raises:
        InputError: it is no scheduler, or is not reachable.
        ComputationError: dask.distributed is not installed.
    """
    checked = check_scheduler(scheduler, label)
    if not isinstance(checked, str):
        yield checked
        return
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise ComputationError(f"{label} needs dask.distributed", advice=install_extra("cluster")) from None
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
            raise InputError(label, scheduler, ACCEPTED, f"is not reachable ({message[:120]})") from None
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


def agreed(client: Client, engine: str) -> Mapping[str, str]:
    """The arithmetic of a run: this process's if a worker has it, else the workers' if it is the same for all.

    Waits for a first worker.

    Raises:
        ComputationError: workers differ, or cannot provide the engine; says how.
    """
    waits = False
    while not (answers := client.run(arithmetic, on_error="return")):
        if not waits:
            say("the scheduler has no workers yet: waiting for one")
        waits = True
        client.wait_for_workers(1)
    workers = {address: answer for address, answer in answers.items() if isinstance(answer, dict)}
    if not workers:
        raise _translated(next(iter(answers.values())))
    ours = arithmetic()
    chosen = ours
    if ours not in workers.values():
        address, chosen = min(workers.items())
        for answer in workers.values():
            if other := difference(answer, chosen):
                raise ComputationError(
                    f"workers differ: beside {address} {other}", advice="use workers of one kind, as this process is"
                )
    if engine == "taylor" and not has_kernel(chosen):
        raise ComputationError(
            "the workers have no C compiler for the engine taylor", advice="install one there, or choose rosenbrock"
        )
    return chosen


def computed(
    client: Client, tasks: Callable[[int], Task], todo: Sequence[int], expected: Mapping[str, str]
) -> Iterator[tuple[int, Block]]:
    """The chunks `todo` and their results, in the order in which they finish.

    What a lost worker had is computed by others. Few chunks are under way at once, so that memory stays bounded.

    Arguments:
        expected: arithmetic of the workers that may answer.
    """
    from distributed import as_completed

    waiting: dict[Any, int] = {}
    refusals: Counter[int] = Counter()
    finished, left = as_completed(), iter(todo)

    def submit(k: int, **where: Any) -> None:
        future = client.submit(_answered, tasks(k), dict(expected), pure=False, **where)
        waiting[future] = k
        finished.add(future)

    try:
        while True:
            most = 2 + 2 * sum(client.nthreads().values())
            for k in left:
                submit(k)
                if len(waiting) >= most:
                    break
            if not waiting:
                return
            future = next(finished)
            check()
            k = waiting.pop(future)
            answer = future.result()
            if not isinstance(answer, Refused):
                yield k, answer
                continue
            refusals[k] += 1
            same = _matching(client, expected, answer, refusals[k])
            submit(k, workers=same, allow_other_workers=False)
    except Exception as error:
        raise _translated(error) from error
    finally:
        with suppress(Exception):  # the connection may be lost
            client.cancel([*waiting])


def _answered(task: Task, expected: Mapping[str, str]) -> Block | Refused:
    """A chunk's results, on a worker; one thread, as Dask runs several tasks side by side."""
    from distributed import get_worker

    if why := difference(arithmetic(), expected):
        return Refused(get_worker().address, why)
    return task(1)


def _matching(client: Client, expected: Mapping[str, str], refused: Refused, count: int) -> list[str]:
    """The workers that may answer; ComputationError if there are none."""
    answers = client.run(arithmetic, on_error="return")
    same = [address for address, answer in answers.items() if answer == dict(expected)]
    if not same or count > _REFUSALS:
        raise ComputationError(
            f"the worker {refused.worker} would compute other digits: {refused.why}",
            advice="use workers of one kind; what is finished is kept",
        )
    return same


def _translated(error: BaseException) -> BaseException:
    """The error in our words, where Dask or a worker's installation is the cause."""
    from asyncio import CancelledError
    from concurrent.futures import CancelledError as Cancelled

    from distributed import KilledWorker

    kept = "what is finished is kept"
    if isinstance(error, KilledWorker):
        return ComputationError(
            "workers died of one chunk again and again", advice=f"they may be out of memory; {kept}"
        )
    if isinstance(error, ModuleNotFoundError):
        return ComputationError(
            f"a worker has no module {error.name}", advice="install the same version of wetdoublet where workers run"
        )
    if isinstance(error, (CancelledError, Cancelled, OSError)):  # of the connection: nothing here opens files
        message = f" ({' '.join(str(error).split())[:120]})" if isinstance(error, OSError) else ""
        return ComputationError(f"the connection to the scheduler is lost{message}", advice=kept)
    return error
