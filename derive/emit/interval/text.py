"""C text over intervals: constants as exact rationals, expressions as `dual` calls, programs as `series` calls."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.law import is_slot_call
from ..casadi.printer import EmissionError
from ..taylor.program import Program

_EXACT = 2**53  # numerators and denominators up to this are doubles
_FUNCTIONS = {
    sp.exp: "d_exp", sp.log: "d_log", sp.sin: "d_sin", sp.cos: "d_cos", sp.tan: "d_tan", sp.Abs: "d_abs",
}  # fmt: skip
_PLAIN = {
    "square": "s_square", "sqrt": "s_root", "exp": "s_exp", "log": "s_log", "reciprocal": "s_reciprocal",
    "quotient": "s_quotient",
}  # fmt: skip


def dual(node: sp.Basic, names: Callable[[sp.Symbol], str]) -> str:
    """C text of an expression as a `dual`: an enclosure with its derivatives.

    Arguments:
        names: C text of a symbol.

    Raises:
        EmissionError: a function that is not enclosed, or a number that is not an exact rational.
    """

    def text(argument: sp.Basic) -> str:
        return dual(argument, names)

    def folded(operation: str, parts: Iterable[sp.Basic]) -> str:
        first, *others = (text(argument) for argument in parts)
        for other in others:
            first = f"{operation}({first}, {other})"
        return first

    if isinstance(node, sp.Symbol):
        return names(node)
    if node is sp.pi:
        return "d_pi()"
    if isinstance(node, sp.Rational):
        if max(abs(node.p), node.q) > _EXACT:
            raise EmissionError(f"no exact interval for {node}")
        return f"d_ratio({node.p}.0, {node.q}.0)"
    if isinstance(node, sp.Add):
        return folded("d_add", node.as_ordered_terms())
    if isinstance(node, sp.Mul):
        over, under = node.as_numer_denom()
        if under != 1 and not under.is_Rational:
            return f"d_div({text(over)}, {text(under)})"
        return folded("d_mul", node.as_ordered_factors())
    if isinstance(node, sp.Pow):
        base, exponent = node.args
        if exponent.is_number and exponent.is_negative:
            return f"d_div(d_ratio(1.0, 1.0), {text(sp.Pow(base, -exponent))})"
        if exponent.is_Integer:
            return f"d_power({text(base)}, {exponent})"
        if exponent == sp.Rational(1, 2):
            return f"d_root({text(base)})"
        return f"d_exp(d_mul({text(exponent)}, d_log({text(base)})))"
    if isinstance(node, (sp.Max, sp.Min)):
        return folded("d_larger" if isinstance(node, sp.Max) else "d_smaller", node.args)
    if isinstance(node, AppliedUndef) and is_slot_call(node):
        return f"{node.func.__name__.replace('.', '_')}({', '.join(map(text, node.args))})"
    if type(node) in _FUNCTIONS:
        return f"{_FUNCTIONS[type(node)]}({text(node.args[0])})"
    raise EmissionError(f"no enclosure of {type(node).__name__}: {node}")


class Constants:
    """Members `c->name` that are computed once per collision: named values, and factors of the recurrences."""

    def __init__(self, given: Iterable[sp.Symbol]) -> None:
        self.prepared: dict[str, str] = {}
        self._known: dict[sp.Expr, str] = {symbol: symbol.name for symbol in given}

    def __contains__(self, symbol: sp.Symbol) -> bool:
        return symbol in self._known

    def name(self, expression: sp.Expr) -> str:
        """C text of a constant; one that is not known yet is added under a number."""
        if expression not in self._known:
            self.define(expression, f"k{len(self.prepared)}")
        return f"c->{self._known[expression]}"

    def define(self, expression: sp.Expr, name: str) -> None:
        """Add a constant under a name."""
        text = dual(sp.sympify(expression), self.name)
        self._known[expression] = name
        self.prepared[name] = text

    def define_all(self, program: Program) -> None:
        """Add the constants that a program names, under these names."""
        for symbol, value in program.named.items():
            if symbol not in self._known:
                self._known[symbol] = symbol.name
                self.prepared[symbol.name] = dual(sp.sympify(value), self.name)

    def assignments(self) -> list[str]:
        """C statements that compute them, in order."""
        return [f"c->{name} = {text};" for name, text in self.prepared.items()]


def recurrences(program: Program, constants: Constants, where: Callable[[str], str]) -> list[str]:
    """C statements for coefficient k of every series of a program.

    Arguments:
        where: C text of the address of a series.
    """
    constants.define_all(program)
    lines = []
    for step in program.operations:
        target, parts = where(step.name), [where(name) for name in step.series]
        if step.kind == "linear" and len(parts) == 1 and step.factors[1] == 0:
            lines.append(f"s_scaled({target}, {parts[0]}, &{constants.name(step.factors[0])}, k);")
        elif step.kind == "linear":
            factors = ", ".join(f"&{constants.name(factor)}" for factor in step.factors[:-1])
            offset = f"&{constants.name(step.factors[-1])}" if step.factors[-1] != 0 else "NULL"
            lines.append(
                f"s_linear({target}, {len(parts)}, (const series *[]){{{', '.join(parts)}}}, "
                f"(const dual *[]){{{factors}}}, {offset}, k);"
            )
        elif step.kind == "product":
            factor = "NULL" if step.factors[0] == 1 else f"&{constants.name(step.factors[0])}"
            lines.append(f"s_product({target}, {parts[0]}, {parts[1]}, {factor}, k);")
        elif step.kind == "sine":
            lines.append(f"s_circular({target}, {where(f'cosine_of_{step.series[0]}')}, {parts[0]}, k);")
        elif step.kind == "call":
            slot, function, arguments = step.call
            passed = "".join(f", {where(a)}" for a in arguments if isinstance(a, str))
            lines.append(
                f"{slot}_{function}_next(&s->{step.name}_parts, {target}, &c->{step.name}_constants{passed}, k);"
            )
        elif step.kind in _PLAIN:
            lines.append(f"{_PLAIN[step.kind]}({', '.join([target, *parts])}, k);")
        elif step.kind != "cosine":  # comes with its sine
            raise EmissionError(f"no recurrence over intervals for {step.kind}")
    return lines
