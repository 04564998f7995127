"""Intervals of the free entries from the profile of the likelihood.

The end of an interval is the farthest value of an entry at which the other entries can still be chosen so that the
log-likelihood is at most 1.92 below its maximum (95 %, chi-squared with one degree of freedom).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from .likelihood import COARSE
from .objective import Objective, whitening

DROP = 1.920729410347062  # half the 95 % quantile of chi-squared with one degree of freedom
_WITHIN = 0.02  # of the root of twice DROP, that an end may miss
_FLAT = 0.1  # of the distance from the maximum, that is left at the last slope of a profile that has flattened
_BETTER = 0.05  # of DROP, by which a point must be more likely to replace the maximum
_STEPS = 25
_NARROW = 1e-6  # of the way to the bound, width of a bracket in which the profile jumps
_FARTHER = 4.0
_FIRST = 0.6  # of the way that the information matrix gives; far outside an optimisation takes longer
_TOLERANCE = 1e-3  # of the sum of squares of a point of the profile
_AT_BOUND = 1e-3  # of the range of the search
_AT_WALL = 0.02  # of the way, width of a bracket beyond which no scene is possible
_HOPELESS = 50.0  # log-likelihood below the maximum from which no start is followed
_CHECKS = 3  # of an end from elsewhere
_OUTSIDE = 0.02  # of the interval's half width, by which a likely point must lie outside to move its end


@dataclass(frozen=True)
class End:
    """An end of an interval.

    Attributes:
        inner: in the variables of the search, all entries; where `open`, the farthest point that was looked at.
        open: the likelihood does not fall by DROP before the bound of the search, or before the scene is impossible.
        better: a point that is more likely than the maximum, if one was met.
        wall: no scene was found beyond; with other values of the other entries there may be one.
    """

    inner: np.ndarray
    open: bool
    better: np.ndarray | None = None
    wall: bool = False


def end(
    objective: Objective, best: np.ndarray, k: int, sign: float, drop: float = DROP, after: np.ndarray | None = None,
    way: np.ndarray | None = None,
) -> End:  # fmt: skip
    """The end of the interval of entry k below (-1) or above (1) its estimate.

    The root of twice the drop of the profile is nearly linear in the entry, and is followed by secants within a
    bracket; the other entries start from where the last points of the profile lead.

    Arguments:
        after: a point within the interval from which to go on.
        way: a rate of all entries by distance that leads to possible scenes; none other than `tangent` if None.
    """
    free, top = objective.free, objective.value(best)
    bound = free.low[k] if sign < 0 else free.high[k]
    if abs(bound - best[k]) < _AT_BOUND * (free.high[k] - free.low[k]):
        return End(best, True)
    goal, most = np.sqrt(2 * drop), abs(bound - best[k])
    inside, outside = (0.0, 0.0), (np.inf, np.inf)  # distances from the estimate, and roots there
    if after is None:
        white = whitening(objective, best)
        covariance = white @ white.T
        step = _FIRST * goal * np.sqrt(covariance[k, k])
        tangent, at = sign * covariance[:, k] / covariance[k, k], best
    else:
        passed = abs(float(after[k] - best[k]))
        inside = passed, np.sqrt(2 * max(top - objective.value(after), 0.0))
        tangent, at, step = (after - best) / passed, after, _next(inside, outside, goal, False)
    for tried in range(_STEPS):
        step = min(step, most)
        value = float(best[k] + sign * step)
        ahead = np.clip(at + tangent * (step - abs(at[k] - best[k])), free.low, free.high)
        aside = at if way is None else np.clip(best + way * step, free.low, free.high)
        start = _possible(objective, (ahead, aside, at, best), k, value)
        point = profile_point(objective, start, k, value)
        height = objective.value(point)
        if height > top + _BETTER * drop:
            return End(point, False, point)
        possible = bool(np.isfinite(height))
        root = np.sqrt(2 * max(top - height, 0.0)) if possible else np.inf
        if root < goal * (1 + _WITHIN) and step == most:
            return End(point, True)
        flat = False  # a profile that flattens just below the goal may never reach it
        if abs(root - goal) < _WITHIN * goal:
            flat = outside[0] == np.inf and (goal - root) * (step - inside[0]) > _FLAT * step * (root - inside[1])
            if not flat:
                return End(point, False)
        if root < goal:
            inside = step, root
        else:
            outside = step, root
        if possible:
            tangent, at = (point - best) / step, point
        wall = not np.isfinite(outside[1]) and np.isfinite(outside[0])
        step = step * _FARTHER if flat else _next(inside, outside, goal, tried % 3 == 2)
        if outside[0] - inside[0] < (_AT_WALL * outside[0] if wall else _NARROW * most):
            return End(at, wall, wall=wall)
    return End(at, not np.isfinite(outside[0]))


def beyond(objective: Objective, best: np.ndarray, k: int, found: End, below: bool) -> np.ndarray | None:
    """The farthest point evaluated so far that is likely enough to lie within the interval and is outside of it."""
    if found.open and not found.wall:
        return None
    least = objective.value(best) - DROP * (1 - _BETTER)
    likely = np.array(objective.heights) > least
    points = np.array(objective.points)[likely]
    excess = (found.inner[k] - points[:, k]) * (1.0 if below else -1.0)
    at = int(np.argmax(excess))
    return points[at] if excess[at] > _OUTSIDE * abs(found.inner[k] - best[k]) else None


def checked(objective: Objective, best: np.ndarray, k: int, found: End, known: Sequence[np.ndarray]) -> End:
    """The end of an interval, looked for from elsewhere too: a profile may follow a local maximum of other entries.

    Arguments:
        known: likely points, such as the ends of other intervals.
    """
    top, drop = objective.value(best), DROP
    coarse = Objective(objective.likelihood, objective.free, COARSE)
    for _ in range(_CHECKS):
        if found.better is not None or (found.open and not found.wall) or found.inner[k] == best[k]:
            break
        value, sign = float(found.inner[k]), float(np.sign(found.inner[k] - best[k]))
        near = max(_elsewhere(objective, best, k, value, known), key=coarse.value)
        guess = np.clip(objective.free.start, objective.free.low, objective.free.high)
        guess[k] = value
        starts = [start for start in (near, guess) if coarse.value(start) > top - _HOPELESS]
        if not starts:
            break
        points = [profile_point(objective, start, k, value) for start in starts]
        first = int(np.argmax([objective.value(each) for each in points]))
        point, start, height = points[first], starts[first], objective.value(points[first])
        if height > top + _BETTER * drop:
            return End(point, False, point)
        if not height > top - drop * (1 - _BETTER):
            break
        way = (start - best) / abs(value - best[k])
        farther = end(objective, best, k, sign, drop, point, way)
        if farther.better is None and abs(farther.inner[k] - best[k]) <= abs(value - best[k]):
            break
        found = farther
    return found


def _elsewhere(
    objective: Objective, best: np.ndarray, k: int, value: float, known: Sequence[np.ndarray]
) -> list[np.ndarray]:
    """Starts of a profile point: the estimate and known points with this value, and points on the way to these."""
    free = objective.free
    starts = []
    for point in (best, *known):
        starts.append(np.where(np.arange(best.size) == k, value, point))
        way = float(point[k] - best[k])
        if way * (value - best[k]) > 0:
            starts.append(np.clip(best + (point - best) * (value - best[k]) / way, free.low, free.high))
    return starts


def _possible(objective: Objective, starts: Sequence[np.ndarray], k: int, value: float) -> np.ndarray:
    """The first start that with this value of entry k is a scene, or the first."""
    for start in starts:
        whole = start.copy()
        whole[k] = value
        if np.isfinite(objective.value(whole)):
            return start
    return starts[0]


def _next(inside: tuple[float, float], outside: tuple[float, float], goal: float, halve: bool) -> float:
    """Where the root reaches the goal, by the line through the bracket, or its middle; outwards without a bracket."""
    (low, at_low), (high, at_high) = inside, outside
    if not np.isfinite(high):
        return low * float(np.clip(goal / max(at_low, 1e-9), 1.1, _FARTHER))
    part = (
        0.5 if halve or not np.isfinite(at_high) else float(np.clip((goal - at_low) / (at_high - at_low), 0.08, 0.92))
    )
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
