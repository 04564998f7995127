"""The most likely values of the free entries, from several starts.

A fit minimises a sum of squares, one term for each row and each prior. The square of a row's residual is twice the
difference of its log-likelihood from that of a perfect observation, so that least squares are maximum likelihood, and
the matrix of Gauss and Newton is close to the information matrix.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Real

import numpy as np
from scipy.optimize import LinearConstraint, least_squares, minimize
from scipy.stats import qmc, t

from ..errors import ComputationError, InputError
from ..host.arguments import check_names
from .free_entries import FreeEntries, Normalisation, Prior
from .joint import Joint
from .likelihood import Evaluation, Likelihood
from .scatter import COARSE, Resolution

DROP = 1.920729410347062  # half the 95 % quantile of chi-squared with one degree of freedom
_STARTS = 16  # quasi-random points at which the likelihood is evaluated
_FOLLOWED = 3  # of these, the number from which an optimum is sought
_NEIGHBOURHOOD = np.log(10.0)  # largest distance of these points from the scene's values, in logarithms
_CLOSE = 6.0  # log-likelihood within which a coarse optimum is followed at full resolution
_DIP = 0.1  # of the log-likelihood between two maxima that count as separate
_EVALUATIONS = 30  # most evaluations of least squares, and most iterations of SLSQP
IMPOSSIBLE = 1e3  # loss of log-likelihood where the scene is impossible
_TOLERANCE = 1e-3  # of the log-likelihood
_ROUNDS = 3  # of turning the lines and refining rows
_FAR_OFF = 1.5  # standard errors that a maximum may be from where the lines were turned
ROUGH = Resolution(1, 6, 96, 11, within=1e-4)
DIRECT = 5e-3  # error of a row's log-likelihood beyond which it gets more lines
_LEAST = 1e-9  # residual below which a row has no derivatives


class Objective:
    """Residuals of a fit and their derivatives, with the last evaluations kept.

    Arguments:
        likelihood, free: both of the same entries in the same order.
        resolution: resolution of the integrals.
    """

    def __init__(self, likelihood: Likelihood | Joint, free: FreeEntries, resolution: Resolution) -> None:
        self.likelihood, self.free, self.resolution = likelihood, free, resolution
        self.points: list[np.ndarray] = []  # all that were evaluated
        self.heights: list[float] = []  # `value` there
        self._last: dict[bytes, Evaluation | None] = {}

    def at(self, inner: np.ndarray) -> Evaluation | None:
        """The log-likelihoods at these variables of the search; None where the scene is impossible."""
        key = inner.tobytes()
        if key not in self._last:
            while len(self._last) > 8:
                del self._last[next(iter(self._last))]
            self._last[key] = self.likelihood(self.free.values(inner), self.resolution)
            self.points.append(inner.copy())
            self.heights.append(self.value(inner))
        return self._last[key]

    def _possible(self, inner: np.ndarray) -> Evaluation:
        evaluation = self.at(inner)
        assert evaluation is not None  # derivatives are taken where a value has been found
        return evaluation

    def residuals(self, inner: np.ndarray) -> np.ndarray:
        """One residual for each row and each prior; infinite where the scene is impossible."""
        evaluation = self.at(inner)
        if evaluation is None:
            return np.full(self.likelihood.size + self.free.size, np.inf)
        return np.concatenate([self._roots(evaluation), self.free.misfits(inner)[0]])

    def _roots(self, evaluation: Evaluation) -> np.ndarray:
        return np.asarray(np.sqrt(np.maximum(2 * (self.likelihood.constant - evaluation.rows), 0.0)))

    def jacobian(self, inner: np.ndarray) -> np.ndarray:
        """Derivatives of the residuals by the variables of the search."""
        evaluation = self._possible(inner)
        root, rates = self._roots(evaluation)[:, None], self.free.rates(self.free.values(inner))
        with np.errstate(divide="ignore", invalid="ignore"):
            rows = np.where(root > _LEAST, -evaluation.scores * rates / root, 0.0)
        return np.vstack([rows, np.diag(self.free.misfits(inner)[1])])

    def value(self, inner: np.ndarray) -> float:
        """The logarithm of likelihood times prior density, up to a constant; -inf where the scene is impossible."""
        evaluation = self.at(inner)
        if evaluation is None:
            return -np.inf
        offset = sum(entry.prior.offset for entry in self.free.entries if isinstance(entry.prior, Normalisation))
        return evaluation.value + offset - float((self.free.misfits(inner)[0] ** 2).sum()) / 2

    def log_likelihood(self, inner: np.ndarray) -> float:
        """The logarithm of the likelihood alone, with all constants of the densities, where the scene is possible."""
        return self.value(inner) + sum(float(e) ** 2 for e, entry in zip(self.free.misfits(inner)[0], self.free.entries)
                                       if isinstance(entry.prior, Prior)) / 2  # fmt: skip

    def gradient(self, inner: np.ndarray) -> np.ndarray:
        """Derivatives of `value`."""
        misfits, slopes = self.free.misfits(inner)
        rates = self.free.rates(self.free.values(inner))
        return np.asarray(self._possible(inner).scores.sum(axis=0) * rates - misfits * slopes)

    @property
    def drop(self) -> float:
        """The log-likelihood from the maximum to the end of a 95 % interval.

        Half the quantile of chi-squared with one degree of freedom; where the noise is fitted that of Student's t, with
        as many degrees of freedom as there are results more than other entries.
        """
        counts = [entry.prior.count for entry in self.free.entries if isinstance(entry.prior, Normalisation)]
        if not counts:
            return DROP
        freedom = max(sum(counts) - self.free.size + len(counts), 1)
        return sum(counts) / 2 * math.log1p(float(t.ppf(0.975, freedom)) ** 2 / freedom)

    def information(self, inner: np.ndarray) -> np.ndarray:
        """The information matrix of rows and priors in the variables of the search (Gauss-Newton)."""
        slopes = self.jacobian(inner)
        information: np.ndarray = slopes.T @ slopes
        for k, entry in enumerate(self.free.entries):
            if isinstance(entry.prior, Normalisation):  # expected: 2 for each value, of which its residual has one
                information[k, k] += entry.prior.count - slopes[self.likelihood.size + k, k] ** 2
        return information

    def log_density(self, values: Mapping[str, float]) -> tuple[float, dict[str, float]]:
        """`value` and its derivatives at values of all free entries by name, SI.

        Raises:
            InputError: a value is missing or no number, or is that of another entry.
        """
        check_names(list(values), self.free.names, "values")
        for name in self.free.names:
            if not isinstance(values.get(name), Real):
                raise InputError(f"values, {name}", values.get(name), "a number, SI", "is no number" * (name in values))
        inner = self.free.inner(np.array([values[name] for name in self.free.names]))
        height, slope = self.value(inner), np.zeros(self.free.size)
        if np.isfinite(height):
            slope = self.gradient(inner) / self.free.rates(self.free.values(inner))
        return height, dict(zip(self.free.names, slope.tolist(), strict=True))


def whitening(objective: Objective, inner: np.ndarray) -> np.ndarray:
    """C with C C' the covariance at a maximum; where the data say nothing, that of the range of the search."""
    values, vectors = np.linalg.eigh(objective.information(inner) + objective.free.vague)
    return np.asarray(vectors / np.sqrt(np.maximum(values, 1e-12)))


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


