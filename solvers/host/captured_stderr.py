"""What CasADi prints on stderr, kept from the user by the thread that causes it.

It prints by way of `sys.stderr`, which all threads share: what is put in its place for a while keeps the words of
threads that listen, and passes on those of the others. Threads may come and go in any order; left behind by one that
replaces `sys.stderr` itself, it only passes on.
"""

from __future__ import annotations

import contextlib
import io
import sys
import threading
from collections.abc import Iterator
from typing import Any


class _Heard(threading.local):
    text: io.StringIO | None = None


_HEARD = _Heard()
_COUNTING = threading.Lock()
_listeners = 0


class _Sieve:
    """A stream for threads that do not listen; what those say that do is kept."""

    def __init__(self, through: Any) -> None:
        self.through = through

    def write(self, text: str) -> int:
        stream = _HEARD.text
        found: int = (self.through if stream is None else stream).write(text)
        return found

    def __getattr__(self, name: str) -> Any:
        return getattr(self.through, name)


@contextlib.contextmanager
def listening() -> Iterator[io.StringIO]:
    """Keep what this thread prints on `sys.stderr`."""
    global _listeners  # of the process, as sys.stderr is
    before, heard = _HEARD.text, io.StringIO()
    with _COUNTING:
        _listeners += 1
        if not isinstance(sys.stderr, _Sieve):
            sys.stderr = _Sieve(sys.stderr)
    _HEARD.text = heard
    try:
        yield heard
    finally:
        _HEARD.text = before
        with _COUNTING:
            _listeners -= 1
            if not _listeners and isinstance(sys.stderr, _Sieve):
                sys.stderr = sys.stderr.through
