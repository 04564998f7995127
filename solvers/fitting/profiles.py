"""Intervals of the free entries from the profile of the likelihood, and the verdicts on them.

The profile at a value of an entry is the largest likelihood over all values of the other entries. The 95 % interval
ends where the logarithm of the profile is `Objective.drop` below its maximum; where the profile is that high at
several places, the farthest counts.
"""

from collections.abc import Sequence

import numpy as np

from ..errors import ComputationError
from .ends import BETTER, NARROW, WITHIN, End, MoreLikely, end_by_newton, predicted
from .free_entries import COMBINED, IDENTIFIED, NOT_AT_ALL, ONE_SIDE, FreeEntries
from .joint import Joint
from .optimise import DIRECT, ROUGH, Objective, Optimum, maximum_with_aiming, rough_maximum, whitening
from .scatter import COARSE, Resolution

_FLAT = 0.1  # a profile is flat if at its last slope this part of the distance from the maximum is still to go
_STEPS = 25
_FARTHER = 4.0  # largest factor from one step outwards to the next
_FIRST = 0.6  # first step, as a part of what the information matrix predicts; a profile point far outside is costly
_AT_BOUND = 1e-3  # distance from a bound, relative to the range of the search, at which an estimate lies on it
_AT_WALL = 0.02  # relative width of a bracket beyond which no scene is possible
_HOPELESS = 50.0  # log-likelihood below the maximum from which no start is followed
_CHECKS = 3  # times that an end is moved by a start from elsewhere
_OUTSIDE = 0.02  # part of the interval's half width by which a likely point must lie outside to move its end
_RESTARTS = 3  # times that a more likely point, met on a profile, replaces the maximum
_ROUNDS = 5  # in which ends are moved beyond likely points


def intervals(likelihood: Joint, free: FreeEntries, best: Optimum) -> tuple[Optimum, list[list[End]]]:
    """The maximum, and for each entry the ends of its interval below and above.

    A more likely point that is met on the way becomes the maximum.

    Raises:
        ComputationError: such points are met again and again.
    """
    for _ in range(_RESTARTS):
        try:
            _refine_at_ends(likelihood, free, best.inner)
            ends = _ends(Objective(likelihood, free, Resolution()), best.inner)
            return best, _with_lines_there(likelihood, free, best.inner, ends)
        except MoreLikely as point:
            again = maximum_with_aiming(likelihood, free, point.inner)
            best = Optimum(again.inner, again.value, best.others)
    advice = "give priors, free fewer entries, or start from other values"
    raise ComputationError("the likelihood has no maximum that its profiles agree on", advice=advice)


def _refine_at_ends(likelihood: Joint, free: FreeEntries, best: np.ndarray) -> None:
    """Give the rows as many lines as they need at the estimate and where its information matrix has the ends.

    Between the ends a change of outcome may move into the scatter of a row that has none at the estimate.
    """
    objective = Objective(likelihood, free, Resolution())
    for k in range(free.size):
        for sign in (-1.0, 1.0):
            likelihood.refine(free.values(predicted(objective, best, k, sign)), DIRECT, at_least=True)


def _with_lines_there(likelihood: Joint, free: FreeEntries, best: np.ndarray, ends: list[list[End]]) -> list[list[End]]:
    """The ends, found again if rows need more lines there than where the information matrix had them."""
    closed = [end.inner for both in ends for end in both if not end.open]
    more = [likelihood.refine(free.values(inner), DIRECT, at_least=True) for inner in closed]
    if not any(more):
        return ends
    objective = Objective(likelihood, free, Resolution())

    return [
        [end if end.open else end_by_newton(objective, best, k, sign, None, end.inner)
         or _followed(objective, best, k, sign, None) for sign, end in zip((-1.0, 1.0), both, strict=True)]
        for k, both in enumerate(ends)
    ]  # fmt: skip


