"""The machine's C compiler, or else Zig's from `wetdoublet[compiler]`: search, test and compilation with a time limit.

A compiler is accepted if it compiles a two-line program that then runs. Without one only shipped and cached kernels
answer and CasADi's integrators are interpreted, with one remark on standard error. WETDOUBLET_COMPILE_SECONDS sets the
time limit for a file.
"""

import ctypes
import hashlib
import math
import os
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from ..errors import InputError, install_extra
from . import user_cache as cache
from .interrupts import held
from .remarks import say
from .thread_caches import once

_COMPILERS = ("cc", "gcc", "clang")
_ZIG = "ziglang"  # the module with which pip installs a compiler
_ONLY_GCC = ("-fexpensive-optimizations", "-ftree-pre", "-fgcse")  # which others ignore, and Zig refuses
_SECONDS = "WETDOUBLET_COMPILE_SECONDS"
_LIMIT = 120.0  # s; the largest kernel takes about ten on a busy machine
_TRIAL_LIMIT = 20.0  # s
_FIRST_OF_ZIG = 120.0  # s; compiles its own C library first, once
_LONGEST = 86400.0  # s; cap of the time limit, as the system's waits accept no arbitrary times
_GIVEN_UP = "WETDOUBLET_NO_COMPILER"  # inherited by workers; set after a compiler has exceeded its time
_INTERRUPTED = (-signal.SIGINT, 128 + signal.SIGINT)  # exit statuses after SIGINT, of a program and of a shell script
_TRIAL = """#include <math.h>
int main(int count, char **words) { return words[0] && sqrt(8.0 + count) == 3.0 ? 42 : 1; }
"""
_ANSWER = 42


class CannotCompile(Exception):
    """A file could not be compiled to a library; the message is the reason."""


class Compiler(NamedTuple):
    """A C compiler that works.

    Arguments:
        command: the words of the command: `("ccache", "/usr/bin/gcc")`.
        version: output of its `--version`.
    """

    command: tuple[str, ...]
    version: str

    def __str__(self) -> str:
        """The command as typed in a shell."""
        return shlex.join(self.command)


@once
def compiler() -> Compiler | None:
    """The machine's first C compiler that passes a trial, preferably $CC; None, with a remark, if there is none.

    Raises:
        InputError: WETDOUBLET_COMPILE_SECONDS is not a valid time.
    """
    limit = _limit()
    if _GIVEN_UP in os.environ:
        return None
    tried: set[tuple[str, ...]] = set()
    failed: list[str] = []
    wanted = os.environ.get("CC", "").strip()
    for named in (*([wanted] if wanted else []), *_COMPILERS, *_zig()):
        command = _command(named)
        wrong = "there is no such program"
        if command is not None:
            if command in tried:
                continue
            tried.add(command)
            accepted = _accepted(command, min(limit, _FIRST_OF_ZIG if _ZIG in command else _TRIAL_LIMIT))
            if isinstance(accepted, Compiler):
                return accepted
            wrong = accepted
            failed += [f"{named}: {wrong}"] if named != wanted else []
        if named == wanted:
            say(f"CC={named} does not work here ({wrong}): others are tried")
    say(
        f"no C compiler ({'; '.join(failed) or ', '.join(_COMPILERS)}): only scenes whose kernels the package "
        f"has can be computed; install gcc or clang, or {install_extra('compiler')}"
    )
    return None


def key(source: str, flags: Sequence[str]) -> str:
    """Digest of everything that a compiled library depends on: source, flags and the compiler's version."""
    working = compiler()
    content = "\0".join([source, str(working), working.version if working else "", *flags])
    return hashlib.sha256(content.encode(errors="surrogateescape")).hexdigest()[:32]


def library(source: str, flags: Sequence[str]) -> bytes:
    """A C file compiled to a shared library.

    Raises:
        CannotCompile: the compilation failed, or what it wrote does not load; gives the reason.
        KeyboardInterrupt: the compiler was interrupted, as by Ctrl-C.
    """
    working = compiler()
    if working is None:
        raise CannotCompile("there is no compiler")
    limit = _limit()
    try:
        content = _compiled(working.command, source, flags, limit)
        cache.loaded(content, ctypes.CDLL)  # one that does not load is not kept
    except subprocess.TimeoutExpired:
        os.environ[_GIVEN_UP] = "1"
        compiler.cache_clear()
        why = f"it has not ended after {limit:g} s ({_SECONDS}) and is not asked again"
        raise CannotCompile(why) from None
    except OSError as error:
        raise CannotCompile(error.strerror or str(error)) from None
    return content


def webassembly(source: str, flags: Sequence[str]) -> bytes:
    """A C file compiled to a WebAssembly module without a main program, by Zig or else by clang with wasi-libc.

    Raises:
        CannotCompile: neither is there, or neither compiles it; gives the reason.
        KeyboardInterrupt: the compiler was interrupted, as by Ctrl-C.
    """
    flags = ("--target=wasm32-wasi", "-mexec-model=reactor", *flags)
    failed = []
    for command in filter(None, map(_command, (*_zig(), "clang"))):
        try:
            return _compiled(command, source, flags, _limit())
        except (CannotCompile, OSError, subprocess.TimeoutExpired) as error:
            failed.append(f"{shlex.join(command)}: {' '.join(str(error).split())}")
    raise CannotCompile("; ".join(failed) or f"there is neither {_ZIG} nor clang")


