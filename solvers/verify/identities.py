"""The identities of the derivation, as findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..model import choose
from .report import Finding

if TYPE_CHECKING:
    from ..scene import Scene


def symbolic(scene: Scene | None = None) -> Iterator[Finding]:
    """The checks of `derive.checks` (which loads sympy), for the laws of `scene`, or for all of the library's."""
    from ...derive.checks import symbolic_checks
    from ...derive.laws import LAWS

    chosen = choose(scene, oblique=True, full=True).laws if scene is not None else ()
    for check in symbolic_checks({slot: LAWS[slot][name] for slot, name in chosen}):
        yield Finding("Symbolic", check.name, check.statement, check.figure, "", check.ok)
