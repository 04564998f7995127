"""Worker processes, which ignore Ctrl-C and end with their parent, and the number of cores for them."""

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

from ..errors import ComputationError
from .remarks import silence_workers

K = TypeVar("K")
R = TypeVar("R")
_LOOK = 0.2  # s between checks for the parent
_PR_SET_PDEATHSIG = 1


def usable_cores() -> int:
    """Number of cores that this process may use, which may be less than the machine's."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def workers(count: int, env: Mapping[str, str] | None = None) -> Iterator[Any]:
    """A pool of `count` processes for the calling thread; they are killed if an exception leaves the context."""
    from loky import ProcessPoolExecutor  # starts workers without importing the caller's script

    pool = ProcessPoolExecutor(max_workers=count, initializer=_begin, initargs=(os.getpid(),), env=env)
    done = False
    try:
        yield pool
        done = True
    finally:
        # idle workers end by themselves; without psutil loky needs pgrep to kill them, and hangs where that is missing
        pool.shutdown(wait=True, kill_workers=not done)


def in_workers(cores: int, run: Callable[..., R], parts: Iterable[tuple[K, tuple[Any, ...]]]) -> Iterator[tuple[K, R]]:
    """Keys and results of `run`, in the order in which they finish; each worker receives only its part.

    Arguments:
        parts: a key and the arguments of `run` for each result.

    Raises:
        ComputationError: a worker died.
    """
    from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait

    waiting: dict[Future[R], K] = {}
    queue = iter(parts)
    try:
        with workers(cores) as pool:
            while True:
                with undisturbed():  # only this process handles an interrupt; it then stops its workers
                    for key, arguments in queue:
                        waiting[pool.submit(run, *arguments)] = key
                        if len(waiting) > 2 * cores:
                            break
                if not waiting:
                    return
                for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                    yield waiting.pop(future), future.result()
    except BrokenExecutor as error:
        raise ComputationError(
            f"a worker process died ({type(error).__name__})", advice="run it again; it may be out of memory"
        ) from None


@contextmanager
def undisturbed() -> Iterator[None]:
    """Block Ctrl-C and SIGTERM in this process and in the processes that it starts meanwhile."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(parent: int) -> None:
    """Initialise a worker: ignore interrupts, suppress remarks, end with the parent process, whose id is given."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    silence_workers()
    if sys.platform == "linux":  # immediate even in a long computation; sent when the starting *thread* ends
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    """End this process soon after its parent has ended for any reason."""
    while os.getppid() == parent:
        time.sleep(_LOOK)
    os._exit(1)
