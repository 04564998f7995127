"""Phases of a trajectory, the smooth equations of each, and the events that can end it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from casadi import SX, Function, cross, densify, fabs, fmax, fmin, horzcat, if_else, jtimes, vertcat

from ...generated.automaton import CLOSING, EVENTS, VOID_WITHOUT
from ...generated.automaton import Event as Row
from ..host.thread_caches import own_cache
from .key import ModelKey
from .model import Model, load


@dataclass(frozen=True)
class Phase:
    """A phase: region of the gap, direction of motion, contact and cavitation.

    Arguments:
        film: 1 inside the film (gap < x0), else 0.
        shear: 1 inside the edge of the tangential force, else 0.
        motion: CLOSING or OPENING; 0 of a region, which has both.
        resting: the spheres stay in contact at a constant gap.
        cavitated: inside the film, which does not act because it cavitates on opening.
        sliding: with friction, the sign of the slip in resting contact; 0 otherwise.
        rolling: with friction, resting without slip.
        sides: of the kinks of a user's laws, 1 or -1 each (`Model.kinks`).
    """

    film: int
    shear: int
    motion: int
    resting: bool = False
    cavitated: bool = False
    sliding: int = 0
    rolling: bool = False
    sides: tuple[int, ...] = ()

    def __str__(self) -> str:
        if self.resting:
            return "resting contact"
        return f"{'closing' if self.motion == CLOSING else 'opening'} {'inside' if self.film else 'beyond'} the film"

    @property
    def region(self) -> Phase:
        """What determines the equations, which both directions of motion share: the phase without one."""
        return replace(self, motion=0)

    @property
    def flags(self) -> dict[str, int]:
        """Flags of the acting forces, as arguments of the structure's functions."""
        return {"film": int(self.film and not self.cavitated), "shear": self.shear}

    @property
    def rubbing(self) -> dict[str, int]:
        """Flags of friction in resting contact, as arguments of the functions that depend on it."""
        return {"sliding": self.sliding, "rolling": int(self.rolling)}


@dataclass(frozen=True)
class Flow:
    """Equations of a region: the model's states, then the quadratures `extras`.

    Extras: `rotation` (the angle turned), and the ledger's `normal_lubrication`, `tangential_lubrication`, `capillary`,
    `attraction`, in the units of `extra_units`.

    Arguments:
        edge_watched: the tangential force ends within the range of gaps, elsewhere than the film.
    """

    choice: ModelKey
    region: Phase
    extras: tuple[str, ...] = ()
    edge_watched: bool = False

    @property
    def model(self) -> Model:
        return load(self.choice)


@dataclass(frozen=True)
class Expressions:
    """A flow as CasADi expressions: vector of variables and vector of rates."""

    variables: SX
    rates: SX


_NEGLIGIBLE = 1e-100  # in m v0^3/x0; CasADi's Rosenbrock divides by squares of slopes, which underflow


@own_cache(256)
def expressions(flow: Flow) -> Expressions:
    """Variables and rates of a flow, in time x0/v0."""
    model, region = flow.model, flow.region
    flags = region.flags | (region.rubbing if region.resting and model.friction else {})
    state = {**model.guarded, "normal_velocity": SX(0)} if region.resting else model.guarded
    name = "resting_rates" if region.resting and model.oblique else "right_hand_side"
    rates = model(name, state, flags, region.sides)
    if region.resting and not model.oblique:
        rates = rates | {"normal_velocity": SX(0)}  # head-on, the time alone goes on in resting contact
    extra_rates: dict[str, SX] = {}
    if flow.extras:
        flags.pop("rolling", None)  # rolling loses nothing
        energy_rates = model("energy_rates", state, flags, region.sides)
        extra_rates = {name: rate * (fabs(rate) > _NEGLIGIBLE) for name, rate in energy_rates.items()}
        if model.has("turning_rate"):
            extra_rates |= model("turning_rate", state)
    if model.space and "rotation" in flow.extras:
        rates, extra_rates["rotation"] = _precessing(model, state, rates)
    units = extra_units(model, flow.extras, model.parameters)
    return Expressions(
        variables=vertcat(model.column, *map(SX.sym, flow.extras)),
        rates=densify(
            vertcat(
                *(SX(rate) for rate in rates.values()),
                *(SX(extra_rates[name]) / unit for name, unit in zip(flow.extras, units, strict=True)),
            )
        ),
    )


