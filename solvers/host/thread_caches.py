"""Caches for any number of threads: what each thread has for itself, and what is built once for all of them.

CasADi's functions work in memory of their own, and calls from Python release the interpreter's lock: neither they nor
the symbols that they are built from may be in two threads at a time. Whatever holds one is kept by `own_cache`.
Numbers, texts and tables, which nothing changes, may be kept by `functools.lru_cache`, where two threads at worst
compute the same; what must not be done twice, by `once`.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Hashable
from contextlib import AbstractContextManager
from functools import lru_cache, update_wrapper
from typing import Any, Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
T = TypeVar("T")
_Workspace = dict[Any, Any]  # caches, by what they are of
_FREE: deque[_Workspace] = deque()  # of threads that have ended: for the next ones, which then need not build anew


class _Lease:
    """A workspace, for as long as a thread lives."""

    def __init__(self, free: deque[_Workspace]) -> None:
        self._free = free
        try:
            self.workspace = free.pop()
        except IndexError:
            self.workspace = {}

    def __del__(self) -> None:
        self._free.append(self.workspace)


class _Own(threading.local):
    def __init__(self) -> None:
        self.lease = _Lease(_FREE)
        self.workspace = self.lease.workspace


_OWN = _Own()


class OwnCache(Generic[P, T]):
    """A function with a cache in every thread: what it returns is the thread's own."""

    def __init__(self, build: Callable[P, T], maxsize: int | None) -> None:
        self.__wrapped__, self._maxsize = build, maxsize
        update_wrapper(self, build)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> T:
        found: T = self._here()(*args, **kwargs)
        return found

    def cache_clear(self) -> None:
        """Forget what this thread has."""
        self._here().cache_clear()

    def cache_info(self) -> Any:
        """How often this thread has been given what it had, and how often it was built."""
        return self._here().cache_info()

    def _here(self) -> Any:
        workspace = _OWN.workspace
        try:
            return workspace[self]
        except KeyError:
            return workspace.setdefault(self, lru_cache(self._maxsize)(self.__wrapped__))


def own_cache(maxsize: int | None) -> Callable[[Callable[P, T]], OwnCache[P, T]]:
    """Decorate a function of hashable arguments: each thread keeps what it returns, the latest `maxsize` of them."""
    return lambda build: OwnCache(build, maxsize)


class Locks:
    """A lock for each of any keys."""

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._of: dict[Hashable, AbstractContextManager[Any]] = {}

    def __call__(self, key: Hashable) -> AbstractContextManager[Any]:
        """The one of a key."""
        with self._guard:
            return self._of.setdefault(key, threading.RLock())


class Once(Generic[P, T]):
    """A function whose results are kept for all threads, each made by one of them while others wait for it."""

    def __init__(self, build: Callable[P, T]) -> None:
        self.__wrapped__ = build
        self._kept: dict[Hashable, Any] = {}
        self._making = Locks()
        update_wrapper(self, build)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> T:
        key = (args, tuple(sorted(kwargs.items())))
        found = self._kept.get(key, self)  # `self` marks a missing entry: a result may be None
        if found is self:
            with self._making(key):
                found = self._kept.get(key, self)
                if found is self:
                    found = self._kept[key] = self.__wrapped__(*args, **kwargs)
        return cast("T", found)

    def cache_clear(self) -> None:
        """Forget all results: the next caller makes them again."""
        self._kept.clear()


def once(build: Callable[P, T]) -> Once[P, T]:
    """Decorate a function of hashable arguments: its result is kept, and made by one thread while others wait for it.

    Other arguments do not wait. An error is not kept: the next caller tries again.
    """
    return Once(build)
