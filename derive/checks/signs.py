"""Proofs that an expression is not negative, by products of squares and of factors with known sign on a region."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

_beyond = sp.Symbol("y", nonnegative=True)


@dataclass(frozen=True)
class Sign:
    """The result of a proof about the sign of an expression on a region.

    Arguments:
        proved: True if the expression is never negative, False if it is negative at `shown`, None if undecided.
        shown: the product that proves it, or the point that refutes it.
    """

    proved: bool | None
    shown: str


def nonnegative(expression: sp.Expr, variable: sp.Symbol, edge: sp.Expr) -> Sign:
    """Proof that `expression` is >= 0 for 0 < variable <= edge, other symbols by their own assumptions.

    The proof uses the expression as given, or with variable = edge/(1 + y) or edge exp(-y), y >= 0, which is the same
    region: a product of even powers, exponentials and nonnegative symbols, or a quotient of sums of such. If that fails
    it is evaluated on a grid, where a negative value refutes it.
    """
    ways = (("", variable), (f"{edge}/(1 + y)", edge / (1 + _beyond)), (f"{edge} exp(-y)", edge * sp.exp(-_beyond)))
    for text, value in ways:
        form = sp.factor(sp.expand_log(sp.simplify(expression.subs(variable, value))))
        if _known(form):
            where = f" with {variable} = {text}, y >= 0" if text else ""
            return Sign(True, f"{form}{where}")
    return _sampled(expression, variable, edge)


def _known(form: sp.Expr) -> bool:
    """True if sympy knows the sign of each factor, or of each term of numerator and denominator when expanded."""
    if form.is_nonnegative:
        return True
    top, bottom = sp.fraction(sp.together(form))
    return all(factor.is_nonnegative or sp.expand(factor).is_nonnegative for factor in (top, bottom))


def _sampled(expression: sp.Expr, variable: sp.Symbol, edge: sp.Expr) -> Sign:
    others = sorted(expression.free_symbols - {variable}, key=str)
    for base in (sp.Rational(1, 3), sp.Rational(7, 5), sp.Rational(-2, 3)):
        values = [base + sp.sign(base) * sp.Rational(index, 7) for index in range(len(others))]
        fixed = {s: abs(value) if s.is_nonnegative else value for s, value in zip(others, values, strict=True)}
        rim = sp.sympify(edge).subs(fixed)
        for k in range(1, 40):
            at = rim * sp.Rational(k, 40)
            value = sp.N(expression.subs(fixed).subs(variable, at))
            if not value.is_real or value < 0:
                places = {variable: sp.N(at, 3), **fixed}
                point = ", ".join(f"{symbol} = {number}" for symbol, number in places.items())
                return Sign(False, f"{sp.N(value, 3)} at {point}")
    return Sign(None, "no proof found, and no negative value on a grid either")


def positive(expression: sp.Expr) -> bool | None:
    """True if a quotient of polynomials in non-negative symbols has non-negative coefficients only."""
    top, bottom = sp.fraction(sp.together(sp.expand(expression)))
    return all(
        all(coefficient >= 0 for coefficient in sp.Poly(part, *sorted(part.free_symbols, key=str)).coeffs())
        if part.free_symbols
        else part > 0
        for part in (sp.expand(top), sp.expand(bottom))
    )
