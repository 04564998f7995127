"""Functions of the Stokes number that are smooth through a change of outcome (along a line of constant angle).

* `criterion`: margin by which the approach meets or misses a rebound criterion; its root is a graze.
* `escape`: margin of the escape, with a rebound or without: at a saddle of the effective potential the amplitude of the
  unstable mode, at the rupture gap x_f the remaining (or missing) squared speed.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from ...generated.automaton import CLOSING, KINDS, EventKind
from ..certificates import Barrier, energy_proof
from ..engines.casadi.integrators import IntegrationFailed, locator, tolerance_for
from ..engines.casadi.locate import FIRST_STRETCH, GROWTH, STRETCHES, EventLocator, EventSequence
from ..engines.choice import collision_engine
from ..engines.settings import RTOL
from ..engines.taylor.build import compile_all
from ..engines.taylor.call import variant
from ..errors import ComputationError
from ..model.dimensionless import Problem, nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow
from ..scene.contact import GAPS, contact_gap
from ..scene.scene import Scene
from . import by_kernel
from .by_kernel import Events
from .resampled import resampled
from .saddle import barrier_of, saddle_of
from .scene_sampler import DEEP

_NEVER = 1e30  # a glass number that no pressure reaches
WITHOUT_SOLIDS = {"glass_number": _NEVER} | dict.fromkeys(GAPS.values(), 0.0)
_UNMET = {"glass_number": 0.0}  # with this glass number the glass guard is minus the pressure
_CREEPING = 1e-3  # relative to v0; a slower approach counts as stopped, and contact at this speed is irrelevant
_GRID = (*(float(part) for part in np.geomspace(1e-7, 0.9, 64)), 1.0)  # parts of a phase; dense at its start


def ready(scenes: Iterable[Scene]) -> None:
    """Compile the kernels for boundaries of these scenes, on all cores."""
    known = (scene for scene in scenes if collision_engine(scene) == "taylor")
    wanted = (variant(scene, select_model(scene, True), RTOL, True, trajectory=True) for scene in known)
    needed = set(wanted)
    if len(needed) > 1:  # a single one is compiled where it is needed
        compile_all(needed)


@dataclass
class Line:
    """The smooth functions of a scene at one angle (rad), by Rosenbrock. Counts the integrated collisions.

    Arguments:
        kernel: take the events of collisions from the Taylor kernel. Default: if it supports the scene.
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

    def numbers(self, stokes: float) -> Problem:
        """Dimensionless groups at a Stokes number."""
        return nondimensionalise(self.scene, self.scene.speed_of(stokes), self.angle)

    @property
    def model(self) -> Model:
        return load(select_model(self.scene, self.scene.turns(self.angle)))

    def events(self, *stokes: float) -> list[Events]:
        """The events of collisions at Stokes numbers."""
        self.collisions += len(stokes)
        speeds = np.array([float(self.scene.speed_of(each)) for each in stokes])
        events = by_kernel.events(self.scene, speeds, self.angle, self.rtol) if self.kernel else None
        if events is None:
            events = []
            for each in stokes:
                groups = self.numbers(each).groups
                path = EventLocator(self.model, groups, self.rtol, machine_code=self.machine_code).run()
                times = np.cumsum([step.duration for step in path.steps]).tolist()
                events.append([(kind, time) for step, time in zip(path.steps, times) for kind in step.kinds])
        return events

    def criterion(self, stokes: float) -> float:
        """Logarithm of the larger of maximum pressure over p_gt and contact gap over smallest gap, of the approach.

        The approach is integrated without a rebound, so the function is smooth where a criterion is just met.
        """
        self.collisions += 1
        groups = self.numbers(stokes).groups
        contact = contact_gap(groups)
        pressure, smallest = approach(self.model, groups, self.rtol, self.machine_code)
        if smallest <= 0:
            raise ComputationError(f"without a rebound the gap closes to zero at St {stokes:.6g}")
        glass = math.log(pressure / groups["glass_number"]) if pressure > 0 else -math.inf
        return max(glass, math.log(contact / smallest) if contact > 0 else -math.inf)

    def escape(self, stokes: float, rebound: bool) -> tuple[bool, float | None]:
        """Whether the doublet separates, and a smooth function with that sign (None if undefined).

        Arguments:
            rebound: with its rebound, or as if there were no rebound criterion.
        """
        self.collisions += 1
        groups = self.numbers(stokes).groups | ({} if rebound else WITHOUT_SOLIDS)
        probe = UnstoppedTrajectory(self.model, groups, self.rtol, machine_code=self.machine_code)
        path = probe.run()
        return path.separated, _amplitude(probe, path)


def approach(model: Model, groups: dict[str, float], rtol: float, machine_code: bool = True) -> tuple[float, float]:
    """Largest scaled pressure and smallest gap of the approach, without any criterion.

    It ends at a turning point, at a certified stick, when it only creeps, or far below the contact gap.
    """
    deep = DEEP * contact_gap(groups)
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


def _amplitude(probe: EventLocator, path: EventSequence) -> float | None:
    """A function of the Stokes number that is positive where the doublet escapes; None where it is not defined."""
    barrier = barrier_of(probe)
    if barrier is None and energy_proof(probe.proof) is not None:
        return None  # nothing confines the doublet at any gap
    rim = probe.groups["rupture_gap"] if probe.model.bridge else 1.0
    if barrier is not None and barrier.gap < rim * (1 - 1e-12):
        return _saddle_amplitude(probe, path, barrier)
    if path.separated:
        return float(path.y[1]) ** 2
    if not path.ends or KINDS[EventKind.FELL_BACK] not in path.steps[-1].kinds:
        return None
    inward = probe.model.values("inward_force", path.ends[-1], probe.p)["inward_force"]
    return -2 * inward * (rim - float(path.ends[-1][0]))


def _saddle_amplitude(probe: EventLocator, path: EventSequence, barrier: Barrier) -> float | None:
    """Amplitude of the unstable mode at the state nearest to the saddle, scaled to initial contact by exp(-lambda t).

    States are the ends of phases, and samples of phases that do not end at rest in the gap.
    """
    saddle = saddle_of(probe, barrier)
    if saddle is None:
        return None
    times, states, start = [0.0], [np.append(probe.model.start(path.p), [0.0] * len(path.extras))], 0.0
    tolerance = tolerance_for(max(probe.rtol, 1e-8), "rosenbrock", probe.groups)
    try:
        for step, _, inside, end in resampled(path, tolerance, _GRID, lambda s: s.event != "turning", path.extras):
            if inside is not None:
                times += [start + part * step.duration for part in _GRID]
                states += list(inside.T)
            start += step.duration
            times.append(start)
            states.append(end)
    except IntegrationFailed:
        return None
    nearest, amplitudes = saddle.nearest(np.array(states).T)
    if np.sum(np.abs(amplitudes) ** 2) > barrier.gap**2 / 4:
        return None
    growth = saddle.rates[saddle.unstable].real * times[nearest]
    return float(amplitudes[saddle.unstable].real * math.exp(-growth)) if growth < 500 else None
