"""The most likely values of the free entries, from several starts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares, minimize
from scipy.stats import qmc

from ..errors import ComputationError
from .free_entries import FreeEntries
from .likelihood import COARSE, Likelihood, Resolution
from .objective import Objective, walls, whitening

_STARTS = 16  # quasi-random points at which the likelihood is looked at
_FOLLOWED = 3  # of these, the number from which an optimum is sought
_NEIGHBOURHOOD = np.log(10.0)  # of the scene's value, within which they lie
_CLOSE = 6.0  # log-likelihood within which a coarse optimum is followed at full resolution
_DIP = 0.1  # of the log-likelihood between two maxima
_EVALUATIONS = 30
_TOLERANCE = 1e-3  # of the log-likelihood
_ROUNDS = 3  # of turning the lines and refining rows
_FAR_OFF = 1.5  # standard errors that a maximum may be from where the lines were turned
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
    distinct: list[Optimum] = []
    for each in found:
        if each.value > found[0].value - _CLOSE and all(_apart(rough, each, other) for other in distinct):
            distinct.append(each)
    finished = [settled(likelihood, free, each.inner) for each in distinct]
    order = np.argsort([-each.value for each in finished])
    best: Optimum = finished[order[0]]
    if order[0] != len(finished) - 1:
        likelihood.aim(free.values(best.inner))  # the lines are those of the last one
        likelihood.refine(free.values(best.inner), _DIRECT)
    objective = Objective(likelihood, free, Resolution())
    others = [finished[k] for k in order[1:] if _apart(objective, finished[k], best)]
    return replace(best, others=tuple(others))


def settled(likelihood: Likelihood, free: FreeEntries, inner: np.ndarray) -> Optimum:
    """The maximum next to a point, with lines turned and rows refined for it."""
    objective = Objective(likelihood, free, Resolution())
    for _ in range(_ROUNDS):
        likelihood.aim(free.values(inner))
        likelihood.refine(free.values(inner), _DIRECT)
        objective = Objective(likelihood, free, Resolution())
        before, inner = inner, polished(objective, inner)
        move = inner - before
        if float(move @ objective.information(inner) @ move) < _FAR_OFF**2:
            break
    return Optimum(inner, objective.value(inner))


def polished(objective: Objective, start: np.ndarray) -> np.ndarray:
    """The maximum next to a point, in variables in which the information matrix is the unit matrix."""
    free = objective.free
    low, high = free.low, free.high
    start = np.clip(start, low, high)
    white = whitening(objective, start)

    def inner(z: np.ndarray) -> np.ndarray:
        at: np.ndarray = np.clip(start + white @ z, low, high)
        return at

    def lack(z: np.ndarray) -> float:
        value = objective.value(inner(z))
        return top - value if np.isfinite(value) else 1e3

    def slope(z: np.ndarray) -> np.ndarray:
        at = inner(z)
        possible = np.isfinite(objective.value(at))
        down: np.ndarray = -white.T @ objective.gradient(at) if possible else np.zeros(z.size)
        return down

    top = objective.value(start)
    found = minimize(
        lack, np.zeros(start.size), jac=slope, constraints=walls(free, start, white), method="SLSQP",
        options={"maxiter": _EVALUATIONS, "ftol": _TOLERANCE},
    )  # fmt: skip
    best: np.ndarray = inner(found.x) if found.fun < 0 else start
    return best


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


def _apart(objective: Objective, one: Optimum, other: Optimum) -> bool:
    """Whether the likelihood is lower between two maxima than at either."""
    between = objective.value((one.inner + other.inner) / 2)
    return between < min(one.value, other.value) - _DIP
