"""Location of the phases and events of a collision: one Rosenbrock flow per phase, frozen at its first event.

The events, their effects and the rules of a rebound are those of `generated/automaton.py`; this module interprets them.
"""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ....generated.automaton import (
    BOUNCE,
    CHATTER_PHASES,
    CLOSING,
    CRITERIA,
    ENDS,
    EVENTS,
    KINDS,
    LEAST_MOMENTUM,
    LOOSEST,
    OPENING,
    RELEASE_SPEED,
    ROTATE,
    SAFETY,
    STICK,
    Event,
    EventKind,
    friction_holds,
    has_no_slip,
    is_on_edge,
    is_parted,
    is_too_oblique,
    is_too_weak,
    is_within_rounding,
)
from ...certificates import (
    Certainty,
    Certificate,
    NoCertificate,
    OrbitalMomentumCertificate,
    SpinDownCertificate,
    at_maximum,
    proof_for,
)
from ...errors import CheckFailed, ComputationError
from ...model.model import Model
from ...model.phases import Flow, Phase, WatchedEvents, kinks_along
from ...model.rebound import rebounded
from ...scene.contact import contact_gap, contact_word
from ...scene.user_model import OwnEvent
from ..settings import CALL, Budget, casadi_steps
from .integrators import EventHit, IntegrationFailed, Locator, Tolerance, locator, plain, tolerance_for

# why a collision stays undecided, in messages
CREEPS, RESTS = "the gap changes too slowly", "the resting doublet turns for too long"
CHATTERS, REVERSED = "the gap opens and closes again and again", "the rotation reverses the approach"
ROUNDED = "rounding of its angular momentum decides"

FIRST_STRETCH, GROWTH, STRETCHES = 16.0, 8.0, 22  # in x0/v0: a trajectory is abandoned after 16 * 8^21 of them
_DOUBLED, _MORE = 2.0, 64  # the same where a certificate is tried after each, as no event of it is watched
_NOW_AND_THEN = 20  # phases of chatter between two checks of the certificate
_STANDSTILL = 1e-100  # in v0; CasADi's Rosenbrock divides by squares of slopes, which underflow
_STRONG = 1e4  # square root of a force over m v0^2/x0
_ON_KINK = 1e-11  # of a guard: below it the side is that towards which it changes
_EVENT_OF = {event.name: event for event in EVENTS}
_GAP, _VELOCITY = 0, 1  # indices in the state


@dataclass(frozen=True)
class PhaseRun:
    """One phase of a duration (x0/v0) up to an event, and the events reported.

    Arguments:
        event: name of the event function to land on; None if the trajectory ends inside the phase.
        kinds: events reported at its end, in order.
        rebounds: the doublet rebounds at its end.
        holds: the normal velocity is zero from here on, or until release.
        grip: of a rebound with friction (`model.rebound`).
        own: name of the declared event that happens at its end, whether or not the phase landed on it.
    """

    phase: Phase
    duration: float
    event: str | None
    kinds: tuple[str, ...]
    rebounds: bool = False
    holds: bool = False
    grip: float = np.inf
    own: str = ""


@dataclass
class EventSequence:
    """The sequence of phases and events of a collision."""

    model: Model
    p: np.ndarray
    watch: WatchedEvents
    steps: list[PhaseRun] = field(default_factory=list)
    separated: bool = False
    certified: bool = False
    ends: list[np.ndarray] = field(default_factory=list)  # state after each phase, including its rebound
    y: np.ndarray = field(default_factory=lambda: np.zeros(0))  # the last state, extras included
    time: float = 0.0  # of the last state
    smallest_gap: float = 1.0
    extras: tuple[str, ...] = ()
    dry_loss: float = 0.0  # dissipated by rebounds and rests, over m v0^2
    friction_loss: float = 0.0  # dissipated by the friction of rebounds
    own_loss: float = 0.0  # taken by jumps of declared events, over m v0^2
    decided: float | None = None  # time at which the stick was certain, if the trajectory continues beyond it

    @property
    def kinds(self) -> list[str]:
        return [kind for step in self.steps for kind in step.kinds]

    @property
    def reversal(self) -> str | None:
        """The first criterion met."""
        return next((kind for kind in self.kinds if kind in CRITERIA), None)

    @property
    def outcome(self) -> str:
        if not self.separated:
            return STICK
        return BOUNCE if self.reversal else ROTATE


