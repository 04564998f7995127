"""Intervals of the free entries from the profile of the likelihood.

The end of an interval is the farthest value of an entry at which the other entries can still be chosen so that the
log-likelihood is at most 1.92 below its maximum (95 %, chi-squared with one degree of freedom).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from .objective import Objective, whitening

DROP = 1.920729410347062  # half the 95 % quantile of chi-squared with one degree of freedom
_WITHIN = 0.02  # of the root of twice DROP, that an end may miss
_BETTER = 0.05  # of DROP, by which a point must be more likely to replace the maximum
_STEPS = 25
_NARROW = 1e-6  # of the way to the bound, width of a bracket in which the profile jumps
_FARTHER = 4.0
_FIRST = 0.6  # of the way that the information matrix gives; far outside an optimisation takes longer
_TOLERANCE = 1e-3  # of the sum of squares of a point of the profile
_AT_BOUND = 1e-3  # of the range of the search


@dataclass(frozen=True)
class End:
    """An end of an interval.

    Attributes:
        inner: in the variables of the search, all entries; the bound of the search where `open`.
        open: the likelihood does not fall by DROP before the bound of the search.
        better: a point that is more likely than the maximum, if one was met.
    """

    inner: np.ndarray
    open: bool
    better: np.ndarray | None = None


def end(objective: Objective, best: np.ndarray, k: int, sign: float, drop: float = DROP) -> End:
    """The end of the interval of entry k below (-1) or above (1) its estimate.

    The root of twice the drop of the profile is nearly linear in the entry, and is followed by secants within a
    bracket; the other entries start from where the last points of the profile lead.
    """
    free, top = objective.free, objective.value(best)
    bound = free.low[k] if sign < 0 else free.high[k]
    if abs(bound - best[k]) < _AT_BOUND * (free.high[k] - free.low[k]):
        return End(best, True)
    white = whitening(objective, best)
    covariance = white @ white.T
    goal, most = np.sqrt(2 * drop), abs(bound - best[k])
    step = _FIRST * goal * np.sqrt(covariance[k, k])
    tangent = sign * covariance[:, k] / covariance[k, k]
    inside, outside = (0.0, 0.0), (np.inf, np.inf)  # distances from the estimate, and roots there
    at = best
    for tried in range(_STEPS):
        step = min(step, most)
        start = np.clip(at + tangent * (step - abs(at[k] - best[k])), free.low, free.high)
        point = profile_point(objective, start, k, float(best[k] + sign * step))
        height = objective.value(point)
        if height > top + _BETTER * drop:
            return End(point, False, point)
        root = np.sqrt(2 * max(top - height, 0.0)) if np.isfinite(height) else 10 * goal
        if root < goal * (1 + _WITHIN) and step == most:
            return End(point, True)
        if abs(root - goal) < _WITHIN * goal:
            return End(point, False)
        if root < goal:
            inside = step, root
        else:
            outside = step, root
        if np.isfinite(height):
            tangent, at = (point - best) / step, point
        step = _next(inside, outside, goal, tried % 3 == 2)
        if outside[0] - inside[0] < _NARROW * most:
            break
    return End(at, False)


def _next(inside: tuple[float, float], outside: tuple[float, float], goal: float, halve: bool) -> float:
    """Where the root reaches the goal, by the line through the bracket, or its middle; outwards without a bracket."""
    (low, at_low), (high, at_high) = inside, outside
    if not np.isfinite(high):
        return low * float(np.clip(goal / max(at_low, 1e-9), 1.1, _FARTHER))
    part = 0.5 if halve else float(np.clip((goal - at_low) / (at_high - at_low), 0.08, 0.92))
    return low + part * (high - low)


def profile_point(objective: Objective, start: np.ndarray, k: int, value: float) -> np.ndarray:
    """The most likely values of the other entries where entry k has this value, in the variables of the search."""
    free = objective.free
    others = np.flatnonzero(np.arange(free.size) != k)
    whole = start.copy()
    whole[k] = value
    if not others.size or not np.isfinite(objective.value(whole)):
        return whole

    def full(part: np.ndarray) -> np.ndarray:
        made = whole.copy()
        made[others] = part
        return made

    low, high = free.low[others], free.high[others]
    inside = np.clip(start[others], low + 1e-9 * (high - low), high - 1e-9 * (high - low))
    found = least_squares(
        lambda part: objective.residuals(full(part)), inside, lambda part: objective.jacobian(full(part))[:, others],
        (low, high), method="trf", ftol=_TOLERANCE, xtol=1e-4, max_nfev=12,
    )  # fmt: skip
    return full(found.x)


def slice_closed(objective: Objective, best: np.ndarray, k: int, drop: float = DROP) -> tuple[bool, bool]:
    """Whether the likelihood falls by `drop` below and above if all other entries stay as they are."""
    free, top = objective.free, objective.value(best)
    closed = []
    for bound in (free.low[k], free.high[k]):
        falls = False
        for part in (0.02, 0.1, 0.3, 1.0):
            at = best.copy()
            at[k] += part * (bound - at[k])
            falls = falls or objective.value(at) < top - drop
            if falls:
                break
        closed.append(falls)
    return closed[0], closed[1]
