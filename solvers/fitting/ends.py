"""Ends of intervals by Newton's method.

The 95 % interval of an entry ends where the logarithm of the profile of the likelihood is `Objective.drop` below its
maximum: at the likely point with the largest or smallest value of the entry.
"""

from dataclasses import dataclass

import numpy as np

from .optimise import Objective, whitening

WITHIN = 0.01  # relative error of the root of twice the drop at an end
BETTER = 0.05  # of the drop, by which a point must be more likely to replace the maximum
NARROW = 1e-6  # distance from a bound, relative to that of the estimate or of the other bound, that does not count
_NEAR = 0.03  # the same, from which the last step goes
_LAST = 0.1  # most that the last step goes on, relative to the distance from the estimate: a profile may flatten out
_CURVED = 0.1  # least change of a gradient along a step, over the expected one, that corrects second derivatives
_STEPS = 8
_UNLIKELY = 3.0  # part of the drop beyond which a predicted end is no start


@dataclass(frozen=True)
class End:
    """An end of an interval.

    Attributes:
        inner: in the variables of the search, all entries; where `open`, the farthest point that was evaluated.
        open: the likelihood does not fall by `Objective.drop` before the bound of the search, or where the scene is
            impossible.
        wall: no scene was found beyond; with other values of the other entries there may be one.
    """

    inner: np.ndarray
    open: bool
    wall: bool = False


class MoreLikely(Exception):
    """A point that is more likely than the maximum."""

    def __init__(self, inner: np.ndarray) -> None:
        super().__init__()
        self.inner = inner


def predicted(objective: Objective, best: np.ndarray, k: int, sign: float) -> np.ndarray:
    """Where the information matrix of the estimate has an end of the interval of entry k, within the bounds."""
    white = whitening(objective, best)
    along = white @ white[k]
    at = best + sign * np.sqrt(2 * objective.drop) * along / np.sqrt(along[k])
    return np.asarray(np.clip(at, objective.free.low, objective.free.high))


def end_by_newton(
    objective: Objective, best: np.ndarray, k: int, sign: float, after: np.ndarray | None,
    near: np.ndarray | None = None,
) -> End | None:  # fmt: skip
    """The likely point with the largest or smallest value of entry k, by Newton's method; None if it does not converge.

    The matrix of second derivatives is that of the estimate, corrected by what gradients change (BFGS). It says how
    much the profile lies above the likelihood of a point; the root of twice the drop of the profile is nearly linear
    in the entry. A point is an end if the last step, which is not evaluated any more, is short.

    Arguments:
        after: a point from which to go on, within the interval or about at its end.
        near: the first point, where there is no `after`, in place of the `predicted` one.
    """
    free, top, goal = objective.free, objective.value(best), float(np.sqrt(2 * objective.drop))
    matrix, at, slopes = objective.information(best) + free.vague, best, objective.gradient(best)
    margin, bound = NARROW * (free.high - free.low), free.low[k] if sign < 0 else free.high[k]
    first = near if after is None else after
    to = predicted(objective, best, k, sign) if first is None else first
    for _ in range(_STEPS):
        to = np.clip(to, free.low, free.high)
        height = objective.value(to)
        while not height > top - (1 + _UNLIKELY) * objective.drop:
            to = (at + to) / 2
            if np.abs(to - at).max() < margin.max():
                return None
            height = objective.value(to)
        if height > top + BETTER * objective.drop:
            raise MoreLikely(to)
        before, at, was, slopes = at, to, slopes, objective.gradient(to)
        matrix = _corrected(matrix, at - before, was - slopes)
        held = ((at <= free.low + margin) & (slopes < 0)) | ((at >= free.high - margin) & (slopes > 0))
        others = np.flatnonzero(~held & (np.arange(at.size) != k))
        inverse = np.linalg.inv(matrix[np.ix_(others, others)])
        shift, follow = inverse @ slopes[others], -inverse @ matrix[others, k]
        gain, slope = float(slopes[others] @ shift) / 2, sign * float(slopes[k] + slopes[others] @ follow)
        root = float(np.sqrt(2 * max(top - height - gain, 0.0)))
        if at[k] == bound and gain < WITHIN * goal**2 and root < goal * (1 + 2 * WITHIN):
            return End(at, True)
        if not (slope < 0 and root > 0):
            return None
        step, to = (goal - root) * root / -slope, at.copy()
        to[k] += sign * step
        to[others] += shift + follow * sign * step
        possible = bool(((to >= free.low) & (to <= free.high)).all())
        close = abs(goal - root) < _NEAR * goal and gain < WITHIN * goal**2
        if possible and close and abs(step) < _LAST * abs(at[k] - best[k]):
            return None if after is not None and sign * (to[k] - after[k]) < 0 else End(to, False)
    return None


def _corrected(matrix: np.ndarray, step: np.ndarray, change: np.ndarray) -> np.ndarray:
    """The matrix that turns a step into the change of the gradient, nearest to another one (BFGS)."""
    across = matrix @ step
    if not float(change @ step) > _CURVED * float(across @ step):
        return matrix
    corrected: np.ndarray = (
        matrix + np.outer(change, change) / (change @ step) - np.outer(across, across) / (across @ step)
    )
    return corrected
