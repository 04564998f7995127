"""Integration of located phases with the chosen engine: smooth flows over known durations, each landed on its event.

The sequence of phases and events is given. The engine's own solution meets each event at a slightly different time,
which the landing step corrects, so that events and their derivatives are those of the engine.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from casadi import SX, Function, jtimes, vertcat

from ...host.thread_caches import own_cache
from ...model.key import ModelKey
from ...model.phases import Flow, WatchedEvents, event_table, expressions, extra_units
from ...model.rebound import rebounded
from ..settings import CVODES, Budget
from .integrators import IntegrationFailed, Tolerance, landing, plain
from .locate import EventSequence, PhaseRun, own_loss

_LANDED = 1e-4  # largest Taylor step, relative to the phase, for landing without another integration
_MISSES = 1e-13  # largest value of an event's function after the step, relative to its scale
_RISES = 1e-9  # in its scale per duration: slope above which the function rises at the landing
_TRIES = 8
_ROUNDING = 1e-15  # noise of a gap or velocity of order 1, for times and event functions


class Stopped(Exception):
    """Failure of the engine in a phase: reason, phase, time (x0/v0) and state.

    `missed`: the solution does not meet the located event; a tighter tolerance may help.
    """

    def __init__(self, why: str, step: PhaseRun, time: float, y: np.ndarray, missed: bool = False) -> None:
        super().__init__(why, step, time, y, missed)
        self.why, self.step, self.time, self.y, self.missed = why, step, time, y, missed


@dataclass(frozen=True)
class Piece:
    """An integrated phase: name, flow, initial state, start time and duration (x0/v0)."""

    name: str
    flow: Flow
    start: np.ndarray
    time: float
    duration: float


@dataclass
class Replay:
    """An event sequence as integrated by one engine; states include the extras, times are in x0/v0."""

    y: np.ndarray
    extras: tuple[str, ...] = ()
    units: Sequence[float] = ()  # of the extras
    offset: float = 0.0
    time: float = 0.0
    steps: int = 0
    smallest_gap: float = 1.0
    dry_loss: float = 0.0
    friction_loss: float = 0.0
    own_loss: float = 0.0
    events: list[tuple[str, float]] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)

    def extra(self, name: str) -> float:
        """The final value of a quadrature, of an energy in m v0^2."""
        position = self.extras.index(name)
        return float(self.units[position]) * (float(self.y[len(self.y) - len(self.extras) + position]) - self.offset)


def replay(
    path: EventSequence, plugin: str, tolerance: Tolerance, kind: Flow, start: np.ndarray, budget: Budget | None = None
) -> Replay:
    """Integrate the event sequence `path` with an integrator plugin; Stopped if the engine fails or misses an event.

    Arguments:
        kind: the model and its extras (flags of film and shear are taken from the sequence).
        start: state at initial contact.
        budget: of its steps; None for those of the tolerance.
    """
    model = kind.model
    known = dict(zip(path.model.groups, path.p, strict=True))
    p = model.group_values(known)
    start = np.concatenate([start, np.full(len(kind.extras), tolerance.offset)])
    replayed = Replay(start, kind.extras, extra_units(model, kind.extras, p), tolerance.offset)
    size = len(model.state)
    budget = budget or Budget(tolerance.steps)
    for step in path.steps:
        flow = Flow(kind.choice, step.phase.region, kind.extras)
        if step.duration > 0:
            before = replayed.y
            given = flow, plugin, tolerance, budget, path.watch, step, replayed, p
            duration, replayed.y = _integrate_onto_event(*given)
            replayed.pieces.append(Piece(str(step.phase), flow, before, replayed.time, duration))
            replayed.time += duration
        replayed.events += [(kind, replayed.time) for kind in step.kinds]
        replayed.smallest_gap = min(replayed.smallest_gap, float(replayed.y[0]))
        if step.rebounds:
            jump = rebounded(model, step.kinds[0], replayed.y, p, step.holds)
            replayed.dry_loss += jump.dry
            replayed.friction_loss += jump.friction
            replayed.y = np.concatenate([jump.after, replayed.y[size:]])
        if step.holds:  # chatter dissipates what remains of the rebound's energy
            replayed.dry_loss += float(replayed.y[1]) ** 2 / 2
            replayed.y[1] = 0.0
        if step.own:
            jumped = np.array([*model.values(f"jump_{step.own}", replayed.y, p).values(), *replayed.y[size:]])
            replayed.own_loss += own_loss(model, replayed.y, jumped, p)
            replayed.y = jumped
    return replayed


def as_located(path: EventSequence, choice: ModelKey) -> Replay:
    """The located trajectory itself with its extras: its own solution, which meets its events by construction."""
    start = path.model.start(path.p)
    begun = np.concatenate([start, np.zeros(len(path.extras))])
    units = extra_units(path.model, path.extras, path.p)
    replayed = Replay(path.y, path.extras, units, smallest_gap=path.smallest_gap, dry_loss=path.dry_loss)
    replayed.friction_loss = path.friction_loss
    replayed.own_loss = path.own_loss
    for step, end in zip(path.steps, path.ends, strict=True):
        if step.duration > 0:
            flow = Flow(choice, step.phase.region, path.extras)
            replayed.pieces.append(Piece(str(step.phase), flow, begun, replayed.time, step.duration))
            replayed.time += step.duration
        replayed.events += [(kind, replayed.time) for kind in step.kinds]
        begun = end
    return replayed


def _integrate_onto_event(
    flow: Flow,
    plugin: str,
    tolerance: Tolerance,
    budget: Budget,
    watch: WatchedEvents,
    step: PhaseRun,
    replayed: Replay,
    p: np.ndarray,
) -> tuple[float, np.ndarray]:
    """Duration and final state of one phase, on the event's surface."""
    cost = CVODES if plugin == "cvodes" else 1

    def integrate(duration: float) -> np.ndarray:
        if budget.is_spent:
            raise Stopped(f"has not finished in {budget.most} steps", step, replayed.time, replayed.y)
        most = min(tolerance.steps, int(budget.call / cost))
        engine = plain(flow, plugin, replace(tolerance, steps=most))
        try:
            return engine(replayed.y, p, duration)
        except IntegrationFailed as failure:
            raise Stopped(f"gave up ({failure})", step, replayed.time, replayed.y) from None
        finally:
            replayed.steps += engine.steps
            budget.spend((engine.steps or most) * cost)  # CVODES says nothing of those after which it fails

    y = integrate(step.duration)
    if step.event is None:
        return step.duration, y
    watched = WatchedEvents(tangential_edge=watch.tangential_edge)
    land = landing(flow, watched, step.event)
    motion = float(step.phase.motion)
    parameters = np.append(p, [motion, 0.0])
    duration = step.duration
    size = next((each.scale for each in flow.model.events if each.name == step.event), "")  # of a kink: 1
    scale = float(p[list(flow.model.groups).index(size)]) if size else 1.0
    nearer = np.inf
    for _ in range(_TRIES):
        landed, dt, miss = (np.asarray(part.full()).ravel() for part in land(y, parameters))
        shift = float(dt[0])
        if not np.isfinite(shift) or duration + shift <= 0 or abs(shift) > step.duration:
            break
        landed_close = abs(shift) <= max(_LANDED * duration, _ROUNDING)
        if landed_close and abs(float(miss[0])) <= max(_MISSES * scale, _ROUNDING):
            if float(_slope(flow, watched, step.event)(landed, parameters)) > _RISES * scale / duration:
                break  # the event was found in the backward direction: the engine's own event is earlier
            return duration + shift, landed
        if abs(shift) > nearer / 2:
            break  # beside a saddle every step is amplified, and the iteration oscillates
        nearer = abs(shift)
        duration += shift
        y = integrate(duration)
    missed = f"does not meet the event {step.event}: the collision lies within its error of a boundary"
    raise Stopped(missed, step, replayed.time + duration, y, missed=True)


@own_cache(512)
def _slope(flow: Flow, watch: WatchedEvents, event: str) -> Function:
    """Rate of change of an event's function along the flow."""
    parts = expressions(flow)
    motion, level = SX.sym("motion"), SX.sym("level")
    table = {each.name: each.function for each in event_table(flow, watch, motion, level)}
    rate = jtimes(table[event], parts.variables, parts.rates)
    return Function("slope", [parts.variables, vertcat(flow.model.parameters, motion, level)], [rate])
