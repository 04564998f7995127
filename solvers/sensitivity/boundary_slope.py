"""Derivatives of a change of outcome in the parameters: gradients of the functions that are zero there.

They are smooth through the change (`boundaries.line`): the amplitude of the unstable mode, the gap at which an escape
stops short of the rim, the largest pressure of the approach. Their gradients in the groups are one adjoint each, at the
change itself; the implicit function theorem gives the derivatives of St*.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from casadi import SX, Function, densify, gradient, jacobian, jtimes, substitute, vertcat

from ...generated.automaton import CRITERIA, KINDS, EventKind
from ..boundaries.changes import FREE, GRAZE, REVERSED, Change
from ..boundaries.line import WITHOUT_SOLIDS, UnstoppedTrajectory
from ..boundaries.resampled import resampled
from ..boundaries.saddle import Saddle, barrier_of, saddle_of
from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain, tolerance_for
from ..engines.casadi.locate import EventLocator, EventSequence, PhaseRun
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.dimensionless import nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow, Region
from ..scene.contact import GAPS, contact_word
from ..scene.scene import Scene
from .derivatives import adjoint, evaluate, settled
from .directions import landed
from .trajectory_expression import Course, course_of, ending, influential

_BELOW, _ABOVE = 1 - 1e-8, 1 + 1e-8  # factors of St* at which it falls back, meets a criterion
_FREE_RIM = 1 + 1e-5  # and at which it leaves a film without attraction
_GRID = (*(float(part) for part in np.linspace(0, 1, 401)[1:]),)
_NEWTON = 12


@dataclass(frozen=True)
class Slope:
    """Gradient (in the named groups) of a function that is zero at a change of outcome; its scale is arbitrary."""

    groups: tuple[str, ...]
    gradient: np.ndarray


def slope(scene: Scene, angle: float, change: Change, rtol: float) -> Slope | None:
    """The gradient at a change; None for a change without a smooth function.

    Raises:
        ComputationError: the trajectory there could not be followed.
    """
    if load(select_model(scene, scene.turns(angle))).own_events:
        return None
    try:
        if change.kind == GRAZE:
            return _graze(scene, angle, change.stokes, rtol)
        if change.kind in (FREE, REVERSED):
            return _escape(scene, angle, change.stokes, change.kind == REVERSED, rtol)
    except IntegrationFailed as failure:
        raise ComputationError(f"the change at St {change.stokes:.10g} cannot be differentiated ({failure})") from None
    return None


def _groups(scene: Scene, angle: float, stokes: float) -> dict[str, float]:
    return nondimensionalise(scene, scene.speed_of(stokes), angle).groups


# ---- a criterion that is just met: the trajectory up to the maximum, where the time derivative is zero


def _graze(scene: Scene, angle: float, stokes: float, rtol: float) -> Slope | None:
    model = load(select_model(scene, scene.turns(angle)))
    finder = EventLocator(model, _groups(scene, angle, stokes * _ABOVE), rtol)
    path = finder.run()
    if path.reversal is None:
        return None
    k = next(k for k, step in enumerate(path.steps) if step.rebounds)
    step = path.steps[k]
    tolerance = tolerance_for(rtol, "rosenbrock", finder.groups)
    word = contact_word(finder.groups) if step.kinds[0] in GAPS else step.kinds[0]
    before = path.ends[k - 1][: len(model.state)] if k else model.start(path.p)
    if step.duration > 0:
        step = replace(
            step, duration=_extremum(model, step, word, before, path.p, tolerance), event=None, rebounds=False
        )
    course, durations = _up_to(path, k, step)
    end = ending(course, "rosenbrock", tolerance)
    durations = settled(end, path.p, durations, landed(course), 1e-8)
    y = evaluate(end.function, path.p, durations)[0]
    margin = _margin(model, word)
    by_state, by_group = evaluate(margin, y, path.p)
    carried = evaluate(adjoint(end, 1), path.p, durations, by_state)[2].ravel()
    return Slope(tuple(model.groups), carried + by_group.ravel())


def _extremum(
    model: Model, step: PhaseRun, word: str, before: np.ndarray, p: np.ndarray, tolerance: Tolerance
) -> float:
    """Time within the phase of the largest pressure or smallest gap, by Newton's method."""
    rates = _rates(model, step.phase.region, word)
    integrate = plain(Flow(model.choice, step.phase.region, ()), "rosenbrock", tolerance)
    time = step.duration
    for _ in range(_NEWTON):
        first, second = evaluate(rates, integrate(before, p, time), p)
        move = -float(first.item()) / float(second.item())
        time += max(min(move, 0.2 * time), -0.2 * time)
        if abs(move) < 1e-9 * time:
            break
    return time


@own_cache(64)
def _rates(model: Model, region: Region, word: str) -> Function:
    """Function (state, groups) -> first and second time derivative of the pressure or gap."""
    flow = model.function("right_hand_side", region.film, region.shear)(model.column, model.parameters)
    first = jtimes(model("events")[word], model.column, flow)
    return Function("rates", [model.column, model.parameters], [first, jtimes(first, model.column, flow)])


@own_cache(64)
def _margin(model: Model, word: str) -> Function:
    """Function (state, groups) -> gradients in both of the logarithmic margin of a criterion."""
    limit = model.groups[CRITERIA[word].limit]
    of = limit / model.state["gap"] if word in GAPS else (limit - model("events")[word]) / limit
    slopes = [densify(gradient(of, each)) for each in (model.column, model.parameters)]
    return Function("margin", [model.column, model.parameters], slopes)


