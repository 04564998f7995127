"""A structure's tangent as linear equations, v' = A v + b: entries of A and b as series of the flow, or constants."""

from typing import TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations.model import Model
from ...physics.forces import FILM, SHEAR
from ..casadi.printer import EmissionError
from .chain_rule import Chain
from .constants import Constants
from .header import Beside, Header
from .law_slopes import arguments, define_shortest, factored, shortest
from .recurrences import Recurrences

Entry: TypeAlias = str | sp.Expr
"""A series' name, or a constant."""


class LinearFlow:
    """The matrix and the source terms of one structure's tangent, and their places in emitted C."""

    def __init__(self, model: Model, beside: Beside) -> None:
        self.model, self.beside = model, beside
        self.header = Header(model, beside)
        self.header.text()  # receives its constants and calls
        self.states = [state.name for state in model.states]
        flow = self.header.flow
        self._flow = {operation.name for operation in flow.operations}
        self._calls = {operation.name for operation in flow.operations if operation.kind == "call"}
        self.program = flow.continued()
        self.slopes: dict[str, str] = {}  # name of a law's derivative -> its array
        self.chain = Chain(model.definitions, self._slope, (*model.groups, FILM, SHEAR))
        self.matrix: dict[tuple[str, str], Entry] = {}
        self.sources: dict[tuple[str, str], Entry] = {}
        self._differentiate()
        places = {group: f"v->{group.name}" for group in model.groups}
        places |= {symbol: f"v->{symbol.name}" for symbol in flow.named}
        self.constants = Constants(places, (FILM, SHEAR))
        self._kept = {entry for entry in (*self.matrix.values(), *self.sources.values()) if isinstance(entry, str)}
        self.recurrences = Recurrences(self.program, self.constants, self._where, lambda name: name not in self._kept)

    # ---- derivatives

    def _slope(self, node: AppliedUndef, position: int) -> sp.Symbol:
        slot, name = node.func.__name__.split(".")
        call = self.header.flow.series(node) if self.header.flow.moves(node) else None
        if call not in self._calls:
            raise EmissionError(f"no slopes of {node}: it is no series of the flow")
        argument = self.law_arguments(slot, name, len(node.args))[position]
        symbol = sp.Symbol(f"{call}_by_{argument}", real=True)
        if symbol.name not in self.slopes:
            self.slopes[symbol.name] = f"{call}.by_{argument}"
            self.program.give(symbol)
        return symbol

    def law_arguments(self, slot: str, name: str, count: int) -> tuple[str, ...]:
        """Names of the arguments of a slot function, as in the fields of its derivatives."""
        return arguments(slot, name, count, self.beside.extra.get(f"{slot}.{name}", ()))

    def _where(self, series: str) -> str:
        if series in self.slopes:
            return self._law_place(self.slopes[series].split(".")[0]) + self.slopes[series]
        return f"of->{series}.result" if series in self._calls else f"of->{series}"

    def _law_place(self, call: str) -> str:
        """C text of a law's derivative, a local variable unless it is itself an entry."""
        entries = {self.slopes[entry].split(".")[0] for entry in self._kept if entry in self.slopes}
        return "s->" if call in entries else ""

    def rates(self) -> list[tuple[str, sp.Expr]]:
        """Expressions of the states' rates, by name."""
        rows = [(name, sp.sympify(rate)) for name, rate in self.model["right_hand_side"].outputs]
        if self.header.turning is not None:
            rows.append(("turned", self.model["turning_rate"].outputs[0][1]))
        return rows

    def _differentiate(self) -> None:
        result: list[tuple[dict[tuple[str, str], Entry], tuple[str, str], sp.Expr]] = []
        for row, rate in self.rates():
            for into, variables in ((self.matrix, self.model.states), (self.sources, self.model.groups)):
                for variable in variables:
                    slope = self.chain.by(rate, variable)
                    if slope != 0:
                        result.append((into, (row, variable.name), slope))
        for symbol, expression in self.chain.named:
            define_shortest(self.program, symbol, expression)
        for into, (row, by), slope in result:
            into[row, by] = shortest(self.program, (slope, *factored(slope)), f"{row}_by_{by}")

    @property
    def flowing(self) -> list[str]:
        """Groups that the rates depend on."""
        return [group.name for group in self.model.groups if any(by == group.name for _, by in self.sources)]

    @property
    def flow(self) -> set[str]:
        """Names of the series of the flow, states included."""
        return self._flow | set(self.states)

    def array(self, name: str) -> str:
        return self.recurrences.array(name)
