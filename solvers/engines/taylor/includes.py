"""Expansion of #include lines: the complete source of a kernel, for its compilation and its name in the cache."""

import re
from collections.abc import Mapping
from pathlib import Path

RUNTIME = Path(__file__).resolve().parent / "runtime"
_LINE = re.compile(r'#(?<![^\n]#)(?:pragma once\n|include "([^"]+)"\n)')  # a search for "#" is faster than for lines


def included(text: str) -> list[str]:
    """Files that a C text includes by `#include "..."`, in order."""
    return [name for name in _LINE.findall(text) if name]


def resolved(source: str, texts: Mapping[str, str]) -> str:
    r"""A C text with each included file inserted once, at its first #include.

    Includes must be unconditional: a file that a variant does not need contains the condition itself.

    Arguments:
        texts: of the files that are not in the runtime's folder, by name.

    Examples:
        >>> resolved('#include "settings.h"\nint order = ORDER;\n', {"settings.h": "#define ORDER 9\n"})
        '#define ORDER 9\nint order = ORDER;\n'
    """
    seen: set[str] = set()

    def put(line: re.Match[str]) -> str:
        name = line[1]
        if name is None or name in seen:
            return ""
        seen.add(name)
        text = texts[name] if name in texts else (RUNTIME / name).read_text()
        return _LINE.sub(put, text)

    return _LINE.sub(put, source)
