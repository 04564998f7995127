"""Reversibility: a smooth section of a trajectory, integrated backward in time, must return to its start.

Relaxing modes grow backward in time, such as the spin of a wet sphere by many decades in a microsecond. Sections are
therefore short, and the bound is the tolerance times the norm of the inverse of the section's variational matrix.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from casadi import SX, Function, integrator, jacobian, reshape, vertcat

from ..engines.casadi.integrators import IntegrationFailed, Plain, Tolerance, plain, quiet, tolerance_for
from ..engines.casadi.locate import locate
from ..engines.casadi.replay import Piece, Stopped, replay
from ..errors import ComputationError, WetDoubletError
from ..host.thread_caches import own_cache
from ..model.dimensionless import nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow, Region, expressions
from ..scene.scene import Scene
from .report import Finding, bounded, note
from .sample import PLUGINS, REFERENCE, RTOL, Sample, place

_SAFETY = 30.0  # in units of rtol; allowed error of either integration over a section, before amplification
MOST = 1e4  # largest amplification of a section
_AIM = 1e3  # target amplification of the first estimate, from the fastest rate at the ends
_SHORTEST = 1e-12  # shortest section, relative to its phase
_PLACES = (0.0, 0.3, 0.8)  # starting points of sections, relative to the phase
_TRAJECTORIES = 6  # trajectories of the sample

Back = Callable[[Flow, str, Tolerance], Plain]
"""Flow, engine and tolerance -> the integrator backward in time."""


@dataclass(frozen=True)
class Replayed:
    """A located collision as integrated by the reference engine, with spin as a state: its phases and final state."""

    model: Model
    p: np.ndarray
    tolerance: Tolerance
    pieces: list[Piece]
    end: np.ndarray


def replayed(scene: Scene, stokes: float, angle: float) -> Replayed:
    """Locate a collision and integrate it. ComputationError if the outcome cannot be decided, or the engine stopped."""
    n = nondimensionalise(scene, scene.speed_of(stokes), angle)
    path = locate(load(select_model(scene, n.oblique)), n.groups, RTOL)
    flow = Flow(select_model(scene, n.oblique, full=True), Region(1, 1, False))
    p, tolerance = flow.model.group_values(n.groups), tolerance_for(RTOL, REFERENCE, n.groups)
    try:
        integrated = replay(path, REFERENCE, tolerance, flow, flow.model.start(p))
    except Stopped as failure:
        raise ComputationError(f"{REFERENCE} {failure.why}", phase=str(failure.step.phase)) from None
    return Replayed(flow.model, p, tolerance, integrated.pieces, integrated.y)


def backward(sample: Sample, back: Back | None = None) -> Iterator[Finding]:
    """Findings for every engine, over sections of every phase of a few trajectories, evenly spaced in the sample.

    Arguments:
        back: factory of the integrator backward in time; `returning` if None.
    """
    errors: dict[str, list[tuple[float, float, str]]] = {engine: [] for engine in PLUGINS}
    impacts = [next(iter(impact.values())) for impact in sample.impacts]
    moving = [one for one in impacts if (one.contact_time or one.until or 0) > 0]
    for k in np.unique(np.linspace(0, len(moving) - 1, min(_TRAJECTORIES, len(moving))).round().astype(int)):
        try:
            path = replayed(sample.scene, moving[k].stokes, moving[k].angle)
        except WetDoubletError:
            continue  # failures are reported with the sample
        for piece in path.pieces:
            at = place(moving[k].stokes, moving[k].angle, event=str(piece.phase))
            for start, duration, amplification in sections(piece, path.p):
                for engine, entries in errors.items():
                    error = _return_error(piece.flow, start, duration, path.p, engine, back or returning)
                    entries.append((error / amplification, amplification, at))
    for engine, entries in errors.items():
        name = f"forward-back, {engine}"
        statement = (
            f"a stretch integrated forward and back returns to its start, within {_SAFETY:.0f} rtol times the norm of "
            f"the inverse of its variational matrix (at most {MOST:.0e})"
        )
        if not entries:
            yield note(name, statement, sample.silent or "no stretch is mild enough")
            continue
        relative, amplification, at = max(entries, key=lambda entry: entry[0])
        most = max(entry[1] for entry in entries)
        about = f"  {len(entries)} stretches; amplification {amplification:.1e} at the worst, at most {most:.1e}"
        yield bounded(name, statement, relative * amplification, _SAFETY * RTOL * amplification, at, about)


def sections(piece: Piece, p: np.ndarray) -> Iterator[tuple[np.ndarray, float, float]]:
    """Smooth parts of a phase: initial state, duration (x0/v0), and backward amplification of errors, at most MOST."""
    parts = expressions(piece.flow)
    rates_by_state = Function(
        "jacobian", [parts.variables, piece.flow.model.parameters], [jacobian(parts.rates, parts.variables)]
    )
    for part in _PLACES:
        start = piece.start
        if part:
            start = plain(piece.flow, "rosenbrock", Tolerance(1e-10, 1e-13))(piece.start, p, part * piece.duration)
        eigenvalues = np.linalg.eigvals(np.asarray(rates_by_state(start, p).full()))
        fastest = max(float(-eigenvalues.real.min()), 1e-300)
        duration = min((1 - part) * piece.duration, math.log(_AIM) / fastest)
        while duration > _SHORTEST * piece.duration:
            amplification = _amplification(piece.flow, start, p, duration)
            if amplification <= MOST:
                yield start, duration, amplification
                break
            duration /= 2


def _return_error(flow: Flow, start: np.ndarray, duration: float, p: np.ndarray, engine: str, back: Back) -> float:
    """Distance of the returned state from the start of a section; inf if an integration fails."""
    share = 1 / 30 if engine == "cvodes" else 1.0  # as elsewhere, so that rtol has about the same meaning for both
    tolerance = Tolerance(RTOL * share, 1e-3 * RTOL * share)
    try:
        end = plain(flow, engine, tolerance)(start, p, duration)
        returned = back(flow, engine, tolerance)(end, p, duration)
    except IntegrationFailed:
        return math.inf
    error = float(np.max(np.abs(returned - start) / _scale(flow, p)))
    return error if math.isfinite(error) else math.inf


@own_cache(64)
def returning(flow: Flow, engine: str, tolerance: Tolerance) -> Plain:
    """The integrator of a flow with negated rates."""
    parts, duration = expressions(flow), SX.sym("duration")
    dae = {"x": parts.variables, "p": vertcat(flow.model.parameters, duration), "ode": -duration * parts.rates}
    with quiet():
        return Plain(integrator("returning", engine, dae, 0, 1, tolerance.options(engine)), engine)


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
    aspect = dict(zip(flow.model.groups, p, strict=True)).get("aspect", 0.0)
    return np.array([(4 + aspect) ** 2 if name == "orbital_momentum" else 1.0 for name in flow.model.state])


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
