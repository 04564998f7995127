"""Constants of a collision in C: groups, named values, and factors that are hoisted out of recurrences."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import sympy as sp

from ..casadi.printer import EmissionError
from .c_text import Text, number


def split_flags(expression: sp.Expr, flags: Iterable[sp.Symbol]) -> tuple[list[sp.Symbol], sp.Expr]:
    """The flags of the region that are factors of an expression, and the rest."""
    result, rest = [flag for flag in flags if flag in expression.free_symbols], expression
    for flag in result:
        rest = sp.cancel(rest / flag)
    return result, rest


class Constants:
    """Quantities computed once per collision: groups, named values, and factors hoisted out of the recurrences."""

    def __init__(self, places: Mapping[sp.Symbol, str], flags: tuple[sp.Symbol, ...] = (), place: str = "c->") -> None:
        self._places = dict(places)
        self._flags = flags
        self._place = place
        self.prepared: dict[str, sp.Expr] = {}
        self._hoisted: dict[sp.Expr, str] = {}
        self._defined: dict[sp.Symbol, str] = {}
        self.text = Text(self.name)

    def beside(self, place: str) -> Constants:
        """Constants stored in another C struct that can use the present ones."""
        more = Constants(self._places | self._defined, self._flags, place)
        more._hoisted = dict(self._hoisted)
        return more

    def name(self, symbol: sp.Symbol) -> str:
        """C name of a constant symbol."""
        if symbol in self._flags:
            return symbol.name
        result = self._places.get(symbol) or self._defined.get(symbol)
        if result is None:
            raise EmissionError(f"{symbol} is neither given nor defined")
        return result

    def assignments(self) -> list[str]:
        """C statements that compute what is prepared, in order."""
        return [f"{self._place}{name} = {self.text.vector(value)};" for name, value in self.prepared.items()]

    def level(self, expression: sp.Expr, hint: str) -> str:
        """Text of coefficient k of a constant."""
        return f"k == 0 ? {self.vector(expression, hint)} : splat(0.0)"

    def vector(self, expression: sp.Expr, hint: str) -> str:
        """`factor` as a vector, also if it is a number."""
        text = self.factor(expression, hint)
        return text if expression.free_symbols else f"splat({text})"

    def define(self, symbol: sp.Symbol, expression: sp.Expr) -> None:
        if symbol not in self._defined:
            self.prepared[symbol.name] = expression
            self._defined[symbol] = f"{self._place}{symbol.name}"

    def factor(self, expression: sp.Expr, hint: str) -> str:
        """Text of a constant: a literal, a name, or a value hoisted under `hint`; the region's flags as factors."""
        flags, rest = split_flags(expression, self._flags)
        text = self._without_flags(rest, hint)
        return "*".join([*(flag.name for flag in flags), *([text] if text != "1.0" else [])]) or text

    def _without_flags(self, rest: sp.Expr, hint: str) -> str:
        """Text of a constant without flags: a literal, a name, or a value hoisted under `hint`."""
        if rest.is_number and not rest.free_symbols:
            return number(rest)
        if isinstance(rest, sp.Symbol):
            return self.name(rest)
        if rest not in self._hoisted:
            name, count = hint, 1
            while name in self.prepared or f"{self._place}{name}" in self._places.values():
                count += 1
                name = f"{hint}_{count}"
            self.prepared[name] = rest
            self._hoisted[rest] = f"{self._place}{name}"
        return self._hoisted[rest]
