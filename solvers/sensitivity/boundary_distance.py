"""How near a trajectory is to a boundary, where derivatives jump or diverge.

First what the trajectory itself shows, at little cost: how flat it meets its events, how nearly it meets a criterion
    that
it misses, how slowly it passes the barrier. Where that looks near, the distance in the Stokes number is measured, by
the functions that are smooth through the boundary (`boundaries.line`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from casadi import Function, densify, jtimes, vertcat

from ...generated.automaton import CLOSING, KINDS, EventKind
from ..boundaries.line import approach, smooth_escape
from ..certificates import energy_proof
from ..engines.casadi.integrators import IntegrationFailed, plain, tolerance
from ..engines.casadi.locate import EventLocator, EventSequence, PhaseRun
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.contact import GAPS, contact_gap
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow
from ..scene.scene import Scene
from .result import Near

LIMIT, PER_RTOL, WIDEST = 1e-6, 1e4, 1e-3
LOOK = 30.0  # times the limit: nearer than this by the trajectory's own measure, the distance is measured
_WORTH_SAYING = 0.5  # as a logarithm: what is further away is not mentioned
_HINT = "v0 squared"  # a suspicion, not a distance: measured or dropped
_COARSE, _FINE = 1e-6, 1e-11
_ASIDE, _SECANTS, _FAR = 1e-4, 4, 0.1  # first relative step in the Stokes number of a secant; how many; how far
_GRID = (*(float(t) for t in np.unique(np.concatenate([np.geomspace(1e-3, 1, 40), np.linspace(0, 1, 41)[1:]]))),)

GLASS = "graze of the glass criterion"
CONTACT = "graze of the contact gap"
SADDLE = "separatrix (saddle of the effective potential)"
RIM = "separatrix (rim: it just reaches the rupture gap)"


def limit(rtol: float) -> float:
    """Relative distance to a boundary within which no derivative is given.

    Errors of the trajectory are amplified by one over the distance: here they may reach rtol/limit = 1e-4 of a
        derivative.
    """
    return min(max(LIMIT, PER_RTOL * rtol), WIDEST)


def checked(
    scene: Scene, n: DimensionlessGroups, finder: EventLocator, path: EventSequence, rtol: float
) -> Near | None:
    """The nearest boundary that a trajectory shows; a one-line ComputationError if it is too near for derivatives."""
    least = limit(rtol)
    if not path.separated:
        near = _stick(scene, n, finder, path, least)
    else:
        if KINDS[EventKind.RESTS] in path.kinds:
            near = Near("chatter (it rests on the solids before it separates)", 0.0, "rebound speed")
            raise refused(near, least)
        near = _nearest(scene, n, list(_suspects(finder, path)), least)
    if near is not None and near.distance < least:
        raise refused(near, least)
    return near


def explained(scene: Scene, n: DimensionlessGroups, error: ComputationError, rtol: float) -> ComputationError:
    """What to say of a trajectory that could not be followed: the boundary that it lies at, if it does."""
    looked = [_measured(scene, n, Near(name, math.inf, _HINT)) for name in (GLASS, SADDLE)]
    near = min(looked, key=lambda one: one.distance)
    return refused(near, limit(rtol)) if near.distance < limit(rtol) else error


def _nearest(scene: Scene, n: DimensionlessGroups, suspects: list[Near], least: float) -> Near | None:
    """The nearest of the suspects; measured where they look near, and only then if they are no more than a hint."""
    found = []
    for boundary in dict.fromkeys(one.boundary for one in suspects):
        near = min((one for one in suspects if one.boundary == boundary), key=lambda one: one.distance)
        if near.distance < LOOK * least:
            measured = _measured(scene, n, near)
            found += [measured] if measured.of != _HINT else []
        elif near.of != _HINT and near.distance < _WORTH_SAYING:
            found.append(near)
    return min(found, key=lambda one: one.distance, default=None)


def refused(near: Near, least: float) -> ComputationError:
    """What is said of a collision nearer to a boundary than `least`."""
    return ComputationError(
        f"no derivative: the collision lies at the {near}, nearer than {least:.1g}",
        advice="move the impact; the boundary itself can be differentiated (wetdoublet boundary --wrt)",
    )


# ---- sticks: nothing to differentiate but e_n = 0, which holds up to the boundary


def _stick(
    scene: Scene, n: DimensionlessGroups, finder: EventLocator, path: EventSequence, least: float
) -> Near | None:
    """A boundary within `least` in the Stokes number, by the outcome on either side."""
    decided = len(path.steps) == 1 and path.steps[0].duration == 0
    if decided and energy_proof(finder.proof) is not None:
        return None  # by energy, before the film has taken any: far from every boundary
    for factor in (1 - least, 1 + least):
        aside = _located(scene, n, n.stokes * factor, finder.rtol)
        if aside is not None and aside.separated:
            kind = _separatrix(finder)
            if aside.reversal and not path.reversal:
                kind = CONTACT if aside.reversal in GAPS else GLASS
            near = Near(kind, least / 2, "impact.stokes")
            return _measured(scene, n, near)
    return None


def _located(scene: Scene, n: DimensionlessGroups, stokes: float, rtol: float) -> EventSequence | None:
    groups = nondimensionalise(scene, scene.speed_of(stokes), n.angle).groups
    try:
        return EventLocator(load(select_model(scene, n.oblique)), groups, min(rtol, 1e-10)).run()
    except ComputationError:
        return None


# ---- what a separated trajectory shows


def _suspects(finder: EventLocator, path: EventSequence) -> Iterator[Near]:
    """Boundaries by the trajectory's own measure."""
    model, groups = finder.model, finder.groups
    contact = contact_gap(groups)
    smaller = sorted(groups[name] for name in GAPS.values())[-2]
    for step, y in _sampled(finder, path):
        if step.phase.motion == CLOSING:
            yield from _criteria(model, path, step, y, groups["glass_number"], contact)
            if step.event == "contact" and smaller > 0:
                yield Near("tie of roughness and elastic length", math.log(contact / smaller), "particles.roughness")
        else:
            yield from _leaving(finder, step, y)
        yield from _passing(finder, step, y)


