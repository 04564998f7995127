"""Processes: whatever ends the main one, no worker outlives it for long, and no temporary folder but for a kill."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ...helpers.command import PATIENCE

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="what a session's processes are is read from /proc")

# more than any machine finishes while it is waited for
LARGE = ["map", "granulation", "--stokes", "log:0.005:0.5:400", "--angle", "1:85:400", "--engine", "cvodes"]


def until(condition):
    """Wait until it holds, however long that takes on this machine."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def members(session):
    """The processes of a session that have not ended."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, its = stat.read_text().rpartition(")")[2].split()[:4]
        except (OSError, ValueError):  # it has ended meanwhile
            continue
        if int(its) == session and state != "Z":
            found.append(int(stat.parent.name))
    return found


def begun(*line, **settings):
    """Python with this line in a session of its own, with the interpreter's own answer to Ctrl-C."""
    return subprocess.Popen(
        [sys.executable, *map(str, line)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env=os.environ | settings,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


@pytest.fixture
def temporary(tmp_path):
    """The temporary folder of the processes that a test starts."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    return folder


COUNTED = """
import sys
from pathlib import Path
from wetdoublet.solvers.commands import bar, cli

plain = bar.Bar.__call__

def counted(shown, done, total):
    Path(sys.argv[1]).write_text(str(done))
    plain(shown, done, total)

bar.Bar.__call__ = counted
cli.main(sys.argv[2:])
"""


@pytest.mark.slow
def test_a_map_that_is_ended(tmp_path, temporary):
    """Ctrl-C, a kill and SIGTERM: all workers end too, nothing is left, and what an interrupt keeps is not redone."""
    file, kept, left = tmp_path / "map.nc", 0, set()
    for number, status in ((signal.SIGINT, 130), (signal.SIGKILL, -9), (signal.SIGTERM, 143)):
        said = ended_by(number, status, file, more_than=kept)
        if number != signal.SIGKILL:
            told = r"interrupted: (\d+) of 160000 collisions are kept in (.*); the same command computes the rest\n"
            found = re.fullmatch(told, said)
            assert found is not None, said
            assert Path(found[2]).is_file()
            assert kept < int(found[1]) < 160000
            kept = int(found[1])
            assert set(temporary.iterdir()) == left
        left = set(temporary.iterdir())  # by the kill
    assert not file.exists()
    assert len([*tmp_path.glob("*.partial")]) == 1


def ended_by(number, status, file, more_than):
    """What a map says on standard error that is ended when more collisions are done; no process of it is left."""
    count = file.with_name("count")
    count.write_text("0")
    process = begun("-c", COUNTED, count, *LARGE, "-o", file, TMPDIR=str(file.with_name("temporary")))
    until(lambda: int(count.read_text() or 0) > more_than or process.poll() is not None)
    if number == signal.SIGINT:  # as a terminal does: to the workers too
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    out, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (status, ""), err
    until(lambda: not members(process.pid))
    return err


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_sigterm_while_a_kernel_is_compiled(tmp_path, temporary):
    """The compiler is stopped, its folder removed, and the exit status is 143."""
    compiler, marker = tmp_path / "slow-cc", tmp_path / "begun"
    compiler.write_text(
        f'#!/bin/sh\ncase "$*" in *-O*) echo $$ > {marker}; exec sleep 100000;; *) exec cc "$@";; esac\n'
    )
    compiler.chmod(0o755)
    cache = tmp_path / "cache"
    settings = {"TMPDIR": str(temporary), "CC": str(compiler), "WETDOUBLET_CACHE": str(cache)}
    process = begun("-m", "wetdoublet.solvers", "collide", "granulation", "--engine", "taylor", **settings)
    until(lambda: (marker.exists() and marker.read_text()) or process.poll() is not None)
    assert any(path.is_dir() for path in cache.iterdir())
    process.send_signal(signal.SIGTERM)
    assert process.communicate(timeout=PATIENCE) == ("", "terminated\n")
    assert process.returncode == 143
    until(lambda: not members(process.pid))
    assert not any(path.is_dir() for path in (*cache.iterdir(), *temporary.iterdir()))
