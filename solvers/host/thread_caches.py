"""Caches for several threads: `own_cache` with results per thread, `once` with results shared by all.

CasADi functions have internal work memory, and calls from Python release the interpreter's lock. Neither functions nor
their symbols may be used by two threads at a time, so objects that hold them are cached by `own_cache`. Immutable data
may be cached by `functools.lru_cache`, where at worst two threads compute the same; `once` avoids that too.
"""

import threading
from collections import deque
from collections.abc import Callable, Hashable
from contextlib import AbstractContextManager
from functools import lru_cache, update_wrapper, wraps
from typing import Any, Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
T = TypeVar("T")
_Workspace = dict[Any, Any]  # caches by decorated function
_FREE: deque[_Workspace] = deque()  # workspaces of ended threads, reused by new ones


class _Lease:
    """A workspace, held for the life of a thread."""

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


_OWN = _Own()


def own_cache(maxsize: int | None) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorate a function of hashable arguments: each thread caches its latest `maxsize` results."""

    def decorate(build: Callable[P, T]) -> Callable[P, T]:
        @wraps(build)
        def cached(*args: P.args, **kwargs: P.kwargs) -> T:
            caches = _OWN.lease.workspace
            if build not in caches:
                caches[build] = lru_cache(maxsize)(build)
            result: T = caches[build](*args, **kwargs)
            return result

        return cached

    return decorate


class Locks:
    """A lock for each key."""

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._of: dict[Hashable, AbstractContextManager[Any]] = {}

    def __call__(self, key: Hashable) -> AbstractContextManager[Any]:
        """The lock of a key."""
        with self._guard:
            return self._of.setdefault(key, threading.RLock())


class Once(Generic[P, T]):
    """A function whose results are shared by all threads; one computes a result while the others wait for it."""

    def __init__(self, build: Callable[P, T]) -> None:
        self.__wrapped__ = build
        self._kept: dict[Hashable, Any] = {}
        self._making = Locks()
        update_wrapper(self, build)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> T:
        key = (args, tuple(sorted(kwargs.items())))
        result = self._kept.get(key, self)  # `self` marks a missing entry, as a result may be None
        if result is self:
            with self._making(key):
                result = self._kept.get(key, self)
                if result is self:
                    result = self._kept[key] = self.__wrapped__(*args, **kwargs)
        return cast("T", result)

    def cache_clear(self) -> None:
        self._kept.clear()


def once(build: Callable[P, T]) -> Once[P, T]:
    """Decorate a function of hashable arguments: one thread computes a result while others wait for it.

    Calls with other arguments do not wait. Errors are not cached; the next caller tries again.
    """
    return Once(build)
