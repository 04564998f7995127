"""Fly a located path again with the engine asked for: smooth flows over known durations, each landed on its event.

The path says which phases and events there are; the engine's own solution meets each event at a slightly different
time, which the landing step corrects. So events, and later their derivatives, are the engine's own.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from casadi import SX, Function, jtimes, vertcat

from ....generated.automaton import EVENTS
from ...host.thread_caches import own_cache
from ...model.model import ModelKey
from ...model.phases import Flow, WatchedEvents, event_table, expressions
from ...settings import STEPS
from .integrators import IntegrationFailed, Plain, Tolerance, landing, plain
from .locate import EventSequence, PhaseRun

_LANDED = 1e-4  # largest Taylor step, as a part of the phase, that is landed without flying again
_MISSES = 1e-13  # of its scale: what an event's function may be off after the step
_RISES = 1e-9  # of its scale over the phase: an event's function falls where it is met, but for rounding at a graze
_TRIES = 8
_ROUNDING = 1e-15  # of a gap or speed of order 1: times and event functions below it are noise


class Stopped(Exception):
    """The engine could not fly a phase: `why`, in which step, at what time (x0/v0) and state.

    `missed`: its solution misses the located event, so a tighter tolerance may help.
    """

    def __init__(self, why: str, step: PhaseRun, time: float, y: np.ndarray, missed: bool = False) -> None:
        super().__init__(why, step, time, y, missed)
        self.why, self.step, self.time, self.y, self.missed = why, step, time, y, missed


@dataclass(frozen=True)
class Piece:
    """A flown phase: its name and flow, state at its start, start time and duration (x0/v0)."""

    name: str
    flow: Flow
    start: np.ndarray
    time: float
    duration: float


@dataclass
class Flown:
    """A path as one engine flew it; states carry the extras, times are in x0/v0."""

    y: np.ndarray
    extras: tuple[str, ...] = ()
    offset: float = 0.0
    time: float = 0.0
    steps: int = 0
    smallest_gap: float = 1.0
    dry_loss: float = 0.0
    events: list[tuple[str, float]] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)

    def extra(self, name: str) -> float:
        """A quadrature's value at the end."""
        return float(self.y[len(self.y) - len(self.extras) + self.extras.index(name)]) - self.offset


def fly(path: EventSequence, plugin: str, tolerance: Tolerance, kind: Flow, start: np.ndarray) -> Flown:
    """Fly `path` with an integrator plugin.

    Arguments:
        kind: the model to fly and its extras (the regions come from the path).
        start: state at initial contact.

    Raises:
        Stopped: the engine gave up, or its solution misses an event of the path.
    """
    model = kind.model
    known = dict(zip(path.model.groups, path.p, strict=True))
    p = model.group_values(known)
    start = np.concatenate([start, np.full(len(kind.extras), tolerance.offset)])
    flown = Flown(start, kind.extras, tolerance.offset)
    size = len(model.state)
    for step in path.steps:
        flow = Flow(kind.choice, step.phase.region, kind.extras)
        if step.duration > 0:
            engine = plain(flow, plugin, tolerance)
            before = flown.y
            duration, flown.y = _flight(engine, flow, path.watch, step, flown, p)
            flown.pieces.append(Piece(str(step.phase), flow, before, flown.time, duration))
            flown.time += duration
        flown.events += [(kind, flown.time) for kind in step.kinds]
        flown.smallest_gap = min(flown.smallest_gap, float(flown.y[0]))
        if step.reverses:
            flown.dry_loss += model.values("reversal_loss", flown.y, p)["dry_contact"]
            after = model.values("reversal", flown.y, p)
            flown.y = np.concatenate([list(after.values()), flown.y[size:]])
        if step.holds:  # chatter takes what is left of the rebound
            flown.dry_loss += float(flown.y[1]) ** 2 / 2
            flown.y[1] = 0.0
    return flown


def as_located(path: EventSequence, choice: ModelKey) -> Flown:
    """The located flight itself, its extras integrated along: one solution, which cannot miss its own events."""
    start = path.model.start(path.p)
    begun = np.concatenate([start, np.zeros(len(path.extras))])
    flown = Flown(path.y, path.extras, smallest_gap=path.smallest_gap, dry_loss=path.dry_loss)
    for step, end in zip(path.steps, path.ends, strict=True):
        if step.duration > 0:
            flow = Flow(choice, step.phase.region, path.extras)
            flown.pieces.append(Piece(str(step.phase), flow, begun, flown.time, step.duration))
            flown.time += step.duration
        flown.events += [(kind, flown.time) for kind in step.kinds]
        begun = end
    return flown


def _flight(
    engine: Plain, flow: Flow, watch: WatchedEvents, step: PhaseRun, flown: Flown, p: np.ndarray
) -> tuple[float, np.ndarray]:
    """Duration and end of one phase, on the event's surface."""

    def flight(duration: float) -> np.ndarray:
        try:
            y = engine(flown.y, p, duration)
        except IntegrationFailed as failure:
            raise Stopped(f"gave up ({failure})", step, flown.time, flown.y) from None
        flown.steps += engine.steps
        if flown.steps > STEPS:
            raise Stopped(f"has not got through in {STEPS} steps", step, flown.time, flown.y)
        return y

    y = flight(step.duration)
    if step.event is None:
        return step.duration, y
    watched = WatchedEvents(tangential_edge=watch.tangential_edge)
    land = landing(flow, watched, step.event)
    motion = float(step.phase.motion)
    parameters = np.append(p, [motion, 0.0])
    duration = step.duration
    size = next(event.scale for event in EVENTS if event.name == step.event)
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
                break  # met on the way back: the engine's own event was earlier
            return duration + shift, landed
        if abs(shift) > nearer / 2:
            break  # beside a saddle every step is amplified, and they go to and fro
        nearer = abs(shift)
        duration += shift
        y = flight(duration)
    missed = f"does not meet the event {step.event}: the collision lies within its error of a boundary"
    raise Stopped(missed, step, flown.time + duration, y, missed=True)


@own_cache(512)
def _slope(flow: Flow, watch: WatchedEvents, event: str) -> Function:
    """Rate of an event's function along the flow."""
    parts = expressions(flow)
    motion, level = SX.sym("motion"), SX.sym("level")
    table = {each.name: each.function for each in event_table(flow, watch, motion, level)}
    rate = jtimes(table[event], parts.variables, parts.rates)
    return Function("slope", [parts.variables, vertcat(flow.model.parameters, motion, level)], [rate])
