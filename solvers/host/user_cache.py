"""What is made once a user and kept: derived code, compiled libraries, factors of units. All of it goes through here.

An entry is a file STEM.DIGEST.SUFFIX in one folder. Its content is read whole and held against the digest in its name
before anything is made of it; what does not agree is removed, said, and made again. It is written beside and moved into
place, never changed: several processes may do so at once. What is loaded as a library is a copy in memory of what was
verified, so nothing that happens to the file afterwards reaches a running process.

The folder belongs to the user alone: one that others could write to is refused, since what is in it is executed. Where
nothing can be written, entries go to a private temporary folder that ends with the process, or to memory: said once.
"""

from __future__ import annotations

import atexit
import errno
import hashlib
import itertools
import os
import shutil
import stat
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TypeVar

from .files import write_all
from .locks import TEMPORARY, held_file, held_folder, sweep, temporary
from .remarks import say, say_once
from .thread_caches import Locks

Loaded = TypeVar("Loaded")

_NAMED = "WETDOUBLET_CACHE"
_PRIVATE = "WETDOUBLET_PRIVATE_CACHE"  # of the process that made it, for its workers
_MAKING = ".making-"  # prefix in the folder of what is being made
_DIGITS = 32  # of the digest in a name
_LARGEST = 1 << 28  # bytes: no entry is as large
_ROOM = 16 << 20  # bytes that a compiler needs, amply
_PROBE = 1 << 18  # bytes: more than most entries
_MEMORY: dict[str, bytes] = {}  # entries for which there is no other place
_REFUSED: set[Path] = set()  # folders that could not be written, which has been said
_LOCK = threading.RLock()
_LOADS = itertools.count()
_MAKING_OF = Locks()


def folder() -> Path:
    """The user's cache folder, which need not exist; WETDOUBLET_CACHE names another than the system's."""
    named = os.environ.get(_NAMED)
    if named:
        return Path(named)
    from platformdirs import user_cache_path

    return user_cache_path("wetdoublet")


def kept(name: str, made: Callable[[], bytes]) -> bytes:
    """The content of the entry of that name, made if it is not there or not whole.

    Arguments:
        name: STEM.SUFFIX, in which everything is that the content depends on.
        made: gives the content; what it raises is raised.

    Example:
        >>> kept("law-3f2a.py", lambda: b"ONE = 1")  # doctest: +SKIP
        b'ONE = 1'
    """
    with _MAKING_OF(name):  # other threads wait for what one of them makes
        content = _found(name)
        if content is None:
            content = made()
            _put(name, content)
        return content


def has(prefix: str) -> bool:
    """Whether there is an entry whose name begins so; it is not read."""
    listed = (name for shelf in _shelves() for name in _names(shelf))
    return any(name.startswith(prefix) for name in (*_MEMORY, *listed))


def loaded(content: bytes, opened: Callable[[str], Loaded]) -> Loaded:
    """What `opened` makes of the path of a library of that content, a copy that is nobody else's.

    Raises:
        OSError, RuntimeError: as `opened` does; it cannot be loaded.
    """
    try:
        with in_memory(content) as descriptor:
            # a path that has been opened before is, to the system's loader, the library it was then
            return opened(f"/proc/self{'/.' * next(_LOADS)}/fd/{descriptor}")
    except (OSError, RuntimeError):  # no such files here, or none that may be executed
        with room() as place:
            library = place / "library.so"
            library.write_bytes(content)
            return opened(str(library))


@contextmanager
def in_memory(content: bytes) -> Iterator[int]:
    """Descriptor of a file that is in memory alone. OSError where there are none."""
    if not hasattr(os, "memfd_create"):
        raise OSError(errno.ENOSYS, "no files in memory")
    descriptor = os.memfd_create("wetdoublet")
    try:
        write_all(descriptor, content)
        yield descriptor
    finally:
        os.close(descriptor)


@contextmanager
def room() -> Iterator[Path]:
    """A private folder with room to compile in, removed at the end, by the next process if this one is killed.

    Raises:
        OSError: there is none.
    """
    own = folder()
    with ExitStack() as stack:
        for place, prefix in ((own, _MAKING), *((root, TEMPORARY) for root in temporary())):
            with suppress(OSError):
                if place == own:
                    place.mkdir(mode=0o700, parents=True, exist_ok=True)
                    if not _private(place):
                        continue
                _sweep(place, prefix)
                if shutil.disk_usage(place).free >= _ROOM:
                    path = stack.enter_context(held_folder(place, prefix))
                    break
        else:
            raise OSError(errno.ENOSPC, "no room to compile in", str(own))
        yield path


