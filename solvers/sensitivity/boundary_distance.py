"""Distance of a collision from the nearest boundary, where derivatives jump or diverge.

Estimates from the trajectory come first, at little cost: the slope at which it meets its events, the margin by which it
misses a criterion, the speed at which it passes the barrier. Where an estimate is small, the distance in the Stokes
number is computed with the functions that are smooth through the boundary (`boundaries.line`).
"""

import math
from collections.abc import Callable, Iterator

import numpy as np
from casadi import Function, densify, jtimes, vertcat

from ...generated.automaton import CLOSING, KINDS, EventKind
from ..boundaries.line import Line
from ..boundaries.resampled import resampled
from ..certificates import energy_proof
from ..engines.casadi.integrators import IntegrationFailed, tolerance_for
from ..engines.casadi.locate import EventLocator, EventSequence, PhaseRun
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.dimensionless import Problem, nondimensionalise
from ..model.model import Model, load, select_model
from ..scene.contact import ENTRIES, GAPS, TIE, contact_gap
from ..scene.scene import Scene
from ..scene.user_model import OwnEvent
from .result import Near

LIMIT, PER_RTOL, WIDEST = 1e-6, 1e4, 1e-3
COMPUTED = 30.0  # multiple of the limit; at smaller estimates the distance is computed
_SLOW = 3e-2  # of v0 squared: so slow, a trajectory may lie where it amplifies errors (`problem.NEAR`)
_FARTHEST = 0.5  # largest logarithmic distance that is reported
_HINT = "v0 squared"  # marks an estimate that is no distance; it is computed or dropped
_ESTIMATE = "the energy of approach, by an estimate"
_COARSE, _FINE = 1e-6, 1e-11
_ASIDE, _SECANTS, _FAR = 1e-4, 4, 0.1  # secants in St: first relative step, number, reach
_GRID = (*(float(t) for t in np.unique(np.concatenate([np.geomspace(1e-3, 1, 40), np.linspace(0, 1, 41)[1:]]))),)

GLASS = "graze of the glass criterion"
CONTACT = "graze of the contact gap"
SADDLE = "separatrix (saddle of the effective potential)"
RIM = "separatrix (rim: it just reaches the rupture gap)"
CHATTER = Near("chatter (it rests on the solids before it separates)", 0.0, "rebound speed")
GRIP = "switch between sliding and sticking contact"
DECLARED = "edge of the declared event"


def limit(rtol: float) -> float:
    """Relative distance to a boundary within which no derivative is given.

    Errors of the trajectory are amplified by one over the distance; at the limit they reach rtol/limit = 1e-4 of a
    derivative.
    """
    return min(max(LIMIT, PER_RTOL * rtol), WIDEST)


def checked(scene: Scene, n: Problem, finder: EventLocator, path: EventSequence, rtol: float) -> Near | None:
    """The nearest boundary found from a trajectory; ComputationError if it is too near for derivatives."""
    least = limit(rtol)
    if path.separated:
        near = _nearest(scene, n, _suspects(finder, path, least), least)
    else:
        near = _stick(scene, n, finder, path, least)
    if near is not None and near.distance < least:
        raise refused(near, least)
    return near


def checked_by_estimates(finder: EventLocator, path: EventSequence, rtol: float) -> Near | None:
    """The boundary nearest to a separated trajectory in space, by estimates only; ComputationError if it is near."""
    least = COMPUTED * limit(rtol)
    near = min(_suspects(finder, path, least), key=lambda one: one.distance, default=None)
    if near is not None and near.distance < least:
        raise refused(Near(near.boundary, near.distance, _ESTIMATE) if near.of == _HINT else near, least)
    return near


def explained(scene: Scene, n: Problem, error: ComputationError, rtol: float) -> ComputationError:
    """The error for a trajectory that could not be differentiated: names the boundary if it is close to one."""
    measured = [_measured(scene, n, Near(name, math.inf, _HINT)) for name in (GLASS, SADDLE)]
    near = min(measured, key=lambda one: one.distance)
    return refused(near, limit(rtol)) if near.distance < limit(rtol) else error


