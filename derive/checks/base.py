"""Checks: a statement, and expressions that must vanish identically for it to hold."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..vocabulary.quantities import VOCABULARY


@dataclass(frozen=True)
class Check:
    """A statement about the derivation, its result (None: reported, not required), and the figure found."""

    name: str
    statement: str
    ok: bool | None
    figure: str


def vanishing(name: str, statement: str, left: list[sp.Expr], figure: str = "", *, holds: bool | None = True) -> Check:
    """A check that every expression of `left` vanishes identically; the first that does not is the figure.

    Arguments:
        holds: the value of `ok` if they do; None for a known violation, which is reported but not required to pass.
    """
    rest = next((value for value in map(settled, left) if value != 0), None)  # the others may be expensive to simplify
    shown = figure or (f"{len(left)} identities" if len(left) > 1 else "identity")
    if rest is not None:
        return Check(name, statement, False, f"left over: {readable(rest)}")
    return Check(name, statement, holds, shown)


def settled(expression: sp.Expr) -> sp.Expr:
    """Zero if the expression vanishes identically: expanded, as one fraction, or simplified if neither shows it."""
    quick = sp.expand(expression)
    if quick == 0:
        return quick
    top, _ = sp.fraction(sp.together(expression))  # not of the expanded form, whose terms have a denominator each
    if sp.expand(top) == 0:
        return sp.Integer(0)
    return sp.simplify(sp.factor(quick))


def readable(expression: sp.Expr) -> str:
    """The expression as text, with the literature's symbols for quantities."""
    short = {
        quantity.symbol: sp.Symbol(_plain(quantity.latex))
        for name, quantity in VOCABULARY.items()
        if quantity.symbol in expression.free_symbols and any(quantity.dimension.exponents)
    }
    return str(expression.xreplace(short))


def _plain(latex: str) -> str:
    return latex.replace("\\", "").replace("_", "").replace("{", "").replace("}", "").replace(",", "")
