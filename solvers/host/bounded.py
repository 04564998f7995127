"""Files that users name, read within bounds: of size, of time, and of how deeply what they hold is nested."""

from __future__ import annotations

import os
import re
import select
import stat
import time
from pathlib import Path

UNOPENED = 0.7  # s: a pipe that nobody has opened for writing by then is not waited for
SILENT = 60.0  # s: what has not been delivered as a whole by then is given up

LARGEST = 1_000_000  # bytes of a model file, or of anything that is emitted

_PART = 65536
_DEEPEST = 8  # tables within tables: a scene has one
_TEXT = re.compile(  # comments and the four kinds of strings of TOML, one that is not closed up to its end
    r'#[^\n]*|"""(?:\\.|[^\\])*?(?:"{3,5}|\Z)|\'\'\'.*?(?:\'{3,5}|\Z)|"(?:\\.|[^"\\\n])*"?|\'[^\'\n]*\'?',
    re.DOTALL,
)
_KEY = r"(?:[\w-]++|\"\")"
_CHAIN = re.compile(rf"(?<![\w-]){_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{_DEEPEST}}}")


class NotRead(Exception):
    """Why a file cannot be read, in words that follow its name."""


def is_folder(path: str | Path) -> bool:
    """Whether there is a folder of that name, which may be none that a file system takes."""
    return stat.S_ISDIR(_mode(path))


def is_file(path: str | Path) -> bool:
    """Whether there is a file of that name, no pipe or device."""
    return stat.S_ISREG(_mode(path))


def exists(path: str | Path) -> bool:
    """Whether there is anything of that name."""
    return _mode(path) != 0


def _mode(path: str | Path) -> int:
    try:
        return os.stat(path).st_mode  # noqa: PTH116 # a Path cannot be made of everything
    except (OSError, ValueError):  # there is none, or it cannot be: too long, with a null byte
        return 0


def read(path: Path, most: int, unopened: float = UNOPENED, silent: float = SILENT) -> bytes:
    """Return the content of a file, a pipe or a device.

    Arguments:
        path: what to read; `/dev/stdin` and the pipes of process substitution are files too.
        most: bytes; more is refused, whatever else would still come.
        unopened: s to wait until something has opened a pipe for writing.
        silent: s in which a pipe must have delivered everything.

    Raises:
        NotRead: larger, too slow, or not to be opened; FileNotFoundError if there is nothing of that name.
    """
    try:
        # without O_NONBLOCK the opening of a pipe waits for its writer
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0))
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        raise NotRead(f"cannot be read ({getattr(error, 'strerror', None) or error})") from None
    try:
        kind = os.fstat(descriptor).st_mode
        waits = stat.S_ISFIFO(kind) or stat.S_ISCHR(kind)
        content = _delivered(descriptor, most, unopened, silent) if waits else _whole(descriptor, most)
    except OSError as error:  # a folder, among others
        raise NotRead(f"cannot be read ({error.strerror or error})") from None
    finally:
        os.close(descriptor)
    if len(content) > most:
        raise NotRead(f"is larger than {most} bytes")
    return content


def _whole(descriptor: int, most: int) -> bytes:
    """At most a byte too many of a file that does not wait."""
    content = b""
    while len(content) <= most and (part := os.read(descriptor, _PART)):
        content += part
    return content


def _delivered(descriptor: int, most: int, unopened: float, silent: float) -> bytes:
    """What a pipe or a terminal delivers until its end."""
    begun = time.monotonic()
    content, met = b"", False  # met: somebody writes, or has written
    while len(content) <= most:
        left = (silent if met else unopened) - (time.monotonic() - begun)
        ready = bool(select.select([descriptor], [], [], max(0.0, left))[0])
        try:
            part = os.read(descriptor, _PART)
        except BlockingIOError:  # a writer is there and has nothing to say yet
            if met and left <= 0:
                raise NotRead(f"did not deliver everything within {silent:g} s") from None
            met = True
            continue
        if not part and not ready and not met:
            raise NotRead(f"is a pipe that nothing has opened for writing within {unopened:g} s")
        if not part:
            break
        content, met = content + part, True
    return content


def text(path: Path) -> str:
    """Return the text of an emitted file; NotRead if it is nested too deeply, OSError or ValueError if it is none."""
    content = read(path, LARGEST).decode()
    if path.suffix == ".json" and too_deep(content):
        raise NotRead("is nested too deeply")
    return content


def depth(text: str) -> int:
    """Return how deeply TOML (or JSON) is nested, at most: brackets within brackets, and keys with dots in them.

    Parsers recurse into the first and take the square of the second in time and memory, so it is asked before them.
    """
    bare = _TEXT.sub('""', text)
    level = deepest = 0
    for bracket in re.findall(r"[\[\]{}]", bare):
        level = level + 1 if bracket in "[{" else max(0, level - 1)
        deepest = max(deepest, level)
    return _DEEPEST + 1 if _CHAIN.search(bare) else deepest


def too_deep(text: str) -> bool:
    """Whether text is nested more deeply than anything that is read here."""
    return depth(text) > _DEEPEST
