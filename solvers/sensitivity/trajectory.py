"""A replayed collision as one differentiable CasADi expression of its groups and durations.

    groups p -> start -> flow -> landing -> jump -> flow -> landing -> ... -> outputs

* `start`, the right-hand sides, the events' guards, the rebounds and `outputs` are the emitted functions of the model.
* A *flow* is CVODES or Rosenbrock over the duration of a phase, a constant (`engines/casadi/integrators.py`).
* A *landing* is one Taylor step onto the surface of the event that ends the phase. At the durations of the replay it is
  almost zero, but its derivative is the saltation.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from casadi import DM, MX, Function, fmin, vertcat

from ..engines.casadi.integrators import Tolerance, landing, plain
from ..engines.casadi.replay import Replay
from ..engines.casadi.sequence import EventSequence, PhaseRun
from ..host.thread_caches import own_cache
from ..model.key import ModelKey
from ..model.model import Model, load
from ..model.phases import Flow, extra_units
from ..model.rebound import reset, rubs
from ..results import DEFINITIONS, SPENT
from ..scene.groups import GAPS, contact_word

STATE = "state."  # begins the name of a component of the last state, among results


@dataclass(frozen=True)
class Course:
    """A model and the legs of a collision: the key of its cached expression.

    A leg is a phase of the record, without its times and words, or its part up to a kink; its duration is 1, or 0 where
    the event happens as the last leg ends.
    """

    choice: ModelKey
    extras: tuple[str, ...]  # quadratures
    legs: tuple[PhaseRun, ...]
    edge_watched: bool

    @cached_property
    def model(self) -> Model:
        return load(self.choice)

    @property
    def durations(self) -> int:
        """How many legs are integrated."""
        return sum(leg.duration > 0 for leg in self.legs)

    def reset(self, leg: PhaseRun) -> Function:
        """What happens at the end of a leg (`model.rebound.reset`)."""
        return reset(self.choice, leg.criterion, leg.holds, leg.own)

    def influences(self, groups: Mapping[str, float]) -> np.ndarray:
        """Mask of the groups that influence the course: not those of rebound criteria that it does not meet."""
        landed = {leg.event for leg in self.legs}
        met = GAPS[contact_word(groups)] if "contact" in landed else None
        absent = {
            "glass_number": "glass" not in landed,
            **{gap: gap != met for gap in GAPS.values()},
            "dry_restitution": not any(leg.rebounds for leg in self.legs),
            **dict.fromkeys(
                ("friction", "contact_tangential_restitution"),
                not any(rubs(self.model, leg.criterion) for leg in self.legs),
            ),
        }
        return np.array([not absent.get(name, False) for name in self.model.groups])


def course_of(path: EventSequence, replay: Replay, choice: ModelKey) -> Course:
    """The course of a replay of a collision; phases are its pieces, which kinks of a law's force divide."""
    model, pieces, legs = load(choice), iter(replay.pieces), []
    for step in path.steps:
        last = replace(step, duration=0.0, event=None, kinds=step.kinds[:1] if step.rebounds else ())
        if step.duration > 0:
            piece = next(pieces)
            while piece.event in model.kinks:
                legs.append(PhaseRun(piece.phase, 1.0, piece.event, ()))
                piece = next(pieces)
            last = replace(last, phase=piece.phase, duration=1.0, event=piece.event)
        legs.append(last)
    return Course(choice, replay.extras, tuple(legs), path.edge_watched)


@dataclass
class End:
    """Last state of a course and what it sums up, as expressions in the groups and durations; `y` has the extras."""

    start: MX
    y: MX
    time: MX
    smallest_gap: MX
    lost: MX  # by rebounds, by their friction, to declared events
    shifts: list[MX]  # by the landings, relative to the durations


