"""The most informative impacts: greedy choice and exchange among candidates, which are refined where they matter.

Information adds up over impacts, so a design is as good as a function of the sum of its impacts' matrices.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Evaluate = Callable[[np.ndarray], np.ndarray]
"""From points in the unit square (points, 2) to information (points, entries, entries)."""

_WIDE, _LEVELS = 3, 6  # levels of refinement about the most promising candidates, and in all
_PROMISING = 24  # candidates around which finer ones are tried, beside those of the design
_ROUNDS = 30
_CORRECTIONS = 12  # rounds of exchange and exact information
_GAIN = 1e-6  # least of the criterion that is worth an exchange
_LOSS = 3e-3  # of the criterion, that neighbours may cost by becoming one
_AROUND = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])


@dataclass(frozen=True)
class Criterion:
    """What is maximised.

    The logarithm of the information matrix's determinant, or that of the precision of entry `target` plus a part of the
    former. Without that part a design may leave the other entries open, wherever the target does not depend on them to
    first order; they are then so uncertain that first order is not enough.

    Attributes:
        target: an entry, or None for all.
        part: of the determinant's logarithm that counts beside the precision of `target`, by entry.
    """

    target: int | None
    part: float = 0.0

    def value(self, total: np.ndarray) -> np.ndarray:
        """Of sums of information (..., entries, entries), (...)."""
        values = np.linalg.slogdet(total)[1]
        if self.target is not None:
            precision = -np.log(np.linalg.inv(total)[..., self.target, self.target])
            values = precision + self.part * values / total.shape[-1]
        return np.asarray(values)

    def rate(self, total: np.ndarray, single: np.ndarray) -> np.ndarray:
        """Derivatives of the value by the weights of single impacts (impacts, entries, entries)."""
        inverse = np.linalg.inv(total)
        rates = np.einsum("ij,cji->c", inverse, single)
        if self.target is not None:
            row = inverse[self.target]
            rates = np.einsum("i,cij,j->c", row, single, row) / row[self.target] + self.part * rates / total.shape[-1]
        return np.asarray(rates)


@dataclass(frozen=True)
class Choice:
    """Chosen impacts.

    Attributes:
        points: (distinct impacts, 2), in the unit square.
        counts: how often each is repeated.
        candidates: number of them.
    """

    points: np.ndarray
    counts: np.ndarray
    candidates: int


def search(
    evaluate: Evaluate, before: np.ndarray, criterion: Criterion, size: int, first: np.ndarray, h: float,
    exact: Evaluate | None = None,
) -> Choice:  # fmt: skip
    """The best impacts among candidates, refined.

    Arguments:
        evaluate: information of impacts.
        before: (entries, entries), what is known already; not singular.
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.
        exact: `evaluate` with smaller errors, for impacts that are chosen: a candidate may be best by an error alone.
    """
    table = _Candidates(evaluate, exact or evaluate, criterion, before, first)
    near = 3 * h / 2**_WIDE
    chosen = table.exchanged(table.greedy(size))
    for level in range(_LEVELS):
        h /= 2
        promising = np.argsort(-table.rate(chosen))[: _PROMISING if level < _WIDE else 0]
        around = table.points[np.unique(np.concatenate([chosen, promising]))]
        table.add((around[:, None] + h * _AROUND * (np.ptp(first, axis=0) > 0)).reshape(-1, 2))
        chosen = table.exchanged(chosen)
    chosen = table.merged(chosen, near)
    distinct, counts = np.unique(chosen, return_counts=True)
    return Choice(table.points[distinct], counts, len(table.points))


class _Candidates:
    """Candidates, their information, and whether that is exact."""

    def __init__(
        self, evaluate: Evaluate, exact: Evaluate, criterion: Criterion, before: np.ndarray, points: np.ndarray
    ) -> None:
        self.evaluate, self.exact, self.criterion, self.before = evaluate, exact, criterion, before
        self.points, self.single = points, evaluate(points)
        self.is_exact = np.zeros(len(points), bool)

    def total(self, chosen: np.ndarray) -> np.ndarray:
        """The information of chosen candidates and of what was known before."""
        total: np.ndarray = self.before + self.single[chosen].sum(axis=0)
        return total

    def value(self, chosen: np.ndarray) -> float:
        return float(self.criterion.value(self.total(chosen)))

    def rate(self, chosen: np.ndarray) -> np.ndarray:
        return self.criterion.rate(self.total(chosen), self.single)

    def add(self, points: np.ndarray) -> None:
        """Add points that are not among the candidates, clipped to the unit square."""
        known = set(map(tuple, self.points.round(9).tolist()))
        new = np.array(sorted(set(map(tuple, np.clip(points, 0, 1).round(9).tolist())) - known)).reshape(-1, 2)
        if new.size:
            self.points = np.concatenate([self.points, new])
            self.single = np.concatenate([self.single, self.evaluate(new)])
            self.is_exact = np.concatenate([self.is_exact, np.zeros(len(new), bool)])

    def greedy(self, size: int) -> np.ndarray:
        """Candidates chosen one by one, each the best in addition to those before it."""
        total, chosen = self.before, []
        for _ in range(size):
            chosen.append(int(np.argmax(self.criterion.value(total + self.single))))
            total = total + self.single[chosen[-1]]
        return np.array(chosen)

    def exchanged(self, chosen: np.ndarray) -> np.ndarray:
        """The choice after Fedorov's exchange, repeated until the information of all its impacts is exact."""
        start = chosen
        for _ in range(_CORRECTIONS):
            chosen = self._exchange(chosen.copy())
            if self.is_exact[chosen].all():
                break
            which = np.unique(chosen)
            which = which[~self.is_exact[which]]
            self.single[which], self.is_exact[which] = self.exact(self.points[which]), True
        # an exchange for a candidate that was the best by its error may not be undone by single exchanges
        return start if self.is_exact[start].all() and self.value(start) > self.value(chosen) else chosen

    def _exchange(self, chosen: np.ndarray) -> np.ndarray:
        """Each impact is replaced by the best candidate, until none is better."""
        value = self.value(chosen)
        for _ in range(_ROUNDS):
            start = value
            for k in range(chosen.size):
                values = self.criterion.value(self.total(np.delete(chosen, k)) + self.single)
                best = int(np.argmax(values))
                if values[best] > value + _GAIN:
                    chosen[k], value = best, float(values[best])
            if value <= start + _GAIN:
                break
        return chosen

    def merged(self, chosen: np.ndarray, near: float) -> np.ndarray:
        """The choice with neighbours as repetitions of the more frequent, as far as that costs next to nothing."""
        distinct = np.unique(chosen)
        apart = np.abs(self.points[distinct][:, None] - self.points[distinct]).max(axis=-1)
        for pair in distinct[np.argwhere(np.triu(apart < near, 1))].tolist():
            gone, into = sorted(pair, key=lambda k: int((chosen == k).sum()))
            fewer = np.where(chosen == gone, into, chosen)
            if self.value(fewer) > self.value(chosen) - _LOSS:
                chosen = fewer
        return chosen
