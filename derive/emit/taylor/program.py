"""Compilation of expressions to elementary operations on Taylor series, one recurrence each, common parts shared.

A series is a symbol that varies along a trajectory; everything else is constant along it and computed once. The builder
walks a whitelist of sympy nodes, as the CasADi printer does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.law import Definition, is_slot_call, needed
from ..casadi.printer import EmissionError

# Cost of an operation in products of whole series; a square counts one half.
COST = {
    "linear": 0.0, "product": 1.0, "square": 0.5, "quotient": 1.0, "reciprocal": 1.0, "sqrt": 0.5, "exp": 1.0,
    "log": 1.0, "side": 0.0, "half": 0.0, "power": 2.0, "sine": 2.0, "cosine": 0.0, "arctangent": 1.0, "call": 0.0,
}  # fmt: skip
Call = tuple[str, str, tuple[str | sp.Expr, ...]]
"""Slot, function and arguments of a law's call: a series by name, a constant as an expression."""


@dataclass(frozen=True)
class Operation:
    """A series `name` computed from others.

    Arguments:
        kind: a key of COST.
        series: names of its operands.
        factors: constants: the factor of a product; for a linear combination one per operand, then the term of order 0.
        call: of a law, for the kind "call".
    """

    name: str
    kind: str
    series: tuple[str, ...]
    factors: tuple[sp.Expr, ...] = ()
    call: Call = ("", "", ())