# ---- a doublet that just escapes


def _escape(scene: Scene, angle: float, stokes: float, rebound: bool, rtol: float) -> Slope | None:
    probe = _probe(scene, angle, stokes * _BELOW, rebound, rtol)
    path = probe.run()
    barrier = barrier_of(probe)
    rim = probe.groups["rupture_gap"] if probe.model.bridge else 1.0
    if barrier is not None and barrier.gap < rim * (1 - 1e-12):
        saddle = saddle_of(probe, barrier)
        return None if saddle is None else _at_saddle(probe, path, saddle)
    if path.steps and KINDS[EventKind.FELL_BACK] in path.steps[-1].kinds:
        return _at_rim(probe, path)
    probe = _probe(scene, angle, stokes * _FREE_RIM, rebound, rtol)
    path = probe.run()
    return _at_rim(probe, path) if path.separated else None


def _probe(scene: Scene, angle: float, stokes: float, rebound: bool, rtol: float) -> UnstoppedTrajectory:
    groups = _groups(scene, angle, stokes) | ({} if rebound else WITHOUT_SOLIDS)
    return UnstoppedTrajectory(load(select_model(scene, scene.turns(angle))), groups, rtol)


def _at_rim(probe: EventLocator, path: EventSequence) -> Slope:
    """Margin of an escape: the largest gap if it turns before rupture, else the normal velocity at rupture."""
    course = course_of(path, probe.model.choice)
    names = list(probe.model.groups)
    durations = np.array([step.duration for step in path.steps])
    end = ending(course, "rosenbrock", tolerance_for(probe.rtol, "rosenbrock", probe.groups))
    durations = settled(end, path.p, durations, landed(course), 1e-8)
    weights = np.zeros((len(probe.model.state), 1))
    weights[1 if path.separated else 0] = 1.0
    found = evaluate(adjoint(end, 1), path.p, durations, weights)[2].ravel()
    if not path.separated and "rupture_gap" in names:
        found[names.index("rupture_gap")] -= 1.0
    return Slope(tuple(names), found * _active(course, probe))


def _at_saddle(probe: EventLocator, path: EventSequence, saddle: Saddle) -> Slope | None:
    """Amplitude of the unstable mode near the saddle, which moves with the parameters.

    Time and mode are kept fixed. The neglected terms are smaller than the growth of the amplitude by the distance of
    the nearest approach.
    """
    tolerance = tolerance_for(probe.rtol, "rosenbrock", probe.groups)
    found = _nearest(probe, path, saddle, tolerance)
    if found is None:
        return None
    k, duration = found
    course, durations = _up_to(path, k, replace(path.steps[k], duration=duration, event=None, rebounds=False))
    end = ending(course, "rosenbrock", tolerance)
    durations = settled(end, path.p, durations, landed(course), 1e-8)
    mode = saddle.modes[saddle.unstable].real
    y = evaluate(end.function, path.p, durations)[0].ravel()
    carried = evaluate(adjoint(end, 1), path.p, durations, mode)[2].ravel()
    at = np.concatenate([[saddle.gap], y[1:]])
    moved = evaluate(_moving(probe.model), at, path.p)[0]
    return Slope(tuple(probe.model.groups), (carried - moved.T @ mode) * _active(course, probe))


def _active(course: Course, probe: EventLocator) -> np.ndarray:
    return np.array(influential(course, probe.groups), dtype=float)


def _nearest(
    probe: EventLocator, path: EventSequence, saddle: Saddle, tolerance: Tolerance
) -> tuple[int, float] | None:
    """The phase nearest to the saddle, among those on its side of the film edge, and the time within it."""
    region = Region(int(saddle.gap < 1), int(saddle.gap < probe.edge), resting=False)

    def beside(step: PhaseRun) -> bool:
        return replace(step.phase.region, cavitated=False) == region

    best: tuple[float, int, float] | None = None
    for k, (step, _, inside, _) in enumerate(resampled(path, tolerance, _GRID, beside)):
        if inside is not None:
            at, amplitudes = saddle.nearest(inside)
            distance = float(np.linalg.norm(amplitudes))
            if best is None or distance < best[0]:
                best = (distance, k, _GRID[at] * step.duration)
    return None if best is None or best[0] > saddle.gap / 2 else best[1:]


def _up_to(path: EventSequence, k: int, last: PhaseRun) -> tuple[Course, np.ndarray]:
    """The course of a path up to a time within phase k, and its durations."""
    steps = [*path.steps[:k], last]
    part = replace(path, steps=steps, ends=path.ends[: k + 1])
    return course_of(part, path.model.choice), np.array([step.duration for step in steps])


@own_cache(64)
def _moving(model: Model) -> Function:
    """Function (state at the saddle's gap with the trajectory's momentum, groups) -> d(saddle's state)/d(groups).

    The gap follows from the slope of the effective potential, which is zero there, by one step of Newton's method.
    """
    gap = model.state["gap"]
    slope_ = model("effective_potential")["slope"]
    held = SX.sym("held", len(model.state))
    foot = substitute([gap - slope_ / jacobian(slope_, gap)], [model.column], [held])[0]
    there = [foot, *(held[k] for k in range(1, len(model.state)))]
    column = vertcat(*(SX(each) for each in model("rigid_rotation").values()))
    state = substitute([column], [model.column], [vertcat(*there)])[0]
    return Function("moving", [held, model.parameters], [densify(jacobian(state, model.parameters))])
