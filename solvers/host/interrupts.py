"""Common handling of Ctrl-C and SIGTERM: finished results are kept, unfinished ones are removed."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED, TERMINATED = 130, 143  # exit statuses, as a shell reports the signals


class Signals:
    """The signals received by the running command."""

    def __init__(self) -> None:
        self.pending = False
        self.terminated = False
        self.held = self.late = False

    @property
    def status(self) -> int:
        """Exit status of a command ended by a KeyboardInterrupt."""
        return TERMINATED if self.terminated else INTERRUPTED

    def __call__(self, number: int, _frame: Any) -> None:
        """Handle a signal; a second SIGTERM ends the process at once."""
        self.pending = True
        if number == signal.SIGTERM:
            self.terminated = True
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
        if self.held:
            self.late = True
            return
        # not a subclass: libraries interrupted in a computation raise KeyboardInterrupt itself again
        raise KeyboardInterrupt("terminated" if self.terminated else "")


_SIGNALS = Signals()


def check() -> None:
    """Raise an interrupt that a library has swallowed, as CasADi does during type conversion."""
    if _SIGNALS.pending:
        _SIGNALS.pending = False
        raise KeyboardInterrupt


@contextmanager
def held() -> Iterator[None]:
    """Delay KeyboardInterrupt to the end of the block, so that a process that is being started is not lost.

    Within another such block, and outside the main thread, it does nothing.
    """
    if threading.current_thread() is not threading.main_thread() or _SIGNALS.held:
        yield
        return
    _SIGNALS.held, _SIGNALS.late = True, False
    try:
        yield
    finally:
        _SIGNALS.held = False
    if _SIGNALS.late:
        raise KeyboardInterrupt("terminated" if _SIGNALS.terminated else "")


@contextmanager
def handled() -> Iterator[Signals]:
    """Turn SIGTERM into KeyboardInterrupt; no effect outside the main thread or if another handler is installed.

    An error that follows a signal is a KeyboardInterrupt as well: a library that is interrupted may report
    whatever it was doing as failed.
    """
    _SIGNALS.pending = _SIGNALS.terminated = False
    main = threading.current_thread() is threading.main_thread()
    usual = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    ours = {number: handler for number, handler in usual.items() if main and signal.getsignal(number) == handler}
    for number in ours:
        signal.signal(number, _SIGNALS)
    try:
        yield _SIGNALS
    except Exception as error:
        if _SIGNALS.pending:
            raise KeyboardInterrupt from error
        raise
    finally:
        for number, handler in ours.items():
            signal.signal(number, handler)
        _SIGNALS.pending = False
