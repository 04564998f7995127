"""A store of what is derived: laws, structures and what they conserve, the same until the derivation changes.

The derivation has no files of its own. Whoever has a place for them opens the store, and answers for it that an entry
is of these sources and versions, unchanged, and from nobody else: entries are pickles. While it is closed, all is
derived.
"""

import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar, cast

T = TypeVar("T")
Fetch = Callable[[str, Callable[[], bytes]], bytes]
"""The content of an entry by its name, made by the function if there is none."""
_PLACES: list[Fetch] = []


@contextmanager
def opened(place: Fetch) -> Iterator[None]:
    """The store is open, with its entries in this place."""
    _PLACES.append(place)
    try:
        yield
    finally:
        _PLACES.remove(place)


def stored(name: str, make: Callable[[], T]) -> T:
    """What `make` returns, from the store if that is open."""
    if not _PLACES:
        return make()
    results: list[T] = []

    def content() -> bytes:
        results.append(make())
        return pickle.dumps(results[0])

    entry = _PLACES[-1](name, content)
    if results:
        return results[0]
    try:
        return cast("T", pickle.loads(entry))
    except Exception:  # noqa: BLE001 # whatever foreign bytes make of it; they are not of this derivation
        return make()
