"""A located trajectory as one CasADi expression: phases over constant durations, landings on events, and jumps.

A landing is a correction of the state onto the event's surface. At the located durations it is almost zero, but its
derivative is the saltation, so that CasADi can differentiate the whole trajectory.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from casadi import DM, MX, Function, vertcat

from ..engines.casadi.integrators import Tolerance, landing, plain
from ..engines.casadi.locate import EventSequence
from ..host.thread_caches import own_cache
from ..model.key import ModelKey
from ..model.model import Model, load
from ..model.phases import Flow, Phase, WatchedEvents, extra_units
from ..model.rebound import jump, rubs
from ..results import DEFINITIONS
from ..scene.contact import GAPS, contact_word

# argument of the guards for the certificate's level, which is not used here
_NO_LEVEL = 0.0


@dataclass(frozen=True)
class Leg:
    """A phase of a trajectory, as `PhaseRun` without its duration, and what happens at its end."""

    phase: Phase
    lasts: bool  # it has a duration; else only its end counts
    event: str | None  # on which it ends; None if it just ends
    rebounds: bool
    holds: bool  # the normal velocity is set to zero at its end
    rubs: bool = False  # the rebound at its end is with dry friction
    declared: str = ""  # the declared event that happens at its end


@dataclass(frozen=True)
class Course:
    """An `EventSequence` reduced to what its expression depends on: the key of the cached expression.

    Arguments:
        nearest: index of the leg at whose end the gap is smallest; -1 for initial contact.
    """

    choice: ModelKey
    legs: tuple[Leg, ...]
    tangential_edge: bool
    nearest: int

    @cached_property
    def model(self) -> Model:
        return load(self.choice)

    @property
    def watch(self) -> WatchedEvents:
        return WatchedEvents(tangential_edge=self.tangential_edge)


def course_of(path: EventSequence, choice: ModelKey) -> Course:
    """The course of a located trajectory, by its reduced model or by the full form of that."""
    legs = tuple(
        Leg(
            step.phase, step.duration > 0, step.event, step.rebounds, step.holds,
            rubs=step.rebounds and rubs(path.model, step.kinds[0]), declared=step.own,
        )
        for step in path.steps
    )  # fmt: skip
    gaps = [1.0, *(float(end[0]) for end in path.ends)]
    return Course(choice, legs, path.watch.tangential_edge, int(np.argmin(gaps)) - 1)


@dataclass(frozen=True)
class TrajectoryExpression:
    """A course as a function: (groups, durations) -> quantities `of`, relative shifts of durations by the landings."""

    function: Function
    of: tuple[str, ...]
    groups: tuple[str, ...]


@dataclass
class CourseState:
    """Final state of a course, as expressions in its groups and durations; `y` includes the quadratures."""

    start: MX
    y: MX
    time: MX
    dry: MX
    friction: MX
    nearest: MX
    shifts: list[MX]


def follow_course(
    course: Course, p: MX, durations: MX, extras: tuple[str, ...], plugin: str, tolerance: Tolerance
) -> CourseState:
    """Build the expressions of a course from initial contact on."""
    model = course.model
    size = len(model.state)
    start = model.function("start")(DM.zeros(size), p)
    at = CourseState(start, vertcat(start, DM.ones(len(extras)) * tolerance.offset), MX(0), MX(0), MX(0), start[0], [])
    for k, leg in enumerate(course.legs):
        if leg.lasts:
            flow = Flow(course.choice, leg.phase.region, extras)
            engine = plain(flow, plugin, tolerance).function
            at.y = engine(x0=at.y, p=vertcat(p, durations[k]))["xf"]
            at.time += durations[k]
            if leg.event is not None:
                land = landing(flow, course.watch, leg.event)
                at.y, dt, _ = land(at.y, vertcat(p, leg.phase.motion, _NO_LEVEL))
                at.time += dt
                at.shifts.append(dt / durations[k])
        if k == course.nearest:
            at.nearest = at.y[0]
        if leg.rebounds:
            after, dry, friction = jump(course.choice, leg.holds)(at.y[:size], p, float(leg.rubs))
            at.dry += dry
            at.friction += friction
            at.y = vertcat(after, at.y[size:])
        if leg.holds:
            at.y = vertcat(at.y[0], 0, at.y[2:])
        if leg.declared:
            at.y = vertcat(model.function(f"jump_{leg.declared}")(at.y[:size], p), at.y[size:])
    return at


def symbols(course: Course) -> tuple[MX, MX]:
    """Symbols for a course's groups and durations."""
    return MX.sym("groups", len(course.model.groups)), MX.sym("durations", len(course.legs))


