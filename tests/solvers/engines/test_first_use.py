"""The first use of a scene: other engines answer at once, and the kernel is compiled for the next process."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from wetdoublet.solvers import collide
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.host.locks import take
from wetdoublet.solvers.host.user_cache import lock_file

from ...helpers.command import PATIENCE

pytestmark = pytest.mark.skipif(compiler() is None or os.name != "posix", reason="no C compiler")
HEAD_ON = {"stokes": 0.3, "angle": 0.0, "rtol": 1e-8}
IN_ONE_PROCESS = f"""
import time
from pathlib import Path
from wetdoublet.solvers import collide
first = collide("granulation", **{HEAD_ON})
deadline = time.monotonic() + {PATIENCE}
while not [*Path("cache").glob("taylor-*.so")]:
    assert time.monotonic() < deadline
    time.sleep(0.02)
second = collide("granulation", **{HEAD_ON})
print(first.engine, second.engine, first == second)
"""
SLOW = """#!/bin/sh
case "$*" in
*-shared*)
  while [ "$1" != -o ]; do shift; done
  echo half > "$2"
  echo "$PPID $$" > begun.new && mv begun.new begun
  exec sleep 900;;
esac
exec cc "$@"
"""


def until(met: Callable[[], object]) -> None:
    """Wait for a condition."""
    deadline = time.monotonic() + PATIENCE
    while not met():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def is_idle() -> bool:
    """True if no background process holds the lock of the cache."""
    descriptor = lock_file()
    assert descriptor is not None
    try:
        return take(descriptor)
    finally:
        os.close(descriptor)


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """An empty folder for this process and those that it starts, with a cache where the background may compile."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("WETDOUBLET_BACKGROUND", "on")
    return tmp_path


def test_a_process_keeps_its_engine_and_the_next_has_the_kernel(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """CVODES answers first, and again, to the bit, once the kernel is compiled; another process takes the kernel."""
    done = subprocess.run((sys.executable, "-c", IN_ONE_PROCESS), capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.split(), done.stderr) == (0, ["cvodes", "cvodes", "True"], "")
    monkeypatch.setenv("WETDOUBLET_BACKGROUND", "off")
    found = collide("granulation", **HEAD_ON)  # this process has not asked for a kernel of that cache
    assert found.engine == "taylor"
    reference = collide("granulation", **HEAD_ON, engine="cvodes")
    assert found.restitution == pytest.approx(reference.restitution, rel=1e-7)
    assert found.energy is not None
    assert reference.energy is not None
    assert found.energy.final == pytest.approx(reference.energy.final, rel=1e-7)


@pytest.mark.parametrize(("number", "refused"), [(signal.SIGKILL, 0), (signal.SIGALRM, 1)])
def test_a_compilation_that_does_not_end(
    here: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals, refused: int
) -> None:
    """The command's pipe closes though the compiler goes on. A kill leaves nothing in the cache; the time limit (a
    SIGALRM) stops the compiler too, and leaves a note that it is not to be tried again.
    """
    slow = here / "slow-cc"
    slow.write_text(SLOW)
    slow.chmod(0o700)
    monkeypatch.setenv("CC", str(slow))
    command = (sys.executable, "-m", "wetdoublet.solvers", "collide", "granulation", "--angle", "0", "--json")
    first = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (first.returncode, first.stderr) == (0, "")
    assert json.loads(first.stdout)["engine"] == "cvodes"
    until((here / "begun").exists)
    background, compiling = map(int, (here / "begun").read_text().split())
    assert not is_idle()
    assert os.getpriority(os.PRIO_PROCESS, background) == 19
    assert os.getsid(background) == background
    os.kill(background, number)
    until(is_idle)
    if number == signal.SIGKILL:
        os.kill(compiling, signal.SIGKILL)
    else:
        with pytest.raises(ProcessLookupError):
            until(lambda: os.kill(compiling, 0))
    names = [path.name for path in (here / "cache").iterdir()]
    assert not [name for name in names if name.startswith("taylor-")]
    assert len([name for name in names if name.startswith("refused-")]) == refused


FAILS = """#!/bin/sh
[ ! -e all-fails ] || exit 1
case "$*" in
*-shared*)
  [ ! -e kernels-fail ] || exit 1
  [ ! -e next-fails ] || { rm next-fails; exit 1; }
  for word in "$@"; do
    case "$word" in *source.c) echo "const char *collide(void *t) { return 0; }" > "$word";; esac
  done;;
esac
exec cc "$@"
"""
REFUSED = """
from pathlib import Path
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor.build import compile_or_refuse, kernel
from wetdoublet.solvers.engines.taylor.call import variant_for_many
from wetdoublet.solvers.host.compiler import compiler

variant = variant_for_many(Scene.load("granulation"), False, 1e-8, False)
compiler()
for fault in ("all-fails", "next-fails", "kernels-fail"):
    Path(fault).touch()
    kernel.cache_clear()
    compile_or_refuse([variant])
    Path(fault).unlink(missing_ok=True)
    print(*sorted(file.name.split("-")[0] for file in Path("cache").glob("[rt]*")))
    for library in Path("cache").glob("taylor-*"):
        library.unlink()
"""


def test_a_kernel_is_refused_where_nothing_else_fails(tmp_path: Path) -> None:
    """No note is left by a compiler that fails once or with everything, as on a full disk; one is by a real refusal."""
    (tmp_path / "cc").write_text(FAILS)
    (tmp_path / "cc").chmod(0o700)
    own = os.environ | {"CC": str(tmp_path / "cc"), "WETDOUBLET_CACHE": "cache"}
    done = subprocess.run(
        (sys.executable, "-c", REFUSED), cwd=tmp_path, env=own, capture_output=True, text=True, check=True
    )
    assert done.stdout == "\ntaylor\nrefused\n"
