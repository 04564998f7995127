"""Replay of the phases that the kernel has found, by CVODES or Rosenbrock: smooth flows, each landed on its event.

The engine's own solution meets each event at a slightly different time, which the landing step corrects, so that events
and their derivatives are those of the engine. All events that could end a phase are watched along the way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ....generated.automaton import KINDS, LOOSEST, EventKind, is_parted, is_too_weak
from ...errors import ComputationError
from ...model.key import ModelKey
from ...model.model import Model, load
from ...model.phases import Flow, Phase, extra_units, kinks_along, rates_along
from ...model.rebound import grip, reset
from ..settings import KERNEL_STEPS, casadi_steps
from .integrators import IntegrationFailed, Tolerance, landing, plain, tolerance_for
from .sequence import EventSequence, PhaseRun
from .watch import POINTS, Crossing, first_crossing, guards

_LANDED = 1e-4  # largest Taylor step, relative to the phase, for landing without another integration
_MISSES = 1e-13  # largest value of an event's function after the step, relative to its scale
_RISES = 1e-9  # in its scale per duration: slope above which the function rises at the landing
_TRIES = 8
_MOVED, _MOVED_LEAST = 1e-4, 1e-12  # of a phase, and in x0/v0: how far an event may lie from where the record has it
_DRIFT = 10.0  # tolerances of the engine, of the time so far: the same in chatter, whose phases shorten below the error
_ROUNDING = 1e-15  # noise of a gap or velocity of order 1, for times and event functions
_SLOW = 1e-2  # in v0: least speed by which that noise is divided, or slow phases would be landed on from afar
_ON_KINK = 1e-11  # of a guard: below it the side is that towards which it changes
_REST = 10.0  # factor in the height of a rebound within which two engines may differ on whether it comes to rest
TIGHTEST = 1e-13  # relative tolerance at which a phase is tried last
PHASES = 10_000  # most phases of a collision, of a record a few seconds
_LONGEST = 10  # times Rosenbrock's steps of one phase: most of a replay, at all of its tolerances
_SETTLES, _DECAYED = 1e6, 1e-12  # of a rest: after this time, x0/v0, rates have gone to this part, or are steady
_PANELS, _BARRIER = 256, 1e-4  # of the work up to a barrier, and its error


class Stopped(Exception):
    """Failure of the engine in a phase: reason, phase, time (x0/v0) and state.

    `missed`: the solution does not agree with the record; a tighter tolerance may help.
    """

    def __init__(self, why: str, phase: Phase, time: float, y: np.ndarray, missed: bool = False) -> None:
        super().__init__(why, phase, time, y, missed)
        self.why, self.phase, self.time, self.y, self.missed = why, phase, time, y, missed

    def error(self, plugin: str, model: Model) -> ComputationError:
        """The error of a replay by a plugin, dimensionless."""
        other = "--engine rosenbrock" if plugin == "cvodes" else "the default engine, or another impact"
        state = dict(zip(model.state, map(float, self.y), strict=False))
        return ComputationError(f"{plugin} {self.why}", str(self.phase), self.time, state, f"try {other}")


@dataclass(frozen=True)
class Piece:
    """An integrated phase, or its part on one side of a kink: flow, first and last state, start and duration (x0/v0).

    `event`: on which it ends, of the phase or a kink; None if it just ends.
    """

    phase: Phase
    event: str | None
    flow: Flow
    start: np.ndarray
    end: np.ndarray
    time: float
    duration: float


@dataclass
class Replay:
    """An event sequence as integrated by one engine; states include the extras, times are in x0/v0."""

    y: np.ndarray
    tolerance: Tolerance
    extras: tuple[str, ...] = ()
    units: Sequence[float] = ()  # of the extras
    time: float = 0.0
    steps: int = 0
    smallest_gap: float = 1.0
    dry_loss: float = 0.0
    friction_loss: float = 0.0
    own_loss: float = 0.0
    grip: float = np.inf  # least distance of a rebound from the switch between sliding and sticking (`grip`)
    events: list[tuple[str, float]] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)

    def extra(self, name: str) -> float:
        """The final value of a quadrature, of an energy in m v0^2."""
        position = self.extras.index(name)
        last = float(self.y[len(self.y) - len(self.extras) + position])
        return float(self.units[position]) * (last - self.tolerance.offset)


def replayed(
    record: Callable[[float], EventSequence], choice: ModelKey, extras: tuple[str, ...], plugin: str, rtol: float
) -> tuple[EventSequence, Replay]:
    """A sequence of events and its replay by a plugin.

    The tolerances of both are tightened while they miss each other: while the error exceeds the distance to a boundary.
    One that was tightened for a grazing start is loosened where the engine cannot meet it.

    Arguments:
        record: the sequence at a relative tolerance.
        choice: the model that is integrated, with the quadratures `extras`.

    Raises:
        Stopped: the replay fails at every tolerance.
        ComputationError: there is no sequence, as `record` says.
    """
    used, looser, path = rtol, None, record(rtol)
    budget = KERNEL_STEPS if plugin == "cvodes" else _LONGEST * casadi_steps(rtol)
    while True:
        tolerance = looser or tolerance_for(used, plugin, path.groups)
        run = Run(path, choice, extras, plugin, tolerance, used, budget)
        try:
            return path, run.run()
        except Stopped as stopped:
            budget -= run.at.steps
            looser = None if stopped.missed else tolerance.loosened(used)
            if looser is not None:
                continue
            if not (stopped.missed and used > TIGHTEST):
                raise
            used = max(used * 1e-2, TIGHTEST)
            try:
                path = record(used)
            except ComputationError:
                raise stopped from None


class Run:
    """One replay of a sequence at one tolerance.

    Arguments:
        choice: the model that is integrated, with the quadratures `extras`.
        rtol: relative tolerance of the record.
        most: steps of the engine.
    """

    def __init__(
        self,
        path: EventSequence,
        choice: ModelKey,
        extras: tuple[str, ...],
        plugin: str,
        tolerance: Tolerance,
        rtol: float,
        most: float = np.inf,
    ) -> None:
        self.path, self.choice, self.extras = path, choice, extras
        self.plugin, self.tolerance, self.rtol, self.most = plugin, tolerance, rtol, most
        self.model: Model = load(choice)
        self.p = self.model.group_values(path.groups)
        start = np.concatenate([self.model.start(self.p), np.full(len(extras), tolerance.offset)])
        self.at = Replay(start, tolerance, extras, extra_units(self.model, extras, self.p))

    def run(self) -> Replay:
        """The whole replay; Stopped if the engine fails, or its solution does not agree with the record."""
        if self.path.separated != self._separates():
            what = "separation has no event" if self.path.separated else "event of separation separates nothing"
            raise Stopped(f"cannot follow the record: its {what}", self.path.steps[-1].phase, self.path.time, self.at.y)
        if len(self.path.steps) > PHASES:
            last, time = self.path.steps[PHASES], sum(step.duration for step in self.path.steps[:PHASES])
            why = f"replays at most {PHASES} phases, and the record has {len(self.path.steps)}"
            raise Stopped(why, last.phase, time, np.zeros(0))
        for k, step in enumerate(self.path.steps):
            if step.duration > 0:
                self.integrate(k, step)
            self.at.events += [(kind, self.at.time) for kind in step.kinds]
            self.at.smallest_gap = min(self.at.smallest_gap, float(self.at.y[0]))
            self._jump(step)
        if self._held_by_energy() and not self._is_below_barrier():
            what = "ends above the barrier that is to hold the stick"
            raise Stopped(what, self.path.steps[-1].phase, self.at.time, self.at.y, missed=True)
        return self.at

    def _held_by_energy(self) -> bool:
        """True if a bridge's energy barrier proved the stick: not at rest, nor at a turning point, which has others."""
        path, model, last = self.path, self.model, self.path.steps[-1]
        proved = path.certified and not path.separated and (path.decided is None or path.decided <= path.time)
        bound = model.bridge and not (
            model.strings or model.space or model.own_events or model.own_terms or "attraction" in model.works
        )
        return proved and bound and last.duration > 0 and not last.phase.resting

    def _is_below_barrier(self) -> bool:
        """True if the energy does not suffice for some gap ahead, where the least energy includes the bridge's work."""
        gap, end = float(self.at.y[0]), float(self.path.groups["rupture_gap"])
        kinetic = self.model.values(self.model.escape, self.at.y, self.p)["kinetic"]
        excess = kinetic - self.model.values("effective_potential", self.at.y, self.p)["energy"]
        nodes, weights = np.polynomial.legendre.leggauss(4)
        ends = gap * (end / gap) ** np.linspace(0, 1, _PANELS + 1)
        width = np.diff(ends)
        states = np.repeat(self.at.y[: len(self.model.state), None], 4 * _PANELS, axis=1)
        states[0] = (ends[:-1, None] + np.outer(width, nodes + 1) / 2).ravel()
        slope = np.asarray(self.model.function("effective_potential")(states, self.p).full())[1]
        rise = np.cumsum(slope.reshape(_PANELS, 4) @ weights * width / 2)
        return bool(excess <= rise.max() + _BARRIER * max(excess, np.abs(rise).max()))

    def _separates(self) -> bool:
        """True if the last event is one that separates the doublet."""
        last = self.path.steps[-1]
        if last.own:
            return any(event.name == last.own and event.row.actions[-1] == "part" for event in self.model.own_events)
        return KINDS[EventKind.RUPTURE] in last.kinds

    def integrate(self, k: int, step: PhaseRun) -> None:
        """Phase k: onto its event, by way of the kinks of its laws."""
        # a last phase without an event ends at the record's time, which earlier landings have moved away from
        remaining, phase = self.path.time - self.at.time if step.event is None else step.duration, step.phase
        while True:
            phase = self._sided(phase)
            flow = Flow(self.choice, phase.region, self.extras, self.path.edge_watched)
            solution = _Solution(self, flow, phase)
            if self.model.kinks:  # first of all, as behind a kink the solution is another
                kink = solution.crossing(remaining, solution.end(remaining)[1], step.event)
                if kink is not None and kink.event in self.model.kinks:
                    duration, y, _ = solution.onto(kink.event, kink.fraction * remaining, moved=True)
                    self._record(phase, kink.event, flow, duration, y)
                    remaining -= duration
                    continue
            duration, y, states = (
                (remaining, *solution.end(remaining)) if step.event is None else solution.onto(step.event, remaining)
            )
            crossing = solution.crossing(duration, states, step.event)
            if crossing is not None:
                time = self.at.time + crossing.fraction * duration
                raise Stopped(
                    f"passes the event {crossing.event} inside a phase, by {-crossing.value:.1e} of its size, where "
                    "the record has none",
                    phase, time, y, missed=True,
                )  # fmt: skip
            self._record(phase, step.event, flow, duration, y)
            return

    def _record(self, phase: Phase, event: str | None, flow: Flow, duration: float, y: np.ndarray) -> None:
        self.at.pieces.append(Piece(phase, event, flow, self.at.y, y, self.at.time, duration))
        self.at.time += duration
        self.at.y = y

    def _sided(self, phase: Phase) -> Phase:
        """The phase on the side of every kink on which its state is; on a kink, that towards which it moves."""
        model = self.model
        if not model.kinks:
            return phase
        sides = phase.sides or (1,) * len(model.kinks)
        for _ in range(2):
            phase = replace(phase, sides=sides)
            flow = Flow(self.choice, phase.region, self.extras, self.path.edge_watched)
            guards, rates = kinks_along(flow)(self.at.y, self.p).full().T
            sides = tuple(np.where(np.where(abs(guards) > _ON_KINK, guards, rates) < 0, -1, 1).tolist())
        if sides != phase.sides and not phase.resting:
            where = ", ".join(name for name, side, last in zip(model.kinks, sides, phase.sides) if side != last)
            raise Stopped(
                f"stays on a step of a law's force ({where}); write the step as a steep slope, as tanh(u/u0)",
                phase,
                self.at.time,
                self.at.y,
            )
        return phase

    def _jump(self, step: PhaseRun) -> None:
        """What happens at the end of a phase."""
        if not (step.rebounds or step.holds or step.own):
            return
        at, size = self.at, len(self.model.state)
        event = reset(self.choice, step.criterion, step.holds, step.own)
        after, dry, friction, own, rebounded = (matrix.full().ravel() for matrix in event(at.y[:size], self.p))
        at.dry_loss += float(dry[0])
        at.friction_loss += float(friction[0])
        at.own_loss += float(own[0])
        if step.rebounds:
            at.grip = min(at.grip, abs(grip(self.model, step.criterion, at.y, self.p, step.holds)))
            self._check_rest(step, rebounded)
        at.y = np.concatenate([after, at.y[size:]])

    def _check_rest(self, step: PhaseRun, after: np.ndarray) -> None:
        """Stopped if the record has a rest where the rebound opens the gap, or none where it is too weak."""
        gap, velocity = float(after[0]), float(after[1])
        rupture = self.path.groups["rupture_gap"] if self.model.bridge else 1.0
        inward = self.model.values("inward_force", after, self.p)["inward_force"]
        rtol = min(self.rtol, LOOSEST)
        is_weak = [is_too_weak(inward, velocity, rtol * share, gap) for share in (1 / _REST, _REST)]
        if not is_parted(gap, rupture) and step.holds not in is_weak:
            what = (
                "opens the gap, and the record has a rest"
                if step.holds
                else "does not open the gap, and the record has no rest"
            )
            raise Stopped(f"has a rebound that {what}", step.phase, self.at.time, after, missed=True)


