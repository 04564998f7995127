"""A collision through the emitted automaton, for integrators of other libraries: phases, events and proved sticks.

Events and their effects are those of `generated/automaton.py`, equations and guards those of `solvers.model`. A stick
is proved where the energy is below a barrier ahead; on strings it would be by the kernel's own proof, so that there are
no peers.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from casadi import SX, Function, sum1, vertcat
from wetdoublet.generated import automaton as rules
from wetdoublet.generated.automaton import CLOSING, OPENING, STICK
from wetdoublet.solvers.engines.casadi.sequence import tangential_edge
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.model.dimensionless import Problem
from wetdoublet.solvers.model.key import ModelKey
from wetdoublet.solvers.model.model import Model, load
from wetdoublet.solvers.model.phases import Flow, Phase
from wetdoublet.solvers.scene.groups import contact_gap, contact_word

from ..tasks import Answer

CERTIFIED = "certified"  # the event that proves a stick
_SPANS = (1e4, 1e8, 1e16)  # x0/v0; a phase fails after their sum
_PHASES = 1000
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class Hit(NamedTuple):
    """Where an integrator stopped: the event, None at the end of its span; the time it took, and the state."""

    event: str | None
    time: float
    y: np.ndarray


class Barrier(NamedTuple):
    """A maximum of the effective potential that none at a larger gap exceeds, in energy since initial contact."""

    gap: float
    height: float


def proof_of(model: Model) -> str:
    """What proves a stick: `energy` below a barrier, or nothing."""
    return "energy" if model.has("effective_potential") and model.choice.law("arm") in (None, "midgap") else ""


@lru_cache(maxsize=64)
def proving(choice: ModelKey) -> Function:
    """Function (state, groups) -> the energy that falls below a level where a stick is proved."""
    model = load(choice)
    works = SX.sym("works", len(model.works))
    energy = sum(model(model.escape).values()) + sum1(works)
    return Function("energy", [vertcat(model.column, works), model.parameters], [energy])


class Automaton:
    """One collision; `run` follows it by a subclass's integrator. `y` has the works of attractions behind the state."""

    def __init__(self, problem: Problem, rtol: float) -> None:
        model, groups = problem.model(), problem.groups
        rupture = groups["rupture_gap"] if model.bridge else 1.0
        if model.friction or model.own_events or model.strings or tangential_edge(model, groups) < rupture:
            what = "no friction, no declared events, no proof on strings, no tangential edge within reach"
            raise ComputationError(f"peers have {what}")
        self.model, self.groups, self.rtol = model, groups, min(rtol, rules.LOOSEST)
        self.p, self.proof = model.group_values(groups), proof_of(model)
        self.works = model.works if self.proof == "energy" else ()
        self.y = np.append(model.start(self.p), [0.0] * len(self.works))
        self.gaps = {"contact": contact_gap(groups), "rupture": rupture, "film edge": 1.0}
        self.phase = Phase(film=1, shear=1, motion=CLOSING)
        self.time, self.reversed, self.outcome = 0.0, False, ""

    def integrated(self, flow: Flow, span: float) -> Hit:
        """Integrate to the first event, or over the span."""
        raise NotImplementedError

    def run(self) -> Answer:
        """Follow the collision to its end; ComputationError where it has none."""
        for _ in range(_PHASES):
            if self.sticks(self.y):
                self.outcome = STICK
            elif word := self.criterion():
                self.rebound(word)
            else:
                self._happens(self._next_event())
            if self.outcome:
                apart = self.outcome != STICK
                return Answer(self.outcome, self.values("outputs")["restitution"] if apart else 0.0)
        raise self.error(f"no end after {_PHASES} phases")

    def values(self, name: str) -> dict[str, float]:
        """Results of an emitted function in the present state."""
        return self.model.values(name, self.y, self.p)

    def error(self, message: str) -> ComputationError:
        """The error that says where the collision stands, without dimensions."""
        state = dict(zip(self.model.state, self.y.tolist(), strict=False))
        return ComputationError(message, phase=str(self.phase), time=self.time, state=state)

    def criterion(self) -> str | None:
        """The rebound criterion that is met where a phase begins."""
        if self.phase.resting or self.phase.motion == OPENING:
            return None
        values = self.values("events")
        return next((word for word in rules.CRITERIA if values[word] <= 0), None)

    def rebound(self, word: str) -> None:
        """Reverse the motion; a rebound that does not open the gap becomes a rest."""
        after = list(self.values("rebound").values())
        self.y = np.array([*after, *self.y[len(after) :]])
        self.reversed = True
        if rules.is_parted(self.y[0], self.gaps["rupture"]):
            self.outcome = rules.BOUNCE
        resting = rules.is_too_weak(self.values("inward_force")["inward_force"], self.y[1], self.rtol, self.y[0])
        if resting:
            self.y[1] = 0.0
        self._opens(resting)

    def _next_event(self) -> str:
        flow = Flow(self.model.choice, self.phase.region, self.works)
        for span in _SPANS:
            hit = self.integrated(flow, span)
            self.time, self.y = self.time + hit.time, hit.y.copy()
            if hit.event is not None or self.sticks(self.y):
                return hit.event or CERTIFIED
        raise self.error(f"no event within {sum(_SPANS):.0e} x0/v0")

    def _happens(self, name: str) -> None:
        """The effect of an event."""
        if name == CERTIFIED:
            self.outcome = STICK
            return
        event, phase = next(row for row in rules.EVENTS if row.name == name), self.phase
        for action in event.actions:
            match action:
                case "gap = target":
                    self.y[0] = self.gaps[event.target]
                case "velocity = 0":
                    self.y[1] = 0.0
                case "rebound":
                    self.rebound(contact_word(self.groups) if event.chosen_by else event.words[0])
                case "open":
                    self.y[1] = rules.RELEASE_SPEED
                    self._opens(False)
                case "turn":
                    self._moves(-phase.motion)
                case "cross film edge":
                    self.phase = replace(phase, film=1 - phase.film)
                case "separate":
                    self.outcome = rules.BOUNCE if self.reversed else rules.ROTATE
                case "cut off":
                    self.outcome = STICK
                case _:
                    raise self.error(f"peers do not know the action {action}")

    def _opens(self, resting: bool) -> None:
        """Open from here, or rest; on an edge, the phase is beyond it."""
        film = 0 if self.model.edged and rules.is_on_edge(self.y[0], 1.0) else self.phase.film
        self.phase = replace(self.phase, film=film, resting=resting)
        self._moves(OPENING)

    def _moves(self, motion: int) -> None:
        self.phase = replace(self.phase, motion=motion, cavitated=self.model.cavitates and motion == OPENING)

    def sticks(self, y: np.ndarray) -> bool:
        """True if a stick is proved in a state."""
        level = self.level(y)
        return level is not None and float(proving(self.model.choice)(y, self.p)) < level

    def level(self, y: np.ndarray) -> float | None:
        """The level below which a stick is proved from a state on; None if there is none."""
        if self.proof != "energy":
            return None
        height = next((barrier.height for barrier in self.barriers if barrier.gap > y[0]), None)
        if height is None:
            return None
        first = sum(self.model.values(self.model.escape, self.model.start(self.p), self.p).values())
        return height - rules.SAFETY * self.rtol * (first + abs(height))

    @cached_property
    def barriers(self) -> tuple[Barrier, ...]:
        """All barriers by gap, for the angular momentum of the impact, which is conserved."""
        gaps = np.geomspace(min(max(self.gaps["contact"], 1e-6), 0.5), self.gaps["rupture"], 161)
        slope = self._slope(gaps)
        tops = [self._top(gaps[k], gaps[k + 1]) for k in np.flatnonzero((slope[:-1] > 0) & (slope[1:] <= 0))]
        tops += [float(gaps[-1])] if slope[-1] > 0 else []
        edges = np.unique([*gaps, *tops, 1.0])
        width = np.diff(edges)
        nodes = edges[:-1] + np.outer(_NODES + 1, width) / 2
        rises = np.append(0.0, np.cumsum((_WEIGHTS @ self._slope(nodes.ravel()).reshape(nodes.shape)) * width / 2))
        touch = float(np.interp(1.0, edges, rises))
        first = self.model.values("effective_potential", self.model.start(self.p), self.p)["energy"]
        heights = first + np.interp(tops, edges, rises) - touch
        return tuple(
            Barrier(top, float(heights[k])) for k, top in enumerate(tops) if (heights[k + 1 :] < heights[k]).all()
        )

    def _top(self, low: float, high: float) -> float:
        """The gap between two at which the slope falls through zero."""
        for _ in range(4):
            parts = np.linspace(low, high, 201)
            last = int(np.argmax(self._slope(parts)[1:] <= 0))
            low, high = float(parts[last]), float(parts[last + 1])
        return (low + high) / 2

    def _slope(self, gaps: np.ndarray) -> np.ndarray:
        """Slope of the effective potential at gaps."""
        states = np.repeat(self.model.start(self.p)[:, None], gaps.size, axis=1)
        states[0] = gaps
        slopes: np.ndarray = self.model.function("effective_potential")(states, self.p).full()[1]
        return slopes


def automata(problems: Sequence[Problem], rtol: float) -> list[Automaton]:
    """Collisions of one structure, for peers that compile it; ComputationError if there are two."""
    if len({problem.key() for problem in problems}) > 1:
        raise ComputationError("head-on and oblique collisions are different structures")
    return [Automaton(problem, rtol) for problem in problems]