def _nearest(scene: Scene, n: Problem, suspected: Iterator[Near], least: float) -> Near | None:
    """The nearest of the estimated boundaries; distances of near ones are computed, other hints dropped."""
    candidates, suspects = [], list(suspected)
    hints = sorted((one for one in suspects if one.of == _HINT), key=lambda one: one.distance)
    suspects = [one for one in suspects if one.of != _HINT] + hints[:1]  # one function has the roots of all
    for boundary in dict.fromkeys(one.boundary for one in suspects):
        near = min((one for one in suspects if one.boundary == boundary), key=lambda one: one.distance)
        if near.distance < max(COMPUTED * least, _SLOW * (near.of == _HINT)):
            measured = _measured(scene, n, near)
            candidates += [measured] if measured.of != _HINT else []
        elif near.of != _HINT and near.distance < _FARTHEST:
            candidates.append(near)
    return min(candidates, key=lambda one: one.distance, default=None)


def refused(near: Near, least: float) -> ComputationError:
    """The error for a collision nearer to a boundary than `least`."""
    return ComputationError(
        f"no derivative: the collision lies at the {near}, nearer than {least:.1g}",
        advice="move the impact; the boundary itself can be differentiated (wetdoublet boundary --wrt)",
    )


# ---- sticks: only e_n = 0 is defined, up to the boundary


def _stick(scene: Scene, n: Problem, finder: EventLocator, path: EventSequence, least: float) -> Near | None:
    """A boundary within the relative distance `least` in the Stokes number, by the outcomes on both sides."""
    decided = len(path.steps) == 1 and path.steps[0].duration == 0
    if decided and energy_proof(finder.proof) is not None:
        return None  # certified by energy before the film dissipates any, so far from every boundary
    for factor in (1 - least, 1 + least):
        aside = _located(scene, n, n.stokes * factor, finder.rtol)
        if aside is not None and aside.separated:
            kind = _separatrix(finder)
            if aside.reversal and not path.reversal:
                kind = CONTACT if aside.reversal in GAPS else GLASS
            near = Near(kind, least / 2, "impact.stokes")
            return _measured(scene, n, near)
    return None


def _located(scene: Scene, n: Problem, stokes: float, rtol: float) -> EventSequence | None:
    groups = nondimensionalise(scene, scene.speed_of(stokes), n.angle).groups
    try:
        return EventLocator(load(select_model(scene, n.oblique)), groups, min(rtol, 1e-10)).run()
    except ComputationError:
        return None


# ---- estimates from a separated trajectory


def _suspects(finder: EventLocator, path: EventSequence, least: float) -> Iterator[Near]:
    """Nearby boundaries, with distances estimated from the trajectory; ComputationError if it rests on the solids."""
    if KINDS[EventKind.RESTS] in path.kinds:
        raise refused(CHATTER, least)
    model, groups = finder.model, finder.groups
    contact = contact_gap(groups)
    smaller = sorted(groups[name] for name in GAPS.values())[-2]
    for step, y in _sampled(finder, path):
        if step.phase.motion == CLOSING:
            yield from _criteria(model, path, step, y, groups["glass_number"], contact)
            if step.event == "contact" and smaller > 0:
                yield Near(TIE, math.log(contact / smaller), list(ENTRIES.values())[-1])
        else:
            yield from _leaving(finder, step, y)
        yield from _passing(finder, step, y)
        if step.grip < math.inf:
            yield Near(GRIP, abs(step.grip), "particles.friction")
        for event, mark in zip(model.own_events, model.marks, strict=True):
            watched = all(getattr(step.phase, part) == value for part, value in event.row.where)
            if watched and y[mark, 0] > 0.5:
                yield from _declared(model, path, event, step, y)


