"""The identities of the derivation, as findings."""

from __future__ import annotations

from collections.abc import Iterator

from .report import Finding


def symbolic() -> Iterator[Finding]:
    """The checks of `derive.checks`, which loads sympy."""
    from ...derive.checks import symbolic_checks

    for check in symbolic_checks():
        yield Finding("Symbolic", check.name, check.statement, check.figure, "", check.ok)
