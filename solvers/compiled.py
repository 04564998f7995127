"""CasADi functions compiled to C and loaded, with a per-user cache addressed by content.

The folder belongs to the user alone: one that others could write to is refused, since what is in it is executed.
Without a compiler everything runs interpreted; that is said once.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

from casadi import Function, external
from platformdirs import user_cache_path

from .caches import Locks, once

FLAGS = ("-O1", "-fPIC", "-shared")  # -O3 takes 1.6 times as long to compile and saves a sixth (docs/performance.md)
_COMPILERS = ("cc", "gcc", "clang")
_INTERRUPTED = (-signal.SIGINT, 128 + signal.SIGINT)  # exit statuses, the second that of a shell script
_HUSHED = "WETDOUBLET_HUSHED"
_BUILDING = Locks()


@once
def compiler() -> tuple[str, str] | None:
    """Path and version line of the machine's C compiler, $CC before others; None, said once, if there is none."""
    wanted = os.environ.get("CC", "").split()[:1]
    for name in (*wanted, *_COMPILERS):
        path = shutil.which(name)
        if path is not None:
            asked = _run(path, "--version")
            if asked.returncode == 0 and asked.stdout.strip():
                return path, asked.stdout.splitlines()[0]
        if name in wanted:
            _say(f"CC={name} is no compiler here: another is looked for")
    _say(
        "no C compiler (cc, gcc, clang): there is no Taylor kernel, other engines answer; "
        "their integrators run interpreted, about five times slower"
    )
    return None


def more_flags() -> tuple[str, ...]:
    """What the C compiler is told besides, as WETDOUBLET_CFLAGS names it: sanitizers, debugging."""
    return tuple(shlex.split(os.environ.get("WETDOUBLET_CFLAGS", "")))


def hush() -> None:
    """For a worker process: the one that started it says what compiler and cache lack."""
    os.environ[_HUSHED] = "1"


def _say(line: str) -> None:
    if _HUSHED not in os.environ:
        sys.stderr.write(f"{line}\n")


def _run(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a compiler; KeyboardInterrupt if that is what ended it: Ctrl-C goes to this process and to it."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode in _INTERRUPTED:
        raise KeyboardInterrupt
    return done


@once
def cache_folder() -> Path:
    """The user's cache folder, or a fresh private one for this process where that cannot be had: said once.

    WETDOUBLET_CACHE names another.
    """
    named = os.environ.get("WETDOUBLET_CACHE")
    folder = Path(named) if named else user_cache_path("wetdoublet")
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if _private(folder) and os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    _say(f"{folder} is not writable by this user alone: what is compiled is kept for this process only")
    private = Path(tempfile.mkdtemp(prefix="wetdoublet-"))
    atexit.register(shutil.rmtree, private, ignore_errors=True)
    return private


def _private(folder: Path) -> bool:
    """Whether only this user can write to a folder."""
    if os.name != "posix":
        return True
    found = folder.stat()
    return found.st_uid == os.getuid() and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def compiled(function: Function) -> Function:
    """`function` as machine code if there is a compiler, else itself; safe with several processes."""
    found = compiler()
    if found is None:
        return function
    path, version = found
    name, flags = function.name(), FLAGS + more_flags()
    with tempfile.TemporaryDirectory(prefix="wetdoublet-") as work:
        source = _source(function, Path(work))
        text = source.read_bytes()
        key = hashlib.sha256(b"\0".join([text, version.encode(), " ".join(flags).encode()])).hexdigest()[:32]
        library = cache_folder() / f"{name}-{key}.so"
        with _BUILDING(library):  # another thread may have the same function
            said = "" if library.is_file() else build(path, flags, source, library)
        if said:
            sys.stderr.write(f"{path} cannot compile {name} ({said}): it runs interpreted\n")
            return function
    return external(name, str(library))


def build(path: str, flags: tuple[str, ...], source: Path, library: Path) -> str:
    """Compile a C file beside which there is room; the first error that the compiler names if it fails, else "".

    The library is built under a name of its own and then moved into place: several processes may do so at once.
    A compiler that is interrupted is an interrupt, not a failure.
    """
    fresh = source.with_suffix(".so")
    built = _run(path, *flags, "-o", str(fresh), str(source), "-lm")
    if built.returncode:
        said = built.stderr.strip().splitlines() or ["no message"]
        return next((line for line in said if "error" in line), said[-1])
    if not fresh.is_file():
        return "no library came of it"
    beside = library.with_suffix(f".{os.getpid()}")
    shutil.copyfile(fresh, beside)
    beside.replace(library)
    return ""


def _source(function: Function, folder: Path) -> Path:
    """C source of a function; CasADi's `generate` takes no path, so the text is taken from it and written."""
    from casadi import CodeGenerator

    generator = CodeGenerator(function.name())
    generator.add(function)
    path = folder / f"{function.name()}.c"
    path.write_text(generator.dump())
    return path
