"""Functions of the Stokes number that are smooth through a change of outcome (along a line of constant angle).

* `criterion`: by how much the approach meets, or misses, a reversal criterion; its root is a graze.
* `escape`: how far a doublet gets, with the solids' reversal or without: through a saddle of the effective potential
  the amplitude of its unstable mode, at the rim x_f the squared speed left (or missing).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from casadi import Function, jacobian

from .errors import ComputationError
from .integrators import IntegrationFailed, locator, plain, tolerance
from .locate import FIRST_STRETCH, GROWTH, STRETCHES, Locate, Path
from .model import Model, choose, load
from .numbers import Numbers, numbers
from .phases import CLOSING, Flow, Region
from .proofs import Barrier, energy_proof
from .scene import Scene

_NEVER = 1e30  # a glass number that no pressure meets
WITHOUT_SOLIDS = {"glass_number": _NEVER, "elastic_gap": 0.0, "rough_gap": 0.0}
_CREEPING = 1e-3  # of v0: an approach as slow as this has been stopped; contact at this speed decides nothing
_DEEP = 1e-3  # of the contact gap: an approach that gets there has met the solids
_GRID = (*(float(part) for part in np.geomspace(1e-7, 0.9, 64)), 1.0)  # of a phase: transients are at its start


@dataclass(frozen=True)
class Escape:
    """Whether a flight separates, and a smooth function with that sign (None where it is not defined)."""

    separates: bool
    value: float | None


@dataclass
class Line:
    """Collisions of a scene at one angle (rad). Counts those it integrates: not those decided at first touch."""

    scene: Scene
    angle: float
    rtol: float
    collisions: int = 0
    _known: dict[float, Path] = field(default_factory=dict)

    def numbers(self, stokes: float) -> Numbers:
        """Dimensionless numbers at a Stokes number."""
        return numbers(self.scene, self.scene.speed_of(stokes), self.angle)

    @property
    def model(self) -> Model:
        return load(choose(self.scene, self.angle > 0))

    def outcome(self, stokes: float) -> str:
        """The outcome of a whole collision."""
        return self._path(stokes).outcome

    def met(self, stokes: float) -> bool:
        """Whether a whole collision meets a reversal criterion."""
        return self._path(stokes).reversal is not None

    def _path(self, stokes: float) -> Path:
        if stokes not in self._known:
            groups = self.numbers(stokes).groups
            path = self._known[stokes] = Locate(self.model, groups, self.rtol, machine_code=True).run()
            self.collisions += path.time > 0
        return self._known[stokes]

    def criterion(self, stokes: float) -> float:
        """Largest pressure of the approach over p_gt, or contact gap over smallest gap if larger, as a logarithm.

        The approach is followed without reversal, so the function is smooth where a criterion is just met.
        """
        self.collisions += 1
        groups = self.numbers(stokes).groups
        contact = max(groups["elastic_gap"], groups["rough_gap"])
        pressure, smallest = approach(self.model, groups, self.rtol)
        glass = math.log(pressure / groups["glass_number"]) if pressure > 0 else -math.inf
        return max(glass, math.log(contact / smallest) if contact > 0 else -math.inf)

    def escape(self, stokes: float, reversed_: bool) -> Escape:
        """Whether the doublet separates if the solids reverse it (`reversed_`) or if no criterion existed."""
        self.collisions += 1
        return smooth_escape(self.model, self.numbers(stokes).groups, self.rtol, reversed_)


def smooth_escape(
    model: Model, groups: dict[str, float], rtol: float, reversed_: bool, machine_code: bool = True
) -> Escape:
    """Whether a doublet separates, and how clearly, if the solids reverse it (`reversed_`) or if there are none."""
    if not reversed_:
        groups = groups | WITHOUT_SOLIDS
    probe = Probe(model, groups, rtol, machine_code=machine_code)
    path = probe.run()
    return Escape(path.separated, _smooth(probe, path))


def approach(model: Model, groups: dict[str, float], rtol: float, machine_code: bool = True) -> tuple[float, float]:
    """Largest scaled pressure and smallest gap of the approach, without any criterion.

    It ends where the doublet turns, where it is proved stuck, where it only creeps, or deep below the contact gap.
    """
    deep = _DEEP * max(groups["elastic_gap"], groups["rough_gap"])
    unmet = {"glass_number": 0.0, "elastic_gap": 0.0, "rough_gap": deep}
    flight = Locate(model, groups | unmet, rtol, (), machine_code)
    y, phase, p = flight.y, flight.phase, flight.p
    pressure = _pressure(model, y, p)
    stretch = FIRST_STRETCH
    # the proof on strings reckons with the criteria, which are left out here
    watch = replace(flight.watch, certificate=None) if flight.watch.certificate == "tethered" else flight.watch
    for _ in range(10 * STRETCHES):
        level = flight.proof.level(y, phase) if watch.certificate else None
        find = locator(Flow(model.choice, phase.region, flight.extras), watch, flight.tolerance, machine_code)
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
        elif stop.event != "glass":  # a maximum of the pressure is passed by
            break
    return pressure, float(y[0])


def _pressure(model: Model, y: np.ndarray, p: np.ndarray) -> float:
    """Scaled film pressure on the axis: the glass event function is glass number minus pressure."""
    return -model.values("events", y, p)["glass"]


class Probe(Locate):
    """A flight that goes on until it separates or falls back, and is proved stuck only while it approaches."""

    def _proved(self) -> bool:
        return self.phase.motion == CLOSING and super()._proved()

    def _level(self) -> float | None:
        return super()._level() if self.phase.motion == CLOSING else None

    def _fly(self) -> bool:
        over = super()._fly()
        fell_back = bool(self.path.steps) and "fell back" in self.path.steps[-1].kinds
        return over or fell_back or self.phase.resting


def _smooth(probe: Locate, path: Path) -> float | None:
    barrier = barrier_of(probe)
    if barrier is None and energy_proof(probe.proof) is not None:
        return None  # nothing holds the doublet at any gap
    rim = probe.groups["rupture_gap"] if probe.model.bridge else 1.0
    if barrier is not None and barrier.gap < rim * (1 - 1e-12):
        return _saddle_amplitude(probe, path, barrier)
    if path.separated:
        return float(path.y[1]) ** 2
    last = path.ends[-1] if path.ends else None
    if last is None or "fell back" not in path.steps[-1].kinds:
        return None
    inward = probe.model.values("inward_force", last, path.p)["inward_force"]
    return -2 * inward * (rim - float(last[0]))


def barrier_of(probe: Locate) -> Barrier | None:
    """The highest maximum of the effective potential for the angular momentum at the end of the flight."""
    proof = energy_proof(probe.proof)
    if proof is None:
        return None
    barriers = proof.barriers(probe.y)
    return barriers[0] if barriers else None


@dataclass(frozen=True)
class Saddle:
    """Rigid rotation at the top of the barrier, and how its neighbourhood moves.

    Arguments:
        modes: left eigenvectors as rows; times a deviation they give each mode's amplitude, as its part of the gap.
        rates: their eigenvalues.
        unstable: index of the one that grows.
    """

    gap: float
    state: np.ndarray
    modes: np.ndarray
    rates: np.ndarray
    unstable: int

    def nearest(self, states: np.ndarray) -> tuple[int, np.ndarray]:
        """Which of the states (columns) is nearest, and its amplitudes."""
        amplitudes = self.modes @ (states[: self.state.size] - self.state[:, None])
        k = int(np.argmin(np.sum(np.abs(amplitudes) ** 2, axis=0)))
        return k, amplitudes[:, k]


def saddle_of(probe: Locate, barrier: Barrier) -> Saddle | None:
    """The saddle at a barrier for the flight's angular momentum; None where nothing grows."""
    saddle = _saddle_state(probe, barrier, probe.y[: len(probe.model.state)])
    # a doublet that escapes comes by while opening
    film = int(barrier.gap < 1 or not probe.model.edged)
    region = Region(film, int(barrier.gap < probe.edge), False, probe.model.cavitates)
    matrix = np.asarray(_jacobian(probe.model, region)(saddle, probe.p).full())
    values, vectors = np.linalg.eig(matrix)
    unstable = int(np.argmax(values.real))
    if values[unstable].real <= 0 or vectors[0, unstable] == 0:
        return None
    shapes = vectors / np.where(vectors[0] == 0, 1, vectors[0])
    return Saddle(barrier.gap, saddle, np.linalg.inv(shapes), values, unstable)