def _criteria(
    model: Model, path: EventSequence, step: PhaseRun, y: np.ndarray, glass: float, contact: float
) -> Iterator[Near]:
    """A closing phase: how flat it meets its criterion, how nearly it meets the others."""
    pressure, first, second = _pressures(model, step.phase.region.film, step.phase.region.shear)(y, path.p).full()
    met = step.kinds[:1] and step.kinds[0]
    if met == "glass":
        if step.duration == 0:  # true at initial contact already
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
    """Gap of the highest barrier; the rupture gap where that is the barrier, or none is known."""
    rim = finder.groups["rupture_gap"] if finder.model.bridge else 1.0
    proof = energy_proof(finder.proof)
    barriers = proof.barriers(finder.y) if proof is not None else ()
    return min(barriers[0].gap, rim) if barriers else rim


def _separatrix(finder: EventLocator) -> str:
    rim = finder.groups["rupture_gap"] if finder.model.bridge else 1.0
    return SADDLE if _barrier(finder) < rim * (1 - 1e-12) else RIM


def _passing(finder: EventLocator, step: PhaseRun, y: np.ndarray) -> Iterator[Near]:
    """How slowly a phase passes the saddle, or how near to it the doublet turns."""
    if _separatrix(finder) != SADDLE:
        return
    speed = np.abs(y[1])
    dips = (speed[1:-1] < speed[:-2]) & (speed[1:-1] < speed[2:])
    if dips.any():
        yield Near(SADDLE, float(np.min(speed[1:-1][dips])) ** 2, _HINT)
    if step.event == "turning":
        yield Near(SADDLE, (float(y[0, -1]) / _barrier(finder) - 1) ** 2, _HINT)


