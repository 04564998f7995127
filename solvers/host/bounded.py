"""Reading of files named by users, within bounds of size and nesting depth."""

import os
import re
import stat
from pathlib import Path

from ..errors import InputError

LARGEST = 1_000_000  # bytes; most of a model file or an emitted file

_DEEPEST = 8  # nested tables; a scene has one level
_TEXT = re.compile(  # comments and the four kinds of TOML strings; an unclosed string extends to the end
    r'#[^\n]*|"""(?:\\.|[^\\])*?(?:"{3,5}|\Z)|\'\'\'.*?(?:\'{3,5}|\Z)|"(?:\\.|[^"\\\n])*"?|\'[^\'\n]*\'?', re.DOTALL
)
_KEY = r"(?:[\w-]++|\"\")"
_CHAIN = re.compile(rf"(?<![\w-]){_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{_DEEPEST}}}")


is_folder, is_file, exists = os.path.isdir, os.path.isfile, os.path.exists
"""What of that name exists; False also for invalid names, unlike the methods of a path."""


def read(source: str | Path, most: int, label: str, accepted: str, absent: str = "is no file") -> bytes:
    """Return the content of a file of at most `most` bytes; also of `/dev/stdin` and pipes of process substitution.

    Arguments:
        label, accepted: field of an error, and what is accepted.
        absent: what is wrong where there is nothing of that name.

    Raises:
        InputError: absent, too large, a named pipe, or cannot be opened.
    """
    try:
        path = Path(source)
        piped = stat.S_ISFIFO(path.stat().st_mode) and path.parts[:2] != ("/", "dev")
        problem = "is a named pipe"  # which would be waited for
        if not piped:
            with path.open("rb") as file:
                content = file.read(most + 1)
            if len(content) <= most:
                return content
            problem = f"is larger than {most} bytes"
    except FileNotFoundError:
        problem = absent
    except (OSError, ValueError) as error:  # for instance a folder; ValueError: a null byte in the name
        problem = f"cannot be read ({getattr(error, 'strerror', None) or error})"
    raise InputError(label, str(source), accepted, problem)


def text(path: Path) -> str:
    """Return the text of an emitted file; ValueError if it is nested too deeply or cannot be read."""
    content = read(path, LARGEST, "file", "an emitted file").decode()
    if path.suffix == ".json" and too_deep(content):
        raise ValueError("is nested too deeply")
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
