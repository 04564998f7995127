"""Symbolic identities of the derivation, as findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ..host.emitted import DERIVING
from ..model.model import select_model
from .report import Finding

if TYPE_CHECKING:
    from ...derive.checks import Check
    from ..scene.scene import Scene
    from ..scene.user_model import Package


def symbolic(scene: Scene | None = None) -> Iterator[Finding]:
    """Findings of `derive.checks` (imports sympy) for the laws of `scene`, or for all laws of the library.

    The checks of a user's laws follow these.
    """
    from ...derive.checks import symbolic_checks
    from ...derive.physics.laws import LAWS

    chosen = select_model(scene, oblique=True, full=True).laws if scene is not None else ()
    laws = {slot: LAWS[slot][name] for slot, name in chosen if name in LAWS[slot]}
    for check in _alone(symbolic_checks(laws)):
        yield Finding("Symbolic", check.name, check.statement, check.figure, "", check.ok)
    if scene is not None and scene.package is not None:
        yield from of_the_model(scene.package)


def _alone(checks: Iterable[Check]) -> Iterator[Check]:
    """Run the checks one by one, locked against derivations in other threads."""
    left = iter(checks)
    while True:
        with DERIVING:
            check = next(left, None)
        if check is None:
            return
        yield check


def of_the_model(package: Package) -> Iterator[Finding]:
    """Findings of the checks of a user's model, from its model file."""
    from ...derive.checks.user import model_checks

    with DERIVING:
        _, checks = model_checks(Path(f"{package.name}.py"), package.source, package.name)
    for check in checks:
        yield Finding(f"Model: {package.name}", check.name, check.statement, check.figure, "", check.ok)
