"""SIGTERM as an interrupt: what is finished is kept and what is begun is cleared away, as after Ctrl-C."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED, TERMINATED = 130, 143  # exit statuses, as a shell reports the signals


class Termination:
    """Whether SIGTERM has come."""

    def __init__(self) -> None:
        self.received = False

    @property
    def status(self) -> int:
        """Exit status of a command that a KeyboardInterrupt has ended."""
        return TERMINATED if self.received else INTERRUPTED

    def __call__(self, *_: Any) -> None:
        """Handle the signal; a second one ends the process at once."""
        self.received = True
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        # not a kind of its own: libraries that are interrupted amid a computation raise this one anew
        raise KeyboardInterrupt("terminated")


@contextmanager
def termination() -> Iterator[Termination]:
    """Turn SIGTERM into KeyboardInterrupt, unless this is no main thread or somebody handles it already."""
    handler = Termination()
    ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    if ours:
        signal.signal(signal.SIGTERM, handler)
    try:
        yield handler
    finally:
        if ours:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
