"""Functions of the Stokes number that are smooth through a change of outcome (along a line of constant angle).

* `criterion`: margin by which the approach meets or misses a rebound criterion; its root is a graze.
* `escape`: margin of the escape, with a rebound or without: at a saddle of the effective potential the amplitude of the
  unstable mode, at the rupture gap x_f the remaining (or missing) squared speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...generated.automaton import CLOSING, KINDS, EventKind
from ..certificates import Barrier, energy_proof
from ..engines.casadi.integrators import IntegrationFailed, locator, tolerance_for
from ..engines.casadi.locate import FIRST_STRETCH, GROWTH, STRETCHES, EventLocator, EventSequence
from ..engines.choice import collision_engine
from ..engines.taylor.build import compile_all
from ..engines.taylor.call import variant
from ..errors import ComputationError
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow
from ..scene.contact import GAPS, NEVER_MET, contact_gap
from ..scene.quantities import NO_GLASS
from ..scene.scene import Scene
from ..settings import RTOL
from . import by_kernel
from .by_kernel import Escaping, Happenings
from .resampled import resampled
from .saddle import barrier_of, saddle_of

_NEVER = 1e30  # a glass number that no pressure reaches
WITHOUT_SOLIDS = {"glass_number": _NEVER} | dict.fromkeys(GAPS.values(), 0.0)
_NO_GLASS = {"glass_transition_pressure": NO_GLASS}
_UNMET = {"glass_number": 0.0}  # with this glass number the glass guard is minus the pressure
_ESCAPE_STEPS = (400, 20_000)  # steps of a first attempt by the kernel, to detect creeping past a saddle
_CREEPING = 1e-3  # relative to v0; a slower approach counts as stopped, and contact at this speed is irrelevant
_DEEP = 1e-3  # relative to the contact gap; an approach to this depth has reached solid contact
_GRID = (*(float(part) for part in np.geomspace(1e-7, 0.9, 64)), 1.0)  # parts of a phase; dense at its start


def ready(scenes: Iterable[Scene]) -> None:
    """Compile the kernels for boundaries of these scenes, on all cores."""
    known = (scene for scene in scenes if collision_engine(scene) == "taylor")
    wanted = (variant(scene, select_model(scene, True), RTOL, True, trajectory=True) for scene in known)
    needed = set(wanted)
    if len(needed) > 1:  # a single one is compiled where it is needed
        compile_all(needed)


@dataclass(frozen=True)
class Escape:
    """Result of an escape: if the trajectory separates, and a smooth function with that sign (None if undefined)."""

    separates: bool
    value: float | None


@dataclass
class Line:
    """The smooth functions of a scene at one angle (rad). Counts the integrated collisions.

    Arguments:
        kernel: use the Taylor kernel; Rosenbrock completes the rest. Default: if the kernel supports the scene.
        machine_code: use integrators compiled to C.
    """

    scene: Scene
    angle: float
    rtol: float
    kernel: bool | None = None
    machine_code: bool = True
    collisions: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        """Determine once whether the kernel supports the scene."""
        self.kernel = collision_engine(self.scene) == "taylor" if self.kernel is None else self.kernel

    def numbers(self, stokes: float) -> DimensionlessGroups:
        """Dimensionless groups at a Stokes number."""
        return nondimensionalise(self.scene, self.scene.speed_of(stokes), self.angle)

    @property
    def model(self) -> Model:
        return load(select_model(self.scene, self.scene.turns(self.angle)))

    def happenings(self, *stokes: float) -> list[Happenings]:
        """What happens at Stokes numbers: words and times (x0/v0)."""
        self.collisions += len(stokes)
        speeds = np.array([float(self.scene.speed_of(each)) for each in stokes])
        found = by_kernel.happenings(self.scene, speeds, self.angle, self.rtol) if self.kernel else None
        return found or [self._happening(each) for each in stokes]

    def _happening(self, stokes: float) -> Happenings:
        path = EventLocator(self.model, self.numbers(stokes).groups, self.rtol, machine_code=self.machine_code).run()
        times = np.cumsum([step.duration for step in path.steps]).tolist()
        return [(kind, time) for step, time in zip(path.steps, times, strict=True) for kind in step.kinds]

    def criterion(self, stokes: float) -> float:
        """Logarithm of the larger of maximum pressure over p_gt and contact gap over smallest gap, of the approach.

        The approach is integrated without a rebound, so the function is smooth where a criterion is just met.
        """
        self.collisions += 1
        n = self.numbers(stokes)
        groups, model = n.groups, self.model
        contact = contact_gap(groups)
        found = None
        if self.kernel:
            p = model.group_values(groups | _UNMET)
            solids = _NO_GLASS | NEVER_MET | {"roughness": _DEEP * contact * n.length}
            found = by_kernel.approach(
                self.scene, n, self.rtol, solids, len(model.state), lambda y: _pressures(model, y, p), _CREEPING
            )
        pressure, smallest = found or approach(model, groups, self.rtol, self.machine_code)
        glass = math.log(pressure / groups["glass_number"]) if pressure > 0 else -math.inf
        return max(glass, math.log(contact / smallest) if contact > 0 else -math.inf)

    def escape(self, stokes: float, rebound: bool) -> Escape:
        """Escape of the doublet, with its rebound (`rebound`) or as if there were no rebound criterion."""
        self.collisions += 1
        n = self.numbers(stokes)
        groups = n.groups if rebound else n.groups | WITHOUT_SOLIDS
        solids = {} if rebound else _NO_GLASS | NEVER_MET
        for steps in _ESCAPE_STEPS if self.kernel else ():
            probe = UnstoppedTrajectory(self.model, groups, self.rtol)
            escaped = by_kernel.escaping(self.scene, n, self.rtol, solids, probe.y[: len(self.model.state)], steps)
            if escaped is None:
                break
            probe.y[: escaped.end.size] = escaped.end
            separates = escaped.separated if escaped.decided else _creeps_out(probe)
            if separates is not None:
                return Escape(separates, _smooth(probe, escaped))
        probe = UnstoppedTrajectory(self.model, groups, self.rtol, machine_code=self.machine_code)
        path = probe.run()
        return Escape(path.separated, _smooth(probe, _Located(probe, path)))


def approach(model: Model, groups: dict[str, float], rtol: float, machine_code: bool = True) -> tuple[float, float]:
    """Largest scaled pressure and smallest gap of the approach, without any criterion.

    It ends at a turning point, at a certified stick, when it only creeps, or far below the contact gap.
    """
    deep = _DEEP * contact_gap(groups)
    unmet = _UNMET | dict.fromkeys(GAPS.values(), deep)
    start = EventLocator(model, groups | unmet, rtol, (), machine_code)
    y, phase, p = start.y, start.phase, start.p
    pressure = _pressure(model, y, p)
    stretch = FIRST_STRETCH
    # the pendulum certificate depends on the criteria, which are disabled here
    watch = replace(start.watch, certificate=None) if start.watch.certificate == "pendulum" else start.watch
    for _ in range(10 * STRETCHES):
        level = start.proof.level(y, phase) if watch.certificate else None
        find = locator(Flow(model.choice, phase.region, start.extras), watch, start.tolerance, machine_code)
        try:
            stop = find(y, p, stretch, CLOSING, -_NEVER if level is None else level)
        except IntegrationFailed as error:
            raise ComputationError(f"the approach cannot be followed ({error})", phase=str(phase)) from None
        y = stop.y
        pressure = max(pressure, _pressure(model, y, p))
        if stop.event is None:
            stretch *= GROWTH
            if abs(y[1]) < _CREEPING:
                break
        elif stop.event == "tangential_edge":
            phase = phase.with_(shear=1 - phase.shear)
        elif stop.event != "glass":  # a maximum of the pressure has been passed
            break
    return pressure, float(y[0])


def _pressure(model: Model, y: np.ndarray, p: np.ndarray) -> float:
    """Scaled film pressure on the axis; the glass guard is the glass number minus this pressure."""
    return -model.values("events", y, p)["glass"]


def _pressures(model: Model, states: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Scaled film pressure on the axis at states (columns)."""
    events = np.asarray(model.function("events")(states, p).full())
    pressures: np.ndarray = -events[model.names("events").index("glass")]
    return pressures