# ---- reading


def _found(name: str) -> bytes | None:
    if name in _MEMORY:
        return _MEMORY[name]
    stem, _, suffix = name.rpartition(".")
    for shelf in _shelves():
        for file in _names(shelf):
            first, _, digest = file.removesuffix(f".{suffix}").rpartition(".")
            if first == stem and file.endswith(f".{suffix}"):
                content = _whole(shelf / file, digest)
                if content is not None:
                    return content
    return None


def _shelves() -> Iterator[Path]:
    """Folders with entries: the user's, and the one of this run if there is one."""
    own, private = folder(), os.environ.get(_PRIVATE)
    for shelf in (own, *([Path(private)] if private else [])):
        with suppress(OSError):
            if _private(shelf):
                yield shelf


def _names(shelf: Path) -> list[str]:
    try:
        return os.listdir(shelf)  # noqa: PTH208 # names, of which there may be thousands
    except OSError:
        return []


def _whole(path: Path, digest: str) -> bytes | None:
    """Content of a file if it is the one that was written; else the file is removed, and None."""
    content = None
    try:
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with os.fdopen(os.open(path, flags), "rb") as file:
            found = os.fstat(file.fileno())
            if stat.S_ISREG(found.st_mode) and found.st_size <= _LARGEST and _alone(found):
                content = file.read()
    except OSError as error:
        if error.errno != errno.ELOOP:  # gone, or not to be read now: nothing is known against it
            return None
    if content is not None and _digest(content) == digest:
        return content
    try:
        path.unlink()
        say(f"{path} was damaged: it is made again", only_here=True)  # only one process has removed it
    except FileNotFoundError:
        pass
    except OSError as error:
        say_once(f"{path} is damaged and cannot be removed ({error.strerror}): it is not used")
    return None


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]


def _private(shelf: Path) -> bool:
    """Whether only this user can write to a folder. OSError if there is none."""
    return _alone(shelf.stat())


def _alone(found: os.stat_result) -> bool:
    if os.name != "posix":
        return True
    return found.st_uid == os.getuid() and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


# ---- writing


def settle() -> None:
    """Find out where entries can be written, and say it, before workers do: they are hushed, and share the place."""
    own = folder()
    with _LOCK:
        if own not in _REFUSED and (reason := _written(own, "", bytes(_PROBE))):
            _refuse(own, reason, os.environ.get(_PRIVATE) or _moved("", bytes(_PROBE)))


def _put(name: str, content: bytes) -> None:
    """Put an entry down, in the first place that takes it."""
    own = folder()
    with _LOCK:
        reason = "" if own in _REFUSED else _written(own, name, content)
        if own not in _REFUSED and not reason:
            return
        private = os.environ.get(_PRIVATE)
        where = private if private and not _written(Path(private), name, content) else _moved(name, content)
        if where is None:
            _MEMORY[name] = content
        if own not in _REFUSED:
            _refuse(own, reason, where)


def _refuse(own: Path, reason: str, where: str | None) -> None:
    _REFUSED.add(own)
    kept_in = "in memory" if where is None else f"in {where}"
    say(f"{own}: {reason}; what is derived or compiled is kept {kept_in} while this runs")


def _written(place: Path, name: str, content: bytes) -> str:
    """Write an entry, or without a name only try to; the reason why it cannot be, or ""."""
    stem, _, suffix = name.rpartition(".")
    try:
        if place == folder():
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _private(place):
            return "others can write to it"
        _sweep(place, _MAKING)
        with held_file(place, _MAKING) as (descriptor, beside):
            write_all(descriptor, content)
            if name:
                beside.replace(place / f"{stem}.{_digest(content)}.{suffix}")
    except OSError as error:
        return error.strerror or str(error)
    return ""


def _moved(name: str, content: bytes) -> str | None:
    """Make a private folder for this run and put an entry there; its path, or None if no place takes it."""
    for root in temporary():
        stack = ExitStack()
        with suppress(OSError):
            _sweep(root, TEMPORARY)
            place = stack.enter_context(held_folder(root, TEMPORARY))
            if not _written(place, name, content):
                os.environ[_PRIVATE] = str(place)
                atexit.register(_leave, stack, os.getpid())
                return str(place)
        stack.close()
    return None


def _leave(stack: ExitStack, owner: int) -> None:
    if os.getpid() == owner:  # no fork of it
        stack.close()


@cache
def _sweep(place: Path, prefix: str) -> None:
    """Once a process."""
    sweep(place, prefix)
