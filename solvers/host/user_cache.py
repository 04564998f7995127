"""The user's cache of derived code, compiled libraries and unit factors.

An entry is a file STEM.DIGEST.SUFFIX in one folder. Its content is read and compared with the digest in its
name before use; an entry that disagrees is removed, with a remark, and made again. An entry is written to a file beside
the entries, moved into place and never changed, so several processes may write at once. A library is loaded from a
verified copy that is removed at once, so later changes of the file do not affect a running process.

A folder that other users can write to is refused, because its content is executed. What the folder does not take stays
in memory as long as the process runs, with one remark.
"""

import errno
import hashlib
import itertools
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

from .remarks import say, say_once
from .thread_caches import Locks

Loaded = TypeVar("Loaded")

_NAMED = "WETDOUBLET_CACHE"
_MAKING = ".new-"  # prefix of temporary files and folders; `.making-` is what older versions remove
_DIGITS = 32  # hexadecimal digits of the digest in a name
_LARGEST = 1 << 28  # bytes; larger than any entry
_ROOM = 16 << 20  # bytes; ample for a compilation
_PROBE = bytes(1 << 18)  # content of a trial entry, larger than most
_MEMORY: dict[str, bytes] = {}  # entries that the folder did not take
_BY_NAME = Locks()


def folder() -> Path:
    """The user's cache folder, which need not exist; WETDOUBLET_CACHE overrides the default."""
    return _folder(os.environ.get(_NAMED), os.environ.get("XDG_CACHE_HOME"), os.environ.get("HOME"))


@lru_cache(maxsize=16)
def _folder(named: str | None, *_usual: str | None) -> Path:
    """The folder by the environment variables that it depends on."""
    if named:
        return Path(named)
    from platformdirs import user_cache_path

    return user_cache_path("wetdoublet")


def fetch(name: str, make: Callable[[], bytes]) -> bytes:
    """The content of the entry of that name; computed and stored if it is missing or damaged.

    Arguments:
        name: STEM.SUFFIX; must identify everything that the content depends on.
        make: computes the content; its exceptions propagate.
    """
    with _BY_NAME(name):  # one thread makes the entry; others wait
        content = lookup(name)
        if content is None:
            content = make()
            if reason := _write_failure(name, content):
                _MEMORY[name] = content
                say_once(f"{folder()}: {reason}; what is derived or compiled is kept in memory while this runs")
        return content


def lookup(name: str) -> bytes | None:
    """The content of the entry of that name; None if it is missing or damaged."""
    stem, _, suffix = name.rpartition(".")
    for file in _names():
        first, _, digest = file.removesuffix(f".{suffix}").rpartition(".")
        if first == stem and file.endswith(f".{suffix}"):
            content = _verified(folder() / file, digest)
            if content is not None:
                return content
    return _MEMORY.get(name)


def has(prefix: str) -> bool:
    """True if an entry's name begins with `prefix`; the entry is not read."""
    return any(name.startswith(prefix) for name in (*_names(), *_MEMORY))


def loaded(content: bytes, opened: Callable[[str], Loaded]) -> Loaded:
    """The result of `opened` for the path of a private copy of a library with that content, removed afterwards.

    Raises:
        OSError, RuntimeError: from `opened`, if the library cannot be loaded.
    """
    failure: Exception = OSError(errno.ENOSPC, "no room to load from", str(folder()))
    for place in _places(create=False):
        # a new name: the loader returns the old library for a path opened before
        copy = place / f"{_MAKING}{os.urandom(8).hex()}.so"
        try:
            _write_new(copy, content)
            return opened(str(copy))
        except (OSError, RuntimeError) as error:  # no room, or a folder from which nothing may be executed
            failure = error
        finally:
            with suppress(OSError):  # not there, or a system that keeps what is loaded
                copy.unlink()
    raise failure


