"""Ctrl-C and SIGTERM end a command alike: what is finished is kept and what is begun is cleared away."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED, TERMINATED = 130, 143  # exit statuses, as a shell reports the signals


class Signals:
    """What has come to the command that runs."""

    def __init__(self) -> None:
        self.pending = False
        self.terminated = False

    @property
    def status(self) -> int:
        """Exit status of a command that a KeyboardInterrupt has ended."""
        return TERMINATED if self.terminated else INTERRUPTED

    def __call__(self, number: int, _frame: Any) -> None:
        """Handle a signal; a second SIGTERM ends the process at once."""
        self.pending = True
        if number == signal.SIGTERM:
            self.terminated = True
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
        # not a kind of its own: libraries that are interrupted amid a computation raise this one anew
        raise KeyboardInterrupt("terminated" if self.terminated else "")


_SIGNALS = Signals()


def check() -> None:
    """Raise an interrupt that was swallowed, as by CasADi, which takes one amid a conversion of arguments for a no."""
    if _SIGNALS.pending:
        _SIGNALS.pending = False
        raise KeyboardInterrupt


@contextmanager
def handled() -> Iterator[Signals]:
    """Turn SIGTERM into KeyboardInterrupt, as Ctrl-C is one; not where this is no main thread or others handle them."""
    _SIGNALS.pending = _SIGNALS.terminated = False
    main = threading.current_thread() is threading.main_thread()
    usual = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    ours = {number: handler for number, handler in usual.items() if main and signal.getsignal(number) == handler}
    for number in ours:
        signal.signal(number, _SIGNALS)
    try:
        yield _SIGNALS
    finally:
        for number, handler in ours.items():
            signal.signal(number, handler)
        _SIGNALS.pending = False
