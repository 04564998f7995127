"""Remarks on standard error: one line each, for what a run does without and goes on.

They are no errors and no part of a result. Worker processes are hushed: the one that started them says what all of them
meet; what a single one has done it says itself.
"""

from __future__ import annotations

import contextlib
import os
import sys
from functools import cache

from ..errors import one_line

_HUSHED = "WETDOUBLET_HUSHED"


def say(line: str, only_here: bool = False) -> None:
    """Write a remark; where standard error cannot be written, there is none.

    Arguments:
        only_here: no other process has the same to say, so a worker says it too.
    """
    if (only_here or _HUSHED not in os.environ) and sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(f"{one_line(line)}\n")


@cache
def say_once(line: str) -> None:
    """Write a remark that this process has not written yet."""
    say(line)


def silence_workers() -> None:
    """For a worker process: its remarks are for the process that started it."""
    os.environ[_HUSHED] = "1"
