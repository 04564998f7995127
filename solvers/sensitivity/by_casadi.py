"""Derivatives of a collision by CasADi: of the expression in `trajectory`, which replays what the kernel has found.

CasADi differentiates the whole: forward, one direction in the groups after another, or adjoint, a result at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from casadi import DM, MX, Function, densify, jtimes

from ..collision.by_kernel import sequence_of
from ..engines.casadi.integrators import IntegrationFailed, failures, quiet
from ..engines.casadi.replay import Stopped, replayed
from ..engines.casadi.sequence import EventSequence
from ..errors import ComputationError
from ..host.thread_caches import own_cache
from ..model.key import ModelKey
from ..model.model import load, select_model
from ..results import DEFINITIONS
from .boundary_distance import SADDLE, check_grip
from .parameters import SCALES, parameter_map
from .problem import NEAR, SHARPEST, Problem, Query, Slopes
from .trajectory import course_of, quadratures, trajectory

# Steps of Rosenbrock are controlled for the states alone, and with a power law its derivatives are far less accurate
# than its values. CVODES controls both, but its errors grow where a doublet creeps apart. Such derivatives are computed
# again at tolerances finer by `_FINER` until two differ by no more than `_RESOLVED` of the largest elasticity.
# Where none is finer, the first is coarser by `_COARSER`.
# A derivative is rounding below `_NONE` of its result, of which `_LEAST` is taken at least, in the scale of the states.
_FINER, _COARSER, _NONE, _LEAST = 1e-2, 10.0, 1e-9, 1e-3
_RESOLVED = {"rosenbrock": 1e-5, "cvodes": 1e-3}
_SHARPEST_CVODES = 3e-12  # smallest tolerance of CVODES with sensitivities; below it some integrations fail
# Largest landing relative to its phase, and that wanted of a trajectory that amplifies errors. The error of a
# derivative is its square times the amplification, near a saddle one over the distance. Beyond `_LOST` no correction
# of durations helps.
_LANDED, _AMPLIFIED, _LOST = 3e-7, 1e-10, 0.5
# The same in x0/v0: a long phase that creeps to its event changes by as much however long it took; rounding.
_LONG, _ROUNDED = 1e-5, 1e-13
_TRIES = 8


# ---- of an expression


@own_cache(256)
def first_derivatives(function: Function, count: int, adjoint: bool) -> Function:
    """Function (groups, durations, seeds) -> results, shifts, and derivatives of the results.

    Forward, seeds are directions (groups x count), and derivatives are along these (results x count). Adjoint, they
    are weights (results x count), and derivatives are gradients of the weighted sums (groups x count).
    """
    p, durations = (MX.sym(name, function.size1_in(k)) for k, name in enumerate(("groups", "durations")))
    z, shifts = function(p, durations)
    seeds = MX.sym("seeds", (z if adjoint else p).numel(), count)
    with quiet():
        slopes = densify(jtimes(z, p, seeds, adjoint))
        return Function("adjoint" if adjoint else "forward", [p, durations, seeds], [z, shifts, slopes])


def evaluate(function: Function, *arguments: np.ndarray) -> list[np.ndarray]:
    """The results of a function, as arrays; IntegrationFailed where an integrator in it fails."""
    with failures():
        arrays = [np.asarray(result.full()) for result in function.call([DM(argument) for argument in arguments])]
    if not all(np.isfinite(array).all() for array in arrays):
        raise IntegrationFailed("a result is not finite")
    return arrays


def derivatives(
    function: Function, p: np.ndarray, durations: np.ndarray, dp: np.ndarray, method: str, amplified: bool
) -> tuple[np.ndarray, np.ndarray]:
    """The results of a trajectory and their derivatives along directions `dp` in the groups (groups, n).

    Durations are corrected by the landings until these are short: an integrator with derivatives takes other steps.

    Arguments:
        amplified: the trajectory is known to amplify small errors.

    Raises:
        IntegrationFailed: the integrator failed, or its solution misses an event.
    """
    adjoint = method == "adjoint"
    seeds, shares = (np.eye(function.size1_out(0)), dp) if adjoint else spanning(p, dp)
    derivative = first_derivatives(function, seeds.shape[1], adjoint)
    for _ in range(_TRIES):
        z, shifts, slopes = evaluate(derivative, p, durations, seeds)
        shifts = shifts.ravel()
        missed = np.max(np.abs(shifts), initial=0.0)
        limits = np.minimum(_AMPLIFIED if amplified else _LANDED, np.maximum(_LONG / durations, _ROUNDED))
        if np.all(np.abs(shifts) <= limits) or missed > _LOST:
            break
        durations = durations * (1 + shifts)
    if missed > _LANDED:
        raise IntegrationFailed("its solution misses an event of the trajectory")
    return z.ravel(), (slopes.T if adjoint else slopes) @ shares


def spanning(p: np.ndarray, dp: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions in the groups, and the shares of each in `dp`: those of `dp`, or the groups' own if these are fewer.

    A group's own direction changes it by its value, or by one if that is zero.
    """
    moving = np.flatnonzero(np.any(dp != 0, axis=1))
    used, place = np.unique(dp, axis=1, return_inverse=True)  # speed and Stokes number give the same direction
    if used.shape[1] < moving.size or not moving.size:
        return used, np.eye(used.shape[1])[:, place.ravel()]
    size = np.where(p == 0, 1.0, p)[moving]
    return np.eye(p.size)[:, moving] * size, dp[moving] / size[:, None]


