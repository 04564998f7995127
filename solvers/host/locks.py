"""Temporary folders, locked by the process that creates them.

The system releases the lock when that process ends, so a folder that another process can lock is stale and may be
deleted. Nothing is deleted on systems where folders cannot be locked.
"""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

TEMPORARY = "wetdoublet-cache-"  # prefix in temporary folders
_TRIES = 5


@contextmanager
def held_folder(folder: Path, prefix: str) -> Iterator[Path]:
    """A new private folder in a folder, removed at the end with its content; OSError if it cannot be made."""
    import shutil
    import tempfile

    from filelock import lock_descriptor  # slow imports

    for _ in range(_TRIES):
        path = Path(tempfile.mkdtemp(prefix=prefix, dir=folder))
        descriptor = None
        try:
            with suppress(OSError):  # a system that does not open or lock folders
                descriptor = os.open(path, os.O_RDONLY)
                lock_descriptor(descriptor)
            if path.exists():  # another process may have removed it before it was locked
                yield path
                return
        finally:
            if descriptor is not None:
                os.close(descriptor)
            shutil.rmtree(path, ignore_errors=True)
    raise OSError(f"{folder}: what is made there is removed at once")


def temporary() -> list[Path]:
    """Folders for temporary files, the system's default first."""
    import tempfile

    folders = []
    with suppress(OSError):
        folders.append(Path(tempfile.gettempdir()))
    shared = Path("/dev/shm")  # in memory; entries made there are private
    return [*folders, *([shared] if shared.is_dir() else [])]


def sweep_temporary() -> None:
    """Remove stale folders of this user's killed processes from the temporary folders."""
    for folder in temporary():
        sweep(folder, TEMPORARY)


def sweep(folder: Path, prefix: str) -> None:
    """Remove this user's folders with that prefix whose processes have ended."""
    with suppress(OSError):
        for path in folder.glob(f"{prefix}*"):
            with suppress(OSError, AttributeError):  # no users, or no locks, on this system
                status = path.lstat()
                if status.st_uid == os.getuid() and stat.S_ISDIR(status.st_mode):
                    _remove_stale(path)


def _remove_stale(path: Path) -> None:
    import shutil

    from filelock import lock_descriptor

    descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
    try:
        if lock_descriptor(descriptor, blocking=False):
            shutil.rmtree(path, ignore_errors=True)
    finally:
        os.close(descriptor)
