"""A strict sympy-to-CasADi source printer: a whitelist of nodes; any other node is an error that names it.

sympy's own printers fall back on the node's name, and so emit functions that CasADi does not have (`erf`) or that have
another meaning (`and`).
"""

from collections.abc import Callable, Iterable

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.law import is_slot_call

_ADD, _MUL, _UNARY, _POW, _ATOM = range(5)  # binding strength

_FUNCTIONS: dict[type, str] = {
    sp.exp: "exp", sp.log: "log", sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.asin: "asin", sp.acos: "acos",
    sp.atan: "atan", sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh", sp.Abs: "fabs",
}  # fmt: skip


class EmissionError(ValueError):
    """An expression with a node that has no CasADi source; the message names the node."""


class Printer:
    """Printer of expressions as Python source; the CasADi names used are recorded in `imports`."""

    def __init__(self) -> None:
        self.imports: set[str] = set()

    def __call__(self, expression: sp.Expr) -> str:
        return self._print(sp.sympify(expression))[0]

    def _print(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Symbol):
            if not node.name.isidentifier():
                raise EmissionError(f"symbol {node.name!r} is not a Python name")
            return node.name, _ATOM
        if isinstance(node, sp.Integer):
            return str(int(node)), _ATOM if node >= 0 else _UNARY
        if isinstance(node, sp.Rational):  # a finite decimal, or p/q: both give the nearest double
            if (decimal := _decimal(node)) is None:
                return f"{int(node.p)}/{int(node.q)}", _MUL
            return decimal, _ATOM if node >= 0 else _UNARY
        if isinstance(node, sp.Float):
            return self._float(node)
        if node is sp.pi:
            return self._name("pi"), _ATOM
        if isinstance(node, sp.Add):
            return self._sum(node), _ADD
        if isinstance(node, sp.Mul):
            return self._product(node)
        if isinstance(node, sp.Pow):
            return self._power(node)
        if isinstance(node, (sp.Min, sp.Max)):
            return self._extremum(node), _ATOM
        if isinstance(node, AppliedUndef) and is_slot_call(node):
            return f"laws.{node.func.__name__}({self._arguments(node.args)})", _ATOM
        if type(node) in _FUNCTIONS:
            return f"{self._name(_FUNCTIONS[type(node)])}({self._arguments(node.args)})", _ATOM
        raise EmissionError(f"no CasADi source for {type(node).__name__}: {node}")

    def _name(self, name: str) -> str:
        self.imports.add(name)
        return name

    def _arguments(self, arguments: tuple[sp.Basic, ...]) -> str:
        return ", ".join(self._print(argument)[0] for argument in arguments)

    def _above(self, node: sp.Basic, strength: int) -> str:
        text, binding = self._print(node)
        return text if binding > strength else f"({text})"

    @staticmethod
    def _float(node: sp.Float) -> tuple[str, int]:
        value = float(node)
        if sp.Float(value, 50) != sp.Float(node, 50):
            raise EmissionError(f"number {node} does not round-trip through a double")
        return repr(value), _ATOM if value >= 0 else _UNARY

    def _sum(self, node: sp.Add) -> str:
        return signed_sum(_positive_first(node.as_ordered_terms()), lambda term: self._above(term, _ADD))

    def _product(self, node: sp.Mul) -> tuple[str, int]:
        if node.could_extract_minus_sign():
            body = -node
            return "-" + self._above(body, _ADD), _UNARY
        over: list[str] = []
        under: list[str] = []
        for factor in node.as_ordered_factors():
            if isinstance(factor, sp.Rational) and not isinstance(factor, sp.Integer):
                decimal = _decimal(factor) if factor.q & (factor.q - 1) else None
                if decimal is not None:
                    over.append(decimal)
                else:
                    over += [str(int(factor.p))] if factor.p != 1 else []
                    under.append(str(int(factor.q)))
            elif isinstance(factor, sp.Pow) and factor.exp.is_number and factor.exp.is_negative:
                under.append(self._above(sp.Pow(factor.base, -factor.exp), _UNARY))
            else:
                over.append(self._above(factor, _UNARY))
        top = "*".join(over) or "1"
        if not under:
            return top, _MUL
        return f"{top}/{under[0]}" if len(under) == 1 else f"{top}/({'*'.join(under)})", _MUL

    def _power(self, node: sp.Pow) -> tuple[str, int]:
        if node.exp == sp.Rational(1, 2):
            return f"{self._name('sqrt')}({self._print(node.base)[0]})", _ATOM
        if node.exp.is_number and node.exp.is_negative:
            return f"1/{self._above(sp.Pow(node.base, -node.exp), _UNARY)}", _MUL
        exponent, strength = self._print(node.exp)
        exponent = exponent if strength >= _ATOM else f"({exponent})"
        return f"{self._above(node.base, _POW)}**{exponent}", _POW

    def _extremum(self, node: sp.Expr) -> str:
        name = self._name("fmin" if isinstance(node, sp.Min) else "fmax")
        first, *rest = sorted(node.args, key=sp.default_sort_key)
        text = self._print(first)[0]
        for other in rest:
            text = f"{name}({text}, {self._print(other)[0]})"
        return text


def _decimal(value: sp.Rational) -> str | None:
    """The finite decimal of at most 15 places that equals `value`, or None."""
    numerator, denominator = int(value.p), int(value.q)
    places = 0
    while (denominator % 10 and (denominator % 2 == 0 or denominator % 5 == 0)) or denominator % 10 == 0:
        if places == 15:
            return None
        numerator, places = numerator * 10, places + 1
        shared = sp.igcd(numerator, denominator)
        numerator, denominator = numerator // shared, denominator // shared
    if denominator != 1:
        return None
    sign, digits = ("-" if numerator < 0 else ""), str(abs(numerator)).rjust(places + 1, "0")
    return f"{sign}{digits[:-places]}.{digits[-places:]}" if places else f"{sign}{digits}"


def signed_sum(terms: Iterable[sp.Expr], text: Callable[[sp.Expr], str]) -> str:
    """A sum in this order, its negative terms subtracted."""
    result = ""
    for term in terms:
        negative = term.could_extract_minus_sign()
        body = text(-term if negative else term)
        result += (f" - {body}" if negative else f" + {body}") if result else (f"-{body}" if negative else body)
    return result


def _positive_first(terms: list[sp.Expr]) -> list[sp.Expr]:
    """The given order, starting with a positive term if there is one."""
    for position, term in enumerate(terms):
        if not term.could_extract_minus_sign():
            return [term, *terms[:position], *terms[position + 1 :]]
    return terms