class Program:
    """Operations in order, built by `series`.

    Arguments:
        moving: symbols that are series initially.
        whole_angles: squared sines of half an angle are taken from its cosine: fewer products, but as a value this
            loses the relative accuracy of a small angle.
    """

    def __init__(self, moving: Iterable[sp.Symbol], whole_angles: bool = False) -> None:
        self._whole_angles = whole_angles
        self.operations: list[Operation] = []
        self.inputs = tuple(symbol.name for symbol in moving)
        self._moving: dict[sp.Basic, str] = {symbol: symbol.name for symbol in moving}
        self.named: dict[sp.Symbol, sp.Expr] = {}  # constants with a name of their own, in order
        self._names: set[str] = set(self.inputs)
        self._continues = False  # another program
        self._of_series: dict[tuple[str, tuple[str, ...]], tuple[Operation, ...]] = {}  # with that other's

    @classmethod
    def for_outputs(
        cls,
        moving: Iterable[sp.Symbol],
        outputs: Iterable[sp.Expr],
        definitions: Sequence[Definition],
        whole_angles: bool = False,
    ) -> Program:
        """A program with the definitions that the outputs need."""
        program = cls(tuple(moving), whole_angles)
        for symbol, expression in needed(list(outputs), definitions)[0]:
            program.define(symbol, expression)
        return program

    @property
    def cost(self) -> float:
        return sum(COST[operation.kind] for operation in self.operations)

    def passing(self, beside: AbstractSet[str] = frozenset()) -> frozenset[str]:
        """Series used in linear combinations only, of which past coefficients are not needed.

        Arguments:
            beside: operations that are ignored.
        """
        counted = [operation for operation in self.operations if operation.name not in beside]
        series = {term for operation in counted if operation.kind != "linear" for term in operation.series}
        plain = ("linear", "product", "square")  # coefficients of the other operations use all preceding ones
        return frozenset(step.name for step in self.operations if step.kind in plain and step.name not in series)

    def give(self, symbol: sp.Symbol) -> None:
        """Declare `symbol` as a series computed elsewhere."""
        self._moving[symbol] = self._free(symbol.name)

    def continued(self) -> Program:
        """A program that continues from these series; its own operations are those added later."""
        later = Program((), self._whole_angles)
        later.inputs = (*self.inputs, *(operation.name for operation in self.operations))
        later._moving = dict(self._moving)
        later._names = set(self._names)
        later._continues = bool(self._of_series)
        later._of_series = dict(self._of_series)
        return later

    def define(self, symbol: sp.Symbol, expression: sp.Expr) -> None:
        """Define `symbol` as an expression: as a series of its name, or as a constant."""
        if self.moves(expression):
            self._moving[symbol] = self.series(expression, symbol.name)
        else:
            self.named[symbol] = expression

    def moves(self, expression: sp.Expr) -> bool:
        """True if an expression varies along a trajectory."""
        return any(node in self._moving for node in sp.preorder_traversal(expression))

    def series(self, expression: sp.Expr, name: str | None = None) -> str:
        """The name of the series of a varying expression."""
        if expression in self._moving:
            return self._moving[expression]
        self._moving[expression] = self._build(expression, name)
        return self._moving[expression]

    def collect_calls(self, calls: dict[str, Call]) -> None:
        """Add the calls of laws, by the names of their series."""
        for operation in self.operations:
            if operation.kind == "call":
                calls.setdefault(operation.name, operation.call)

    def result(self, expression: sp.Expr, name: str) -> str | sp.Expr:
        """The name of the series of an expression, or the expression itself if it is constant."""
        expression = sp.sympify(expression)
        return self.series(expression, name) if self.moves(expression) else expression

    def _add(
        self,
        kind: str,
        series: tuple[str, ...],
        name: str | None,
        hint: str,
        factors: tuple[sp.Expr, ...] = (),
        call: Call = ("", "", ()),
    ) -> str:
        alike = self._of_series.get((kind, series), ())
        for operation in alike:
            if (operation.factors, operation.call) == (factors, call):
                return operation.name
            if kind == "product" and self._continues:
                ratio = factors[0] / operation.factors[0]  # equal up to its constant factor
                return self._add("linear", (operation.name,), name, hint, (ratio, sp.Integer(0)))
        chosen = self._free(name or hint)
        self.operations.append(Operation(chosen, kind, series, factors, call))
        self._of_series[kind, series] = (*alike, self.operations[-1])
        return chosen

    def _free(self, wanted: str) -> str:
        name, count = wanted, 1
        while name in self._names:
            count += 1
            name = f"{wanted}_{count}"
        self._names.add(name)
        return name

    def _build(self, node: sp.Expr, name: str | None) -> str:
        for kind, build in ((sp.Add, self._sum), (sp.Mul, self._product), (sp.Pow, self._power)):
            if isinstance(node, kind):
                return build(node, name)
        if isinstance(node, AppliedUndef) and is_slot_call(node):
            return self._call(node)
        if isinstance(node, (sp.exp, sp.log)):
            inner = self.series(node.args[0])
            kind = "exp" if isinstance(node, sp.exp) else "log"
            return self._add(kind, (inner,), name, f"{kind}_of_{inner}")
        if isinstance(node, sp.sign):
            inner = self.series(node.args[0])
            return self._add("side", (inner,), name, f"side_of_{inner}")
        if isinstance(node, (sp.sin, sp.cos)):
            return self._sine_or_cosine(node, name)
        if isinstance(node, sp.tan):
            return self.series(sp.sin(node.args[0]) / sp.cos(node.args[0]), name)
        if isinstance(node, sp.Heaviside):
            inner = self.series(node.args[0])
            return self._add("half", (inner,), name, f"half_of_{inner}")
        if isinstance(node, sp.tanh):  # by exponentials that fall, which never overflow; at zero either will do
            side = 2 * sp.Heaviside(node.args[0], 1) - 1
            fallen = sp.exp(-2 * side * node.args[0])
            return self.series(side * (1 - fallen) / (1 + fallen), name)
        if isinstance(node, (sp.sinh, sp.cosh)):
            return self.series(node.rewrite(sp.exp), name)
        if isinstance(node, sp.atan):
            inner, slope = self.series(node.args[0]), self.series(1 / (1 + node.args[0] ** 2))
            return self._add("arctangent", (inner, slope), name, f"arctangent_of_{inner}")
        raise EmissionError(f"no Taylor recurrence for {type(node).__name__}: {node}")

    def _sum(self, node: sp.Add, name: str | None) -> str:
        series: list[str] = []
        factors: list[sp.Expr] = []
        alone: list[sp.Expr] = []
        for term in node.as_ordered_terms():
            if not self.moves(term):
                alone.append(term)
                continue
            factor, moving = self._split(term)
            series.append(self.series(moving))
            factors.append(factor)
        return self._add("linear", tuple(series), name, "combination", (*factors, sp.Add(*alone)))

    def _split(self, node: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The constant factor of a product, and the remaining expression."""
        parts = node.as_ordered_factors()
        still = [factor for factor in parts if not self.moves(factor)]
        return sp.Mul(*still), sp.Mul(*(factor for factor in parts if self.moves(factor)))

    def _product(self, node: sp.Mul, name: str | None) -> str:
        factor, moving = self._split(node)
        over = [operand for operand in moving.as_ordered_factors() if not _divides(operand)]
        under = [1 / operand for operand in moving.as_ordered_factors() if _divides(operand)]
        plain = factor == 1
        if len(over) + len(under) == 1:
            base = self.series(over[0] if over else 1 / under[0], name if plain else None)
            return base if plain else self._add("linear", (base,), name, f"scaled_{base}", (factor, sp.Integer(0)))
        names = [self.series(operand) for operand in over]
        # multiply by an existing inverse instead of dividing
        names += [self._moving[1 / operand] for operand in under if 1 / operand in self._moving]
        under = [operand for operand in under if 1 / operand not in self._moving]
        if not names:
            names, under = [self.series(1 / under[0])], under[1:]
        result = names[0]
        for position, other in enumerate(names[1:]):
            last = position == len(names) - 2 and not under
            hint = f"{result}_by_{other}"
            factors = (factor if last else sp.Integer(1),)
            result = self._add("product", (result, other), name if last else None, hint, factors)
            plain = plain or last
        for position, operand in enumerate(under):
            below = self.series(operand)
            last = position == len(under) - 1 and plain
            result = self._add("quotient", (result, below), name if last else None, f"{result}_over_{below}")
        if not plain:
            result = self._add("linear", (result,), name, f"scaled_{result}", (factor, sp.Integer(0)))
        return result

    def _power(self, node: sp.Pow, name: str | None) -> str:
        base, exponent = node.args
        if self.moves(exponent):
            return self.series(sp.exp(exponent * sp.log(base), evaluate=False), name)
        if self._whole_angles and exponent == 2 and isinstance(base, sp.sin):
            return self.series(sp.Rational(1, 2) - sp.cos(2 * base.args[0]) / 2, name)
        if exponent == -2 and 1 / base in self._moving:
            inverse = self._moving[1 / base]
            return self._add("square", (inverse,), name, f"{inverse}_squared")
        if exponent.is_number and exponent.is_negative:
            below = self.series(sp.Pow(base, -exponent))
            return self._add("reciprocal", (below,), name, f"inverse_{below}")
        if exponent == sp.Rational(1, 2):
            inner = self.series(base)
            return self._add("sqrt", (inner,), name, f"root_of_{inner}")
        if exponent.is_Integer:
            half = self.series(sp.Pow(base, exponent // 2))
            squared = self._add("square", (half,), None if exponent % 2 else name, f"{half}_squared")
            if exponent % 2 == 0:
                return squared
            inner = self.series(base)
            return self._add("product", (squared, inner), name, f"{squared}_by_{inner}", (sp.Integer(1),))
        inner = self.series(base)
        return self._add("power", (inner,), name, f"power_of_{inner}", (exponent,))

    def _sine_or_cosine(self, node: sp.Expr, name: str | None) -> str:
        angle = node.args[0]
        if isinstance(node, sp.sin) and sp.sin(angle / 2) in self._moving:  # sine and cosine share one operation
            return self.series(2 * sp.sin(angle / 2) * sp.cos(angle / 2), name)
        inner = self.series(angle)
        sine = self._add("sine", (inner,), None, f"sine_of_{inner}")
        cosine = self._add("cosine", (inner,), None, f"cosine_of_{inner}")
        self._moving[sp.sin(angle)], self._moving[sp.cos(angle)] = sine, cosine
        return sine if isinstance(node, sp.sin) else cosine

    def _call(self, node: AppliedUndef) -> str:
        slot, function = node.func.__name__.split(".")
        arguments = [self.series(argument) if self.moves(argument) else argument for argument in node.args]
        series = tuple(argument for argument in arguments if isinstance(argument, str))
        return self._add("call", series, None, f"{slot}_{function}_law", call=(slot, function, tuple(arguments)))


def _divides(factor: sp.Expr) -> bool:
    return isinstance(factor, sp.Pow) and bool(factor.exp.is_number and factor.exp.is_negative)


def cheapest(
    expression: sp.Expr, definitions: Iterable[tuple[sp.Symbol, sp.Expr]], moving: tuple[sp.Symbol, ...]
) -> tuple[Program, str | sp.Expr]:
    """The program of an expression, as written or expanded, whichever is cheaper; and its result."""
    candidates: list[tuple[float, int, Program, str | sp.Expr]] = []
    for form in dict.fromkeys((expression, sp.expand(expression, trig=False))):
        program = Program(moving)
        for symbol, value in definitions:
            program.define(symbol, value)
        result = program.result(form, "result")
        candidates.append((program.cost, len(candidates), program, result))
    return min(candidates, key=lambda entry: entry[:2])[2:]