def follow(course: Course, p: MX, durations: MX, plugin: str, tolerance: Tolerance) -> End:
    """A course from initial contact on."""
    model, k = course.model, 0
    size = len(model.state)
    start = model.function("start")(DM.zeros(size), p)
    y = vertcat(start, DM.ones(len(course.extras)) * tolerance.offset)
    at = End(start, y, MX(0), start[0], MX.zeros(3), [])
    for leg in course.legs:
        if leg.duration > 0:
            flow = Flow(course.choice, leg.phase.region, course.extras, course.edge_watched)
            at.y = plain(flow, plugin, tolerance).function(x0=at.y, p=vertcat(p, durations[k]))["xf"]
            at.time += durations[k]
            shift = MX(0)
            if leg.event is not None:
                at.y, shift, _ = landing(flow, leg.event)(at.y, vertcat(p, leg.phase.motion))
            at.time += shift
            at.shifts.append(shift / durations[k])
            at.smallest_gap = fmin(at.smallest_gap, at.y[0])
            k += 1
        if leg.rebounds or leg.holds or leg.own:
            after, *lost, _ = course.reset(leg)(at.y[:size], p)
            at.lost += vertcat(*lost)
            at.y = vertcat(after, at.y[size:])
    return at


@own_cache(256)
def trajectory(course: Course, of: tuple[str, ...], plugin: str, tolerance: Tolerance) -> Function:
    """A course as a function: (groups, durations) -> results `of`, and shifts of the durations by the landings."""
    p, durations = MX.sym("groups", len(course.model.groups)), MX.sym("durations", course.durations)
    end = follow(course, p, durations, plugin, tolerance)
    shifts = vertcat(*end.shifts) if end.shifts else MX(0, 1)
    named = results(course, p, end, tolerance)
    column = vertcat(*(named.get(name, MX(0)) for name in of))
    return Function("trajectory", [p, durations], [column, shifts])


def results(course: Course, p: MX, end: End, tolerance: Tolerance) -> dict[str, MX]:
    """Results by their names in `DEFINITIONS`, and the last state by `STATE` and the names of its components."""
    model = course.model
    size = len(model.state)
    y = end.y[:size]
    before, after = (model.function("energies")(s, p) for s in (end.start, y))
    symbols = (model.column, model.parameters)
    outputs = model.function("outputs")(*symbols)
    # a function each: head-on the slope of a tangential restitution is infinite, and zero times it no number
    functions = {name: Function(name, symbols, [outputs[k]]) for k, name in enumerate(model.names("outputs"))}
    named = {name: function(y, p) for name, function in functions.items()}
    energies = {name: (before[k], after[k]) for k, name in enumerate(model.names("energies"))}
    named |= {"contact_time": end.time, "smallest_gap": end.smallest_gap}
    named |= {"energy.dry_contact": end.lost[0], "energy.own_events": end.lost[2]}
    named["energy.initial"], named["energy.final"] = energies["kinetic"]
    if "strings" in energies:
        named["energy.strings"] = energies["strings"][1] - energies["strings"][0]
    if model.oblique:
        first, last = (model.function("surface_slip")(state, p) for state in (end.start, y))
        named["slip_restitution"] = last / first
    if "rotation" in model.state:
        named["rotation"] = y[list(model.state).index("rotation")]
    for k, (name, unit) in enumerate(zip(course.extras, extra_units(model, course.extras, p), strict=True)):
        named[name if name == "rotation" else f"energy.{name}"] = unit * (end.y[size + k] - tolerance.offset)
    if model.own_terms:
        before, after = energies.get("own_energy", (MX(0), MX(0)))
        named["energy.own_terms"] = after - before + named.pop("energy.own_work", MX(0))
    named["energy.dry_friction"] = named.get("energy.dry_friction", MX(0)) + end.lost[1]
    spent = sum((named[name] for name in SPENT if name in named), named["energy.final"])
    named["energy.residual"] = named["energy.initial"] - spent
    return named | {STATE + name: y[k] for k, name in enumerate(model.state)}


def quadratures(model: Model, of: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the quadratures that results need: the rotation where it is no state, and terms of the ledger."""
    turns = model.has("turning_rate") and not model.strings
    has = {*model.names("energy_rates"), *(("rotation",) if turns else ())}
    every = dict.fromkeys((*of, *SPENT) if "energy.residual" in of else of)
    rows = (DEFINITIONS[name] for name in every if name in DEFINITIONS)
    wanted = ["own_work" if row.term == "own_terms" else row.term for row in rows if row.integral]
    return tuple(name for name in wanted if name in has)
