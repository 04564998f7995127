"""CasADi functions of a trajectory's derivatives, forward and adjoint, cached by course."""

import numpy as np
from casadi import DM, MX, Function, densify, jtimes

from ..engines.casadi.integrators import IntegrationFailed, quiet
from ..host.captured_stderr import captured_stderr
from ..host.interrupts import check
from ..host.thread_caches import own_cache
from .trajectory_expression import TrajectoryExpression

# Largest landing step relative to its phase, and that after durations are corrected. The error of a derivative is the
# square of the step times the amplification, near a saddle one over the distance.
LANDED, LANDED_WELL = 3e-7, 1e-10
# The same in x0/v0, for long phases: what creeps to its event changes by as much in a step however long it took.
_LONG, _ROUNDED = 1e-5, 1e-13
_TRIES = 8


def evaluate(function: Function, *arguments: np.ndarray | DM) -> list[np.ndarray]:
    """A function's results as arrays; IntegrationFailed without CasADi's long messages."""
    check()
    with captured_stderr() as printed:
        try:
            results = function.call([DM(each) for each in arguments])
        except (RuntimeError, SystemError) as error:
            if "KeyboardInterrupt" in str(error) + printed.getvalue():
                raise KeyboardInterrupt from None
            raise IntegrationFailed("the integrator gave up") from None
    if "KeyboardInterrupt" in printed.getvalue():  # an interrupt that CVODES has treated as a failed step
        raise KeyboardInterrupt
    arrays = [np.asarray(each.full()) for each in results]
    if not all(np.isfinite(each).all() for each in arrays):
        raise IntegrationFailed("a result is not finite")
    return arrays


@own_cache(256)
def first_derivatives(expression: TrajectoryExpression, count: int, adjoint: bool) -> Function:
    """Function (groups, durations, seeds) -> quantities, shifts, and derivatives of the quantities.

    Forward, seeds are directions (groups x count), and derivatives are along these (quantities x count). Adjoint, they
    are weights (quantities x count), and derivatives are gradients of the weighted sums (groups x count).
    """
    p, durations = (MX.sym(name, expression.function.size1_in(k)) for k, name in enumerate(("groups", "durations")))
    z, shifts = expression.function(p, durations)
    seeds = MX.sym("seeds", (z if adjoint else p).numel(), count)
    with quiet():
        slopes = densify(jtimes(z, p, seeds, adjoint))
        return Function("adjoint" if adjoint else "forward", [p, durations, seeds], [z, shifts, slopes])


def lands(shifts: np.ndarray, durations: np.ndarray, within: float) -> bool:
    """True if landing steps relative to their phases (of these durations) are within a part, and short in x0/v0."""
    return bool(np.all(np.abs(shifts) <= np.minimum(within, np.maximum(_LONG / durations, _ROUNDED))))


def settled(
    expression: TrajectoryExpression, p: np.ndarray, durations: np.ndarray, landed: np.ndarray, within: float
) -> np.ndarray:
    """Durations corrected so that this engine's solution meets its events within a part `within` of each phase.

    Arguments:
        landed: indices of the legs that end on an event.

    Raises:
        IntegrationFailed: the engine's solution misses an event.
    """
    durations, settles = durations.copy(), False
    for _ in range(_TRIES):
        shifts = evaluate(expression.function, p, durations)[1].ravel()
        if lands(shifts, durations[landed], within):
            return durations
        if np.max(np.abs(shifts)) > 0.5:
            break
        settles = np.max(np.abs(shifts)) <= within
        durations[landed] *= 1 + shifts
    if settles:  # as well as the tolerance lets it
        return durations
    raise IntegrationFailed("its solution misses an event of the located trajectory")
