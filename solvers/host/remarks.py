"""Remarks on standard error, one line each, about resources that are missing but not necessary.

They are neither errors nor part of a result. Worker processes are silent, because the parent reports what concerns all;
a worker reports only what concerns it alone.
"""

import contextlib
import os
import sys
import threading
from collections.abc import Iterator
from functools import cache

from ..errors import one_line

_HUSHED = "WETDOUBLET_HUSHED"

underway: list[str] = []
"""What `say_after` waits for at present."""


def say(line: str, only_here: bool = False) -> None:
    """Write a remark; ignored if standard error cannot be written.

    Arguments:
        only_here: the remark concerns this process alone, so a worker writes it too.
    """
    if (only_here or _HUSHED not in os.environ) and sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(f"{one_line(line)}\n")


@contextlib.contextmanager
def say_after(seconds: float, line: str) -> Iterator[None]:
    """Write a remark on a terminal, once in a process, if what is done here takes longer than that."""

    def remark() -> None:
        if sys.stderr is not None and sys.stderr.isatty():
            say_once(line)

    timer = threading.Timer(seconds, remark)
    timer.daemon = True  # an interrupt is not held up by it
    timer.start()
    underway.append(line)
    try:
        yield
    finally:
        underway.remove(line)
        timer.cancel()


@cache
def say_once(line: str) -> None:
    """Write a remark unless this process has already written it."""
    say(line)


def silence_workers() -> None:
    """Suppress the remarks of this worker process."""
    os.environ[_HUSHED] = "1"
