"""What a check is: a statement, and the expressions that must vanish identically for it to hold."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Check:
    """A statement about the derivation, whether it holds, and what was found."""

    name: str
    statement: str
    ok: bool
    figure: str


def vanishing(name: str, statement: str, left: list[sp.Expr], figure: str = "") -> Check:
    """A check that every expression of `left` vanishes identically; the first that does not is the figure."""
    rest = [value for value in map(_settled, left) if value != 0]
    shown = figure or (f"{len(left)} identities" if len(left) > 1 else "identity")
    return Check(name, statement, not rest, f"left over: {rest[0]}" if rest else shown)


def _settled(expression: sp.Expr) -> sp.Expr:
    """Zero if the expression vanishes identically: expanded, and simplified only where that is not enough."""
    quick = sp.expand(expression)
    if quick == 0:
        return quick
    return sp.simplify(sp.factor(quick))