def extra_units(model: Model, names: Sequence[str], p: Any) -> list[Any]:
    """Units of a flow's extras in a ledger's m v0^2, for groups `p`.

    That of an energy that is lost is the sum of the approach, the sliding, and the work of the strings over x0; the
    shear loses the sliding's, which may be far less. Entries of an implicit integrator's matrix that are much larger
    than those of the motion spoil the motion's digits.
    """
    group = {name: p[k] for k, name in enumerate(model.groups)}
    sliding = group.get("obliquity", 0.0) ** 2
    lost = 1 + sliding
    if model.strings:
        lost += group["weight"] * group["aspect"] / group["string_ratio"]
    sheared = lost if model.strings else fmax(sliding, _NEGLIGIBLE)
    units = {"rotation": 1.0, **dict.fromkeys(model.works, 1.0), "tangential_lubrication": sheared}
    return [units.get(name, lost) for name in names]


def _precessing(model: Model, state: dict[str, SX], rates: dict[str, SX]) -> tuple[dict[str, SX], SX]:
    """Rates in axes that turn with a rigid doublet, about the angular momentum L; their angle over |L|, as a rate.

    In these axes L is constant as well, and no function but the rates depends on the axes. A doublet that tumbles is
    nearly at rest in them, so that a stiff integrator takes large steps.
    """
    parts = model("precession", state)
    axis = vertcat(*(parts[f"momentum_{name}"] for name in "xyz"))
    turning = parts["per_momentum"]
    result = {name: SX(rate) for name, rate in rates.items()}
    for vector in dict.fromkeys(name[:-2] for name in result if name.endswith(("_x", "_y", "_z"))):
        names = [f"{vector}_{component}" for component in "xyz"]
        turned = turning * cross(axis, vertcat(*(state[name] for name in names)))
        result |= {name: result[name] - turned[k] for k, name in enumerate(names)}
    return result, turning


def event_table(flow: Flow, motion: SX) -> dict[str, SX]:
    """Guards of the events of a region by name, positive before, for either direction of motion (CLOSING or OPENING).

    The order is the precedence among coincident events. A declared event happens once.
    """
    model, region = flow.model, flow.region
    guards = model("events", region=region.flags if model.friction else None)
    table = {
        row.name: _guard(row, guards, region, motion)
        for row in EVENTS
        if all(name in guards for name in row.functions)
        and (flow.edge_watched or not row.within_reach)
        and (region.shear or model.strings or model.own_terms or not row.driven)
        and all(
            getattr(region, field) == value
            for field, value in row.where
            if field != "motion" and VOID_WITHOUT.get(field, "turning") in guards
        )
    }
    table |= {
        event.name: if_else(model.state[event.mark] > 0.5, _guard(event.row, guards, region, motion), 1)
        for event in model.own_events
        if all(getattr(region, field) == value for field, value in event.row.where if field != "motion")
    }
    if not region.resting:
        table |= {name: side * model.kinks[name] for name, side in zip(model.kinks, region.sides)}
    return table


def _guard(row: Row, guards: dict[str, SX], region: Phase, motion: SX) -> SX:
    """The guard function of an event; constant 1 in a direction of motion in which it cannot occur."""
    value = guards[row.functions[0]]
    for name in row.functions[1:]:
        value = fmin(value, guards[name])
    if row.follows == "motion":
        value = motion * value
    elif row.follows:
        value = value * (getattr(region, row.follows) or -1)
    directions = [wanted for field, wanted in row.where if field == "motion"]
    return if_else(motion == directions[0], value, 1) if directions else value


@own_cache(256)
def kinks_along(flow: Flow) -> Function:
    """The guards of the kinks in a state, and their rates: (y, groups) -> two columns."""
    parts, guards = expressions(flow), vertcat(*flow.model.kinks.values())
    rates = jtimes(guards, parts.variables, parts.rates)
    return Function("kinks", [parts.variables, flow.model.parameters], [horzcat(guards, rates)])


@own_cache(256)
def rates_along(flow: Flow) -> Function:
    """Rates of a flow's variables: (y, groups) -> a column."""
    parts = expressions(flow)
    return Function("rates", [parts.variables, flow.model.parameters], [parts.rates])