def _ends(objective: Objective, best: np.ndarray) -> list[list[End]]:
    """The ends of all intervals; MoreLikely if the maximum is none."""
    entries = range(objective.free.size)
    ends = [[_end(objective, best, k, sign) for sign in (-1.0, 1.0)] for k in entries]
    for k in entries:
        for side in (0, 1):
            others = [end.inner for j, both in enumerate(ends) for end in both if j != k]
            ends[k][side] = _from_elsewhere(objective, best, k, ends[k][side], others)
    for _ in range(_ROUNDS):  # a point evaluated on the way to one end may lie outside another
        moved = False
        for k in entries:
            for side, sign in enumerate((-1.0, 1.0)):
                point = _likely_outside(objective, best, k, ends[k][side], sign)
                end = None if point is None else _end(objective, best, k, sign, point)
                if end is not None and sign * (end.inner[k] - ends[k][side].inner[k]) > 0:
                    ends[k][side], moved = end, True
        if not moved:
            break
    return ends


def _end(objective: Objective, best: np.ndarray, k: int, sign: float, after: np.ndarray | None = None) -> End:
    """The end of the interval of entry k below (-1) or above (1) its estimate.

    Arguments:
        after: a point from which to go on, within the interval or about at its end.
    """
    free = objective.free
    bound = free.low[k] if sign < 0 else free.high[k]
    if abs(bound - best[k]) < _AT_BOUND * (free.high[k] - free.low[k]):
        return End(best, True)
    return end_by_newton(objective, best, k, sign, after) or _followed(objective, best, k, sign, after)


def _followed(objective: Objective, best: np.ndarray, k: int, sign: float, after: np.ndarray | None) -> End:
    """The end of an interval along its profile, with the first value of the entry at which the likelihood has fallen.

    The root of twice the drop of the profile is nearly linear in the entry, and is followed by secants within a
    bracket; the other entries start from where the last points of the profile lead.

    Arguments:
        after: as of `_end`; the other entries may also start on the straight line from the estimate through it.
    """
    free, top = objective.free, objective.value(best)
    bound = free.low[k] if sign < 0 else free.high[k]
    goal, most = np.sqrt(2 * objective.drop), abs(bound - best[k])
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
    through = tangent
    for tried in range(_STEPS):
        step = min(step, most)
        value = float(best[k] + sign * step)
        ahead = np.clip(at + tangent * (step - abs(at[k] - best[k])), free.low, free.high)
        aside = at if after is None else np.clip(best + through * step, free.low, free.high)
        starts = [_with(guess, k, value) for guess in (ahead, aside, at, best)]
        start = next((guess for guess in starts if np.isfinite(objective.value(guess))), starts[0])
        point = profile_point(objective, start, k, value)
        height = objective.value(point)
        if height > top + BETTER * objective.drop:
            raise MoreLikely(point)
        possible = bool(np.isfinite(height))
        root = np.sqrt(2 * max(top - height, 0.0)) if possible else np.inf
        if root < goal * (1 + 2 * WITHIN) and step == most:
            return End(point, True)
        flat = False  # a profile that flattens just below the goal may never reach it
        if abs(root - goal) < WITHIN * goal:
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
        if outside[0] - inside[0] < (_AT_WALL * outside[0] if wall else NARROW * most):
            return End(at, wall, wall=wall)
    return End(at, not np.isfinite(outside[0]))


def _next(inside: tuple[float, float], outside: tuple[float, float], goal: float, halve: bool) -> float:
    """Where the root reaches the goal, by the line through the bracket, or its middle; outwards without a bracket."""
    (low, at_low), (high, at_high) = inside, outside
    if not np.isfinite(high):
        return low * float(np.clip(goal / max(at_low, 1e-9), 1.1, _FARTHER))
    if halve or not np.isfinite(at_high):
        return (low + high) / 2
    return low + float(np.clip((goal - at_low) / (at_high - at_low), 0.08, 0.92)) * (high - low)


