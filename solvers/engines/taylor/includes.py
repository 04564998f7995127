"""C files that include one another as one text: what a compiler sees of a kernel, and what names it in the cache."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

RUNTIME = Path(__file__).resolve().parent / "runtime"
_LINE = re.compile(r'^(?:#pragma once\n|#include "([^"]+)"\n)', re.MULTILINE)


def included(text: str) -> list[str]:
    """Files that a C text includes by `#include "..."`, in its order."""
    return [name for name in _LINE.findall(text) if name]


def resolved(text: str, made: Mapping[str, str]) -> str:
    r"""A C text with each file that it includes put in its place, once, where it is first asked for.

    What is included stands outside any condition: a file that a variant does without says so itself.

    Arguments:
        made: texts of the files that are not in the runtime's folder, by name.

    Examples:
        >>> resolved('#include "settings.h"\nint order = ORDER;\n', {"settings.h": "#define ORDER 9\n"})
        '#define ORDER 9\nint order = ORDER;\n'
    """
    seen: set[str] = set()

    def put(found: re.Match[str]) -> str:
        name = found[1]
        if name is None or name in seen:
            return ""
        seen.add(name)
        own = made[name] if name in made else (RUNTIME / name).read_text()
        return _LINE.sub(put, own)

    return _LINE.sub(put, text)