class UnstoppedTrajectory(EventLocator):
    """A trajectory until it separates or falls back; certificates end it only while it approaches."""

    def _proved(self, elapsed: float) -> bool:
        return self.phase.motion == CLOSING and super()._proved(elapsed)

    def _level(self) -> float | None:
        return super()._level() if self.phase.motion == CLOSING else None

    def _run_phase(self) -> bool:
        over = super()._run_phase()
        fell_back = bool(self.path.steps) and KINDS[EventKind.FELL_BACK] in self.path.steps[-1].kinds
        return over or fell_back or self.phase.resting


class _Located:
    """A located trajectory as an `Escaping`, sampled on demand."""

    def __init__(self, probe: EventLocator, path: EventSequence) -> None:
        self.probe, self.path = probe, path
        self.separated = path.separated
        self.fell_back = bool(path.ends) and KINDS[EventKind.FELL_BACK] in path.steps[-1].kinds
        self.end = path.y if path.separated or not path.ends else path.ends[-1]

    @cached_property
    def _both(self) -> tuple[np.ndarray, np.ndarray]:
        return _sampled(self.probe, self.path)

    @property
    def times(self) -> np.ndarray:
        return self._both[0]

    @property
    def states(self) -> np.ndarray:
        return self._both[1]


def _creeps_out(probe: EventLocator) -> bool | None:
    """True if a doublet that creeps past the only barrier will separate; None if undecided.

    All modes but the unstable one have decayed, so the sign of its amplitude decides: outside, nothing confines the
    doublet; inside, its energy is below the barrier.
    """
    proof, barrier = energy_proof(probe.proof), barrier_of(probe)
    rim = probe.groups["rupture_gap"] if probe.model.bridge else 1.0
    if proof is None or barrier is None or not proof.theorem or len(proof.barriers(probe.y)) > 1 or barrier.gap >= rim:
        return None
    saddle = saddle_of(probe, barrier)
    return None if saddle is None else saddle.side(probe.y)