class EventLocator:
    """Locator of the events of one collision; `run` returns its EventSequence."""

    def __init__(
        self,
        model: Model,
        groups: dict[str, float],
        rtol: float,
        extras: tuple[str, ...] = (),
        machine_code: bool = False,
        budget: Budget | None = None,
        until: float = 0.0,
    ) -> None:
        rtol = min(rtol, LOOSEST)
        self.model, self.rtol, self.machine_code = model, rtol, machine_code
        self.tolerance = tolerance_for(rtol, "rosenbrock", groups)
        self.p = model.group_values(groups)
        self.groups = groups
        self.proof: Certificate = proof_for(model, self.p, rtol)
        self.contact_gap = contact_gap(groups)
        self.rupture_gap = groups["rupture_gap"] if model.bridge else 1.0
        more = (groups[str(symbol)] for symbol in model.extra("shear", "edge"))
        self.edge = float(model.laws.shear.edge(groups["aspect"], *more)) if model.oblique else np.inf
        self.gaps = {"contact": self.contact_gap, "rupture": self.rupture_gap, "film edge": 1.0}
        self.gaps["tangential edge"] = self.edge
        own_edge = self.edge != 1.0 and min(self.contact_gap, 1.0) < self.edge < self.rupture_gap
        self.watch = WatchedEvents(tangential_edge=own_edge, certificate=self.proof.watches)
        works = self.proof.watches == "energy" or any(work in extras for work in model.works)
        self.extras = tuple(name for name in extras if name not in model.works) + (model.works if works else ())
        self.path = EventSequence(model, self.p, self.watch, extras=self.extras)
        self.y = self.path.y = np.append(model.start(self.p), [0.0] * len(self.extras))
        self.phase = Phase(film=1, shear=int(self.edge >= 1.0), motion=CLOSING)
        self.budget = budget or Budget(casadi_steps(rtol, model.space))
        self.until, self.deadline = until, np.inf
        self._maxima: list[np.ndarray] = []  # states at maxima of the gap

    def run(self) -> EventSequence:
        """Integrate the collision to separation, to a cut-off, or to a certificate, and from there up to `until`."""
        if is_too_oblique(self.groups["obliquity"], self.groups["aspect"]):
            raise self._error(
                f"at this angle, with these spins, {REVERSED} within a rounding error of the film thickness",
                "try a smaller angle or slower spins",
            )
        path = self.path
        self._follow()
        if not path.separated and path.steps[-1].event is None and path.time < self.until:
            proved, path.decided, self.deadline = path.certified, path.time, self.until
            self.proof, self.watch = NoCertificate(), replace(self.watch, certificate=None)
            self.budget = Budget(self.budget.most)
            self._follow()
            if path.separated:
                word = "proved" if proved else "decided, not proved,"
                message = f"a stick that is {word} separates when it is followed on"
                raise self._error(message, "please report the scene" if proved else "leave out --until")
        return path

    def _follow(self) -> None:
        """Integrate phase by phase until the collision is over, or to the deadline."""
        over = False
        while not (over or self.path.separated) and self.path.time < self.deadline:
            over = self._proved(0.0) or self._held_in_chatter() or self._run_or_act()

    def _held_in_chatter(self) -> bool:
        """True if the orbital-momentum certificate holds for a doublet in long chatter, which is then a stick."""
        phases, proof = len(self.path.steps), self.proof
        if phases < CHATTER_PHASES or phases % _NOW_AND_THEN or self.model.strings:
            return False
        if not (isinstance(proof, OrbitalMomentumCertificate) and (proof.holds(self.y) or proof.settles(self.y))):
            return False
        self._next(PhaseRun(self.phase, 0.0, None, ()))
        self.path.certified = proof.theorem
        return True

    def _undecided(self) -> ComputationError:
        phases, most = len(self.path.steps), self.budget.most
        if self.path.decided is not None:
            message = f"{most} steps have not led from the proof to the time that was asked for"
            return self._error(message, "try an earlier --until")
        why, remedy = CREEPS, "a larger --rtol, or "
        if self.phase.resting:
            why = RESTS
        elif phases > min(CHATTER_PHASES, most // (4 * CALL)):
            why, remedy = CHATTERS, ""  # which no tolerance shortens
        return self._error(
            f"{most} steps in {phases + 1} phases have not decided the outcome", f"{why}: try {remedy}another impact"
        )

    def _tolerance(self) -> Tolerance:
        """The tolerance of the next call, with its limit of steps. ComputationError if none are left."""
        if self.budget.is_spent:
            raise self._undecided()
        most = self.budget.most if self.machine_code else self.budget.call  # each limit is compiled anew
        return replace(self.tolerance, steps=min(self.tolerance.steps, most))

    def _call(self, integrator: Any, *given: float) -> Any:
        """The result of an integrator from the present state; its steps are counted, also where it fails."""
        try:
            return integrator(self.y, self.p, *given)
        finally:
            self.budget.spend(integrator.steps)

    def _run_or_act(self) -> bool:
        """A criterion or declared event that is due at the start of a phase, or else the phase; True if all is over."""
        if not self.phase.resting and (self.phase.motion == CLOSING or self.model.own_events):
            values = self.model.values("events", self.y, self.p)
            for kind in CRITERIA if self.phase.motion == CLOSING else ():
                if values[kind] <= 0:
                    self._rebound(kind, 0.0)
                    return False
            for each, mark in zip(self.model.own_events, self.model.marks, strict=True):
                watched = all(getattr(self.phase, part) == value for part, value in each.row.where)
                if watched and self.y[mark] > 0.5 and values[each.name] <= 0:
                    return self._own_event(each, 0.0, None)
        self._choose_sides()
        return self._run_phase()

    def _choose_sides(self) -> None:
        """The side of every kink in the phase that begins: of one that is met, that towards which its guard changes."""
        model = self.model
        if not model.kinks:
            return
        sides = self.phase.sides or (1,) * len(model.kinks)
        for _ in range(2):
            self.phase = self.phase.with_(sides=sides)
            guards, rates = kinks_along(self._flow())(self.y, self.p).full().T
            sides = tuple(np.where(np.where(abs(guards) > _ON_KINK, guards, rates) < 0, -1, 1).tolist())
        if sides != self.phase.sides and not self.phase.resting:
            where = ", ".join(name for name, one, other in zip(model.kinks, sides, self.phase.sides) if one != other)
            raise self._error(
                f"the motion stays on a step of a law's force ({where})",
                "write the step as a steep slope, as tanh(u/u0)",
            )

    def _proved(self, elapsed: float) -> bool:
        """True if the collision ends here as a stick, by a certificate or by energy."""
        if at_maximum(self.y, self.phase):
            self._maxima.append(self.y)
        certainty = self.proof.decided(self.y, self.phase, self._maxima)
        if certainty:
            self._next(PhaseRun(self.phase, elapsed, None, ()))
            self.path.certified = certainty is Certainty.PROVED
        elif isinstance(self.proof, SpinDownCertificate) and self.proof.rounded(self.y):
            raise self._error(
                f"orbit and spins cancel to {LEAST_MOMENTUM:.0e} of their angular momentum or less, and the doublet "
                f"separates so slowly that {ROUNDED}",
                "try spins with another angular momentum",
            )
        return bool(certainty)

    def _level(self) -> float | None:
        return self.proof.level(self.y, self.phase) if self.watch.certificate else None

    def _flow(self) -> Flow:
        return Flow(self.model.choice, self.phase.region, self.extras)

    def _run_phase(self) -> bool:
        """Integrate to the next event and apply its effect; True if the collision is over."""
        elapsed, stretch = 0.0, self._first_stretch()
        growth, most = (_DOUBLED, _MORE) if self.model.own_events else (GROWTH, STRETCHES)
        for _ in range(most):
            level, left, before = self._level(), self.deadline - self.path.time, self.y[: len(self.model.state)]
            stop = self._advance(min(stretch, left), -np.inf if level is None else level)
            elapsed += stop.time
            self.path.time += stop.time
            self.y = self.path.y = stop.y
            self.path.smallest_gap = min(self.path.smallest_gap, float(self.y[0]))
            if stop.event == "certified":
                if self._proved(elapsed):
                    return True
            elif stop.event is not None:
                return self._happens(stop.event, elapsed)
            elif stop.time >= left:
                self.path.time = self.deadline
                self._next(PhaseRun(self.phase, elapsed, None, ()))
                return True
            elif self._proved(elapsed):
                return True
            elif not self.phase.resting and abs(self.y[_VELOCITY]) < _STANDSTILL:
                break
            else:
                stretch *= growth
        if self.phase.resting and np.allclose(before, self.y[: before.size], rtol=self.rtol, atol=0.0):
            self._next(PhaseRun(self.phase, elapsed, None, ()))  # no force changes any more: a stick without a proof
            return True
        raise self._error(
            f"no event within {elapsed:.3g} x0/v0",
            f"the outcome changes within the tolerance of this impact, or {CREEPS}: "
            "try a smaller --rtol, or another impact",
        )

    def _first_stretch(self) -> float:
        """Length of the first interval: at most 1e5 times the time in which the force closes the film."""
        force = abs(self.model.values("inward_force", self.y, self.p)["inward_force"])
        return FIRST_STRETCH * min(1.0, _STRONG / np.sqrt(force)) if force > 0 else FIRST_STRETCH

    def _advance(self, stretch: float, level: float) -> EventHit:
        # an unreachable level is a large negative number, since infinities break the integrator's arithmetic
        level, spent, most = max(level, -1e30), self.budget.spent, self.budget.call
        find = locator(self._flow(), self.watch, self._tolerance(), self.machine_code)
        try:
            stop = self._call(find, stretch, self.phase.motion, level)
            if stop.dipped and stop.event:
                stop = self._refined(find, stop, stop.event, level)
            return self._overshot(find, stop, level)
        except IntegrationFailed as error:
            if self.budget.spent - spent >= most:  # an integrator whose steps are used up fails, too
                raise self._undecided() from None
            if looser := self.tolerance.loosened(self.rtol):
                self.tolerance = looser
                return self._advance(stretch, level)
            raise self._error(f"integration failed ({error})", "try --rtol 1e-8, or a less extreme impact") from None

    def _overshot(self, find: Locator, stop: EventHit, level: float) -> EventHit:
        """The first event that was crossed before a stop, where one step crosses several.

        CasADi may report a later one, or none beside the minimum of another function. The gap is monotone within a
        phase, so every function of it that is negative at the stop has one earlier zero.
        """
        rows = (row.name for row in self.model.events if not row.dips or row not in EVENTS)
        crossed = [
            self._refined(find, stop, name, level)
            for name in (*rows, *self.model.kinks)
            if name in find.events
            and name != stop.event
            and find.value(name, stop.y, self.p, self.phase.motion, level)
            < (-_ON_KINK if name in self.model.kinks else 0)
        ]
        return min(crossed, key=lambda hit: hit.time, default=stop)

    def _refined(self, find: Locator, stop: EventHit, event: str, level: float) -> EventHit:
        """The zero of an event function before a stop at which it is negative: bisection with secant steps."""
        before, after, y_after = 0.0, stop.time, stop.y
        g_after, g_before = find.value(event, stop.y, self.p, self.phase.motion, level), None
        for count in range(80):
            trial = 0.5 * (before + after)
            if g_before is not None and count % 2:
                trial = before + (after - before) * g_before / (g_before - g_after)
            y = self._call(plain(self._flow(), "rosenbrock", self._tolerance()), trial)
            g = find.value(event, y, self.p, self.phase.motion, level)
            if g < 0:
                after, g_after, y_after = trial, g, y
            else:
                before, g_before = trial, g
            if after - before < 1e-12 * stop.time:
                break
        return EventHit(event, after, y_after, False)

    def _happens(self, name: str, elapsed: float) -> bool:
        if name in self.model.kinks:
            self._next(PhaseRun(self.phase, elapsed, name, ()))
            return False
        own = next((each for each in self.model.own_events if each.name == name), None)
        return self._own_event(own, elapsed, name) if own else self._act(_EVENT_OF[name], elapsed)

    def _own_event(self, event: OwnEvent, elapsed: float, landed: str | None) -> bool:
        """The jump of a declared event and what follows it; True if it ends the collision."""
        model, before = self.model, self.y
        after = model.values(f"jump_{event.name}", before, self.p)
        self.y = self.path.y = np.concatenate([list(after.values()), before[len(after) :]])
        loss = own_loss(model, before, self.y, self.p)
        released = model.values(f"release_{event.name}", before, self.p)["released"]
        kinetic = model.values("energies", before, self.p)["kinetic"]
        if -loss > released + SAFETY * self.rtol * kinetic:
            raise self._error(
                f"the event {event.word} creates {-loss:.3g} m v0^2 of kinetic energy, and declares {released:.3g}",
                "declare what it releases, event(..., releases=), or another jump",
            )
        self.path.own_loss += loss
        velocity = float(self.y[_VELOCITY])
        pull = -velocity if velocity else model.values("inward_force", self.y, self.p)["inward_force"]
        step = PhaseRun(self.phase, elapsed, landed, (event.word,), own=event.name)
        self._next(step, self._towards(CLOSING if pull > 0 else OPENING, self.phase))
        self.path.separated = event.row.actions[-1] == "part"
        return event.row.actions[-1] != "go on"

    def _act(self, event: Event, elapsed: float) -> bool:
        """Apply the effect of an event; True if it ends the collision."""
        before, phase = self.phase, self.phase
        word = self._word(event)
        for action in event.actions:
            if action == "rebound":
                self._rebound(word, elapsed, event.name)
                return False
            phase = self._done(action, phase, event.target)
        self._next(PhaseRun(before, elapsed, event.name, (word,)), phase)
        return event.actions[-1] in ENDS

    def _word(self, event: Event) -> str:
        if event.chosen_by == "motion":
            return event.words[self.phase.motion == OPENING]
        if event.chosen_by == "larger gap":
            return contact_word(self.groups)
        if event.chosen_by == "grip":
            return event.words[not self._grips(self.phase).rolling]
        return event.words[0]

    def _done(self, action: str, phase: Phase, target: str) -> Phase:
        """The phase after an action of an event with this target; the action may also change the state."""
        match action:
            case "gap = target":
                self._put(_GAP, self.gaps[target] if target in self.gaps else self.groups[target])
            case "velocity = 0":
                self._put(_VELOCITY, 0.0)
            case "turn":
                return self._towards(-phase.motion, phase)
            case "cross film edge":
                film = 1 - phase.film
                return phase.with_(film=film, shear=film if self.edge == 1.0 else phase.shear)
            case "cross tangential edge":
                return phase.with_(shear=1 - phase.shear)
            case "open":
                self._put(_VELOCITY, RELEASE_SPEED)
                return self._opening(phase.with_(resting=False, sliding=0, rolling=False))
            case "roll or slide":
                return self._grips(phase)
            case "slide":
                return self._slides(phase)
            case "separate":
                if is_within_rounding(self.y[_VELOCITY], self.groups["obliquity"], self.groups["aspect"]):
                    raise self._error(
                        f"the doublet separates so slowly that {ROUNDED}", "try spins with another angular momentum"
                    )
                self.path.separated = True
            case "cut off":
                pass
            case _:
                raise CheckFailed(f"generated/automaton.py has an unknown action: {action}; run `wetdoublet generate`")
        return phase

    def _put(self, position: int, value: float) -> None:
        """A state set exactly onto an event's surface, so that later decisions do not depend on rounding."""
        self.y = np.array(self.y)
        self.y[position] = value
        self.path.y = self.y

    def _next(self, step: PhaseRun, phase: Phase | None = None) -> None:
        """Record a phase that ends here; the next one begins, if there is one."""
        self.path.steps.append(step)
        self.path.ends.append(self.y)
        self.phase = phase or self.phase

    def _rebound(self, kind: str, elapsed: float, event: str | None = None) -> None:
        """A rebound; a weak one becomes resting contact, one at the rupture gap separates the doublet.

        The contact that holds a resting doublet is that of the rebound criterion, the glassy liquid included
        (docs/explanation/events.md).
        """
        jump = rebounded(self.model, kind, self.y, self.p)
        gap, velocity = map(float, jump.after[: _VELOCITY + 1])
        parts = is_parted(gap, self.rupture_gap)
        inward = self.model.values("inward_force", jump.after, self.p)["inward_force"]
        # without drag it rises by u^2/(2 inward); the chatter that would follow is a geometric series at the same gap
        holds = not parts and is_too_weak(inward, velocity, self.rtol, gap)
        if holds and self.model.friction:
            jump = rebounded(self.model, kind, self.y, self.p, holds)
        self.path.dry_loss += jump.dry
        self.path.friction_loss += jump.friction
        self.y = self.path.y = np.concatenate([jump.after, self.y[jump.after.size :]])
        self.path.separated, phase = parts, self._opening(self.phase)
        kinds = (kind, *([KINDS[EventKind.RUPTURE]] if parts else []), *([KINDS[EventKind.RESTS]] if holds else []))
        if holds:
            self.path.dry_loss += float(self.y[_VELOCITY]) ** 2 / 2
            self.y[_VELOCITY] = 0.0
            phase = phase.with_(resting=True)
            if self.model.friction:
                phase = self._rubbing(phase)
                kinds += (KINDS[EventKind.ROLLS],) if phase.rolling else ()
        self._next(PhaseRun(self.phase, elapsed, event, kinds, rebounds=True, holds=holds, grip=jump.grip), phase)

    def _rubbing(self, phase: Phase) -> Phase:
        """The mode of resting contact with friction; in space a creep takes the place of rolling."""
        if self.model.space:
            return phase.with_(sliding=1)
        slip = self.model.values("dry_slip", self.y, self.p)["slip"]
        return self._grips(phase) if has_no_slip(slip) else phase.with_(sliding=int(np.sign(slip)), rolling=False)

    def _grips(self, phase: Phase) -> Phase:
        """The mode without slip: rolling if friction can hold the surfaces together, else sliding."""
        forces = self._dry_forces(phase)
        if friction_holds(forces["holding"], forces["limit"]):
            return phase.with_(sliding=0, rolling=True)
        return self._slides(phase)

    def _slides(self, phase: Phase) -> Phase:
        """The mode of sliding in the direction in which the surfaces are driven past each other."""
        return phase.with_(sliding=int(np.sign(self._dry_forces(phase)["holding"])), rolling=False)

    def _dry_forces(self, phase: Phase) -> dict[str, float]:
        flags = phase.region.flags
        return self.model.values("dry_forces", self.y, self.p, flags["film"], flags["shear"])

    def _opening(self, phase: Phase) -> Phase:
        """The phase that opens from here; on an edge, the phase is beyond that edge."""
        film = 0 if self.model.edged and is_on_edge(self.y[_GAP], 1.0) else phase.film
        shear = 0 if is_on_edge(self.y[_GAP], self.edge) else phase.shear
        return self._towards(OPENING, phase).with_(film=film, shear=shear)

    def _towards(self, motion: int, phase: Phase) -> Phase:
        """The phase with another motion."""
        return phase.with_(motion=motion, cavitated=self.model.cavitates and motion == OPENING)

    def _error(self, message: str, advice: str) -> ComputationError:
        state = dict(zip(self.model.state, map(float, self.y), strict=False))
        return ComputationError(message, phase=str(self.phase), time=self.path.time, state=state, advice=advice)


def own_loss(model: Model, before: np.ndarray, after: np.ndarray, p: np.ndarray) -> float:
    """Kinetic energy that a declared event takes, over m v0^2; negative if it gives some."""
    kinetic = [model.values("energies", y, p)["kinetic"] for y in (before, after)]
    return kinetic[0] - kinetic[1]


def locate(
    model: Model,
    groups: dict[str, float],
    rtol: float,
    extras: tuple[str, ...] = (),
    machine_code: bool = False,
    until: float = 0.0,
    budget: Budget | None = None,
) -> EventSequence:
    """Phases and events of a collision.

    Arguments:
        extras: additional quadratures (`rotation`), included in the sequence's last state.
        machine_code: use integrators compiled to C.
        until: time (x0/v0) to which a stick is followed on after its proof.
        budget: of its steps; None for one of its own.

    Raises:
        ComputationError: with phase, time (x0/v0) and state, if the outcome cannot be decided.
    """
    return EventLocator(model, groups, rtol, extras, machine_code, budget, until).run()
