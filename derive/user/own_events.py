"""Events of a user's model: what a file declares, judged on the spot, and its form in the equations of a structure.

    snapped = event("snap", guard=critical - u / x, where="opening beyond the film", ends="separated")

Each event has a state of its own, its mark: 1 before the event, 0 after it. `event` returns the mark, which laws of the
same file may use as a factor. As a state it needs no further machinery in derivatives, recurrences and records.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

import sympy as sp

from ..equations.automaton import CLOSING, EVENTS, OPENING, WORDS, Event
from ..equations.functions import ModelFunction
from ..equations.model import GROUPS, Model
from ..equations.terms import CLOCKS, settled
from ..physics.mechanics import equations_of_motion
from ..physics.scaling import DISTANCE, to_groups
from ..physics.structure import Structure
from ..physics.terms import STILL
from ..vocabulary import quantities as q
from ..vocabulary.dimensions import RATE, SPEED, Dimension
from .kinks import rounded

ACCEPTED = "x, u, omega, xi, beta, t, r, quantities of a scene and of the model file, marks of other events"
MOVING = (q.x, q.u, q.omega, q.xi, q.beta, q.t)  # a guard depends on one of them at least
JUMPS: dict[sp.Symbol, Dimension] = {q.u: SPEED, q.omega: RATE, q.xi: RATE}
WORD = re.compile(r"[a-z][a-z0-9]*( [a-z0-9]+)*")
TAKEN_WORDS = {row.word for row in WORDS}
TAKEN_NAMES = {name for row in EVENTS for name in (row.name, *row.functions)}
Form = tuple[sp.Expr, dict[sp.Symbol, sp.Expr], sp.Expr]
"""Guard, state after the jump as far as it jumps, and release of an event in a structure."""
AT_REST = {  # what changes in resting contact, by what it is called there
    "rotation": (q.orbital_momentum, q.spin, q.partner_spin), "angle": (q.angle_turned, q.beta),
    "time": (q.time_passed,),
}  # fmt: skip
MARK = "before_"  # and the name of an event: its mark
MOTIONS = {"closing": CLOSING, "opening": OPENING, "any": 0}
REGIONS = {"": None, "inside the film": 1, "beyond the film": 0}
PLACES = tuple(f"{motion} {region}".strip() for motion in MOTIONS for region in REGIONS)
ENDINGS = {"": "go on", "separated": "part", "stick": "cut off"}


@dataclass(frozen=True)
class Proposed:
    """An event as declared, in SI.

    Arguments:
        mark: its state, 1 before the event and 0 after it.
        word: its name in reports.
        where: a direction of motion, and a part of the film, of PLACES.
        jump: normal velocity u, rotation rate omega or spins xi just after the event.
        ends: "", "separated" or "stick".
        releases: stored energy that may go into the motion, J.
    """

    name: str
    word: str
    mark: sp.Symbol
    guard: sp.Expr
    where: str
    jump: tuple[tuple[sp.Symbol, sp.Expr], ...]
    ends: str
    releases: sp.Expr
    meaning: str
    source: str

    @property
    def expressions(self) -> tuple[sp.Expr, ...]:
        return (self.guard, self.releases, *(value for _, value in self.jump))

    @property
    def row(self) -> Event:
        """Its row in the table of events, behind the library's."""
        motion, region = self.where.partition(" ")[::2]
        directed = MOTIONS[motion] or None  # resting contact has no direction: what is watched in any is watched there
        watched = {"resting": 0 if directed else None, "motion": directed, "film": REGIONS[region]}
        where = tuple((component, value) for component, value in watched.items() if value is not None)
        actions = (f"jump {self.name}", ENDINGS[self.ends])
        return Event(self.name, (self.name,), where, (self.word,), actions, (), dips=True)


@dataclass(frozen=True)
class Reach:
    """How a guard varies: signs of its slopes along the gap and along the speed |u|; None where no sign is shown.

    `alone`: it depends on gap and normal velocity only. A guard with both signs is positive in a region if it is so in
    the worst corner.
    """

    alone: bool
    by_gap: int | None
    opening: int | None
    closing: int | None

    @property
    def is_known(self) -> bool:
        return self.alone and self.by_gap is not None


