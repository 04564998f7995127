"""Derivatives of a change of outcome in the parameters: gradients of the functions that are zero there.

The trajectories just below and just above the change share their phases up to the one in which they part. What happens
there decides the function, which is smooth through the change: the margin of a criterion that only one of them meets,
the gap at which an escape stops short of the rim, the amplitude of the unstable mode of a saddle that they pass on
different sides. Its gradient in the groups is one adjoint; the implicit function theorem gives the derivatives of St*.
"""

from dataclasses import dataclass, replace

import numpy as np
from casadi import SX, Function, densify, gradient, jacobian, jtimes, substitute, vertcat
from scipy.optimize import brentq

from ...generated.automaton import CRITERIA, KINDS, EventKind
from ..boundaries.changes import Change
from ..boundaries.resampled import resampled
from ..boundaries.saddle import Saddle, saddle_at
from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain, tolerance_for
from ..engines.casadi.locate import EventLocator, EventSequence, PhaseRun
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.dimensionless import nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow
from ..scene.contact import GAPS, contact_word
from ..scene.scene import Scene
from .derivatives import evaluate, first_derivatives, settled
from .directions import landed
from .trajectory_expression import course_of, ending, influential

_ASIDE, _FREE_RIM = 1e-8, 1e-5  # of St*: where both sides are computed; where it leaves a film without attraction
_AT_RIM = 1e-4  # of the rupture gap; an escape that stops so near it stops at the rim
_SLOW = 1e-2  # of v0; a doublet that just reaches the rim separates more slowly
_TANGENT = 0.1  # of a phase; the extremum of a criterion that is just met lies nearer to its end
_ZERO = 1e-4  # largest margin of a criterion that is just met, _ASIDE of St* away from there
_GRID = (*(float(part) for part in np.linspace(0, 1, 401)[1:]),)
_GAPS = 400  # gaps at which the slope of the effective potential is computed
_NEWTON = 12


@dataclass(frozen=True)
class Slope:
    """Gradient (in the named groups) of a function that is zero at a change of outcome; its scale is arbitrary."""

    groups: tuple[str, ...]
    gradient: np.ndarray


@dataclass(frozen=True)
class _Side:
    """The trajectory on one side of a change."""

    finder: EventLocator
    path: EventSequence

    @property
    def model(self) -> Model:
        return self.path.model

    def before(self, k: int) -> np.ndarray:
        return self.path.ends[k - 1][: len(self.model.state)] if k else self.model.start(self.path.p)

    @property
    def tolerance(self) -> Tolerance:
        return tolerance_for(self.finder.rtol, "rosenbrock", self.finder.groups)


def slope(scene: Scene, angle: float, change: Change, rtol: float) -> Slope:
    """The gradient at a change; ComputationError if no trajectory or no smooth function is found there."""
    if load(select_model(scene, scene.turns(angle))).own_events:
        raise ComputationError("beside declared events a change has no smooth function: not differentiated")
    try:
        low, high = (_side(scene, angle, change.stokes * (1 + away), rtol) for away in (-_ASIDE, _ASIDE))
        outcomes = low.path.outcome, high.path.outcome
        if outcomes != (change.before, change.after):
            seen = " and ".join(outcomes)
            raise ComputationError(f"collisions beside St {change.stokes:.10g} end in {seen}: not differentiated")
        k = _parting(low.path, high.path)
        result = _just_met(low, high, k) or _at_rim(low, high, k) or _at_saddle(low, high, k)
        if result is None:
            separated = high if high.path.separated else low
            aside = _ASIDE if separated.model.bridge else _FREE_RIM
            beside = change.stokes * (1 + (aside if separated is high else -aside))
            result = _leaving(_side(scene, angle, beside, rtol))
    except IntegrationFailed as failure:
        raise ComputationError(f"the change at St {change.stokes:.10g} cannot be differentiated ({failure})") from None
    if result is None:
        raise ComputationError(
            f"the trajectories beside St {change.stokes:.10g} part in phase {k + 1}, neither at a criterion that is "
            "just met, nor at the rupture gap, nor at a saddle: not differentiated"
        )
    return result


def _side(scene: Scene, angle: float, stokes: float, rtol: float) -> _Side:
    groups = nondimensionalise(scene, scene.speed_of(stokes), angle).groups
    finder = EventLocator(load(select_model(scene, scene.turns(angle))), groups, rtol)
    return _Side(finder, finder.run())


def _parting(low: EventSequence, high: EventSequence) -> int:
    """Index of the first phase that ends differently on both sides."""
    pairs = zip(low.steps, high.steps)
    alike = (one.kinds == other.kinds and one.event == other.event for one, other in pairs)
    return next((k for k, same in enumerate(alike) if not same), min(len(low.steps), len(high.steps)) - 1)


