"""The energy ledger in C, enclosed in WITH_LEDGER: work of the forces as series, energies and losses of a state.

Kernels without a ledger have none of these series, constants and functions. Only structures that keep the spin have
them, so that a drift of angular momentum is visible.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ...equations.model import Model
from ..casadi.printer import EmissionError
from ..text import needed
from .c_text import Constants, Recurrences
from .layout import comment, function
from .program import Program

# : Terms of the ledger with a series of their own; the work against all attractions together is a state already.
TERMS = {
    "normal_lubrication": "normal_loss",
    "tangential_lubrication": "tangential_loss",
    "attraction": "attraction_work",
}
_MEANING = {
    "normal_loss": "energy dissipated by the normal force of the film, over m v0^2",
    "tangential_loss": "energy dissipated by the tangential force, over m v0^2",
    "attraction_work": "work against van der Waals forces, over m v0^2",
}
Valued = Callable[[list[tuple[str, sp.Expr]], str, dict[str, str], str, Constants], list[str]]


def behind_flag(lines: list[str]) -> list[str]:
    """Lines compiled only with a ledger."""
    return ["#if WITH_LEDGER", *lines, "#endif"] if lines else []


class Ledger:
    """The ledger parts of one structure's header; empty for structures without a ledger.

    Arguments:
        flow: the program of the right-hand side, whose series are shared.
        made: its recurrences.
        constants: those of the structure; constants of the ledger are stored separately.
    """

    def __init__(self, model: Model, flow: Program, made: Recurrences, constants: Constants) -> None:
        self.model = model
        self.there = not model.structure.reduced
        self.constants = constants.beside("c->ledger.")
        self.program = flow.continued()
        rates = model["energy_rates"].by_name if self.there else {}
        more, _ = needed([rate for key, rate in rates.items() if key in TERMS], model.definitions)
        for symbol, expression in more:  # intermediates that the equations of motion do not use
            if symbol not in flow.named and not flow.moves(symbol):
                self.program.define(symbol, expression)
        self._rates = {
            TERMS[key]: self.program.series(sp.sympify(rate), f"rate_of_{TERMS[key]}")
            for key, rate in rates.items()
            if key in TERMS
        }
        if any(operation.kind == "call" for operation in self.program.operations):
            raise EmissionError(f"{model.structure.name}: the ledger calls a law that the equations of motion do not")
        self.made = Recurrences(self.program, self.constants, made.array)

    def enumerations(self) -> list[str]:
        """The number of states that the ledger adds."""
        if not self.there:
            return ["#define LEDGER_STATES 0"]
        return [
            "#if WITH_LEDGER",
            f"#define LEDGER_STATES {len(self._rates)}",
            "#else",
            "#define LEDGER_STATES 0",
            "#endif",
        ]

    def places(self) -> list[str]:
        """Positions of the ledger's states, after all others."""
        first, *others = (name.upper() for name in self._rates) if self.there else ("",)
        start = f"{first} = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE"
        lines = [f"enum {{ {', '.join([start, *others])} }};"]
        if "tangential_loss" in self._rates:
            lines.append("#define TANGENTIAL 1")
        return behind_flag(lines if self.there else [])

    def states(self) -> list[str]:
        """Series of the ledger's states."""
        return behind_flag([f"    vec {name}[TERMS]; /* {_MEANING[name]} */" for name in self._rates])

    def series(self) -> list[str]:
        """All other series of the ledger."""
        return behind_flag([f"    {field}" for field in self.made.fields()])

    def coefficients(self) -> list[str]:
        """Coefficient k of the ledger's series and k + 1 of its states."""
        lines = self.made.lines()
        lines += [f"s->{name}[k + 1] = {self.made.array(rate)}[k]*next;" for name, rate in self._rates.items()]
        return behind_flag(lines)

    def constants_struct(self) -> list[str]:
        """The struct of the ledger's constants; to be called after all code that uses them has been generated."""
        fields = [f"    vec {name};" for name in self.constants.prepared]
        return behind_flag(["typedef struct {", *fields, "} ledger_constants;", ""] if fields else [])

    def member(self) -> list[str]:
        """The ledger's constants as a member of those of the structure."""
        return behind_flag(["    ledger_constants ledger;"] if self.constants.prepared else [])

    def prepare(self) -> list[str]:
        """Statements that compute the ledger's constants."""
        prepared = self.constants.prepared.items()
        return behind_flag([f"c->ledger.{name} = {self.constants.text.vector(value)};" for name, value in prepared])

    def functions(self, valued: Valued) -> list[str]:
        """Energies of a state, its angular momentum, and the loss at a rebound."""
        if not self.there:
            return []
        model = self.model
        energies = list(model["energies"].outputs)
        places = {key: f"energy[{position}]" for position, (key, _) in enumerate(energies)}
        lines = valued(
            energies,
            "static inline void energies(const constants *c, const vec *y, vec *energy)",
            places,
            f"{model['energies'].doc} In order: {', '.join(places)}.",
            self.constants,
        )
        loss = model["rebound_loss"]
        head = "static inline vec rebound_loss(const constants *c, const vec *y)"
        lines += valued(list(loss.outputs), head, {"dry_contact": "return"}, loss.doc, self.constants)
        head = "static inline vec booked_momentum(const constants *c, const vec *y)"
        if "angular_momentum" in model:
            momentum = model["angular_momentum"]
            lines += valued(list(momentum.outputs), head, {"angular_momentum": "return"}, momentum.doc, self.constants)
        else:
            doc = "No angular momentum is conserved."
            lines += [*comment(doc), *function(head, ["(void)c; (void)y;", "return splat(1.0);"]), ""]
        return [*behind_flag([f"enum {{ ENERGIES = {len(energies)} }};", *lines[:-1]]), ""]
