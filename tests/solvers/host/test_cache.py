"""The cache: damaged entries, full and foreign folders, several processes, what a kill leaves."""

import ctypes
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from wetdoublet.solvers.host import user_cache as cache
from wetdoublet.solvers.host.compiler import compiler, library

from ...helpers.disks import fill, small_disk

WHOLE = bytes(range(256)) * 300
posix = pytest.mark.skipif(os.name != "posix", reason="permissions, signals and locks of POSIX")
compiling = pytest.mark.skipif(compiler() is None, reason="no C compiler")


@pytest.fixture
def shelf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own, which nothing has been put into."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def only(folder: Path) -> Path:
    """The one file in a folder."""
    (found,) = folder.iterdir()
    return found


def unexpected() -> bytes:
    """What gives an entry that ought to be there."""
    raise AssertionError("it was made again")


def in_process(text: str, **settings: str) -> subprocess.CompletedProcess[str]:
    """A program in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=False, env=os.environ | settings
    )


def truncated(path: Path) -> None:
    """Half of it is left."""
    os.truncate(path, path.stat().st_size // 2)


def flipped(path: Path) -> None:
    """One bit is another."""
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 4
    path.write_bytes(content)


def linked(path: Path) -> None:
    """A link to something of the same content is in its place."""
    aside = path.parent.with_name("aside")
    path.rename(aside)
    path.symlink_to(aside)


def opened(path: Path) -> None:
    """Others can write to it."""
    path.chmod(0o666)


DAMAGES = [truncated, flipped, pytest.param(linked, marks=posix), pytest.param(opened, marks=posix)]


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_entry_is_made_again(damage: Callable[[Path], None], shelf: Path, capfd: pytest.CaptureFixture[str]):
    """Whatever has happened to its file, an entry is what was made, its file too afterwards, and one line says so."""
    assert cache.fetch("one.bin", lambda: WHOLE) == WHOLE == cache.fetch("one.bin", unexpected)
    path = only(shelf)
    damage(path)
    assert cache.fetch("one.bin", lambda: WHOLE) == WHOLE == cache.fetch("one.bin", unexpected)
    assert (only(shelf), path.read_bytes(), path.is_symlink()) == (path, WHOLE, False)
    assert capfd.readouterr().err == f"{path} was damaged: it is made again\n"


_CACHE = "from wetdoublet.solvers.host import user_cache as cache"


_RACE = """
import os, sys, time
from pathlib import Path
from wetdoublet.solvers.host.user_cache import fetch

def made():
    meeting = Path(sys.argv[1])
    (meeting / str(os.getpid())).touch()
    while len(list(meeting.iterdir())) < 2:
        time.sleep(0.01)
    return b"ONE = 1"

print(fetch("one.py", made))
"""


def test_two_processes_fill_the_cache_at_once(shelf: Path, tmp_path: Path):
    """Two processes that make the same entry at the same time both get it, and leave one file, private, behind."""
    meeting = tmp_path / "meeting"
    meeting.mkdir()
    command = [sys.executable, "-c", _RACE, str(meeting)]
    running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    assert {process.communicate(timeout=60)[0] for process in running} == {"b'ONE = 1'\n"}
    assert len(list(meeting.iterdir())) == 2  # both were inside
    assert only(shelf).read_bytes() == b"ONE = 1"
    assert [path.stat().st_mode & 0o777 for path in (shelf, only(shelf))] == [0o700, 0o600]


@compiling
def test_a_library_outlives_its_file(shelf: Path):
    """What is loaded is a copy of what was verified: its file may be cut short, and another takes no other's name."""
    large = "char pages[1 << 20] = {1}; int answer(void) { long sum = ADDED;"
    large += " for (long k = 0; k < sizeof pages; k += 512) sum += pages[k]; return sum; }"
    found = []
    for added in (6, 41):
        name, source = f"answer{added}.so", large.replace("ADDED", str(added))
        content = cache.fetch(name, lambda source=source: library(source, ("-shared", "-fPIC")))
        found.append(cache.loaded(content, ctypes.CDLL))
    assert not list(shelf.glob(".*"))
    for path in shelf.glob("*.so"):
        os.truncate(path, 0)
    assert [one.answer() for one in found] == [7, 42]


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770])
def test_a_folder_that_others_can_write_to_is_refused(mode: int, shelf: Path):
    """Nothing is taken from it, nothing is put there, and one line says so."""
    shelf.mkdir()
    shelf.chmod(mode)
    program = f'{_CACHE}; print(cache.fetch("a.b", lambda: b"own"), cache.has("a."))'
    done = in_process(program)
    assert done.stdout == "b'own' True\n"
    said = "others can write to it; what is derived or compiled is kept in memory while this runs"
    assert done.stderr == f"{shelf}: {said}\n"
    assert not list(shelf.iterdir())


@posix
def test_nothing_is_compiled_or_loaded_where_others_can_replace_it(shelf: Path, tmp_path: Path):
    """A folder for temporary files that others can write to serves if only owners can remove what is there."""
    shelf.mkdir()
    shelf.chmod(0o777)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    program = f"{_CACHE}; print(cache.loaded(b'', str))\nwith cache.room() as place:\n    print(place)"
    for mode, serves in ((0o777, False), (0o1777, True), (0o700, True)):
        temporary.chmod(mode)
        done = in_process(program, TMPDIR=str(temporary))
        assert [Path(line).parent == temporary for line in done.stdout.split()] == [serves] * 2, done.stderr


_FULL = """
from wetdoublet.solvers.host import user_cache as cache
for name in ("a.b", "c.d", "a.b"):
    print(len(cache.fetch(name, lambda: b"1" * 100_000 if cache.lookup("a.b") is None else b"made again")))
with cache.room() as place:
    (place / "object").write_bytes(bytes(1 << 20))
"""


@posix
def test_a_full_disk(tmp_path: Path):
    """Entries stay in memory, one line says so, and there is room to compile elsewhere; nothing is left behind."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    with small_disk(tmp_path / "disk", 1 << 18) as disk:
        fill(disk)
        done = in_process(_FULL, TMPDIR=str(temporary), WETDOUBLET_CACHE=str(disk / "cache"))
        assert done.stdout.split() == ["100000", "10", "100000"]
        said = "No space left on device; what is derived or compiled is kept in memory while this runs"
        assert done.stderr == f"{disk / 'cache'}: {said}\n"
    assert not list(temporary.iterdir())


@posix
@compiling
def test_a_folder_from_which_nothing_may_be_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """What is compiled stands there, and is tried and loaded elsewhere: the compiler is found."""
    program = (
        f"{_CACHE}; import ctypes; from wetdoublet.solvers.host.compiler import library\n"
        "made = cache.fetch('a.so', lambda: library('int six(void) { return 6; }', ('-shared', '-fPIC')))\n"
        "print(cache.loaded(made, ctypes.CDLL).six())"
    )
    with small_disk(tmp_path / "disk", 1 << 24, "noexec") as disk:
        monkeypatch.setenv("WETDOUBLET_CACHE", str(disk))
        done = in_process(program)
        assert (done.stdout, done.stderr) == ("6\n", "")
        assert sorted(path.suffix for path in disk.iterdir()) == [".so", ".txt"]
