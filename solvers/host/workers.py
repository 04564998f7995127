"""Worker processes: started the same way everywhere, ignoring Ctrl-C, and ended with their parent."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from .remarks import silence_workers
from .user_cache import settle

_LOOK = 0.2  # s between two looks at whether the parent is there
_PR_SET_PDEATHSIG = 1
_LASTING = threading.Lock()  # of the pool that stays


@contextmanager
def workers(count: int, env: Mapping[str, str] | None = None) -> Iterator[Any]:
    """A pool of `count` processes for the calling thread; they are killed if it is left by an exception."""
    from loky import ProcessPoolExecutor  # starts workers without running the caller's script again

    settle()
    pool = ProcessPoolExecutor(max_workers=count, initializer=_begin, initargs=(os.getpid(), True), env=env)
    done = False
    try:
        yield pool
        done = True
    finally:
        # idle workers end by themselves; without psutil loky kills by pgrep, which slim systems lack, and never ends
        pool.shutdown(wait=True, kill_workers=not done)


@contextmanager
def lasting_workers(count: int) -> Iterator[Any]:
    """A pool that stays for the next caller; it is killed if it is left by an exception.

    There is one; while a thread has it, others have one each for the while.
    """
    if not _LASTING.acquire(blocking=False):
        with workers(count) as pool:
            yield pool
        return
    try:
        from loky import get_reusable_executor

        settle()
        pool = get_reusable_executor(max_workers=count, initializer=_begin, initargs=(os.getpid(), False))
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=True, kill_workers=True)
            raise
    finally:
        _LASTING.release()


@contextmanager
def undisturbed() -> Iterator[None]:
    """Hold Ctrl-C and SIGTERM back, also from the processes that are started meanwhile, until these have begun."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(parent: int, bound: bool) -> None:
    """In a worker: interrupts and remarks are for the process that started it, whose end is its own.

    Arguments:
        parent: process number of that process.
        bound: the thread that started it stays until it ends.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    silence_workers()
    if bound and sys.platform == "linux":  # at once, even amid a long computation; it comes when the *thread* ends
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    """End this process soon after its parent has ended, by whatever."""
    while os.getppid() == parent:
        time.sleep(_LOOK)
    os._exit(1)