def _smooth(probe: EventLocator, escaped: Escaping | _Located) -> float | None:
    barrier = barrier_of(probe)
    if barrier is None and energy_proof(probe.proof) is not None:
        return None  # nothing confines the doublet at any gap
    rim = probe.groups["rupture_gap"] if probe.model.bridge else 1.0
    if barrier is not None and barrier.gap < rim * (1 - 1e-12):
        return _saddle_amplitude(probe, escaped, barrier)
    if escaped.separated:
        return float(escaped.end[1]) ** 2
    if not escaped.fell_back:
        return None
    inward = probe.model.values("inward_force", escaped.end, probe.p)["inward_force"]
    return -2 * inward * (rim - float(escaped.end[0]))


def _saddle_amplitude(probe: EventLocator, escaped: Escaping | _Located, barrier: Barrier) -> float | None:
    """Amplitude of the unstable mode where nearest to the saddle, scaled to initial contact by exp(-lambda t)."""
    saddle = saddle_of(probe, barrier)
    if saddle is None:
        return None
    try:
        times, states = escaped.times, escaped.states
    except IntegrationFailed:
        return None
    nearest, amplitudes = saddle.nearest(states)
    if np.sum(np.abs(amplitudes) ** 2) > barrier.gap**2 / 4:
        return None
    growth = saddle.rates[saddle.unstable].real * times[nearest]
    return float(amplitudes[saddle.unstable].real * math.exp(-growth)) if growth < 500 else None


def _sampled(probe: EventLocator, path: EventSequence) -> tuple[np.ndarray, np.ndarray]:
    """Times and states of the trajectory: ends of phases, and samples of phases that do not end at rest in the gap."""
    times, states, clock = [0.0], [np.append(probe.model.start(path.p), [0.0] * len(path.extras))], 0.0
    tolerance = tolerance_for(max(probe.rtol, 1e-8), "rosenbrock", probe.groups)
    for step, _, inside, end in resampled(path, tolerance, _GRID, lambda step: step.event != "turning", path.extras):
        if inside is not None:
            times += [clock + part * step.duration for part in _GRID]
            states += list(inside.T)
        clock += step.duration
        times.append(clock)
        states.append(end)
    return np.array(times), np.array(states).T
