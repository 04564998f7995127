"""Intervals of the free entries from the profile of the likelihood.

The end of an interval is the farthest value of an entry at which the other entries can still be chosen so that the
log-likelihood is at most 1.92 below its maximum (95 %, chi-squared with one degree of freedom). It is one constrained
optimisation, in variables in which the information matrix is the unit matrix.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, least_squares, minimize

from .objective import Objective, walls, whitening

DROP = 1.920729410347062  # half the 95 % quantile of chi-squared with one degree of freedom
_WIDTH = 1.959963984540054
_WITHIN = 0.05  # of DROP, that an end may miss
_STEPS = 25
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
    """The end of the interval of entry k below (-1) or above (1) its estimate."""
    free, top = objective.free, objective.value(best)
    low, high = free.low, free.high
    span = high - low
    if (best[k] - low[k] if sign < 0 else high[k] - best[k]) < _AT_BOUND * span[k]:
        return End(best, True)
    white = whitening(objective, best)
    row = white[k]
    sigma = float(np.linalg.norm(row))
    scale = np.sqrt(2 * drop)

    def inner(z: np.ndarray) -> np.ndarray:
        return np.clip(best + white @ z, low, high)

    def excess(z: np.ndarray) -> float:
        value = objective.value(inner(z))
        return value - top + drop if np.isfinite(value) else -100.0

    def excess_slope(z: np.ndarray) -> np.ndarray:
        at = inner(z)
        return white.T @ objective.gradient(at) if np.isfinite(objective.value(at)) else np.zeros(z.size)

    # the normal of the ellipse predicts the end; the search begins within the bounds
    first = sign * scale * row / sigma
    step = white @ first
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.where(step > 0, (high - best) / step, np.where(step < 0, (low - best) / step, np.inf))
    first = first * min(1.0, 0.98 * float(np.min(room)))
    found = minimize(
        lambda z: -sign * scale * float(row @ z) / sigma, first, jac=lambda _z: -sign * scale * row / sigma,
        constraints=[{"type": "ineq", "fun": excess, "jac": excess_slope}, *walls(free, best, white)], method="SLSQP",
        options={"maxiter": _STEPS, "ftol": 2e-3},
    )  # fmt: skip
    at = inner(found.x)
    left = excess(found.x)
    if left > drop * (1 + _WITHIN):
        return End(at, False, at)
    bound = low[k] if sign < 0 else high[k]
    at_bound = abs(at[k] - bound) < _AT_BOUND * span[k]
    if at_bound and left > -_WITHIN * drop:
        return End(at, True)
    if abs(left) < _WITHIN * drop and found.success:
        return End(at, False)
    return _searched(objective, best, k, sign, top - drop)


def _searched(objective: Objective, best: np.ndarray, k: int, sign: float, level: float) -> End:
    """The same by the profile itself, step by step: slower, where the constrained optimisation does not end well."""
    free = objective.free
    bound = free.low[k] if sign < 0 else free.high[k]
    white = whitening(objective, best)
    step = min(float(np.linalg.norm(white[k])) * _WIDTH, abs(bound - best[k]))
    held: dict[float, np.ndarray] = {float(best[k]): best}
    heights: dict[float, float] = {float(best[k]): objective.value(best) - level}

    def excess(at: float) -> float:
        if at not in held:
            nearest = min(held, key=lambda other: abs(other - at))
            held[at] = profile_point(objective, held[nearest], k, at)
            heights[at] = max(objective.value(held[at]) - level, -100.0)
        return heights[at]

    inside, top = float(best[k]), level + DROP
    while True:
        outside = inside + sign * step
        if (outside - bound) * sign >= 0:
            outside = float(bound)
        left = excess(outside)
        if left > (top - level) * (1 + _WITHIN):
            return End(held[outside], False, held[outside])
        if left < 0:
            break
        if outside == bound:
            return End(held[outside], True)
        inside, step = outside, 2 * step
    if excess(inside) <= 0:
        return End(held[inside], False)
    brentq(excess, inside, outside, xtol=_WITHIN * 0.1 * abs(outside - inside) + 1e-12, maxiter=12, disp=False)
    return End(held[min(held, key=lambda at: abs(heights[at]))], False)


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
        (low, high), method="trf", ftol=1e-4, xtol=1e-4, max_nfev=12,
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
