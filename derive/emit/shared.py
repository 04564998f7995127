"""Functions that several structures share: emitted once, and imported, or included, by the others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import PurePosixPath

from ..equations.model import Model
from .casadi.modules import function_lines
from .casadi.printer import Printer

_LEAST = 8  # lines of a C function that is worth a file of its own
_C_FUNCTION = re.compile(
    r"(?:/\*.*?\*/\n)?(?:static inline|INLINE|OUTLINE) [^;{]*?(\w+)\([^;{]*\)\n\{\n.*\n\}", re.DOTALL
)


def homes(models: Iterable[Model]) -> dict[str, str]:
    """Text of every Python function of several structures -> name of the first one, which defines it."""
    first: dict[str, str] = {}
    for model in models:
        for function in model.functions:
            first.setdefault("\n".join(function_lines(model, function.name, Printer())), model.structure.name)
    return first


def with_shared_functions(headers: Mapping[str, str], provenance: str) -> dict[str, str]:
    """C headers whose common functions are included from `taylor/shared/`, and the files there.

    Arguments:
        headers: texts by path; functions are set apart by blank lines.
        provenance: the first line of a file.
    """
    users: dict[str, list[str]] = {}
    for path, text in headers.items():
        for block in text.rstrip("\n").split("\n\n"):
            if block.count("\n") + 1 >= _LEAST and _C_FUNCTION.fullmatch(block):
                users.setdefault(block, []).append(path)
    files = dict(headers)
    for block, paths in users.items():
        if len(paths) > 1:
            function = _C_FUNCTION.fullmatch(block)
            assert function is not None
            name = f"shared/{function[1]}_{PurePosixPath(paths[0]).stem}.h"
            files[f"taylor/{name}"] = f"{provenance}{block}\n"
            for path in paths:
                files[path] = files[path].replace(f"\n{block}\n", f'\n#include "{name}"\n')
    return files
