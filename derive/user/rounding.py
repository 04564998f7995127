"""Kinks of a law rounded, so that every engine integrates, differentiates and encloses the same smooth function.

`Abs`, `Max`, `Min`, `sign`, the conditions of a `Piecewise`, and powers, roots and logarithms of what may vanish have no
Taylor series at their kink. Each is replaced by a smooth function that differs from it by some WIDTH^2 over the distance
to the kink: |k| by sqrt(k^2 + WIDTH^2). Steps shrink in front of a kink and grow behind it, by a constant factor each, so
that it is passed in some hundred of them; derivatives pass with the motion, those of a step in the force included.
"""

from collections.abc import Collection, Iterable
from dataclasses import replace

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanFunction

from ..physics.laws.base import LawFunction
from ..vocabulary.quantities import normal_velocity

WIDTH = sp.Rational(1, 10**10)
_FLAT = (sp.Max, sp.Min, sp.Piecewise, sp.Heaviside)  # may vanish over a range, not only at a point


class RoundingError(ValueError):
    """A kink that cannot be rounded; the message names it and says what can."""


def rounded(function: LawFunction, still: Collection[sp.Symbol]) -> LawFunction:
    """A law's function with every kink rounded; the function itself if it has none.

    Arguments:
        still: its arguments that are constant along a trajectory.

    Raises:
        RoundingError: a condition that is no comparison of numbers.
    """
    rounding = _Rounding({argument for argument in function.arguments if argument not in still})
    definitions = []
    for symbol, value in function.definitions:
        definitions.append((symbol, rounding(value)))
        rounding.parts[symbol] = value.xreplace(rounding.parts)
    return replace(function, result=rounding(function.result), definitions=tuple(definitions))


class _Rounding:
    """`moving` are symbols that vary along a trajectory, `parts` named parts of the expression as they were written."""

    def __init__(self, moving: Collection[sp.Symbol]) -> None:
        self.moving = set(moving)
        self.parts: dict[sp.Basic, sp.Basic] = {}

    def __call__(self, node: sp.Expr) -> sp.Expr:
        if isinstance(node, sp.Piecewise):
            return self._piecewise(node)
        if isinstance(node, sp.Pow):
            return self._power(node)
        arguments = [self(argument) for argument in node.args]
        if isinstance(node, sp.Abs):
            return _root(arguments[0])
        if isinstance(node, sp.sign):
            return arguments[0] / _root(arguments[0])
        if isinstance(node, sp.Heaviside):
            return _step(arguments[0])
        if isinstance(node, (sp.Max, sp.Min)):
            return _extreme(arguments, 1 if isinstance(node, sp.Max) else -1)
        if isinstance(node, sp.log) and self._vanishes(node.args[0]):
            inner = node.args[0]
            return sp.log(_squared(self(inner.args[0] if isinstance(inner, sp.Abs) else inner))) / 2
        return node.func(*arguments) if node.args else node

    def _vanishes(self, base: sp.Expr) -> bool:
        """True if an expression may pass zero along a trajectory."""
        whole = base.xreplace(self.parts)
        return not whole.is_positive and bool(whole.free_symbols & self.moving)

    def _power(self, node: sp.Pow) -> sp.Expr:
        base, exponent = node.base, self(node.exp)
        if not self._vanishes(base):
            return self(base) ** exponent
        if isinstance(base, sp.Abs) and not (exponent.is_Integer and exponent.is_positive):
            return _squared(self(base.args[0])) ** (exponent / 2)
        inner = self(base)
        if not exponent.is_Integer:
            if isinstance(base, sp.Pow) and base.exp == 2:
                return _squared(self(base.base)) ** exponent
            if base.xreplace(self.parts).has(*_FLAT):  # stays zero where the base is
                return inner * _squared(inner) ** ((exponent - 1) / 2)
            return _squared(inner) ** (exponent / 2)
        if base == normal_velocity and exponent.is_negative:  # of a force that vanishes with it
            return (inner / _squared(inner)) ** -exponent
        return inner**exponent

    def _piecewise(self, node: sp.Piecewise) -> sp.Expr:
        *cases, (result, last) = node.args
        if last != sp.true:
            raise RoundingError(f"{node} says nothing elsewhere: end it with (value, True)")
        result = self(result)
        for value, condition in reversed(cases):
            holds = self._holds(condition)
            result = holds * self(value) + (1 - holds) * result
        return result

    def _holds(self, condition: sp.Basic) -> sp.Expr:
        """1 where a condition holds and 0 where it does not."""
        if condition in (sp.true, sp.false):
            return sp.Integer(condition == sp.true)
        if isinstance(condition, (sp.Eq, sp.Ne)):  # at a point, which a trajectory only passes
            return sp.Integer(isinstance(condition, sp.Ne))
        if isinstance(condition, Relational):
            return _step(self(condition.gts - condition.lts))
        parts = [self._holds(part) for part in condition.args] if isinstance(condition, BooleanFunction) else []
        if isinstance(condition, sp.And):
            return sp.Mul(*parts)
        if isinstance(condition, sp.Or):
            return 1 - sp.Mul(*(1 - part for part in parts))
        if isinstance(condition, sp.Not):
            return 1 - parts[0]
        raise RoundingError(f"the condition {condition} is no comparison; accepted: <, <=, >, >=, &, |, ~")


def _squared(inner: sp.Expr) -> sp.Expr:
    return inner**2 + WIDTH**2


def _root(inner: sp.Expr) -> sp.Expr:
    """|k|, with positive factors of k in front."""
    if inner.is_nonnegative:
        return inner
    factors = sp.Mul.make_args(sp.factor_terms(inner))
    outside = sp.Mul(*(factor for factor in factors if factor.is_positive))
    return outside * sp.sqrt(_squared(sp.Mul(*(factor for factor in factors if not factor.is_positive))))


def _step(inner: sp.Expr) -> sp.Expr:
    """1 where k > 0 and 0 where k < 0."""
    return (1 + inner / _root(inner)) / 2


def _extreme(values: Iterable[sp.Expr], sign: int) -> sp.Expr:
    first, *others = values
    for other in others:
        first = (first + other + sign * _root(first - other)) / 2
    return first
