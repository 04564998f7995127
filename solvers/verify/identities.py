"""Symbolic identities of the derivation, as findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..host.emitted import DERIVING
from ..model.model import select_model
from .report import Finding
from .verdicts import kept_verdicts, symbolic_key

if TYPE_CHECKING:
    from ...derive.checks import Check
    from ..scene.scene import Scene
    from ..scene.user_model import Package


def symbolic(scene: Scene | None = None, recompute: bool = False) -> Iterator[Finding]:
    """Findings of `derive.checks` for the laws of `scene`, or for all laws of the library.

    They are cached (`verdicts`); sympy is imported only to compute them. The checks of a user's laws follow these and
    are always computed, because a model file may import modules that no digest covers.

    Arguments:
        recompute: compute them even if they are cached.
    """
    chosen = dict(select_model(scene, oblique=True, full=True).laws) if scene is not None else {}
    yield from kept_verdicts(symbolic_key(chosen), lambda: _made(chosen), recompute)
    if scene is not None and scene.package is not None:
        yield from of_the_model(scene.package)


def _made(chosen: Mapping[str, str]) -> Iterator[Finding]:
    from ...derive.checks import symbolic_checks
    from ...derive.physics.laws import LAWS

    laws = {slot: LAWS[slot][name] for slot, name in chosen.items() if name in LAWS[slot]}
    for check in _alone(symbolic_checks(laws)):
        yield Finding("Symbolic", check.name, check.statement, check.figure, "", check.ok)


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