def _declared(model: Model, path: EventSequence, event: OwnEvent, step: PhaseRun, y: np.ndarray) -> Iterator[Near]:
    """Boundaries of a declared event: its guard just falls to zero, or is so where it begins to be watched."""
    guard, first, second = _guard_rates(model, event.name, *_region(step))(y, path.p).full()
    name, scale = f"{DECLARED} {event.word}", float(np.abs(guard).max())
    if step.duration == 0 or scale == 0:  # it happens where it begins to be watched, or may not
        if step.own == event.name:
            yield Near(f"{name} at the start of a phase", abs(float(guard[0])), "its guard")
        return
    if step.own == event.name:
        if second[-1] > 0:
            yield Near(name, first[-1] ** 2 / (2 * second[-1] * scale), "its guard")
    else:
        yield Near(name, float(guard.min()) / scale, "its guard")


def _criteria(
    model: Model, path: EventSequence, step: PhaseRun, y: np.ndarray, glass: float, contact: float
) -> Iterator[Near]:
    """Boundaries of a closing phase: grazing of its criterion, and margins of the others."""
    guard, first, second = _guard_rates(model, "glass", *_region(step))(y, path.p).full()
    pressure, first, second = glass - guard, -first, -second
    met = step.kinds[:1] and step.kinds[0]
    if met == "glass":
        if step.duration == 0:  # met at initial contact
            yield Near("glass criterion met at initial contact", math.log(pressure[-1] / glass), _P_GT)
        elif second[-1] < 0 < first[-1]:
            yield Near(GLASS, first[-1] ** 2 / (-2 * second[-1] * glass), _P_GT)
    else:
        k = int(np.argmax(pressure))
        peak = pressure[k]
        if second[k] < 0 and first[k] ** 2 < -2 * second[k] * peak:
            peak = peak - first[k] ** 2 / (2 * second[k])
        if peak > 0:
            yield Near(GLASS, abs(math.log(glass / peak)), _P_GT)
    gap, normal_velocity = y[0, -1], y[1, -1]
    if met in GAPS and step.duration > 0:
        slowing = float(model.function("right_hand_side", *_region(step))(y[: len(model.state), -1], path.p)[1])
        if slowing > 0:
            yield Near(CONTACT, normal_velocity**2 / (2 * slowing * contact), f"the gap of {met} contact")
    elif contact > 0 and met not in GAPS:
        yield Near(CONTACT, abs(math.log(gap / contact)), "the gap of contact")


_P_GT = "liquid.glass_transition_pressure"


def _barrier(finder: EventLocator) -> float:
    """Gap of the highest barrier; the rupture gap if that is the barrier or none is known."""
    rim = finder.groups["rupture_gap"] if finder.model.bridge else 1.0
    proof = energy_proof(finder.proof)
    barriers = proof.barriers(finder.y) if proof is not None else ()
    return min(barriers[0].gap, rim) if barriers else rim


def _separatrix(finder: EventLocator) -> str:
    rim = finder.groups["rupture_gap"] if finder.model.bridge else 1.0
    return SADDLE if _barrier(finder) < rim * (1 - 1e-12) else RIM


def _passing(finder: EventLocator, step: PhaseRun, y: np.ndarray) -> Iterator[Near]:
    """Separatrix of the saddle: speed at which a phase passes it, or distance at which the doublet turns."""
    if _separatrix(finder) != SADDLE:
        return
    speed = np.abs(y[1])
    dips = (speed[1:-1] < speed[:-2]) & (speed[1:-1] < speed[2:])
    if dips.any():
        yield Near(SADDLE, float(np.min(speed[1:-1][dips])) ** 2, _HINT)
    if step.event == "turning":
        yield Near(SADDLE, (float(y[0, -1]) / _barrier(finder) - 1) ** 2, _HINT)


