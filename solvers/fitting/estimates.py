"""The numbers of a fit: estimates, rows and remarks, as pictures and reports show them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..scene.scene import Scene
from .free_entries import FreeEntries, in_unit, interval
from .likelihood import KNEE
from .measurements import Measurements
from .optimise import Objective

CONTRADICTED = (
    "At least half of the impacts contradict the model: no entry is identified. The estimates are the least bad ones, "
    "and the intervals say only which values are as bad."
)
"""The first remark where `RowDiagnostics.contradicted`."""


@dataclass(frozen=True)
class Estimate:
    """An entry: the most likely value, its 95 % interval (None: an open end), SI, and the verdict."""

    value: float
    low: float | None
    high: float | None
    verdict: str


@dataclass(frozen=True)
class RowDiagnostics:
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


@dataclass(frozen=True)
class Fitted:
    """What a fit has found.

    Attributes:
        scene: with the most likely values.
        first: the scene that was fitted.
        estimates: by dotted name.
        log_likelihood: maximum, with all constants of the densities; priors are not part of it.
        correlation: of the estimates in the variables of the search, (entries, entries).
        combinations: sentences on products of powers that the data tell.
        remarks: sentences on defaults, contradictions, and what the data lack.
        quadrature: change of the log-likelihood with twice as fine integrals.
        others: values of less likely separate maxima, with their log-likelihoods.
        ends: of each entry's interval below and above, all entries in the variables of the search.
    """

    scene: Scene
    first: Scene
    data: Measurements
    estimates: Mapping[str, Estimate]
    log_likelihood: float
    correlation: np.ndarray
    combinations: tuple[str, ...]
    remarks: tuple[str, ...]
    rows: RowDiagnostics
    quadrature: float
    others: tuple[tuple[Mapping[str, float], float], ...]
    objective: Objective = field(repr=False, compare=False)
    ends: tuple[tuple[np.ndarray, np.ndarray], ...] = field(repr=False, compare=False)

    @property
    def points(self) -> int:
        """Number of impacts."""
        return self.data.size

    @property
    def free(self) -> FreeEntries:
        return self.objective.free

    @cached_property
    def best(self) -> np.ndarray:
        """The estimates in the variables of the search."""
        return np.array([each.inner(self.estimates[each.name].value) for each in self.free.entries])

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Head and rows of the table of estimates."""
        rows = [
            [name, in_unit(self.first, name, one.value), interval(self.first, name, one.low, one.high), one.verdict]
            for name, one in self.estimates.items()
        ]
        return ["entry", "estimate", "95 % interval", "verdict"], rows
