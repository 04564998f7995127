"""Reversibility: a smooth section of a trajectory, integrated backward in time, must return to its start.

Relaxing modes grow backward in time, such as the spin of a wet sphere by many decades in a microsecond. Sections are
therefore short, and the bound is the tolerance times the norm of the inverse of the section's variational matrix.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from casadi import SX, Function, integrator, jacobian, reshape, vertcat

from ..engines.casadi.integrators import IntegrationFailed, Tolerance, plain, quiet
from ..engines.casadi.replay import Piece
from ..errors import WetDoubletError
from ..host.thread_caches import own_cache
from ..model.phases import Flow, expressions
from .follow import Followed, follow
from .report import Finding, bounded
from .sample import PLUGINS, REFERENCE, RTOL, Sample, place

_SAFETY = 30.0  # in units of rtol; allowed error of either integration over a section, before amplification
MOST = 1e4  # largest amplification of a section
_AIM = 1e3  # target amplification of the first estimate, from the fastest rate at the ends
_SHORTEST = 1e-12  # shortest section, relative to its phase
_PLACES = (0.0, 0.3, 0.8)  # starting points of sections, relative to the phase
_TRAJECTORIES = 6  # trajectories of the sample


@dataclass(frozen=True)
class Stretch:
    """A smooth section of a trajectory: initial state, duration (x0/v0), and backward amplification of errors."""

    flow: Flow
    start: np.ndarray
    duration: float
    amplification: float


@dataclass(frozen=True)
class _Return:
    """Distance of the returned state from the start of a section, and its bound."""

    error: float
    bound: float
    amplification: float
    where: str


def backward(group: str, sample: Sample, back: Back | None = None) -> Iterator[Finding]:
    """Findings for every engine, over sections of every phase of a few trajectories.

    Arguments:
        back: factory of the integrator backward in time; `returning` if None.
    """
    back = returning if back is None else back
    returns: dict[str, list[_Return]] = {engine: [] for engine in PLUGINS}
    for one in _chosen(sample):
        try:
            followed = follow(sample.scene, one[0], one[1], REFERENCE, RTOL)
        except WetDoubletError:
            continue  # failures are reported with the sample
        for piece in followed.replayed.pieces:
            where = place(*one, event=piece.name)
            for stretch in stretches(piece, followed.p):
                for engine, found in returns.items():
                    found.append(_returned(stretch, followed, engine, where, back))
    for engine, found in returns.items():
        statement = (
            f"a stretch integrated forward and back returns to its start, within {_SAFETY:.0f} rtol times the norm of "
            f"the inverse of its variational matrix (at most {MOST:.0e})"
        )
        if not found:
            yield Finding(
                group, f"forward-back, {engine}", statement, sample.silent or "no stretch is mild enough", "", None
            )
            continue
        worst = max(found, key=lambda entry: entry.error / entry.bound)
        most = max(entry.amplification for entry in found)
        told = (f"  {len(found)} stretches; amplification {worst.amplification:.1e} at the worst, at most {most:.1e}",)
        yield bounded(group, f"forward-back, {engine}", statement, worst.error, worst.bound, worst.where, told)


def _chosen(sample: Sample) -> list[tuple[float, float]]:
    """A few impacts of the sample, evenly spaced."""
    impacts = [next(iter(impact.values())) for impact in sample.impacts]
    moving = [(one.stokes, one.angle) for one in impacts if (one.contact_time or one.until or 0) > 0]
    picked = np.unique(np.linspace(0, len(moving) - 1, min(_TRAJECTORIES, len(moving))).round().astype(int))
    return [moving[k] for k in picked]


def stretches(piece: Piece, p: np.ndarray) -> Iterator[Stretch]:
    """Sections of a phase with an amplification of at most MOST."""
    tolerance = Tolerance(1e-10, 1e-13)
    for part in _PLACES:
        start = piece.start
        if part:
            start = plain(piece.flow, "rosenbrock", tolerance)(piece.start, p, part * piece.duration)
        rates = np.asarray(_jacobian(piece.flow)(start, p).full())
        fastest = max(float(-np.linalg.eigvals(rates).real.min()), 1e-300)
        duration = min((1 - part) * piece.duration, math.log(_AIM) / fastest)
        while duration > _SHORTEST * piece.duration:
            amplification = _amplification(piece.flow, start, p, duration)
            if amplification <= MOST:
                yield Stretch(piece.flow, start, duration, amplification)
                break
            duration /= 2


def _returned(stretch: Stretch, followed: Followed, engine: str, where: str, returning: Back) -> _Return:
    tolerance = tolerance_of(engine)
    scale = _scale(stretch.flow, followed.p)
    bound = _SAFETY * RTOL * stretch.amplification
    try:
        end = plain(stretch.flow, engine, tolerance)(stretch.start, followed.p, stretch.duration)
        back = returning(stretch.flow, engine, tolerance)(end, followed.p, stretch.duration)
        error = float(np.max(np.abs(back - stretch.start) / scale))
    except IntegrationFailed:
        error = math.inf
    return _Return(error if math.isfinite(error) else math.inf, bound, stretch.amplification, where)


def tolerance_of(engine: str) -> Tolerance:
    """Integrator tolerance of an engine for this check."""
    share = 1 / 30 if engine == "cvodes" else 1.0  # as elsewhere, so that rtol has about the same meaning for both
    return Tolerance(RTOL * share, 1e-3 * RTOL * share)


class Returning:
    """Protocol of a backward integrator: (y at the end, groups, duration) -> y at the start."""

    def __init__(self, function: Function) -> None:
        self.function = function

    def __call__(self, y: np.ndarray, p: np.ndarray, duration: float) -> np.ndarray:
        try:
            with quiet():
                return np.asarray(self.function(x0=y, p=np.append(p, duration))["xf"].full()).ravel()
        except RuntimeError as error:
            raise IntegrationFailed(str(error).strip().splitlines()[-1]) from None


Back = Callable[[Flow, str, Tolerance], Returning]


@own_cache(64)
def returning(flow: Flow, engine: str, tolerance: Tolerance) -> Returning:
    """The integrator of a flow with negated rates."""
    parts, duration = expressions(flow), SX.sym("duration")
    dae = {"x": parts.variables, "p": vertcat(flow.model.parameters, duration), "ode": -duration * parts.rates}
    with quiet():
        return Returning(integrator("returning", engine, dae, 0, 1, tolerance.options(engine)))


def _amplification(flow: Flow, start: np.ndarray, p: np.ndarray, duration: float) -> float:
    """Norm of the inverse of a section's variational matrix, in units of the states' scales; inf if too large."""
    size = start.size
    x0 = np.concatenate([start, np.eye(size).ravel()])
    try:
        with quiet():
            end = _variational(flow)(x0=x0, p=np.append(p, duration))["xf"].full().ravel()
    except RuntimeError:
        return math.inf
    inverse = end[size:].reshape(size, size)  # transposed, as CasADi stores columns; scaled below
    scale = _scale(flow, p)
    scaled = inverse.T * scale[None, :] / scale[:, None]
    return float(np.linalg.norm(scaled, np.inf)) if np.isfinite(scaled).all() else math.inf


def _scale(flow: Flow, p: np.ndarray) -> np.ndarray:
    """Scales of the states: 1, except for the orbital momentum, which starts at (4 + aspect)^2."""
    groups = dict(zip(flow.model.groups, p, strict=True))
    sizes = {"orbital_momentum": (4 + groups.get("aspect", 0.0)) ** 2}
    return np.array([sizes.get(name, 1.0) for name in flow.model.state])


@own_cache(32)
def _jacobian(flow: Flow) -> Function:
    parts = expressions(flow)
    return Function("jacobian", [parts.variables, flow.model.parameters], [jacobian(parts.rates, parts.variables)])


@own_cache(32)
def _variational(flow: Flow) -> Function:
    """Integrator of a flow and of the inverse of its variational matrix: dW/dt = -W df/dy, W(0) = 1."""
    parts, duration = expressions(flow), SX.sym("duration")
    size = parts.variables.numel()
    inverse = SX.sym("inverse", size, size)
    growth = -inverse @ jacobian(parts.rates, parts.variables)
    dae = {
        "x": vertcat(parts.variables, reshape(inverse, -1, 1)),
        "p": vertcat(flow.model.parameters, duration),
        "ode": duration * vertcat(parts.rates, reshape(growth, -1, 1)),
    }
    with quiet():
        return integrator("variational", "rosenbrock", dae, 0, 1, {"reltol": 1e-6, "abstol": 1e-8})