def _leaving(finder: EventLocator, step: PhaseRun, y: np.ndarray) -> Iterator[Near]:
    """Separatrix of the rim: remaining speed at separation."""
    model = finder.model
    held = model.bridge or model.strings or model.choice.law("attraction") is not None
    if step.event != "rupture" or (model.oblique and not model.wall and not held):
        return  # with a film alone a doublet separates for any angular momentum but none
    yield Near(RIM, float(y[1, -1]) ** (2 if held else 1), _HINT)
    if model.strings and model.oblique:
        names = list(model.state)
        yield Near("half turn at separation", 1 - float(y[names.index("rotation"), -1]) / math.pi, "rotation")
        orbital_momentum = y[names.index("orbital_momentum")]
        yield Near(
            "reversal of the rotation",
            float(orbital_momentum.min() / np.abs(orbital_momentum).max()),
            "angular momentum",
        )


@own_cache(256)
def _guard_rates(model: Model, name: str, film: int, shear: int) -> Function:
    """Function (states, groups) -> guard of an event, its first and second time derivative: three rows."""
    rates = model.function("right_hand_side", film, shear)(model.column, model.parameters)
    guard = model("events")[name]
    first = jtimes(guard, model.column, rates)
    rows = densify(vertcat(guard, first, jtimes(first, model.column, rates)))
    return Function("guard_rates", [model.column, model.parameters], [rows])


def _region(step: PhaseRun) -> tuple[int, int]:
    return step.phase.region.film, step.phase.region.shear


def _sampled(finder: EventLocator, path: EventSequence) -> Iterator[tuple[PhaseRun, np.ndarray]]:
    """Phases and states along each: at a coarse tolerance, and a fine one where those indicate a boundary."""
    tolerance = tolerance_for(_COARSE, "rosenbrock", finder.groups)
    for step, before, inside, end in resampled(
        path, tolerance, _GRID, lambda step: not step.phase.resting, lenient=True
    ):
        if step.phase.resting:
            continue
        y = before[:, None]
        if step.duration > 0:
            y = np.column_stack([before, end if inside is None else inside])
            if not step.own:  # which may change every state
                still = np.arange(end.size) == 0 if step.grip < math.inf else np.arange(end.size) != 1
                y[:, -1] = np.where(still, end, y[:, -1])  # the others before the jump
            if not step.rebounds and not step.own:
                y[1, -1] = end[1]
        yield step, y


# ---- distances in the Stokes number, by functions that are smooth through the boundary


def _measured(scene: Scene, n: Problem, near: Near) -> Near:
    """The computed distance in the Stokes number of an estimated boundary."""
    line = Line(scene, n.angle, _FINE, kernel=False, machine_code=False)
    escapes = (lambda stokes: line.escape(stokes, True)[1], lambda stokes: line.escape(stokes, False)[1])
    functions: dict[str, tuple[Callable[[float], float | None], ...]] = {
        GLASS: (line.criterion,),
        CONTACT: (line.criterion,),
        SADDLE: escapes,
        RIM: escapes,
    }
    for function in functions.get(near.boundary, ()):
        try:
            distance = _secant(function, n.stokes)
        except (ComputationError, IntegrationFailed):
            continue
        if distance is not None:
            return Near(near.boundary, distance, "impact.stokes")
    return near


def _secant(function: Callable[[float], float | None], stokes: float) -> float | None:
    """Relative distance to the nearest root, within about a percent; None where the function is undefined."""
    before, at = 0.0, _ASIDE
    f_before, f = function(stokes), function(stokes * (1 + _ASIDE))
    for _ in range(_SECANTS):
        if f_before is None or f is None or f == f_before or not math.isfinite(f - f_before):
            return None
        before, at, f_before = at, at - f * (at - before) / (f - f_before), f
        if abs(at) > _FAR or abs(at - before) < 1e-2 * abs(at):
            break
        f = function(stokes * (1 + at))
    return abs(at)
