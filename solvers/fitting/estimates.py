"""Estimates and rows of a fit, and what is drawn and reported of one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ..scene.scene import Scene
from .free_entries import FreeEntries
from .likelihood import KNEE
from .measurements import Measurements
from .objective import Objective

CONTRADICTED = (
    "At least half of the impacts contradict the model: no entry is identified. The estimates are the least bad ones, "
    "and the intervals say only which values are as bad."
)
"""The first remark where `Rows.contradicted`."""


@dataclass(frozen=True)
class Estimate:
    """An entry: the most likely value, its 95 % interval (None: an open end), SI, and the verdict."""

    value: float
    low: float | None
    high: float | None
    verdict: str

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of an estimate."""
        return {"value": self.value, "low": self.low, "high": self.high, "verdict": self.verdict}


@dataclass(frozen=True)
class Rows:
    """The rows of the data under the estimates; arrays of one length, NaN where a row has no such number.

    Attributes:
        probability: of the observed outcome.
        expected: result -> its mean over the scatter, where the outcome is the observed one.
        residual: result -> what was measured less that, over the standard deviation of both.
        log_likelihood: of the row, relative to a perfect observation.
        pull: how far the estimates would move without the row, in standard errors, to first order.
    """

    probability: np.ndarray
    expected: Mapping[str, np.ndarray]
    residual: Mapping[str, np.ndarray]
    log_likelihood: np.ndarray
    pull: np.ndarray

    @property
    def contradicting(self) -> np.ndarray:
        """Indices of the rows that lie beyond what the scatter allows."""
        return np.flatnonzero(self.log_likelihood < -KNEE)

    @property
    def contradicted(self) -> bool:
        """Whether at least half of the rows contradict the model."""
        return 2 * self.contradicting.size >= self.log_likelihood.size


class Fitted(Protocol):
    """What pictures and reports show of a `Fit`."""

    @property
    def first(self) -> Scene: ...
    @property
    def data(self) -> Measurements: ...
    @property
    def estimates(self) -> Mapping[str, Estimate]: ...
    @property
    def rows(self) -> Rows: ...
    @property
    def correlation(self) -> np.ndarray: ...
    @property
    def combinations(self) -> tuple[str, ...]: ...
    @property
    def remarks(self) -> tuple[str, ...]: ...
    @property
    def log_likelihood(self) -> float: ...
    @property
    def quadrature(self) -> float: ...
    @property
    def points(self) -> int: ...
    @property
    def objective(self) -> Objective: ...
    @property
    def free(self) -> FreeEntries: ...
    @property
    def best(self) -> np.ndarray: ...
    @property
    def ends(self) -> tuple[tuple[np.ndarray, np.ndarray], ...]: ...
    def plot(self, path: str | Path | None = None) -> Any:
        """Draw it."""
