"""Temporary files and folders, locked by the process that creates them.

The system releases the lock when that process ends, so a file that another process can lock is stale and may be
deleted. Nothing is deleted on systems without such locks.
"""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

try:
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]  # tested before each use

TEMPORARY = "wetdoublet-cache-"  # prefix in temporary folders
_TRIES = 5


@contextmanager
def held_file(folder: Path, prefix: str) -> Iterator[tuple[int, Path]]:
    """A new private file in a folder, open for writing; removed at the end unless renamed.

    Raises:
        OSError: it cannot be made.
    """
    for _ in range(_TRIES):
        descriptor, name = tempfile.mkstemp(prefix=prefix, dir=folder)
        path = Path(name)
        try:
            if _hold(descriptor, path):
                yield descriptor, path
                return
        finally:
            os.close(descriptor)
            path.unlink(missing_ok=True)
    raise OSError(f"{folder}: what is made there is removed at once")


@contextmanager
def held_folder(folder: Path, prefix: str) -> Iterator[Path]:
    """A new private folder in a folder; removed at the end with its content.

    Raises:
        OSError: it cannot be made.
    """
    for _ in range(_TRIES):
        path = Path(tempfile.mkdtemp(prefix=prefix, dir=folder))
        descriptor = _opened(path)
        try:
            if fcntl is None or (descriptor is not None and _hold(descriptor, path)):
                yield path
                return
        finally:
            if descriptor is not None:
                os.close(descriptor)
            shutil.rmtree(path, ignore_errors=True)
    raise OSError(f"{folder}: what is made there is removed at once")


def take(descriptor: int) -> bool:
    """Lock an open file without waiting; False if another process holds the lock. True on systems without locks."""
    if fcntl is None:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        return error.errno not in (errno.EWOULDBLOCK, errno.EACCES)
    return True


def _opened(folder: Path) -> int | None:
    """Descriptor of a folder; None if the system has none for folders or the folder is gone."""
    if fcntl is None:
        return None
    try:
        return os.open(folder, os.O_RDONLY)
    except FileNotFoundError:
        return None


def _hold(descriptor: int, path: Path) -> bool:
    """Lock a new file or folder; False if another process has removed it before."""
    if fcntl is None:
        return True
    with contextlib.suppress(OSError):  # a file system without locks
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    try:
        return os.path.samestat(os.fstat(descriptor), path.lstat())
    except FileNotFoundError:
        return False


def temporary() -> list[Path]:
    """Folders for temporary files, the system's default first."""
    found = []
    with contextlib.suppress(OSError):
        found.append(Path(tempfile.gettempdir()))
    shared = Path("/dev/shm")  # in memory; entries made there are private
    return [*found, *([shared] if shared.is_dir() else [])]


def sweep_temporary() -> None:
    """Remove stale entries of this user's killed processes from the temporary folders."""
    for folder in temporary():
        sweep(folder, TEMPORARY)


def sweep(folder: Path, prefix: str) -> None:
    """Remove this user's files and folders with that prefix whose processes have ended."""
    if fcntl is None:
        return
    with contextlib.suppress(OSError):
        for path in folder.glob(f"{prefix}*"):
            _sweep(path)


def _sweep(path: Path) -> None:
    with contextlib.suppress(OSError):
        found = path.lstat()
        kind = stat.S_IFMT(found.st_mode)
        if found.st_uid != os.getuid() or kind not in (stat.S_IFREG, stat.S_IFDIR):
            return
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if kind == stat.S_IFDIR:
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)
        finally:
            os.close(descriptor)
