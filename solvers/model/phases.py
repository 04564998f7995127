"""Phases of a trajectory, the smooth equations of each, and the events that can end it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from casadi import SX, densify, fmax, fmin, if_else, logic_and, vertcat

from ...generated.automaton import CLOSING, EVENTS, VOID_WITHOUT
from ...generated.automaton import Event as Row
from ..host.thread_caches import own_cache
from .model import Model, ModelKey, load


@dataclass(frozen=True)
class Phase:
    """Where the doublet is and which way it goes.

    Arguments:
        film: 1 inside the film (gap < x0), else 0.
        shear: 1 inside the edge of the tangential force, else 0.
        motion: CLOSING or OPENING.
        resting: the gap is held in contact.
        cavitated: the film is there but does not act, since it cavitates while opening.
    """

    film: int
    shear: int
    motion: int
    resting: bool = False
    cavitated: bool = False

    def __str__(self) -> str:
        if self.resting:
            return "resting contact"
        return f"{'closing' if self.motion == CLOSING else 'opening'} {'inside' if self.film else 'beyond'} the film"

    def with_(self, **changes: int | bool) -> Phase:
        return replace(self, **changes)  # type: ignore[arg-type]  # fields by keyword

    @property
    def region(self) -> Region:
        return Region(self.film, self.shear, self.resting, self.cavitated)


@dataclass(frozen=True)
class Region:
    """What of a phase the equations depend on: both directions of motion share them."""

    film: int
    shear: int
    resting: bool
    cavitated: bool = False

    @property
    def flags(self) -> dict[str, int]:
        """What acts, as the structure's functions want it."""
        return {"film": int(self.film and not self.cavitated), "shear": self.shear}


@dataclass(frozen=True)
class Flow:
    """Equations of a region: the model's states, then `extras` that are integrated along.

    Extras: `rotation` (the angle turned), and the ledger's `normal_lubrication`, `tangential_lubrication`, `capillary`,
    `attraction`.
    """

    choice: ModelKey
    region: Region
    extras: tuple[str, ...] = ()

    @property
    def model(self) -> Model:
        return load(self.choice)


@dataclass(frozen=True)
class Expressions:
    """A flow as CasADi expressions: vector of variables, their rates."""

    variables: SX
    extras: dict[str, SX]
    rates: SX


@own_cache(256)
def expressions(flow: Flow) -> Expressions:
    """Variables and rates of a flow, in time x0/v0."""
    model, region = flow.model, flow.region
    flags = region.flags
    state = {**model.guarded, "normal_velocity": SX(0)} if region.resting else model.guarded
    rates = model("resting_rates" if region.resting and model.oblique else "right_hand_side", state, flags)
    if region.resting and not model.oblique:
        rates = dict.fromkeys(rates, SX(0))  # head-on nothing moves in resting contact
    extra_rates: dict[str, SX] = {}
    if flow.extras:
        extra_rates = model("energy_rates", state, flags)
        if model.has("turning_rate"):
            extra_rates |= model("turning_rate", state)
    extras = {name: SX.sym(name) for name in flow.extras}
    return Expressions(
        variables=vertcat(model.column, *extras.values()),
        extras=extras,
        rates=densify(
            vertcat(*(SX(rate) for rate in rates.values()), *(SX(extra_rates[name]) for name in flow.extras))
        ),
    )


@dataclass(frozen=True)
class Event:
    """A function that is positive before the event; `dips` if it may fall below zero and return within a step."""

    name: str
    function: SX
    dips: bool = False


@dataclass(frozen=True)
class WatchedEvents:
    """What an event table depends on besides the flow.

    Arguments:
        tangential_edge: the edge of the tangential force lies within reach and is not the film's own.
        certificate: watch for the proof of a stick: "energy" below a level, or "pendulum" by a margin.
    """

    tangential_edge: bool = False
    certificate: str | None = None


def event_table(flow: Flow, watch: WatchedEvents, motion: SX, level: SX) -> tuple[Event, ...]:
    """The events of a region, for either direction of motion (`motion` is CLOSING or OPENING).

    The order is the order of precedence among coincident ones. `level` is the energy below which a stick is proved, or
    the relative margin by which the proof on strings must hold.
    """
    model, region = flow.model, flow.region
    found = model("events")
    table = [
        Event(row.name, _guard(row, found, region, motion), row.dips)
        for row in EVENTS
        if all(name in found for name in row.functions)
        and (watch.tangential_edge or not row.within_reach)
        and all(
            getattr(region, part) == value
            for part, value in row.where
            if part != "motion" and VOID_WITHOUT.get(part, "turning") in found
        )
    ]
    if watch.certificate == "energy":
        table.append(Event("certified", mechanical_energy(flow) - level))
    elif watch.certificate == "pendulum":
        table.append(Event("certified", pendulum_margin(model, level)))
    return tuple(table)


def _guard(row: Row, found: dict[str, SX], region: Region, motion: SX) -> SX:
    """The function of an event, positive before it; 1 in the direction of motion in which it is not watched."""
    value = found[row.functions[0]]
    for name in row.functions[1:]:
        value = fmin(value, found[name])
    if row.follows == "motion":
        value = motion * value
    elif row.follows:
        value = value * (1 if getattr(region, row.follows) else -1)
    directions = [wanted for part, wanted in row.where if part == "motion"]
    return if_else(motion == directions[0], value, 1) if directions else value


def pendulum_margin(model: Model, margin: SX | float) -> SX:
    """Negative where the proof on strings holds by the relative `margin`: the worst of its three inequalities.

    Not negative where one of them is not a number: fmax would leave that one out.
    """
    found = model("pendulum_margins")
    outward, pull = found["outward"], found["pull"]
    slack = margin * fmax(model.groups["stokes"], 1)
    parts = (outward - pull + margin * (outward + pull), found["film"] + slack, found["recoil"] + slack)
    worst = fmax(fmax(parts[0], parts[1]), parts[2])
    return if_else(logic_and(logic_and(parts[0] < 0, parts[1] < 0), parts[2] < 0), worst, fmax(worst, 0))


def mechanical_energy(flow: Flow) -> SX:
    """Kinetic energy, work against attractions so far and, head-on, the strings' potential, over m v0^2."""
    model, extras = flow.model, expressions(flow).extras
    energy = sum(model(model.escape).values(), SX(0))
    return sum((extras[work] for work in model.works if work in extras), energy)
