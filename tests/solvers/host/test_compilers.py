"""Compilers: which are accepted, how long they may take, and what happens where none does its work."""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import ComputationError, InputError, collide_many
from wetdoublet.solvers.engines.taylor.build import kernel
from wetdoublet.solvers.host.compiler import CannotCompile, compiler, library
from wetdoublet.solvers.host.interrupts import handled

REAL = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang") or ""
pytestmark = pytest.mark.skipif(os.name != "posix" or compiler() is None or not REAL, reason="no compiler, or no sh")
FLAGS = ("-shared", "-fPIC")
# What a script does beside calling the real compiler. The trial's own source is the one with a main.
ON_MORE = "[ -z $source ] || grep -q 'main(' $source ||"


def script(path: Path, does: str) -> Path:
    """A compiler that does something first; `$source` is the file that it is to compile."""
    path.parent.mkdir(exist_ok=True)
    find = 'for word in "$@"; do case "$word" in *source.c) source=$word;; esac; done'
    path.write_text(f'#!/bin/sh\n{find}\n{does}\nexec {REAL} "$@"\n')
    path.chmod(0o700)
    return path


@pytest.fixture
def anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """Compilers are looked for again, with a cache of the test's own; no trace is left for other tests."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("WETDOUBLET_NO_COMPILER", "")  # so that it is restored
    monkeypatch.delenv("WETDOUBLET_NO_COMPILER")
    monkeypatch.setitem(sys.modules, "ziglang", None)  # as if not installed
    compiler.cache_clear()
    yield monkeypatch
    compiler.cache_clear()


@pytest.mark.parametrize(
    ("named", "does", "command"),
    [
        ("my compilers/cc", "", ("{path}",)),
        ("'{path}' -g", "", ("{path}", "-g")),
        ("env LANG=C '{path}'", "", ("{env}", "LANG=C", "{path}")),
        ("cc", r"printf 'pr\351sent\n' >&2; [ $1 != --version ] || { printf 'version \351\n'; exit; }", ("{path}",)),
    ],
    ids=["a path with spaces", "with options", "behind another", "not UTF-8"],
)
def test_a_compiler_of_ones_own(
    named: str, does: str, command: tuple[str, ...], tmp_path: Path, anew: pytest.MonkeyPatch
):
    """CC is a path, or words as a shell reads them; what it says need not be UTF-8."""
    path = script(tmp_path / "my compilers" / "cc", does)
    anew.chdir(tmp_path)
    anew.setenv("CC", named.format(path=path) if "{" in named else str(path))
    found = compiler()
    assert found is not None
    assert found.command == tuple(word.format(path=path, env=shutil.which("env")) for word in command)
    assert library("int one = 1;", FLAGS).startswith(b"\x7fELF" if sys.platform.startswith("linux") else b"")


@pytest.mark.parametrize(
    ("does", "wrong"),
    [
        (None, "there is no such program"),
        ("exit 0", "it does not say its version"),
        ("[ $1 = --version ] || exit 0", "nothing came of it"),
        ("[ $1 = --version ] || { echo error: no licence >&2; exit 1; }", "error: no licence"),
        ("[ $1 = --version ] || kill -9 $$", "ended by signal 9"),
        ("grep -q 'main(' $source 2>/dev/null && sed -i s/42/41/ $source", "what it compiles does not run"),
        ("sleep 600", "it has not ended after 0.2 s"),
        ("[ $1 = --version ] || { sleep 600 & wait; }", "it has not ended after 0.2 s"),
    ],
    ids=[
        "missing", "silent", "compiles nothing", "fails", "is killed", "for another machine", "hangs",
        "hangs when it compiles",
    ],
)  # fmt: skip
def test_what_is_no_compiler(
    does: str | None, wrong: str, tmp_path: Path, anew: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
):
    """A compiler is accepted only once it has compiled a program that runs; one line names what it does not do."""
    path = tmp_path / "cc"
    if does is not None:
        script(path, does)
    (tmp_path / "bin").mkdir()
    for tool in ("sh", "grep", "sed", "sleep", "as", "ld"):
        (tmp_path / "bin" / tool).symlink_to(shutil.which(tool) or "")
    anew.setenv("CC", str(path))
    anew.setenv("PATH", str(tmp_path / "bin"))
    if "0.2 s" in wrong:
        anew.setenv("WETDOUBLET_COMPILE_SECONDS", "0.2")
    assert compiler() is None  # no other is on the path
    said = capfd.readouterr().err.splitlines()
    assert said[0] == f"CC={path} does not work here ({wrong}): others are tried"
    assert (len(said), said[1].partition(":")[0]) == (2, "no C compiler (cc, gcc, clang)")


def test_a_trial_is_kept(tmp_path: Path, anew: pytest.MonkeyPatch):
    """A compiler that has been tried is not tried again, unless it is another."""
    log = tmp_path / "log"
    path = script(tmp_path / "cc", f"[ -z $source ] || echo tried >> {log}")
    anew.setenv("CC", str(path))
    for _ in range(2):
        compiler.cache_clear()
        assert compiler() is not None
    assert log.read_text().splitlines() == ["tried"]
    script(path, f": another; [ -z $source ] || echo tried >> {log}")
    compiler.cache_clear()
    assert compiler() is not None
    assert log.read_text().splitlines() == ["tried"] * 2


def test_the_limit_is_a_time(anew: pytest.MonkeyPatch):
    """A limit that is none names its setting."""
    for text in ("soon", "0", "-1", "nan"):
        anew.setenv("WETDOUBLET_COMPILE_SECONDS", text)
        with pytest.raises(InputError, match=f'WETDOUBLET_COMPILE_SECONDS: "{text}" is no time; accepted: .* above 0'):
            compiler()


def test_what_cannot_be_compiled(anew: pytest.MonkeyPatch):
    """The first error that the compiler names is the reason."""
    with pytest.raises(CannotCompile, match="error"):
        library("int one = ;", FLAGS)


def test_a_compiler_that_hangs(tmp_path: Path, anew: pytest.MonkeyPatch):
    """It is ended, and not asked again."""
    anew.setenv("CC", str(script(tmp_path / "cc", f"{ON_MORE} exec sleep 600")))
    assert compiler() is not None
    anew.setenv("WETDOUBLET_COMPILE_SECONDS", "0.5")
    with pytest.raises(CannotCompile, match=r"it has not ended after 0.5 s \(WETDOUBLET_COMPILE_SECONDS\)"):
        library("int one = 1;", FLAGS)
    assert compiler() is None


def test_a_compiler_that_fails(tmp_path: Path, anew: pytest.MonkeyPatch):
    """Every collision of the request fails with what the compiler said."""
    path = script(tmp_path / "cc", f"{ON_MORE} {{ echo error: no licence >&2; exit 1; }}")
    anew.setenv("CC", str(path))
    kernel.cache_clear()
    try:
        with pytest.raises(ComputationError, match="cannot compile the Taylor kernel .error: no licence"):
            collide_many("granulation-dry-bridge", stokes=0.5, angle=0.3)
    finally:
        kernel.cache_clear()


def test_an_interrupt_while_a_compiler_begins(tmp_path: Path, anew: pytest.MonkeyPatch):
    """It runs, and its `Popen` is not returned yet: it is stopped all the same."""
    begin, processes = subprocess.Popen.__init__, []

    def interrupted(process: subprocess.Popen[bytes], *arguments: Any, **options: Any) -> None:
        begin(process, *arguments, **options)
        processes.append(process)
        os.kill(os.getpid(), signal.SIGTERM)

    anew.setattr(subprocess.Popen, "__init__", interrupted)
    anew.setenv("CC", str(script(tmp_path / "slow" / "cc", "exec sleep 1000")))
    with handled(), pytest.raises(KeyboardInterrupt):
        compiler()
    assert [process.returncode for process in processes] == [-signal.SIGKILL]