def more_flags() -> tuple[str, ...]:
    """Additional compiler flags from WETDOUBLET_CFLAGS, such as sanitizers."""
    return tuple(shlex.split(os.environ.get("WETDOUBLET_CFLAGS", "")))


def _limit() -> float:
    """Time limit of a compilation, s."""
    text = os.environ.get(_SECONDS, "")
    if not text:
        return _LIMIT
    try:
        limit = float(text)
    except ValueError:
        limit = math.nan
    if not limit > 0:
        raise InputError(_SECONDS, text, "a time in seconds above 0", "is no time")
    return min(limit, _LONGEST)


def _command(named: str) -> tuple[str, ...] | None:
    """The words of a command, the first an executable's path, which may contain spaces; None if not found."""
    whole = shutil.which(named)
    if whole is not None:
        return (whole,)
    try:
        words = shlex.split(named)
    except ValueError:
        return None
    first = shutil.which(words[0]) if words else None
    return None if first is None else (first, *words[1:])


def _zig() -> tuple[str, ...]:
    """The command of Zig's C compiler, where it is installed beside this Python."""
    if find_spec(_ZIG) is None:
        return ()
    return (shlex.join((sys.executable, "-m", _ZIG, "cc")),)


def _accepted(command: tuple[str, ...], limit: float) -> Compiler | str:
    """The compiler of a command if it compiles a program that runs; else the reason as text.

    Success is cached with the compiler's version, size and date, so that later processes skip the test.
    """
    try:
        status, output = _run((*command, "--version"), limit)
        version = next(iter(output.strip().splitlines()), "")
        if status or not version:
            return "it does not say its version"
        content = "\0".join([*command, version, *(_identity(word) for word in command), _TRIAL])
        name = f"compiler-{hashlib.sha256(content.encode(errors='replace')).hexdigest()[:32]}.txt"
        if not cache.has(name.removesuffix("txt")):
            _try(command, limit)
            cache.fetch(name, lambda: f"{shlex.join(command)}\n{version}\n".encode(errors="replace"))
    except subprocess.TimeoutExpired:
        return f"it has not ended after {limit:g} s"
    except CannotCompile as error:
        return str(error)
    except OSError as error:
        return error.strerror or str(error)
    return Compiler(command, version)


def _identity(word: str) -> str:
    """Size and date of the executable that a word of a command names."""
    path = shutil.which(word)
    if path is None:
        return ""
    status = Path(path).stat()
    return f"{os.path.realpath(path)} {status.st_size} {status.st_mtime_ns}"


def _try(command: tuple[str, ...], limit: float) -> None:
    """Compile the test program and run it. CannotCompile, TimeoutExpired or OSError if that fails."""
    with cache.room() as place:
        program = place / "trial"
        program.write_bytes(_compiled(command, _TRIAL, (), limit))
        program.chmod(0o700)
        if _run((str(program),), limit)[0] != _ANSWER:
            raise CannotCompile("what it compiles does not run")


def _compiled(command: tuple[str, ...], source: str, flags: Sequence[str], limit: float) -> bytes:
    """The binary of a C file. CannotCompile, TimeoutExpired or OSError if that fails."""
    if _ZIG in command:  # "-s": without text with paths of this machine
        flags = [*(flag for flag in flags if flag not in _ONLY_GCC), "-s"]
    with cache.room() as place:
        file, binary = place / "source.c", place / "made"
        file.write_text(source, encoding="utf-8")
        status, output = _run((*command, *flags, "-o", str(binary), str(file), "-lm"), limit, place)
        if status:
            lines = output.strip().splitlines() or [f"ended by signal {-status}" if status < 0 else "no message"]
            raise CannotCompile(next((line for line in lines if "error" in line), lines[-1]))
        if not binary.is_file():
            raise CannotCompile("nothing came of it")
        return binary.read_bytes()


def _run(command: tuple[str, ...], limit: float, place: Path | None = None) -> tuple[int, str]:
    """Run a command; returns its status and output, errors last.

    Raises:
        TimeoutExpired: the command exceeded its time.
        OSError: it cannot be run.
        KeyboardInterrupt: it was interrupted.
    """
    environment = os.environ | {"LC_ALL": "C"} | ({"TMPDIR": str(place)} if place else {})
    process = None
    try:
        with held():  # an interrupt while it begins would lose it
            process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
            )
        output, errors = process.communicate(timeout=limit)
    except BaseException:
        if process is not None:
            with process:  # which waits for its end
                process.kill()
        raise
    if process.returncode in _INTERRUPTED:
        raise KeyboardInterrupt
    return process.returncode, (output + b"\n" + errors).decode(errors="replace")
