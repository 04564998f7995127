"""The emitted C headers of a scene's model: committed, or derived on first use and cached; and what has none."""

from __future__ import annotations

import sys
from functools import cache

from .. import emitted
from ..model import Choice

_NONE = "#error "  # how a header begins that could not be emitted


@cache
def headers(choice: Choice) -> tuple[str, ...] | None:
    """Texts of the headers of a choice, laws first; None where a law has no recurrence, which is said once."""
    texts = [_law(choice, slot, name) for slot, name in choice.laws]
    texts.append(_structure(choice))
    for text in texts:
        if text.startswith(_NONE):
            _say(text.removeprefix(_NONE).strip())
            return None
    return tuple(texts)


@cache  # the files are the package's own
def tangents(choice: Choice) -> tuple[str, ...] | None:
    """Texts of the headers with the derivatives of a choice, laws first; None where they are not emitted."""
    paths = [f"taylor/tangent/laws/{slot}_{name.replace('-', '_')}.h" for slot, name in choice.laws]
    paths.append(f"taylor/tangent/{choice.structure}.h")
    known = choice.package is None and all(map(emitted.committed, paths))
    return tuple(map(emitted.header, paths)) if known else None


def _law(choice: Choice, slot: str, name: str) -> str:
    package = choice.package
    if package is not None and (name in package.laws(slot) or package.changes((slot,))):
        return package.law_header(slot, name)
    return emitted.header(f"taylor/laws/{slot}_{name.replace('-', '_')}.h")


def _structure(choice: Choice) -> str:
    package, slots = choice.package, tuple(slot for slot, _ in choice.laws)
    if package is not None and package.changes(slots):
        return package.structure_header(choice.structure)
    return emitted.header(f"taylor/{choice.structure}.h")


@cache  # once a process
def _say(why: str) -> None:
    sys.stderr.write(f"no Taylor kernel ({why}): other engines answer\n")
