"""The most likely values of the free entries, from several starts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

from ..errors import ComputationError
from .free_entries import FreeEntries
from .likelihood import COARSE, Likelihood, Resolution
from .objective import Objective

_STARTS = 16  # quasi-random points at which the likelihood is looked at
_FOLLOWED = 3  # of these, the number from which an optimum is sought
_NEIGHBOURHOOD = np.log(10.0)  # of the scene's value, within which they lie
_CLOSE = 6.0  # log-likelihood within which a coarse optimum is followed at full resolution
_SAME = 0.3  # distance, in standard errors, below which two optima are one
_EVALUATIONS = 30
_ROUNDS = 3  # of turning the lines and refining rows
_ROUGH = Resolution(1, 6, 96, 11)
_DIRECT = 0.02  # error of a row's log-likelihood that is worth more lines


@dataclass(frozen=True)
class Optimum:
    """A maximum of the likelihood.

    Attributes:
        inner: in the variables of the search.
        value: log-likelihood, priors included.
        others: separate maxima that are less likely, descending.
    """

    inner: np.ndarray
    value: float
    others: tuple[Optimum, ...] = ()


def optimise(likelihood: Likelihood, free: FreeEntries, starts: int = _STARTS, seed: int = 0) -> Optimum:
    """The maximum of the likelihood, with the lines of the likelihood turned for it.

    Raises:
        ComputationError: no start has a likelihood.
    """
    first = _screened(likelihood, free, starts, seed)
    rough = Objective(likelihood, free, _ROUGH)
    found: list[Optimum] = []
    for start in first:
        likelihood.aim(free.values(start))
        rough = Objective(likelihood, free, _ROUGH)
        if not np.isfinite(rough.value(start)):
            continue
        inner = climbed(rough, start, 1e-3)
        found.append(Optimum(inner, rough.value(inner)))
    if not found:
        raise ComputationError("no start of the fit has a likelihood", advice="give the scene another first guess")
    found.sort(key=lambda each: -each.value)
    good = [each for each in found if each.value > found[0].value - _CLOSE]
    distinct: list[Optimum] = []
    for each in good:
        if not any(_same(rough, each, other) for other in distinct):
            distinct.append(each)
    finished = [settled(likelihood, free, each.inner) for each in distinct]
    order = np.argsort([-each.value for each in finished])
    best = finished[order[0]]
    if order[0] != len(finished) - 1:
        best = settled(likelihood, free, best.inner, rounds=1)  # the lines belong to the last one
    objective = Objective(likelihood, free, Resolution())
    others = [finished[k] for k in order[1:] if not _same(objective, finished[k], best)]
    return replace(best, others=tuple(others))


def settled(likelihood: Likelihood, free: FreeEntries, inner: np.ndarray, rounds: int = _ROUNDS) -> Optimum:
    """The maximum next to a point, with lines turned and rows refined for it."""
    objective = Objective(likelihood, free, Resolution())
    before = np.inf
    for _ in range(rounds):
        likelihood.aim(free.values(inner))
        likelihood.refine(free.values(inner), _DIRECT)
        objective = Objective(likelihood, free, Resolution())
        inner = climbed(objective, inner, 1e-5)
        value = objective.value(inner)
        if abs(value - before) < _DIRECT:
            break
        before = value
    return Optimum(inner, objective.value(inner))


def climbed(objective: Objective, start: np.ndarray, within: float) -> np.ndarray:
    """The maximum that is reached from a start.

    Arguments:
        within: relative tolerance of the sum of squares and of the variables.
    """
    free = objective.free
    low, high = free.low, free.high
    inside = np.clip(start, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
    found = least_squares(
        objective.residuals, inside, objective.jacobian, (low, high), method="trf", ftol=within, xtol=within,
        gtol=1e-8, max_nfev=_EVALUATIONS, x_scale=np.where([each.log for each in free.entries], 1.0, high - low),
    )  # fmt: skip
    inner: np.ndarray = found.x
    return inner


def _screened(likelihood: Likelihood, free: FreeEntries, starts: int, seed: int) -> list[np.ndarray]:
    """The scene's own values, and the most likely of quasi-random points around them."""
    own = np.clip(free.start, free.low, free.high)
    low = np.where([each.log for each in free.entries], np.maximum(free.low, own - _NEIGHBOURHOOD), free.low)
    high = np.where([each.log for each in free.entries], np.minimum(free.high, own + _NEIGHBOURHOOD), free.high)
    points = qmc.scale(qmc.Sobol(free.size, seed=seed).random(starts), low, high) if starts else np.zeros((0, 1))
    coarse = Objective(likelihood, free, COARSE)
    values = [coarse.value(point) for point in points]
    order = np.argsort([-value for value in values])
    return [own, *(points[k] for k in order[: _FOLLOWED - 1])]


def _same(objective: Objective, one: Optimum, other: Optimum) -> bool:
    """Whether two maxima are one, in standard errors or along a direction that the data do not tell."""
    apart = one.inner - other.inner
    return float(apart @ objective.information(other.inner) @ apart) < _SAME**2 and abs(one.value - other.value) < 0.1