def _gradient(side: _Side, k: int, last: PhaseRun, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Final state of a path up to a time within phase k, and the gradient of a weighted sum of it in the groups."""
    path = side.path
    part = replace(path, steps=[*path.steps[:k], last], ends=path.ends[: k + 1])
    course = course_of(part, path.model.choice)
    end = ending(course, "rosenbrock", side.tolerance)
    durations = np.array([step.duration for step in part.steps])
    durations = settled(end, path.p, durations, landed(course), 1e-8)
    y, _, slopes = evaluate(first_derivatives(end, 1, True), path.p, durations, weights)
    return y.ravel(), slopes.ravel() * np.array(influential(course, side.finder.groups), dtype=float)


# ---- a criterion that is just met: the trajectory up to the maximum, where the time derivative is zero


def _just_met(low: _Side, high: _Side, k: int) -> Slope | None:
    """Margin of the criterion that phase k meets on one side only, and there first."""
    meeting = [side for side in (low, high) if side.path.steps[k].rebounds]
    if not meeting:
        return None
    side = min(meeting, key=lambda each: each.path.steps[k].duration)
    step, model, p = side.path.steps[k], side.model, side.path.p
    word = contact_word(side.finder.groups) if step.kinds[0] in GAPS else step.kinds[0]
    y = side.before(k)
    last = replace(step, event=None, rebounds=False, holds=False, own="")
    if step.duration > 0:
        time = _extremum(side, step, word, y)
        if time is None:
            return None
        last = replace(last, duration=time)
        y = plain(Flow(model.choice, step.phase.region, ()), "rosenbrock", side.tolerance)(y, p, time)
    value, by_state, by_group = evaluate(_margin(model, word), y, p)
    if abs(value.item()) > _ZERO:
        return None
    return Slope(tuple(model.groups), _gradient(side, k, last, by_state)[1] + by_group.ravel())


def _extremum(side: _Side, step: PhaseRun, word: str, before: np.ndarray) -> float | None:
    """Time within the phase of the largest pressure or smallest gap, by Newton's method; None if it is not near."""
    model, p = side.model, side.path.p
    rates = guard_rates(model, word, *step.phase.region.flags.values())
    integrate = plain(Flow(model.choice, step.phase.region, ()), "rosenbrock", side.tolerance)
    time = step.duration
    for _ in range(_NEWTON):
        _, first, second = evaluate(rates, integrate(before, p, time), p)[0].ravel().tolist()
        move = -first / second
        time += move
        if not abs(time - step.duration) < _TANGENT * step.duration:
            return None
        if abs(move) < 1e-9 * time:
            break
    return time


@own_cache(64)
def _margin(model: Model, word: str) -> Function:
    """Function (state, groups) -> logarithmic margin of a criterion, and its gradients in both."""
    limit = model.groups[CRITERIA[word].limit]
    value = limit / model.state["gap"] - 1 if word in GAPS else -model("events")[word] / limit
    slopes = [densify(gradient(value, each)) for each in (model.column, model.parameters)]
    return Function("margin", [model.column, model.parameters], [value, *slopes])


# ---- a doublet that just escapes


def _at_rim(low: _Side, high: _Side, k: int) -> Slope | None:
    """Margin of an escape that stops just short of the rupture gap."""
    for side in (low, high):
        step, gap = side.path.steps[k], float(side.path.ends[k][0])
        if KINDS[EventKind.FELL_BACK] in step.kinds and abs(gap / side.finder.rupture_gap - 1) < _AT_RIM:
            weights = np.eye(len(side.model.state), 1)
            slopes, names = _gradient(side, k, step, weights)[1], tuple(side.model.groups)
            if side.model.bridge:
                slopes[names.index("rupture_gap")] -= 1.0
            return Slope(names, slopes)
    return None


def _leaving(side: _Side) -> Slope | None:
    """Normal velocity at separation of a doublet that just reaches the rim, for one that stops short is not followed.

    A stick may be certain before, and in a film without attraction it creeps for ever.
    """
    model, path = side.model, side.path
    if not path.separated or path.y[1] > _SLOW:
        return None
    k = len(path.steps) - 1
    return Slope(tuple(model.groups), _gradient(side, k, path.steps[k], np.eye(len(model.state), 1, -1))[1])


def _at_saddle(low: _Side, high: _Side, k: int) -> Slope | None:
    """Amplitude of the unstable mode near the saddle, which moves with the parameters.

    Time and mode are kept fixed. The neglected terms are smaller than the growth of the amplitude by the distance of
    the nearest approach.
    """
    side = high if high.path.separated else low
    nearest = _nearest(side, k)
    if nearest is None:
        return None
    saddle, at, duration = nearest
    mode = saddle.modes[saddle.unstable].real
    last = replace(side.path.steps[at], duration=duration, event=None, rebounds=False, holds=False)
    y, carried = _gradient(side, at, last, mode)
    shear = side.path.steps[at].phase.region.shear
    by_state, moved = evaluate(_moving(side.model, shear), np.concatenate([[saddle.gap], y[1:]]), side.path.p)
    if not shear:  # the gap of the saddle follows the momentum, which the trajectory brings
        carried = _gradient(side, at, last, mode - by_state.T @ mode)[1]
    return Slope(tuple(side.model.groups), carried - moved.T @ mode)


def _nearest(side: _Side, last: int) -> tuple[Saddle, int, float] | None:
    """The saddle that the trajectory passes nearest, up to phase `last`, the phase and the time within it."""
    model = side.model
    if not model.has("effective_potential") or model.strings:
        return None
    best: tuple[float, Saddle, int, float] | None = None
    part = replace(side.path, steps=side.path.steps[: last + 1], ends=side.path.ends[: last + 1])
    phases = resampled(part, side.tolerance, _GRID, lambda step: not step.phase.resting)
    for k, (step, _before, inside, _) in enumerate(phases):
        if inside is None:
            continue
        region = step.phase.region
        for gap in _maxima(side, inside[:, -1], float(inside[0].min()), float(inside[0].max()), region.shear):
            if (int(gap < 1 or not model.edged), int(gap < side.finder.edge)) != (region.film, region.shear):
                continue
            saddle = saddle_at(model, gap, inside[:, -1], side.path.p, region)
            if saddle is None:
                continue
            at, amplitudes = saddle.nearest(inside)
            distance = float(np.linalg.norm(amplitudes)) / gap
            if best is None or distance < best[0]:
                best = (distance, saddle, k, _GRID[at] * step.duration)
    return None if best is None or best[0] > 0.5 else best[1:]


def _maxima(side: _Side, y: np.ndarray, low: float, high: float, shear: int) -> list[float]:
    """Gaps of the maxima of the potential that a trajectory between two gaps may pass.

    With a tangential force it is the effective potential of rigid rotation, without one that of the present momentum.
    """
    gaps = np.geomspace(low / 2, min(2 * high, side.finder.rupture_gap), _GAPS)
    function, row = side.model.function("effective_potential" if shear else "inward_force"), shear

    def slopes(at: np.ndarray) -> np.ndarray:
        states = np.repeat(y[:, None], at.size, axis=1)
        states[0] = at
        return np.asarray(np.asarray(function(states, side.path.p).full())[row])

    values = slopes(gaps)
    places = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    return [float(brentq(lambda gap: slopes(np.array([gap]))[0], gaps[j], gaps[j + 1], xtol=1e-15)) for j in places]


@own_cache(64)
def _moving(model: Model, shear: int) -> Function:
    """Function (state at the saddle's gap with the trajectory's momentum, groups) -> derivatives of the saddle's state.

    They are in the state and in the groups. The gap follows from the slope of the potential, which is zero there, by
    one step of Newton's method. In rigid rotation the momentum is conserved, and a derivative in the state is not used.
    """
    gap = model.state["gap"]
    slope_ = model("effective_potential")["slope"] if shear else model("inward_force")["inward_force"]
    held = SX.sym("held", len(model.state))
    foot = substitute([gap - slope_ / jacobian(slope_, gap)], [model.column], [held])[0]
    there = [foot, *(held[k] for k in range(1, len(model.state)))]
    values = list(model("rigid_rotation").values() if shear else model.state.values())
    values = values if shear else [gap, SX(0), *values[2:]]
    column = vertcat(*(SX(each) for each in values))
    state = substitute([column], [model.column], [vertcat(*there)])[0]
    slopes = [densify(jacobian(state, each)) for each in (held, model.parameters)]
    return Function("moving", [held, model.parameters], slopes)


@own_cache(256)
def guard_rates(model: Model, name: str, film: int, shear: int) -> Function:
    """Function (states, groups) -> guard of an event, its first and second time derivative: three rows."""
    rates = model.function("right_hand_side", film, shear)(model.column, model.parameters)
    guard = model("events")[name]
    first = jtimes(guard, model.column, rates)
    rows = densify(vertcat(guard, first, jtimes(first, model.column, rates)))
    return Function("guard_rates", [model.column, model.parameters], [rows])
