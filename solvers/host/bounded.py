"""Reading of files named by users, within bounds of size and nesting depth."""

import os
import re
import stat
from pathlib import Path

LARGEST = 1_000_000  # bytes; most of a model file or an emitted file

_PART = 65536
_DEEPEST = 8  # nested tables; a scene has one level
_TEXT = re.compile(  # comments and the four kinds of TOML strings; an unclosed string extends to the end
    r'#[^\n]*|"""(?:\\.|[^\\])*?(?:"{3,5}|\Z)|\'\'\'.*?(?:\'{3,5}|\Z)|"(?:\\.|[^"\\\n])*"?|\'[^\'\n]*\'?', re.DOTALL
)
_KEY = r"(?:[\w-]++|\"\")"
_CHAIN = re.compile(rf"(?<![\w-]){_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{_DEEPEST}}}")


class NotRead(Exception):
    """The reason why a file cannot be read, worded to follow its name."""


is_folder, is_file, exists = os.path.isdir, os.path.isfile, os.path.exists
"""What of that name exists; False also for invalid names, unlike the methods of a path."""


def read(path: Path, most: int) -> bytes:
    """Return the content of a file of at most `most` bytes; also of `/dev/stdin` and pipes of process substitution.

    Raises:
        NotRead: too large, a named pipe, or cannot be opened.
        FileNotFoundError: there is nothing of that name.
    """
    try:
        # without O_NONBLOCK, open() of a pipe would wait for its writer
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0))
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        raise NotRead(f"cannot be read ({getattr(error, 'strerror', None) or error})") from None
    try:
        if stat.S_ISFIFO(os.fstat(descriptor).st_mode) and path.parts[:2] != ("/", "dev"):
            raise NotRead("is a named pipe")
        if hasattr(os, "O_NONBLOCK"):  # elsewhere nothing was opened so, and files cannot be set
            os.set_blocking(descriptor, True)
        content = b""
        while len(content) <= most and (chunk := os.read(descriptor, _PART)):
            content += chunk
    except OSError as error:  # for instance a folder
        raise NotRead(f"cannot be read ({error.strerror or error})") from None
    finally:
        os.close(descriptor)
    if len(content) > most:
        raise NotRead(f"is larger than {most} bytes")
    return content


def text(path: Path) -> str:
    """Return the text of an emitted file; NotRead if it is nested too deeply, OSError or ValueError if unreadable."""
    content = read(path, LARGEST).decode()
    if path.suffix == ".json" and too_deep(content):
        raise NotRead("is nested too deeply")
    return content


def depth(text: str) -> int:
    """Return an upper bound of the nesting depth of TOML or JSON: nested brackets, and dotted keys.

    Parsers recurse over brackets, and need time and memory quadratic in dotted keys, so this is checked before parsing.
    """
    bare = _TEXT.sub('""', text)
    level = deepest = 0
    for bracket in re.findall(r"[\[\]{}]", bare):
        level = level + 1 if bracket in "[{" else max(0, level - 1)
        deepest = max(deepest, level)
    return _DEEPEST + 1 if _CHAIN.search(bare) else deepest


def too_deep(text: str) -> bool:
    """True if text is nested more deeply than any accepted file."""
    return depth(text) > _DEEPEST