def optimise(
    likelihood: Likelihood | Joint, free: FreeEntries, starts: int = _STARTS, seed: int = 0, everywhere: bool = False
) -> Optimum:
    """The most likely of the maxima that several starts lead to; the lines of the likelihood are left turned for it.

    Arguments:
        everywhere: starts lie in the whole range of the search, not only about the scene's values.

    Raises:
        ComputationError: no start has a likelihood.
    """
    climbs: list[Optimum] = []
    for start in _screened(likelihood, free, starts, seed, np.inf if everywhere else _NEIGHBOURHOOD):
        likelihood.aim(free.values(start))
        rough = Objective(likelihood, free, ROUGH)
        if np.isfinite(rough.value(start)):
            inner = rough_maximum(rough, start)
            climbs.append(Optimum(inner, rough.value(inner)))
    if not climbs:
        raise ComputationError("no start of the fit has a likelihood", advice="give the scene another first guess")
    climbs.sort(key=lambda climb: -climb.value)
    distinct: list[Optimum] = []
    for climb in climbs:
        if climb.value > climbs[0].value - _CLOSE and all(_apart(rough, climb, other) for other in distinct):
            distinct.append(climb)
    finished = [maximum_with_aiming(likelihood, free, climb.inner) for climb in distinct]
    best, *others = sorted(finished, key=lambda optimum: -optimum.value)
    if best is not finished[-1]:
        likelihood.aim(free.values(best.inner))  # its lines were last turned for another maximum
        likelihood.refine(free.values(best.inner), DIRECT)
    objective = Objective(likelihood, free, Resolution())
    return replace(best, others=tuple(optimum for optimum in others if _apart(objective, optimum, best)))