@own_cache(256)
def trajectory_expression(
    course: Course, of: tuple[str, ...], plugin: str, tolerance: Tolerance
) -> TrajectoryExpression:
    """The expression of the requested quantities of a course, with only the quadratures that they need."""
    model = course.model
    extras, size = _extras(model, of), len(model.state)
    p, durations = symbols(course)
    at = follow_course(course, p, durations, extras, plugin, tolerance)
    quantities: dict[str, Any] = {"contact_time": at.time, "smallest_gap": at.nearest, "energy.dry_contact": at.dry}
    quantities |= _at_the_end(model, at.start, at.y[:size], p)
    for k, (name, unit) in enumerate(zip(extras, extra_units(model, extras, p), strict=True)):
        key = name if name == "rotation" else f"energy.{name}"
        quantities[key] = unit * (at.y[size + k] - tolerance.offset)
    quantities["energy.dry_friction"] = quantities.get("energy.dry_friction", MX(0)) + at.friction
    column = vertcat(*(quantities.get(name, MX(0)) for name in of))
    missed = vertcat(*at.shifts) if at.shifts else MX(0, 1)
    return TrajectoryExpression(Function("trajectory", [p, durations], [column, missed]), of, tuple(model.groups))


@own_cache(256)
def ending(course: Course, plugin: str, tolerance: Tolerance) -> TrajectoryExpression:
    """The expression of the final state of a course."""
    p, durations = symbols(course)
    at = follow_course(course, p, durations, (), plugin, tolerance)
    missed = vertcat(*at.shifts) if at.shifts else MX(0, 1)
    return TrajectoryExpression(
        Function("ending", [p, durations], [at.y, missed]), tuple(course.model.state), tuple(course.model.groups)
    )


def _extras(model: Model, of: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the quadratures needed: the rotation where it is not a state, and terms of the energy ledger."""
    wanted = [DEFINITIONS[name].term for name in of if DEFINITIONS[name].integral]
    turns = model.has("turning_rate") and not model.strings
    has = {*model.names("energy_rates"), *(("rotation",) if turns else ())}
    return tuple(name for name in wanted if name in has)


def _at_the_end(model: Model, start: MX, y: MX, p: MX) -> dict[str, MX]:
    outputs = model.function("outputs")(y, p)
    outputs_by_name = {name: outputs[k] for k, name in enumerate(model.names("outputs"))}
    before, after = (model.function("energies")(state, p) for state in (start, y))
    names = model.names("energies")
    kinetic = names.index("kinetic")
    outputs_by_name |= {"energy.initial": before[kinetic], "energy.final": after[kinetic]}
    if "strings" in names:
        outputs_by_name["energy.strings"] = after[names.index("strings")] - before[names.index("strings")]
    if model.oblique:
        first, last = (model.function("surface_slip")(state, p) for state in (start, y))
        outputs_by_name["slip_restitution"] = last / first
    if "rotation" in model.state:
        outputs_by_name["rotation"] = y[list(model.state).index("rotation")]
    return outputs_by_name


def influential(course: Course, groups: dict[str, float]) -> list[bool]:
    """Mask of the groups that influence a course: not those of rebound criteria that it does not meet."""
    landed = {leg.event for leg in course.legs}
    met = GAPS[contact_word(groups)] if "contact" in landed else None
    absent = {
        "glass_number": "glass" not in landed,
        **{gap: gap != met for gap in GAPS.values()},
        "dry_restitution": not any(leg.rebounds for leg in course.legs),
        **dict.fromkeys(("friction", "contact_tangential_restitution"), not any(leg.rubs for leg in course.legs)),
    }
    return [not absent.get(name, False) for name in course.model.groups]