# ---- of a collision


def slopes(problem: Problem, query: Query, plugin: str) -> Slopes:
    """Derivatives of the results of a collision by its parameters; ComputationError if the engine fails."""
    scene, n = problem.scene, problem.n
    choice = select_model(
        scene, n.oblique, full=bool({"energy.tangential_lubrication", "energy.residual"} & {*query.of})
    )
    mapping = parameter_map(problem.kind, problem.wrt, tuple(load(choice).groups))
    numbers, by_theta, units = mapping.at(problem.reference(problem.kind.entries))
    p, scales = np.split(numbers, [-len(SCALES)])
    record, parting = partial(sequence_of, n), problem.path.parting
    try:
        z, dz = Replayable(record, choice, plugin, parting, p, by_theta[: p.size]).differentiated(query)
    except ComputationError as error:
        raise n.in_si(error) from None
    # in SI: a result is its dimensionless value times a scale
    places = [(*SCALES, None).index(DEFINITIONS[name].scale) for name in query.of]
    scale = np.append(scales, 1.0)[places]
    by_scale = np.vstack([by_theta[p.size :], np.zeros(len(units))])[places]
    return z * scale, (dz * scale[:, None] + z[:, None] * by_scale) / units


@dataclass(frozen=True)
class Replayable:
    """A collision to be replayed and differentiated.

    Arguments:
        record: as for `replayed`.
        parting: opening speed at separation over v0.
        p, dp: groups, and directions (groups, n) along which derivatives are needed.
    """

    record: Callable[[float], EventSequence]
    choice: ModelKey
    plugin: str
    parting: float
    p: np.ndarray
    dp: np.ndarray

    def differentiated(self, query: Query) -> Slopes:
        """The results of a query, and their derivatives along the directions.

        Raises:
            ComputationError: the replay does not agree with the record, the trajectory cannot be differentiated, or its
                derivatives are not resolved.
        """
        doubtful = self.choice.package is not None if self.plugin == "rosenbrock" else 0 < self.parting < NEAR
        if doubtful and self._sharp(query) == self._sharp(replace(query, rtol=query.rtol * _FINER)):
            query = replace(query, rtol=query.rtol * _COARSER)
        z, dz = self._at_tolerance(query)
        error, resolved = 0.0, _RESOLVED[self.plugin]
        while doubtful:
            coarse, before = dz, self._sharp(query)
            query = replace(query, rtol=max(query.rtol * _FINER, SHARPEST))
            if self._sharp(query) == before:
                if error > resolved:
                    message = (
                        f"{self.plugin} does not resolve the derivatives: down to a tolerance of {before:.1g} they"
                    )
                    raise ComputationError(f"{message} change by {error:.1g} of the largest", advice="another --engine")
                break
            z, dz = self._at_tolerance(query)
            largest = np.abs(dz).max(axis=1) + _NONE * np.maximum(np.abs(z), _LEAST)
            largest[[name == "energy.residual" for name in query.of]] = np.inf  # it is rounding error
            error = np.max(np.abs(dz - coarse) / largest[:, None], initial=0.0)
            doubtful = error > resolved
        return z, dz

    def _sharp(self, query: Query) -> float:
        """The tolerance of a query as the engine has it."""
        sharp = query.sharpened(self.parting)
        return max(sharp, _SHARPEST_CVODES) if self.plugin == "cvodes" else sharp

    def _at_tolerance(self, query: Query) -> Slopes:
        """`differentiated` at the tolerance that the query has."""
        choice, plugin, sharp, near = self.choice, self.plugin, self._sharp(query), query.near
        if plugin == "cvodes" and query.amplified and near is not None and near.boundary == SADDLE:
            message = "no derivative by cvodes: its steps do not follow those of a trajectory that lies at the"
            raise ComputationError(f"{message} {near}, nearer than {NEAR:g}", advice="--engine rosenbrock")
        try:
            path, replay = replayed(self.record, choice, quadratures(load(choice), query.of), plugin, sharp)
        except Stopped as stopped:
            raise stopped.error(plugin, load(choice)) from None
        check_grip(replay.grip, query.rtol)
        course = course_of(path, replay, choice)
        function = trajectory(course, query.of, plugin, replay.tolerance)
        durations = np.array([piece.duration for piece in replay.pieces])
        dp = self.dp * course.influences(path.groups)[:, None]
        try:
            return derivatives(function, self.p, durations, dp, query.method, query.amplified)
        except IntegrationFailed as failure:
            raise ComputationError(
                f"{plugin} could not differentiate the trajectory ({failure})",
                phase=str(path.steps[-1].phase),
                advice="try another --rtol, or the other --engine",
            ) from None
