"""What a fit minimises, in the variables of the search: a sum of squares, one term for each row and each prior.

The square of a row's residual is twice what its log-likelihood lacks to that of a perfect observation, so that least
squares are maximum likelihood, and Gauss-Newton's matrix is close to the information matrix.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .free_entries import FreeEntries
from .likelihood import Evaluation, Likelihood, Resolution

_LEAST = 1e-9


class Objective:
    """Residuals of a fit and their derivatives, with the last evaluations kept.

    Arguments:
        likelihood, free: of the same entries in the same order.
        resolution: of the integrals.
    """

    def __init__(self, likelihood: Likelihood, free: FreeEntries, resolution: Resolution) -> None:
        self.likelihood, self.free, self.resolution = likelihood, free, resolution
        self.evaluations = 0
        self.points: list[np.ndarray] = []  # all that were evaluated
        self.heights: list[float] = []  # `value` there
        self._last: dict[bytes, Evaluation | None] = {}

    def at(self, inner: np.ndarray) -> Evaluation | None:
        """The log-likelihoods; None where the scene is impossible."""
        key = inner.tobytes()
        if key not in self._last:
            while len(self._last) > 8:
                del self._last[next(iter(self._last))]
            self._last[key] = self.likelihood(self.free.values(inner), self.resolution)
            self.evaluations += 1
            self.points.append(inner.copy())
            self.heights.append(self.value(inner))
        return self._last[key]

    def residuals(self, inner: np.ndarray) -> np.ndarray:
        """One residual for each row and each prior; infinite where the scene is impossible."""
        found = self.at(inner)
        if found is None:
            return np.full(self.likelihood.data.size + self.free.size, np.inf)
        lack = np.maximum(2 * (self.likelihood.constant - found.rows), 0.0)
        return np.concatenate([np.sqrt(lack), self._priors(inner)[0]])

    def jacobian(self, inner: np.ndarray) -> np.ndarray:
        """Derivatives of the residuals by the variables of the search."""
        found = self.at(inner)
        assert found is not None
        root = np.sqrt(np.maximum(2 * (self.likelihood.constant - found.rows), 0.0))
        rates = self.free.rates(self.free.values(inner))
        with np.errstate(divide="ignore", invalid="ignore"):
            rows = np.where(root[:, None] > _LEAST, -found.scores * rates / root[:, None], 0.0)
        return np.vstack([rows, np.diag(self._priors(inner)[1])])

    def value(self, inner: np.ndarray) -> float:
        """The logarithm of likelihood times prior density, up to a constant; -inf where the scene is impossible."""
        found = self.at(inner)
        return -np.inf if found is None else found.value - float((self._priors(inner)[0] ** 2).sum()) / 2

    def gradient(self, inner: np.ndarray) -> np.ndarray:
        """Derivatives of `value`."""
        found = self.at(inner)
        assert found is not None
        misfits, slopes = self._priors(inner)
        gradient: np.ndarray = found.scores.sum(axis=0) * self.free.rates(self.free.values(inner)) - misfits * slopes
        return gradient

    def information(self, inner: np.ndarray) -> np.ndarray:
        """The information matrix of rows and priors in the variables of the search (Gauss-Newton)."""
        slopes = self.jacobian(inner)
        found: np.ndarray = slopes.T @ slopes
        return found

    def _priors(self, inner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        misfits, slopes = np.zeros(self.free.size), np.zeros(self.free.size)
        values = self.free.values(inner)
        rates = self.free.rates(values)
        for k, each in enumerate(self.free.entries):
            if each.prior is not None:
                misfits[k], slope = each.prior.misfit(float(values[k]))
                slopes[k] = slope * rates[k]
        return misfits, slopes


def whitening(objective: Objective, inner: np.ndarray) -> np.ndarray:
    """C with C C' the covariance at a maximum, where the data say nothing that of the range of the search."""
    free = objective.free
    information = objective.information(inner) + np.diag((2.0 / (free.high - free.low)) ** 2)
    values, vectors = np.linalg.eigh(information)
    found: np.ndarray = vectors / np.sqrt(np.maximum(values, 1e-12))
    return found


def walls(free: FreeEntries, at: np.ndarray, white: np.ndarray) -> list[dict[str, Any]]:
    """The bounds of the entries as constraints on z, at + C z."""
    low, high = free.low, free.high
    span = high - low
    return [
        {"type": "ineq", "fun": lambda z: (at + white @ z - low) / span, "jac": lambda _z: white / span[:, None]},
        {"type": "ineq", "fun": lambda z: (high - at - white @ z) / span, "jac": lambda _z: -white / span[:, None]},
    ]
