"""What a user asks to be written: whole or not at all, on a real disk that is full."""

import errno
import os
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from wetdoublet.solvers.host import files

from ...helpers.command import run
from ...helpers.disks import fill, small_disk

MAP = ["map", "granulation", "--stokes", "log:0.01:0.5:3", "--angle", "10:70:3"]
NO_ROOM = "No space left on device"


@pytest.fixture
def full(tmp_path: Path) -> Iterator[Path]:
    """A disk with some files and no room."""
    with small_disk(tmp_path / "disk", 1 << 17) as disk:
        (disk / "old.txt").write_text("old")
        fill(disk)
        yield disk


def test_whole_or_not_at_all(full: Path):
    """A file for which there is no room is an error that names it; what was there stays, and nothing is left over."""
    for name in ("old.txt", "new.txt"):
        with pytest.raises(OSError, match=NO_ROOM) as caught:
            files.write(full / name, "new" * 5000)
        assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(full / name))
    assert (full / "old.txt").read_text() == "old"
    assert {path.name for path in full.iterdir()} == {"old.txt", "filling"}


@pytest.mark.skipif(os.name != "posix", reason="links, modes and devices of POSIX")
def test_what_a_path_is_stays(tmp_path: Path):
    """A link is followed, a mode kept, a device written to; a new file is as any other program's."""
    (tmp_path / "real").write_text("old")
    (tmp_path / "real").chmod(0o640)
    (tmp_path / "link").symlink_to("real")
    (tmp_path / "hard").hardlink_to(tmp_path / "real")
    for name in ("link", "hard"):
        files.write(tmp_path / name, name)
        assert (tmp_path / "link").is_symlink()
        assert [(tmp_path / each).read_text() for each in ("real", "link", "hard")] == [name] * 3
        assert (tmp_path / "real").stat().st_mode & 0o777 == 0o640
    (tmp_path / "plain").touch()
    files.write(tmp_path / "new", b"new")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "plain").stat().st_mode
    files.write("/dev/null", "gone")
    assert Path("/dev/null").is_char_device()
    if Path("/dev/full").exists():
        with pytest.raises(OSError, match=NO_ROOM):
            files.write("/dev/full", "gone")


COMMANDS = {
    "out.txt": ["collide", "granulation", "-o"], "map.nc": [*MAP, "-o"], "map.csv": [*MAP, "-o"],
    "out.json": ["collide", "granulation", "--json", "-o"], "flight.png": ["collide", "granulation", "--plot"],
    "code": ["export", "granulation", "--to", "casadi", "--out"],
}  # fmt: skip


@pytest.mark.parametrize("name", COMMANDS)
def test_no_room_for_what_a_command_writes(name: str, full: Path):
    """Exit status 1, one line that names the file and says why, no traceback and no part of a file."""
    done = run(*COMMANDS[name], full / name)
    assert (done.exit_code, len(done.stderr.splitlines())) == (1, 1)
    assert re.match(rf"{full / name}\S*: {NO_ROOM}; accepted: a file that can be written", done.stderr)
    assert {path.name for path in full.rglob("*")} - {"code"} == {"old.txt", "filling"}
