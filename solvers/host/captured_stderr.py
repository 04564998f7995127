"""Capture, per thread, of the text that CasADi prints on stderr.

CasADi prints on `sys.stderr`, which all threads share. A temporary replacement stores the output of capturing threads
and passes the output of all others to the original stream. Threads may start and end capturing in any order.
"""

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
    """A stream that stores the output of capturing threads and passes on that of the others."""

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
    """Capture the text that this thread prints on `sys.stderr`."""
    global _listeners  # counted for the process, because sys.stderr is shared
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
