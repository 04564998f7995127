"""Derivatives of a trajectory's expression, forward and adjoint, first and second: CasADi functions, kept by course."""

from __future__ import annotations

import numpy as np
from casadi import DM, MX, Function, densify, jtimes

from ..engines.casadi.integrators import IntegrationFailed, quiet
from ..host.captured_stderr import listening
from ..host.interrupts import check
from ..host.thread_caches import own_cache
from .trajectory_expression import TrajectoryExpression

# Largest landing step over its phase. The error of a first derivative is of its square, times how much the trajectory
# amplifies, which near a saddle is one over the distance; that of a second derivative is of the step itself.
LANDED, LANDED_WELL = 3e-7, 1e-10
_TRIES = 8


def evaluate(function: Function, *arguments: np.ndarray | DM) -> list[np.ndarray]:
    """A function's results as arrays; IntegrationFailed in one line, and CasADi's pages dropped."""
    check()
    with listening() as heard:
        try:
            found = function.call([DM(each) for each in arguments])
        except (RuntimeError, SystemError) as error:
            if "KeyboardInterrupt" in str(error) + heard.getvalue():
                raise KeyboardInterrupt from None
            raise IntegrationFailed("the integrator gave up") from None
    if "KeyboardInterrupt" in heard.getvalue():  # CVODES has taken it for a step to be tried again
        raise KeyboardInterrupt
    arrays = [np.asarray(each.full()) for each in found]
    if not all(np.isfinite(each).all() for each in arrays):
        raise IntegrationFailed("a result is not finite")
    return arrays


@own_cache(256)
def forward(expression: TrajectoryExpression, count: int) -> Function:
    """(groups, durations, directions: groups x count) -> quantities, shifts, derivatives (quantities x count)."""
    p, durations, z, shifts = _symbols(expression)
    seeds = MX.sym("seeds", p.numel(), count)
    with quiet():
        slopes = densify(jtimes(z, p, seeds))
        return Function("forward", [p, durations, seeds], [z, shifts, slopes])


@own_cache(256)
def adjoint(expression: TrajectoryExpression, count: int) -> Function:
    """(groups, durations, weights: quantities x count) -> quantities, shifts, gradients (groups x count)."""
    p, durations, z, shifts = _symbols(expression)
    seeds = MX.sym("seeds", z.numel(), count)
    with quiet():
        slopes = densify(jtimes(z, p, seeds, True))
        return Function("adjoint", [p, durations, seeds], [z, shifts, slopes])


@own_cache(256)
def curvature(expression: TrajectoryExpression, count: int) -> Function:
    """(groups, durations, weights, directions: groups x count) -> the weighted sum's Hessian times the directions.

    Forward over adjoint. Rosenbrock only: CasADi's CVODES has no second derivatives of this kind.
    """
    p, durations, z, _ = _symbols(expression)
    weights, seeds = MX.sym("weights", z.numel()), MX.sym("seeds", p.numel(), count)
    with quiet():
        gradient = jtimes(z, p, weights, True)
        bent = densify(jtimes(gradient, p, seeds))
        return Function("curvature", [p, durations, weights, seeds], [bent])


def _symbols(expression: TrajectoryExpression) -> tuple[MX, MX, MX, MX]:
    p = MX.sym("groups", expression.function.size1_in(0))
    durations = MX.sym("durations", expression.function.size1_in(1))
    z, shifts = expression.function(p, durations)
    return p, durations, z, shifts


def settled(
    expression: TrajectoryExpression, p: np.ndarray, durations: np.ndarray, landed: np.ndarray, within: float
) -> np.ndarray:
    """Durations at which this engine's own solution meets its events within a part `within` of each phase.

    Arguments:
        integrated: indices of the legs that are landed.

    Raises:
        IntegrationFailed: it does not: its solution misses an event.
    """
    durations = durations.copy()
    for _ in range(_TRIES):
        shifts = evaluate(expression.function, p, durations)[1].ravel()
        if shifts.size == 0 or np.max(np.abs(shifts)) <= within:
            return durations
        if np.max(np.abs(shifts)) > 0.5:
            break
        durations[landed] *= 1 + shifts
    raise IntegrationFailed("its solution misses an event of the located trajectory")
