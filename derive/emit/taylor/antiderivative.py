"""Antiderivatives of force laws by a few simple rules: powers, exponentials, gap over a root."""

from __future__ import annotations

import sympy as sp


def antiderivative(force: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    """The antiderivative of `force` in `variable`, verified by differentiation; None if no rule applies to a term."""
    total = sp.Integer(0)
    for term in sp.Add.make_args(sp.expand(force, power_exp=False, power_base=False, log=False, trig=False)):
        part = _of_term(term, variable)
        if part is None:
            return None
        total += part
    residue = sp.simplify(sp.expand(total.diff(variable) - force))
    return total if residue == 0 else None


def _of_term(term: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    still, moving = term.as_independent(variable, as_Add=False)
    if moving == 1:
        return still * variable
    if moving.is_Pow and moving.base == variable and moving.exp != -1 and not moving.exp.has(variable):
        return still * variable ** (moving.exp + 1) / (moving.exp + 1)
    if moving == 1 / variable:
        return still * sp.log(variable)
    if moving == variable:
        return still * variable**2 / 2
    if isinstance(moving, sp.exp):
        slope = moving.args[0].diff(variable)
        return None if slope.has(variable) or slope == 0 else still * moving / slope
    return _gap_over_root(still, moving, variable)


def _gap_over_root(still: sp.Expr, moving: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    """The rule h/sqrt(q) -> 2 sqrt(q)/(q'/h), for q' proportional to h."""
    roots = [part for part in sp.Mul.make_args(moving) if part.is_Pow and part.exp == -sp.Rational(1, 2)]
    if len(roots) != 1 or sp.simplify(moving * sp.sqrt(roots[0].base)) != variable:
        return None
    share = sp.simplify(roots[0].base.diff(variable) / variable)
    return None if share.has(variable) else still * 2 * sp.sqrt(roots[0].base) / share
