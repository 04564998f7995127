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


class _Capture(threading.local):
    text: io.StringIO | None = None


_CAPTURE = _Capture()
_LOCK = threading.Lock()
_capturing = 0


class _PerThreadStream:
    """A stream that stores the output of capturing threads and passes on that of the others."""

    def __init__(self, original: Any) -> None:
        self.original = original

    def write(self, text: str) -> int:
        stream = _CAPTURE.text or self.original
        written: int = stream.write(text)
        return written

    def __getattr__(self, name: str) -> Any:
        return getattr(self.original, name)


@contextlib.contextmanager
def captured_stderr() -> Iterator[io.StringIO]:
    """Capture the text that this thread prints on `sys.stderr`."""
    global _capturing  # counted for the process, because sys.stderr is shared
    before, text = _CAPTURE.text, io.StringIO()
    with _LOCK:
        _capturing += 1
        if not isinstance(sys.stderr, _PerThreadStream):
            sys.stderr = _PerThreadStream(sys.stderr)
    _CAPTURE.text = text
    try:
        yield text
    finally:
        _CAPTURE.text = before
        with _LOCK:
            _capturing -= 1
            if not _capturing and isinstance(sys.stderr, _PerThreadStream):
                sys.stderr = sys.stderr.original