@contextmanager
def room() -> Iterator[Path]:
    """A private folder with space for compilation, removed at the end.

    Raises:
        OSError: no folder has the space.
    """
    import shutil  # slow imports
    import tempfile

    for place in _places(create=True):
        with suppress(OSError):
            if shutil.disk_usage(place).free >= _ROOM:
                private = tempfile.TemporaryDirectory(prefix=_MAKING, dir=place, ignore_cleanup_errors=True)
                break
    else:
        raise OSError(errno.ENOSPC, "no room to compile in", str(folder()))
    with private as path:
        yield Path(path)


def _places(create: bool) -> Iterator[Path]:
    """Folders in which temporary files can be: the user's, then the system's; last those where nothing may be run."""
    last = []
    for place in itertools.chain(_own(create), _temporary()):
        if _runs_nothing(place):
            last.append(place)
        else:
            yield place
    yield from last


def _own(create: bool) -> Iterator[Path]:
    """The user's folder, if it is there or shall be made, where others cannot write."""
    with suppress(OSError):
        _check_private(folder(), create=create)
        yield folder()


def _runs_nothing(place: Path) -> bool:
    return os.name == "posix" and bool(os.statvfs(place).f_flag & getattr(os, "ST_NOEXEC", 0))


def _temporary() -> Iterator[Path]:
    """The system's folders for temporary files, but for those in which others could replace what is made there."""
    import tempfile

    for named in (tempfile.gettempdir, lambda: "/dev/shm"):  # the latter is in memory
        with suppress(OSError):
            place = Path(named())
            status = place.stat()
            if _alone(status) or status.st_mode & stat.S_ISVTX:
                yield place


def _write_new(path: Path, content: bytes) -> None:
    path.touch(mode=0o600, exist_ok=False)
    path.write_bytes(content)


# ---- reading


def _names() -> list[str]:
    """Names of the files in the user's folder; none where it is not there, or others can write to it."""
    try:
        _check_private(folder())
        return os.listdir(folder())  # noqa: PTH208 # names, of which there may be thousands
    except OSError:
        return []


def _verified(path: Path, digest: str) -> bytes | None:
    """Content of a file if its digest is right; else None, and the file is removed."""
    content = None
    try:
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with os.fdopen(os.open(path, flags), "rb") as file:
            status = os.fstat(file.fileno())
            if stat.S_ISREG(status.st_mode) and status.st_size <= _LARGEST and _alone(status):
                content = file.read()
    except OSError as error:
        if error.errno != errno.ELOOP:  # absent or unreadable, but not known to be damaged
            return None
    if content is not None and digest_of(content) == digest:
        return content
    try:
        path.unlink()
        say(f"{path} was damaged: it is made again", only_here=True)
    except FileNotFoundError:  # another process has removed it
        pass
    except OSError as error:
        say_once(f"{path} is damaged and cannot be removed ({error.strerror}): it is not used")
    return None


def digest_of(content: bytes) -> str:
    """Digest of a content, as it stands in the names of entries."""
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


def _check_private(shelf: Path, create: bool = False) -> None:
    """Raise OSError unless the folder exists, or is created, and only this user can write to it."""
    if create:
        shelf.mkdir(mode=0o700, parents=True, exist_ok=True)
    if not _alone(shelf.stat()):
        raise OSError(errno.EPERM, "others can write to it")


def _alone(status: os.stat_result) -> bool:
    if os.name != "posix":
        return True
    return status.st_uid == os.getuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


# ---- writing


def why_unwritable() -> str:
    """Why the user's folder cannot be written; "" if it can."""
    return _write_failure("", _PROBE)


def _write_failure(name: str, content: bytes) -> str:
    """Write an entry; returns why that failed, or "" if it did not. With an empty name only test the folder."""
    stem, _, suffix = name.rpartition(".")
    file = folder() / f"{_MAKING}{os.urandom(8).hex()}"
    try:
        _check_private(folder(), create=True)
        try:
            _write_new(file, content)
            if name:
                file.replace(folder() / f"{stem}.{digest_of(content)}.{suffix}")
        finally:
            file.unlink(missing_ok=True)
    except OSError as error:
        return error.strerror or str(error)
    return ""