def _leaving(finder: EventLocator, step: PhaseRun, y: np.ndarray) -> Iterator[Near]:
    """How fast the doublet still is where it separates."""
    model = finder.model
    held = model.bridge or model.strings or model.choice.law("attraction") is not None
    if step.event != "rupture" or (model.oblique and not model.wall and not held):
        return  # what turns, with a film alone, always separates
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


def _region(step: PhaseRun) -> tuple[int, int]:
    return step.phase.region.film, step.phase.region.shear


@own_cache(128)
def _pressures(model: Model, film: int, shear: int) -> Function:
    """(states, groups) -> scaled film pressure, its rate, and the rate of that."""
    rates = model.function("right_hand_side", film, shear)(model.column, model.parameters)
    pressure = model.groups["glass_number"] - model("events")["glass"]
    first = jtimes(pressure, model.column, rates)
    second = jtimes(first, model.column, rates)
    return Function("pressures", [model.column, model.parameters], [densify(vertcat(pressure, first, second))])


def _sampled(finder: EventLocator, path: EventSequence) -> Iterator[tuple[PhaseRun, np.ndarray]]:
    """Steps and states along each: coarse, and sharper where the coarse ones would decide something."""
    size = len(finder.model.state)
    before = finder.model.start(path.p)
    told = tolerance(_COARSE, "rosenbrock", finder.groups)
    for step, end in zip(path.steps, path.ends, strict=True):
        y = before[:, None]
        if step.duration > 0 and not step.phase.resting:
            flow = Flow(finder.model.choice, step.phase.region, ())
            try:
                inside = plain(flow, "rosenbrock", told, _GRID)(before, path.p, step.duration)
                y = np.column_stack([before, inside])
            except IntegrationFailed:
                y = np.column_stack([before, end[:size]])
            y[:, -1] = np.where(np.arange(size) == 1, y[:, -1], end[:size])  # the speed is the one before a jump
            if not step.rebounds:
                y[1, -1] = end[1]
        if not step.phase.resting:
            yield step, y
        before = end[:size]


# ---- distances in the Stokes number, by functions that are smooth through the boundary


@dataclass(frozen=True)
class _Aside:
    """A collision's scene at other Stokes numbers."""

    scene: Scene
    n: DimensionlessGroups

    def groups(self, stokes: float) -> dict[str, float]:
        return nondimensionalise(self.scene, self.scene.speed_of(stokes), self.n.angle).groups

    def criterion(self, stokes: float) -> float:
        """Largest pressure over p_gt, or contact gap over smallest gap, as a logarithm, of the approach alone."""
        groups = self.groups(stokes)
        model = load(select_model(self.scene, self.n.oblique))
        contact = contact_gap(groups)
        pressure, smallest = approach(model, groups, _FINE, machine_code=False)
        glass = math.log(pressure / groups["glass_number"]) if pressure > 0 else -math.inf
        return max(glass, math.log(contact / smallest) if contact > 0 else -math.inf)

    def escape(self, stokes: float, rebound: bool) -> float | None:
        model = load(select_model(self.scene, self.n.oblique))
        return smooth_escape(model, self.groups(stokes), _FINE, rebound, machine_code=False).value


def _measured(scene: Scene, n: DimensionlessGroups, near: Near) -> Near:
    """The distance in the Stokes number of a boundary that looks near."""
    aside = _Aside(scene, n)
    functions: dict[str, tuple[Callable[[float], float | None], ...]] = {
        GLASS: (aside.criterion,),
        CONTACT: (aside.criterion,),
        SADDLE: (lambda stokes: aside.escape(stokes, True), lambda stokes: aside.escape(stokes, False)),
        RIM: (lambda stokes: aside.escape(stokes, True), lambda stokes: aside.escape(stokes, False)),
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
    """Relative distance to the nearest root, to a percent or so; None where the function is not defined."""
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
