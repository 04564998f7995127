"""Derivatives of a trajectory along as few directions in its groups as needed."""

import numpy as np

from .derivatives import LANDED, LANDED_WELL, evaluate, first_derivatives, lands, settled
from .trajectory_expression import Course, TrajectoryExpression

Active = list[bool]


def landed(course: Course) -> np.ndarray:
    """Indices of the legs that end on an event's surface."""
    return np.array([k for k, leg in enumerate(course.legs) if leg.lasts and leg.event is not None], dtype=int)


def differentiated(
    whole: TrajectoryExpression,
    course: Course,
    p: np.ndarray,
    durations: np.ndarray,
    dp: np.ndarray,
    active: Active,
    method: str,
    amplified: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """The quantities, and their derivatives in the groups.

    Arguments:
        dp: directions (groups, n); the derivatives are valid along these, with `adjoint` along all.
        active: mask of groups with influence.
        amplified: True if the trajectory is known to amplify small errors.

    Raises:
        IntegrationFailed: the engine failed, or its solution misses an event.
    """
    if amplified:
        durations = settled(whole, p, durations, landed(course), LANDED_WELL)
    z, shifts, dz = _once(whole, p, durations, dp, active, method)
    if not lands(shifts, durations[landed(course)], LANDED):
        durations = settled(whole, p, durations, landed(course), LANDED_WELL)
        z, _, dz = _once(whole, p, durations, dp, active, method)
    return z, dz


def _once(
    whole: TrajectoryExpression, p: np.ndarray, durations: np.ndarray, dp: np.ndarray, active: Active, method: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if method == "adjoint":
        weights = np.eye(len(whole.of))
        z, shifts, gradients = evaluate(first_derivatives(whole, len(weights), True), p, durations, weights)
        return z.ravel(), shifts.ravel(), gradients.T
    seeds = spanning(p, dp, active)
    if seeds.shape[1] == 0:
        z, shifts = evaluate(whole.function, p, durations)
        return z.ravel(), shifts.ravel(), np.zeros((z.size, p.size))
    z, shifts, slopes = evaluate(first_derivatives(whole, seeds.shape[1], False), p, durations, seeds)
    return z.ravel(), shifts.ravel(), slopes @ inverse(seeds)


def spanning(p: np.ndarray, dp: np.ndarray, active: Active) -> np.ndarray:
    """Directions in the groups that span `dp`: `dp` itself, or unit directions of the groups if those are fewer.

    A unit direction changes a group by its own value, or by one if that is zero.
    """
    moving = [k for k in range(p.size) if active[k] and np.any(dp[k])]
    used = np.unique(dp[:, np.any(dp != 0, axis=0)], axis=1)  # speed and Stokes number give the same direction
    if used.shape[1] < len(moving) and np.linalg.matrix_rank(used) == used.shape[1]:
        return used
    unit = np.zeros((p.size, len(moving)))
    unit[moving, range(len(moving))] = [p[k] or 1.0 for k in moving]
    return unit


def inverse(seeds: np.ndarray) -> np.ndarray:
    """Left inverse of directions, scaled by rows, because groups may differ by many orders of magnitude."""
    rows = np.abs(seeds).max(axis=1, initial=0.0)
    rows[rows == 0] = 1.0
    sized = seeds / rows[:, None]
    columns = np.linalg.norm(sized, axis=0)
    columns[columns == 0] = 1.0
    return np.asarray(np.linalg.pinv(sized / columns) / columns[:, None] / rows)
