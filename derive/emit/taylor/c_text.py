"""C text of expressions over lanes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.law import is_slot_call
from ..casadi.printer import EmissionError, signed_sum

_FUNCTIONS = {
    sp.exp: "vec_exp", sp.log: "vec_log", sp.sin: "vec_sin", sp.cos: "vec_cos", sp.tan: "vec_tan", sp.atan: "vec_atan",
    sp.Abs: "vec_abs",
}  # fmt: skip
_EXTREMES = {sp.Max: "vec_larger", sp.Min: "vec_smaller"}
_TINY = sp.Float("1e-300")
_ADD, _MUL, _ATOM = range(3)


class Text:
    """Printer of expressions as C text over lanes; `names` maps symbols to C names.

    Arguments:
        calls: for slot functions whose constant arguments are prepared: the call up to its varying argument, and the
            position of that argument.
    """

    def __init__(self, names: Callable[[sp.Symbol], str], calls: Mapping[str, tuple[str, int]] | None = None) -> None:
        self._names, self._calls = names, calls or {}

    def __call__(self, expression: sp.Expr) -> str:
        return self._print(sp.sympify(expression))[0]

    def vector(self, expression: sp.Expr) -> str:
        """The expression as a vector, also if it is a number."""
        text = self(expression)
        return f"splat({text})" if not expression.free_symbols else text

    def _print(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Symbol):
            return self._names(node), _ATOM
        if node.is_number and not node.free_symbols and not node.has(AppliedUndef):
            return number(node), _ATOM
        if isinstance(node, sp.Add):
            return self._sum(node), _ADD
        if isinstance(node, sp.Mul):
            return self._product(node), _MUL
        if isinstance(node, sp.Pow):
            return self._power(node)
        if type(node) in _EXTREMES:
            first, *others = (self.vector(argument) for argument in node.args)
            for other in others:
                first = f"{_EXTREMES[type(node)]}({first}, {other})"
            return first, _ATOM
        if isinstance(node, AppliedUndef) and is_slot_call(node):
            if node.func.__name__ in self._calls:
                call, position = self._calls[node.func.__name__]
                return f"{call}{self.vector(node.args[position])})", _ATOM
            arguments = ", ".join(self.vector(argument) for argument in node.args)
            return f"{node.func.__name__.replace('.', '_')}({arguments})", _ATOM
        if type(node) in _FUNCTIONS:
            return f"{_FUNCTIONS[type(node)]}({self(node.args[0])})", _ATOM
        if isinstance(node, sp.tanh):
            return self._print(1 - 2 / (1 + sp.exp(2 * node.args[0])))
        if isinstance(node, sp.sign):
            return self._print(node.args[0] / sp.Max(sp.Abs(node.args[0]), _TINY))
        if isinstance(node, sp.Heaviside):  # of the derivatives of Max and Min
            return self._print((1 + sp.sign(node.args[0])) / 2)
        raise EmissionError(f"no lane-wise C for {type(node).__name__}: {node}")

    def _at_least(self, node: sp.Basic, strength: int) -> str:
        text, binding = self._print(node)
        return text if binding >= strength else f"({text})"

    def _sum(self, node: sp.Add) -> str:
        terms = sorted(node.as_ordered_terms(), key=lambda term: term.could_extract_minus_sign())
        return signed_sum(terms, lambda term: self._at_least(term, _MUL))

    def _product(self, node: sp.Mul) -> str:
        over: list[str] = []
        under: list[str] = []
        sign = ""
        for factor in _roots_together(node):
            if factor == -1:
                sign = "-"
            elif isinstance(factor, sp.Pow) and factor.exp.is_number and factor.exp.is_negative:
                under.append(self._at_least(sp.Pow(factor.base, -factor.exp), _ATOM))
            else:
                over.append(self._at_least(factor, _ATOM))
        top = sign + ("*".join(over) or "1.0")
        if not under:
            return top
        return f"{top}/{under[0]}" if len(under) == 1 else f"{top}/({'*'.join(under)})"

    def _power(self, node: sp.Pow) -> tuple[str, int]:
        base, exponent = node.args
        if exponent == sp.Rational(1, 2):
            return f"vec_sqrt({self(base)})", _ATOM
        if isinstance(base, sp.UnevaluatedExpr):
            base = base.args[0]
        if exponent.is_number and exponent.is_negative and exponent.is_Integer:
            return f"1.0/{self._at_least(sp.Pow(base, -exponent), _ATOM)}", _MUL
        if exponent.is_Integer and 2 <= exponent <= 4:
            return "(" + "*".join([self._at_least(base, _ATOM)] * int(exponent)) + ")", _ATOM
        return f"vec_exp({self._at_least(exponent, _ATOM)}*vec_log({self.vector(base)}))", _ATOM


def _roots_together(node: sp.Mul) -> list[sp.Expr]:
    """Factors of a product; those with the same fractional power share one logarithm, numbers come first."""
    factors: list[sp.Expr] = []
    below: dict[sp.Expr, list[sp.Expr]] = {}
    for factor in node.as_ordered_factors():
        broken = isinstance(factor, sp.Pow) and factor.exp.is_Rational and not factor.exp.is_Integer
        if not broken or factor.base.is_number or abs(factor.exp) == sp.Rational(1, 2):
            factors.append(factor)
        else:
            power = abs(factor.exp)
            below.setdefault(power, []).append(factor.base if factor.exp > 0 else 1 / factor.base)
    roots = [sp.Pow(sp.UnevaluatedExpr(sp.Mul(*bases)), power, evaluate=False) for power, bases in below.items()]
    return factors + roots


def number(value: sp.Expr) -> str:
    """The nearest double of a number, as a C literal."""
    text = repr(float(value.evalf(30)))
    return f"({text})" if text.startswith("-") else text