@dataclass(frozen=True)
class OwnEvent:
    """A declared event with `let` parts substituted and its quantities as groups, dimensionless in SI symbols.

    Arguments:
        guard: over m^i x0^j v0^k of its dimension. jump: (quantity, value over v0 or rate_scale).
        releases: over m v0^2.
        used: a law, or the guard of another event, depends on its mark.
    """

    proposed: Proposed
    guard: sp.Expr
    jump: tuple[tuple[sp.Symbol, sp.Expr], ...]
    releases: sp.Expr
    used: bool = False

    @property
    def name(self) -> str:
        return self.proposed.name

    @property
    def mark(self) -> sp.Symbol:
        return self.proposed.mark

    @property
    def symbols(self) -> set[sp.Symbol]:
        """The symbols of guard, release and jump."""
        return set().union(*(e.free_symbols for e in (self.guard, self.releases, *(value for _, value in self.jump))))

    @property
    def rotates(self) -> bool:
        """The guard or the jump speaks of a rotation, which there is none of beside a wall."""
        return bool({*self.symbols, *(target for target, _ in self.jump)} & {*STILL, q.omega0})

    @cached_property
    def turns(self) -> bool:
        """Its guard varies with a rotation only, so that nothing happens head-on."""
        return not sp.simplify(self.guard.xreplace(STILL)).free_symbols & {q.x, q.u, q.t}

    @property
    def spins(self) -> bool:
        """The jump changes the rotation, so that the spin cannot be eliminated by the angular momentum."""
        return any(target in (q.omega, q.xi) for target, _ in self.jump)

    @cached_property
    def takes(self) -> bool:
        """True if its jump is shown to never add kinetic energy."""
        after = {target: value * (q.v0 if target == q.u else q.rate_scale) for target, value in self.jump}
        kinetic = equations_of_motion().kinetic_energy
        change = sp.factor(sp.simplify(sp.expand(kinetic.xreplace(after)) - sp.expand(kinetic)))
        return bool(change == 0 or change.is_nonpositive)

    @property
    def harmless(self) -> bool:
        """Shown to leave every barrier of the energy as it is: it adds none, keeps L and the laws, and does not end."""
        return self.takes and not self.spins and not self.used and self.proposed.ends != "separated"

    @property
    def keeps_direction(self) -> bool:
        """True if its jump is shown to never reverse the motion."""
        return bool(sp.simplify(dict(self.jump).get(q.u, q.u / q.v0) * q.v0 / q.u).is_nonnegative)

    def reach(self, of: Structure) -> Reach:
        """How its guard varies in a structure, by the signs of its derivatives for every positive group."""
        guard = self.in_structure(of)[0]
        moving = {symbol for symbols in AT_REST.values() for symbol in symbols}
        speed, closer = sp.Symbol("speed", positive=True), sp.Symbol("gap", positive=True)

        def sign(value: sp.Expr) -> int | None:
            value = sp.factor(sp.simplify(value))
            return 1 if value.is_nonnegative else -1 if value.is_nonpositive else None

        def along(direction: int) -> tuple[int | None, int | None]:
            form = guard.xreplace({q.normal_velocity: direction * speed, q.gap: closer})
            return sign(form.diff(closer)), sign(form.diff(speed))

        (first, opening), (second, closing) = along(OPENING), along(CLOSING)
        watched = MOTIONS[self.proposed.where.partition(" ")[0]]
        by_gap = first if watched == OPENING else second if watched == CLOSING else first if first == second else None
        if by_gap is None or (watched != CLOSING and opening is None) or (watched != OPENING and closing is None):
            return Reach(False, None, None, None)
        return Reach(not moving & guard.free_symbols, by_gap, opening, closing)

    def fits(self, structure: Structure) -> bool:
        """Whether a structure can have the event."""
        if not structure.oblique:
            return not self.turns
        return not (structure.partner == "wall" and self.rotates) and not (structure.reduced and self.spins)

    def in_structure(self, structure: Structure) -> Form:
        """Guard, jump of the states, and release over m v0^2, in states and groups of a structure."""

        def put(value: sp.Expr) -> sp.Expr:
            return settled(f"event {self.name}", value, structure)

        jump: dict[sp.Symbol, sp.Expr] = {}
        for target, value in self.jump:
            if target == q.u:
                jump[q.normal_velocity] = put(value)
            elif structure.oblique and target == q.omega:
                jump[q.orbital_momentum] = put(value) * DISTANCE**2
            elif structure.oblique:
                jump[q.spin] = put(value)
                if structure.partner == "pair":
                    jump[q.partner_spin] = put(value.xreplace({q.xi: q.partner_spin_rate}))
        return put(self.guard), jump, put(self.releases)