def _likely_outside(objective: Objective, best: np.ndarray, k: int, end: End, sign: float) -> np.ndarray | None:
    """The farthest point evaluated so far that is likely enough to lie within the interval and is outside of it."""
    if end.open and not end.wall:
        return None
    least = objective.value(best) - objective.drop * (1 + 2 * WITHIN)  # first, as it may be evaluated anew
    points = np.array(objective.points)[np.array(objective.heights) > least]
    excess = sign * (points[:, k] - end.inner[k])
    farthest = int(np.argmax(excess))
    return points[farthest] if excess[farthest] > _OUTSIDE * abs(end.inner[k] - best[k]) else None


def _from_elsewhere(objective: Objective, best: np.ndarray, k: int, end: End, others: Sequence[np.ndarray]) -> End:
    """The end of an interval, moved outwards where other starts give a higher profile there.

    The points of a profile may follow a local maximum over the other entries.

    Arguments:
        others: likely points, such as the ends of other intervals.
    """
    free, top = objective.free, objective.value(best)
    if free.size == 1:
        return end
    coarse, rough = (Objective(objective.likelihood, free, resolution) for resolution in (COARSE.values, ROUGH))
    for _ in range(_CHECKS):
        if (end.open and not end.wall) or end.inner[k] == best[k]:
            break
        value, sign = float(end.inner[k]), float(np.sign(end.inner[k] - best[k]))
        starts = []
        for point in (best, *others):  # with this value, and on the way to the point
            starts.append(_with(point, k, value))
            way = float(point[k] - best[k])
            if way * (value - best[k]) > 0:
                starts.append(np.clip(best + (point - best) * (value - best[k]) / way, free.low, free.high))
        guess = _with(np.clip(free.start, free.low, free.high), k, value)
        likeliest = max(starts, key=coarse.value), guess
        followed = [
            start
            for start in likeliest
            if coarse.value(start) > top - _HOPELESS and not _leads_to(coarse, rough, start, end.inner)
        ]
        if not followed:
            break
        point = max((profile_point(rough, start, k, value) for start in followed), key=objective.value)
        if objective.value(point) > top + BETTER * objective.drop:
            raise MoreLikely(point)
        if not objective.value(point) > top - objective.drop * (1 - BETTER):
            break
        farther = _end(objective, best, k, sign, point)
        if abs(farther.inner[k] - best[k]) <= abs(value - best[k]):
            break
        end = farther
    return end


def _leads_to(coarse: Objective, rough: Objective, start: np.ndarray, end: np.ndarray) -> bool:
    """Whether from a start the likelihood rises towards a more likely end, and lies above the chord halfway."""
    height, top, middle = (coarse.value(point) for point in (start, end, (start + end) / 2))
    if height > top or middle < (height + top) / 2:
        return False
    return np.isfinite(rough.value(start)) and float(rough.gradient(start) @ (end - start)) >= 0


def profile_point(objective: Objective, start: np.ndarray, k: int, value: float) -> np.ndarray:
    """The most likely values of the other entries where entry k has this value, in the variables of the search."""
    point = _with(start, k, value)
    if objective.free.size == 1 or not np.isfinite(objective.value(point)):
        return point
    return rough_maximum(objective, point, k, 1e-4, 12)


def _with(point: np.ndarray, k: int, value: float) -> np.ndarray:
    return np.where(np.arange(point.size) == k, value, point)


def judged(objective: Objective, best: np.ndarray, k: int, ends: Sequence[End]) -> str:
    """The verdict on entry k, from the ends of its interval.

    With both ends open the data may still tell the entry in combination with others: they do if the likelihood falls
    when the others keep their values.
    """
    still_open = [end.open for end in ends]
    if not any(still_open):
        return IDENTIFIED
    if not all(still_open):
        return ONE_SIDE
    free, least = objective.free, objective.value(best) - objective.drop
    alone = (
        _with(best, k, best[k] + share * (bound[k] - best[k]))
        for bound in (free.low, free.high)
        for share in (0.02, 0.1, 0.3, 1.0)
    )
    return COMBINED if free.size > 1 and any(objective.value(point) < least for point in alone) else NOT_AT_ALL