@dataclass
class _Solution:
    """The engine's solution from the present state of a replay on."""

    run: Run
    flow: Flow
    phase: Phase

    def end(self, duration: float) -> tuple[np.ndarray, np.ndarray]:
        """The state after a duration, and those at `POINTS` of it."""
        states = self.states(duration, POINTS)
        return states[:, -1], states

    def states(self, duration: float, parts: np.ndarray) -> np.ndarray:
        """States at parts of a duration, as columns; a rest that is long is only integrated until it has settled."""
        if not (self.phase.resting and duration > _SETTLES):
            return self._integrated(duration, parts)
        near = parts[parts * duration < _SETTLES] * duration / _SETTLES
        moving = self._integrated(_SETTLES, np.append(near, 1.0))
        last, settled = moving[:, -1], rates_along(self.flow)
        first, rates = (settled(y, self.run.p).full().ravel() for y in (self.run.at.y, last))
        rates[abs(rates) <= _DECAYED * abs(first)] = 0.0
        later = settled(last + rates * duration, self.run.p).full().ravel()
        if (abs(later - rates) > _DECAYED * np.maximum(abs(first), abs(rates))).any():
            return self._integrated(duration, parts)
        goes_on = parts[near.size :] * duration - _SETTLES
        return np.column_stack([moving[:, :-1], last[:, None] + rates[:, None] * goes_on])

    def _integrated(self, duration: float, parts: np.ndarray) -> np.ndarray:
        at = self.run.at
        if at.steps > self.run.most:
            raise Stopped(f"has not replayed the record in {at.steps} steps", self.phase, at.time, at.y)
        grid = tuple(parts[parts > 0].tolist())
        engine = plain(self.flow, self.run.plugin, self.run.tolerance, grid)
        try:
            states = engine(at.y, self.run.p, duration).reshape(at.y.size, len(grid))
        except IntegrationFailed as failure:
            raise Stopped(f"gave up ({failure})", self.phase, at.time, at.y) from None
        finally:
            at.steps += engine.steps
        return np.column_stack([at.y, states]) if parts[0] == 0 else states

    def crossing(self, duration: float, states: np.ndarray, landed: str | None) -> Crossing | None:
        """The first event inside the phase, if there is one."""
        parameters = np.append(self.run.p, float(self.phase.motion))
        return first_crossing(
            self.flow, parameters, duration, states, lambda parts: self.states(duration, parts),
            self.run.tolerance.relative, landed,
        )  # fmt: skip

    def onto(self, event: str, expected: float, moved: bool = False) -> tuple[float, np.ndarray, np.ndarray]:
        """Duration and state on an event's surface, and the states at `POINTS` up to nearly there.

        Arguments:
            moved: the duration is expected only about.
        """
        run = self.run
        guard, events = guards(self.flow)
        if event not in events:
            raise Stopped(f"has no event {event} in this phase", self.phase, run.at.time, run.at.y, missed=True)
        land = landing(self.flow, event)
        parameters = np.append(run.p, float(self.phase.motion))
        scale, duration, nearer = self._scale(event), expected, np.inf
        y, states = self.end(duration)
        for _ in range(_TRIES):
            landed, dt, miss = (np.asarray(result.full()).ravel() for result in land(y, parameters))
            shift = float(dt[0])
            if not np.isfinite(shift) or duration + shift <= 0 or abs(shift) > expected + _ROUNDING:
                break
            noise = _ROUNDING / min(max(abs(float(y[1])), _SLOW), 1.0)  # of a time, from that of a gap
            landed_close = abs(shift) <= max(_LANDED * duration, noise)
            if landed_close and abs(float(miss[0])) <= max(_MISSES * scale, _ROUNDING):
                slope = float(guard(landed, parameters)[1][events.index(event)])
                if slope > _RISES * scale / duration:
                    break  # the event was found in the backward direction: the engine's own event is earlier
                drift = _DRIFT * run.tolerance.relative * run.at.time
                if not moved and abs(duration + shift - expected) > max(_MOVED * expected, _MOVED_LEAST, drift):
                    break
                return duration + shift, landed, states
            if abs(shift) > nearer / 2:
                break  # beside a saddle every step is amplified, and the iteration oscillates
            nearer = abs(shift)
            duration += shift
            y, states = self.end(duration)
        missed = f"does not meet the event {event} where the record has it: it may lie within its error of a boundary"
        raise Stopped(missed, self.phase, run.at.time + duration, y, missed=True)

    def _scale(self, event: str) -> float:
        """The size of an event's function: a group, or 1."""
        group = next((row.scale for row in self.flow.model.events if row.name == event), "")
        return float(self.run.p[list(self.flow.model.groups).index(group)]) if group else 1.0