def _saddle_amplitude(probe: Locate, path: Path, barrier: Barrier) -> float | None:
    """Amplitude of the saddle's unstable mode at the nearest approach, taken back to first touch by exp(-lambda t)."""
    saddle = saddle_of(probe, barrier)
    if saddle is None:
        return None
    try:
        times, states = _sampled(probe, path)
    except IntegrationFailed:
        return None
    nearest, amplitudes = saddle.nearest(states)
    if np.sum(np.abs(amplitudes) ** 2) > barrier.gap**2 / 4:
        return None
    growth = saddle.rates[saddle.unstable].real * times[nearest]
    return float(amplitudes[saddle.unstable].real * math.exp(-growth)) if growth < 500 else None


def _saddle_state(probe: Locate, barrier: Barrier, y: np.ndarray) -> np.ndarray:
    """Rigid rotation at the barrier's gap with the state's angular momentum."""
    at_barrier = np.concatenate([[barrier.gap], y[1:]])
    return np.array(list(probe.model.values("rigid_rotation", at_barrier, probe.p).values()))


@lru_cache(maxsize=128)
def _jacobian(model: Model, region: Region) -> Function:
    rates = model.function("right_hand_side", **region.flags)
    y, p = model.column, model.parameters
    return Function("jacobian", [y, p], [jacobian(rates(y, p), y)])


def _sampled(probe: Locate, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times and states of the flight: ends of phases, and a grid over phases that do not end at rest in the gap."""
    times, states, clock = [0.0], [np.append(probe.model.start(path.p), [0.0] * len(path.extras))], 0.0
    before = states[0]
    for step, end in zip(path.steps, path.ends, strict=True):
        if step.event != "turning" and step.duration > 0:
            flow = Flow(probe.model.choice, step.phase.region, path.extras)
            told = tolerance(max(probe.rtol, 1e-8), "rosenbrock", probe.groups)
            inside = plain(flow, "rosenbrock", told, _GRID)(before, path.p, step.duration)
            times += [clock + part * step.duration for part in _GRID]
            states += list(inside.T)
        clock += step.duration
        times.append(clock)
        states.append(end)
        before = end
    return np.array(times), np.array(states).T
