"""Dimensions, coherent SI units as text, and a strict check of the dimensional homogeneity of expressions.

sympy's own dimension system checks only the first term of a sum; this one checks every term and names the wrong one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import prod
from types import MappingProxyType
from typing import TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

Power: TypeAlias = Fraction | sp.Expr


@dataclass(frozen=True)
class Dimension:
    """Exponents of mass, length and time: fractions, or expressions of the plain numbers that stand as exponents."""

    mass: Power = Fraction(0)
    length: Power = Fraction(0)
    time: Power = Fraction(0)

    def __post_init__(self) -> None:
        for name in ("mass", "length", "time"):
            value = sp.expand(getattr(self, name))
            exact = Fraction(int(value.p), int(value.q)) if isinstance(value, sp.Rational) else value
            object.__setattr__(self, name, exact)

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(self.mass + other.mass, self.length + other.length, self.time + other.time)

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other**-1

    def __pow__(self, exponent: int | Power) -> Dimension:
        return Dimension(*(sp.sympify(exponent) * power for power in self.exponents))

    @property
    def exponents(self) -> tuple[Power, Power, Power]:
        return (self.mass, self.length, self.time)

    def __str__(self) -> str:
        powers = [(base, power) for base, power in zip("MLT", self.exponents, strict=True) if power]
        texts = {base: f"^({power})" if isinstance(power, sp.Add) else f"^{power}" for base, power in powers}
        return " ".join(base if power == 1 else base + texts[base] for base, power in powers) or "1"


ONE = Dimension()
MASS, LENGTH, TIME = Dimension(mass=Fraction(1)), Dimension(length=Fraction(1)), Dimension(time=Fraction(1))
SPEED, RATE = LENGTH / TIME, TIME**-1
FORCE = MASS * LENGTH / TIME**2
PRESSURE, ENERGY = FORCE / LENGTH**2, FORCE * LENGTH


class DimensionError(ValueError):
    """A dimensionally inhomogeneous expression; the message names the term at fault."""


_TRANSCENDENTAL = (sp.exp, sp.log, sp.sin, sp.cos, sp.tan, sp.asin, sp.acos, sp.atan, sp.sinh, sp.cosh, sp.tanh)


def dimension_of(
    expression: sp.Expr, of: Mapping[sp.Basic, Dimension], slots: Callable[[AppliedUndef], Dimension] | None = None
) -> Dimension | None:
    """Dimension of `expression`; None for an exact zero, which fits anywhere.

    Arguments:
        of: dimension of each symbol (and of each applied function, such as x(t)).
        slots: dimension of an applied undefined function that is not in `of` (a law slot).

    Raises:
        DimensionError: a sum of unlike terms, a transcendental of a dimensional argument, an unknown symbol or node.
    """

    def walk(node: sp.Basic) -> Dimension | None:
        if node in of:
            return of[node]
        if node.is_zero:
            return None
        if isinstance(node, (sp.Number, sp.NumberSymbol)):
            return ONE
        if isinstance(node, (sp.Add, sp.Max, sp.Min)):
            return _common(node, node.args)
        if isinstance(node, sp.Mul):
            parts = [walk(factor) for factor in node.args]
            dimensions = [dimension for dimension in parts if dimension is not None]
            return prod(dimensions, start=ONE) if len(dimensions) == len(parts) else None
        if isinstance(node, sp.Pow):
            return _power(node)
        if isinstance(node, sp.Derivative):
            top, below = walk(node.expr), [(walk(symbol) or ONE, int(count)) for symbol, count in node.variable_count]
            return top and prod((bottom**-count for bottom, count in below), start=top)
        if isinstance(node, sp.Abs):
            return walk(node.args[0])
        if isinstance(node, sp.sign):
            walk(node.args[0])
            return ONE
        if isinstance(node, sp.Piecewise):
            for relation in node.atoms(Relational):
                _common(relation, relation.args)
            return _common(node, [value for value, _ in node.args])
        if isinstance(node, _TRANSCENDENTAL):
            _demand_pure(node, node.args[0])
            return ONE
        if isinstance(node, AppliedUndef) and slots is not None:
            for argument in node.args:
                _demand_pure(node, argument)
            return slots(node)
        raise DimensionError(f"no dimension is known for {node} (a {type(node).__name__})")

    def _common(whole: sp.Basic, terms: list[sp.Basic] | tuple[sp.Basic, ...]) -> Dimension | None:
        pairs = [(term, dimension) for term in terms if (dimension := walk(term)) is not None]
        for term, dimension in pairs[1:]:
            if dimension != pairs[0][1]:
                beside = f"{pairs[0][0]} of dimension {pairs[0][1]}"
                raise DimensionError(f"term {term} has dimension {dimension} beside {beside} in {whole}")
        return pairs[0][1] if pairs else None

    def _power(node: sp.Pow) -> Dimension | None:
        base = walk(node.base)
        if base is None:
            return None
        if isinstance(node.exp, sp.Rational):
            return base ** Fraction(int(node.exp.p), int(node.exp.q))
        _demand_pure(node, node.exp)
        return base if base == ONE else base**node.exp

    def _demand_pure(whole: sp.Basic, argument: sp.Basic) -> None:
        dimension = walk(argument)
        if dimension not in (None, ONE):
            raise DimensionError(f"argument {argument} of {whole} has dimension {dimension}, it must be a pure number")

    return walk(expression)


def demand_dimension(
    name: str,
    expression: sp.Expr,
    expected: Dimension,
    of: Mapping[sp.Basic, Dimension],
    slots: Callable[[AppliedUndef], Dimension] | None = None,
) -> None:
    """Raise DimensionError, naming the equation, unless `expression` has dimension `expected`."""
    try:
        result = dimension_of(expression, of, slots)
    except DimensionError as error:
        raise DimensionError(f"{name}: {error}") from None
    if result not in (None, expected):
        raise DimensionError(f"{name}: {expression} has dimension {result}, expected {expected}")


UNITS: dict[str, Dimension] = {
    "1": ONE, "rad": ONE, "m": LENGTH, "kg": MASS, "s": TIME, "N": FORCE, "Pa": PRESSURE, "J": ENERGY,
    "W": ENERGY / TIME, "Hz": TIME**-1,
}  # fmt: skip
_FACTOR = re.compile(r"([A-Za-z1]+)(?:\^(-?\d{1,2}|[a-z]\w*))?")


class UnitError(ValueError):
    """An unknown unit; the message names it."""


def dimension_of_unit(text: str, numbers: Mapping[str, sp.Symbol] = MappingProxyType({})) -> Dimension:
    """Dimension of a product or quotient of coherent SI units; UnitError names an unknown unit.

    Arguments:
        numbers: plain numbers that may stand as exponents, by name: "Pa s^index".
    """
    if not isinstance(text, str) or not text.strip():
        raise UnitError("is not a unit")
    result = ONE
    for place, group in enumerate(text.replace("**", "^").replace("*", " ").split("/")):
        factors = group.split()
        if not factors or (place and len(factors) > 1):
            raise UnitError('is not a unit (one factor behind each "/")')
        for factor in factors:
            match = _FACTOR.fullmatch(factor)
            if match is None and factor.partition("^")[0] in UNITS:
                raise UnitError(f"has {factor!r}, whose exponent is not whole, nor a plain number declared before")
            if match is None or match[1] not in UNITS:
                raise UnitError(f"has the unknown unit {factor!r}")
            if (match[2] or "1")[0].isalpha() and match[2] not in numbers:
                raise UnitError(f"has the exponent {match[2]}, which is no plain number declared before it")
            power = sp.sympify(numbers.get(match[2]) or int(match[2] or 1)) * (-1 if place else 1)
            result = result * UNITS[match[1]] ** power
    return result
