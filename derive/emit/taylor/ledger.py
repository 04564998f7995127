"""The energy ledger in C, enclosed in WITH_LEDGER: work of the forces as series, energies and losses of a state.

Kernels without a ledger have none of these series, constants and functions. Only structures that keep the spin have
them, so that a drift of angular momentum is visible.
"""

from collections.abc import Callable, Mapping

import sympy as sp

from ...equations.model import Model
from ...equations.terms import mass
from ...physics.law import needed
from ..casadi.printer import EmissionError
from .constants import Constants
from .layout import compiled_if, documented, struct
from .program import Program
from .recurrences import Recurrences

# Terms of the ledger with a series of their own; the work against all attractions together is a state already.
TERMS = {
    "normal_lubrication": "normal_loss", "tangential_lubrication": "tangential_loss", "attraction": "attraction_work",
    "dry_friction": "friction_loss", "own_work": "own_work",
}  # fmt: skip
_MEANING = {
    "normal_loss": "energy dissipated by the normal force of the film, over m v0^2",
    "tangential_loss": "energy dissipated by the tangential force, over m v0^2",
    "attraction_work": "work against van der Waals forces, over m v0^2",
    "friction_loss": "energy dissipated by the friction of the dry contact, over m v0^2",
    "own_work": "work against declared forces, over m v0^2",
}
_FLAG = "WITH_LEDGER"
BOOKED = "c->ledger."
"""Place of the ledger's constants."""


Valued = Callable[..., list[str]]
"""The emission of a function of the states (`Header`)."""


class Ledger:
    """The ledger parts of one structure's header, in motion or at rest; empty for structures without a ledger.

    Arguments:
        flow: the program of the right-hand side, whose series are shared.
        recurrences: its recurrences.
        constants: of the ledger, which are stored separately.
        mode: values of what the mode of motion holds.
    """

    def __init__(
        self, model: Model, flow: Program, recurrences: Recurrences, constants: Constants, mode: Mapping[sp.Symbol, int]
    ) -> None:
        self.model = model
        self.there = not model.structure.reduced
        self.constants = constants
        self.program = flow.continued()
        rates = {
            TERMS[key]: rate.subs(mode) for key, rate in model["energy_rates"].outputs if self.there and key in TERMS
        }
        more, _ = needed(list(rates.values()), model.definitions)
        for symbol, expression in more:  # intermediates that the equations of motion do not use
            if symbol not in flow.named and not flow.moves(symbol):
                self.program.define(symbol, expression)
        self._rates = {name: self.program.result(rate, f"rate_of_{name}") for name, rate in rates.items()}
        if any(operation.kind == "call" for operation in self.program.operations):
            raise EmissionError(f"{model.structure.name}: the ledger calls a law that the equations of motion do not")
        self.recurrences = Recurrences(self.program, self.constants, recurrences.array)

    def enumerations(self) -> list[str]:
        """The number of states that the ledger adds."""
        if not self.there:
            return ["#define LEDGER_STATES 0"]
        count = f"#define LEDGER_STATES {len(self._rates)}"
        return ["#if WITH_LEDGER", count, "#else", "#define LEDGER_STATES 0", "#endif"]

    def places(self) -> list[str]:
        """Positions of the ledger's states, after all others."""
        if not self.there:
            return []
        first, *others = (name.upper() for name in self._rates)
        start = f"{first} = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE"
        tangential = ["#define TANGENTIAL 1"] if "tangential_loss" in self._rates else []
        return compiled_if(_FLAG, [f"enum {{ {', '.join([start, *others])} }};", *tangential])

    def states(self) -> list[str]:
        return compiled_if(_FLAG, [f"vec {name}[TERMS]; /* {_MEANING[name]} */" for name in self._rates])

    def series(self) -> list[str]:
        return compiled_if(_FLAG, self.recurrences.fields())

    def coefficients(self) -> list[str]:
        """Coefficient k of the ledger's series and k + 1 of its states."""
        lines = self.recurrences.lines()
        for name, rate in self._rates.items():
            value = f"{self.recurrences.array(rate)}[k]*next" if isinstance(rate, str) else "splat(0.0)"
            lines.append(f"s->{name}[k + 1] = {value};")
        return compiled_if(_FLAG, lines)

    def constants_struct(self) -> list[str]:
        """The struct of the ledger's constants; to be called after all code that uses them has been generated."""
        fields = [f"vec {name};" for name in self.constants.prepared]
        return compiled_if(_FLAG, struct("ledger_constants", fields) if fields else [])

    def member(self) -> list[str]:
        """The ledger's constants as a member of those of the structure."""
        return compiled_if(_FLAG, ["ledger_constants ledger;"] if self.constants.prepared else [])

    def prepare(self) -> list[str]:
        return compiled_if(_FLAG, self.constants.assignments())

    def functions(self, valued: Valued) -> list[str]:
        """Energies of a state, its angular momentum, and the loss at a rebound."""
        if not self.there:
            return []
        energies, loss = self.model["energies"], self.model["rebound_loss"]
        places = {key: f"energy[{position}]" for position, key in enumerate(energies.by_name)}
        head = "static inline void energies(const constants *c, const vec *y, vec *energy)"
        doc = f"{energies.doc} In order: {', '.join(places)}."
        lines = [f"enum {{ ENERGIES = {len(places)} }};"]
        lines += valued(energies.outputs, head, places, doc, self.constants)
        head = "static inline vec rebound_loss(const constants *c, const vec *y)"
        lines += valued(loss.outputs, head, {"dry_contact": "return"}, loss.doc, self.constants)
        lines += self._of_terms(valued, list(places))
        head = "static inline vec booked_momentum(const constants *c, const vec *y)"
        if "angular_momentum" in self.model:
            momentum = self.model["angular_momentum"]
            lines += valued(momentum.outputs, head, {"angular_momentum": "return"}, momentum.doc, self.constants)
        else:
            doc = "No angular momentum is conserved."
            lines += documented(doc, head, ["(void)c; (void)y;", "return splat(1.0);"])
        return [*compiled_if(_FLAG, lines[:-1]), ""]

    def _of_terms(self, valued: Valued, energies: list[str]) -> list[str]:
        """What the ledger takes of declared terms: the place of their energy, their work, the inertia of the gap."""
        if self.model.structure.terms is None:
            return []
        lines = [f"#define OWN_ENERGY {energies.index('own_energy')}"] if "own_energy" in energies else []
        lines += ["#define OWN_WORKS 1"] if "own_work" in self._rates else []
        head = "static inline vec own_inertia(const constants *c, const vec *y)"
        inertia = [("inertia", mass(self.model.structure) - 1)]
        doc = "Declared inertia of the motion along the line of centres, over m."
        return lines + valued(inertia, head, {"inertia": "return"}, doc, self.constants)