def extended(model: Model, events: tuple[OwnEvent, ...]) -> Model:
    """A structure's model with the states, guards and jumps of declared events, without the proofs they void."""
    present = [event for event in events if event.fits(model.structure)]
    called = set().union(*(value.free_symbols for function in model.functions for _, value in function.outputs))
    called = called.union(*(value.free_symbols for _, value in model.definitions))
    # the mark of an event that never happens in this structure stays 1 for the laws that have it
    marks = tuple(event.mark for event in events if event in present or event.mark in called)
    if not marks:
        return model
    forms = {}
    for event in present:
        guard, jump, released = event.in_structure(model.structure)
        forms[event.name] = rounded(guard), {state: rounded(value) for state, value in jump.items()}, rounded(released)
    guards, watched = _in_order(forms, together(present, model.structure)), groups_of(events, model.structure)
    clocks = {q.angle_turned: model["turning_rate"][q.beta.name]} if q.angle_turned in watched else {}
    clocks |= {q.time_passed: sp.Integer(1)} if q.time_passed in watched else {}
    clocks = {state: rate for state, rate in clocks.items() if state not in model.states}  # which terms watch already
    rates = {**dict.fromkeys(marks, sp.Integer(0)), **clocks}
    same = {state: state for state in rates}
    more: dict[str, Mapping[sp.Symbol, sp.Expr]] = {
        "right_hand_side": rates, "resting_rates": rates, "rebound": same, "rigid_rotation": same, "rubbed": same,
        "start": {state: sp.Integer(state in marks) for state in rates},
    }  # fmt: skip
    functions = []
    for function in model.functions:
        if function.certificate:
            continue
        outputs = function.outputs + tuple((mark.name, value) for mark, value in more.get(function.name, {}).items())
        if function.name == "events":
            outputs += tuple(guards.items())
        functions.append(replace(function, outputs=outputs))
    states = (*model.states, *rates)
    for item in present:
        _, jump, released = forms[item.name]
        after = {state: jump.get(state, state) for state in states} | {item.mark: sp.Integer(0)}
        doc = f"State just after the event {item.name}: {item.proposed.meaning}."
        functions.append(ModelFunction(f"jump_{item.name}", doc, tuple((state.name, after[state]) for state in states)))
        doc = f"Stored energy over m v0^2 that the event {item.name} may give to the motion."
        functions.append(ModelFunction(f"release_{item.name}", doc, (("released", released),)))
    return replace(model, states=states, functions=tuple(functions))


def together(events: Sequence[OwnEvent], structure: Structure) -> dict[str, OwnEvent]:
    """By name of an event, one before it in the file whose guard falls to zero with its own in a structure."""
    present = [event for event in events if event.fits(structure)]
    if len(present) < 2:
        return {}
    guards = {event.name: event.in_structure(structure)[0] for event in present}
    pairs = ((event, first) for place, event in enumerate(present) for first in present[:place])
    return {
        event.name: first
        for event, first in pairs
        if event.proposed.where == first.proposed.where and _is_positive(guards[event.name] / guards[first.name])
    }


@cache  # guards are the same in most structures
def _is_positive(expression: sp.Expr) -> bool:
    return bool(sp.simplify(expression).is_positive)


def _in_order(forms: Mapping[str, Form], waits: Mapping[str, OwnEvent]) -> dict[str, sp.Expr]:
    """The guards, of which one waits for the event that it falls to zero with.

    If the earlier jump leaves the guard and the direction as they are, the later event follows at once.
    """
    guards = {name: guard for name, (guard, _, _) in forms.items()}
    for name, first in waits.items():
        guard, jump = guards[name], forms[first.name][1]
        keeps = sp.simplify(guard.xreplace(jump) - guard) == 0
        keeps &= bool(sp.simplify(jump.get(q.normal_velocity, q.normal_velocity) / q.normal_velocity).is_positive)
        guards[name] = first.mark - sp.Rational(1, 2) if keeps else guard * (1 - first.mark) + first.mark
    return guards


def groups_of(events: tuple[OwnEvent, ...], structure: Structure) -> set[sp.Basic]:
    """Symbols that the events bring into a structure."""
    forms = (event.in_structure(structure) for event in events if event.fits(structure))
    return {
        s for guard, jump, released in forms for value in (guard, released, *jump.values()) for s in value.free_symbols
    }


def scale_of(dimension: Dimension) -> sp.Expr:
    """m^i x0^j v0^k of a dimension."""
    mass, length, time = map(sp.sympify, dimension.exponents)
    return q.m**mass * q.x0 ** (length + time) * q.v0**-time


def may_use(symbol: sp.Basic) -> bool:
    """Whether a symbol of the vocabulary may occur in an event: the motion, groups, and quantities with a group."""
    return symbol in {*to_groups(), *CLOCKS, *GROUPS, q.a, q.mu, q.v0} - {q.partner_spin_rate}
