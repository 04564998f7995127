"""Work for later processes: in a process of its own at the lowest priority, one at a time for each cache.

It outlives this process, holds none of its pipes, and ends at a time limit. WETDOUBLET_BACKGROUND=off forbids it; so
does CI, a variable that systems for continuous integration set, unless WETDOUBLET_BACKGROUND=on.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import InputError
from .locks import take
from .remarks import is_silent, silence_workers
from .user_cache import lock_file

_SETTING = "WETDOUBLET_BACKGROUND"
_LONGEST = 600  # s; a derivation and a compilation take seconds, at this priority on a busy machine minutes
_NICEST = 19
_START = f"import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); from {__name__} import main; main()"


class TimeUp(Exception):
    """The time limit of a background process is reached."""


def allowed() -> bool:
    """True if work may be started that outlives this process.

    Raises:
        InputError: WETDOUBLET_BACKGROUND is neither on nor off.
    """
    said = os.environ.get(_SETTING, "")
    if said not in ("", "on", "off"):
        raise InputError(_SETTING, said, "on, off", "is not known")
    able = os.name == "posix" and not is_silent() and Path(sys.executable or "").name.startswith(("python", "pypy"))
    return able and said != "off" and (said == "on" or not os.environ.get("CI"))


def begin(work: Callable[[Any], object], argument: object) -> bool:
    """Start a process that calls a function of a module with a picklable argument; does not wait for it.

    Returns:
        False where that is not allowed or not possible, or where such a process runs already for this cache.
    """
    if not allowed() or not _is_free():
        return False
    try:
        with tempfile.TemporaryFile() as file:  # not a pipe, which could fill
            pickle.dump(sys.path, file)
            pickle.dump((work, argument), file)
            file.seek(0)
            process = subprocess.Popen(
                (sys.executable, "-P", "-c", _START),
                stdin=file, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
            )  # fmt: skip
    except OSError:
        return False
    threading.Thread(target=process.wait, daemon=True).start()  # no zombie is left while this process runs
    return True


def main() -> None:
    """What the process does: the work that standard input names, unless another has the lock."""
    with suppress(OSError):
        os.nice(_NICEST)  # Linux derives the priority of disk access from it
    descriptor = lock_file()
    if descriptor is None or not take(descriptor):
        return
    silence_workers()
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM, signal.SIGTERM})
    signal.signal(signal.SIGALRM, _out_of_time)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # the compiler that runs is stopped too
    signal.alarm(_LONGEST)
    work, argument = pickle.load(sys.stdin.buffer)  # written by `begin`
    work(argument)


def _out_of_time(*_: object) -> None:
    raise TimeUp


def _is_free() -> bool:
    descriptor = lock_file()
    if descriptor is None:
        return False
    try:
        return take(descriptor)
    finally:
        os.close(descriptor)