def maximum_with_aiming(likelihood: Likelihood | Joint, free: FreeEntries, inner: np.ndarray) -> Optimum:
    """The maximum nearest to a point, with `aim` and `refine` of the likelihood repeated there."""
    for _ in range(_ROUNDS):
        likelihood.aim(free.values(inner))
        likelihood.refine(free.values(inner), DIRECT)
        objective = Objective(likelihood, free, Resolution())
        before, inner = inner, refined_maximum(objective, inner)
        move = inner - before
        if float(move @ objective.information(inner) @ move) < _FAR_OFF**2:
            break
    return Optimum(inner, objective.value(inner))


def refined_maximum(objective: Objective, start: np.ndarray) -> np.ndarray:
    """The nearest maximum, by SLSQP in variables with unit information matrix at the start; else the start itself."""
    low, high = objective.free.low, objective.free.high
    start = np.clip(start, low, high)
    white, at_start, span = whitening(objective, start), objective.value(start), high - low

    def from_white(z: np.ndarray) -> np.ndarray:
        return np.asarray(np.clip(start + white @ z, low, high))

    def loss(z: np.ndarray) -> tuple[float, np.ndarray]:
        at = from_white(z)
        value = objective.value(at)
        possible = np.isfinite(value)
        return (at_start - value, -white.T @ objective.gradient(at)) if possible else (IMPOSSIBLE, np.zeros(z.size))

    box = LinearConstraint(white / span[:, None], (low - start) / span, (high - start) / span)
    optimum = minimize(
        loss, np.zeros(start.size), jac=True, constraints=box, method="SLSQP",
        options={"maxiter": _EVALUATIONS, "ftol": _TOLERANCE},
    )  # fmt: skip
    return np.asarray(from_white(optimum.x) if optimum.fun < 0 else start)


def rough_maximum(
    objective: Objective, start: np.ndarray, fixed: int | None = None, variables: float = 1e-3, most: int = _EVALUATIONS
) -> np.ndarray:
    """The maximum that is reached from a start, by least squares to a relative 1e-3 of the sum of squares.

    Arguments:
        fixed: an entry that keeps its value.
        variables: relative tolerance of the variables.
        most: most evaluations.
    """
    free = objective.free
    moving = np.flatnonzero(np.arange(free.size) != fixed)
    low, high = free.low[moving], free.high[moving]

    def with_moved(values: np.ndarray) -> np.ndarray:
        inner = start.copy()
        inner[moving] = values
        return inner

    optimum = least_squares(
        lambda values: objective.residuals(with_moved(values)),
        np.clip(start[moving], low + 1e-9 * (high - low), high - 1e-9 * (high - low)),
        lambda values: objective.jacobian(with_moved(values))[:, moving],
        (low, high), method="trf", ftol=1e-3, xtol=variables, gtol=1e-8, max_nfev=most,
        x_scale=np.where(free.logarithmic[moving], 1.0, high - low),
    )  # fmt: skip
    return with_moved(optimum.x)


def _screened(
    likelihood: Likelihood | Joint, free: FreeEntries, starts: int, seed: int, neighbourhood: float
) -> list[np.ndarray]:
    """The scene's own values, and the most likely of quasi-random points around them."""
    scene = np.clip(free.start, free.low, free.high)
    low = np.where(free.logarithmic, np.maximum(free.low, scene - neighbourhood), free.low)
    high = np.where(free.logarithmic, np.minimum(free.high, scene + neighbourhood), free.high)
    points = qmc.scale(qmc.Sobol(free.size, seed=seed).random(starts), low, high) if starts else np.zeros((0, 1))
    coarse = Objective(likelihood, free, COARSE.values)
    return [scene, *sorted(points, key=lambda point: -coarse.value(point))[: _FOLLOWED - 1]]


def _apart(objective: Objective, first: Optimum, other: Optimum) -> bool:
    """True if the likelihood halfway between two maxima is lower than at either."""
    between = objective.value((first.inner + other.inner) / 2)
    return between < min(first.value, other.value) - _DIP
