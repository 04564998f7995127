"""The most informative impacts: greedy choice and exchange among candidates, which are refined where they matter.

Information adds up over impacts, so a design is as good as a function of the sum of its impacts' matrices. Both
functions used here are concave in that sum, which bounds how much better any other choice among the candidates can be.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

Evaluate = Callable[[np.ndarray], np.ndarray]
"""From points in the unit square (points, 2) to information (draws, points, entries, entries)."""

_LEVELS = 3  # of refinement of the candidates
_PROMISING = 24  # candidates around which finer ones are tried, beside those of the design
_ROUNDS = 30
_TOP = 16  # candidates that are made exact at once
_CORRECTIONS = 12  # rounds of exchange and exact information
_GAIN = 1e-6  # least of the criterion that is worth an exchange
_LOSS = 3e-3  # of the criterion, that neighbours may cost by becoming one
_STEPS = 24  # evaluations of the continuous refinement of a point


@dataclass(frozen=True)
class Criterion:
    """What is maximised, as a mean over draws of the entries' values.

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
        """Of sums of information (draws, ..., entries, entries), (...)."""
        values = np.linalg.slogdet(total)[1]
        if self.target is not None:
            precision = -np.log(np.linalg.inv(total)[..., self.target, self.target])
            values = precision + self.part * values / total.shape[-1]
        mean: np.ndarray = values.mean(axis=0)
        return mean

    def rate(self, total: np.ndarray, single: np.ndarray) -> np.ndarray:
        """Derivatives of the value by the weights of single impacts (draws, impacts, entries, entries)."""
        inverse = np.linalg.inv(total)
        rates = np.einsum("mij,mcji->mc", inverse, single)
        if self.target is not None:
            row = inverse[:, self.target]
            of_target = np.einsum("mi,mcij,mj->mc", row, single, row) / row[:, None, self.target]
            rates = of_target + self.part * rates / total.shape[-1]
        mean: np.ndarray = rates.mean(axis=0)
        return mean


@dataclass(frozen=True)
class Choice:
    """Chosen impacts.

    Attributes:
        points: (distinct impacts, 2), in the unit square.
        counts: how often each is repeated.
        information: (draws, entries, entries), of all of them and what was known before.
        value: of the criterion.
        bound: what `value` cannot exceed by any choice of as many impacts among the candidates; None where the
            information of the most promising candidate is too uncertain.
        candidates: number of them.
    """

    points: np.ndarray
    counts: np.ndarray
    information: np.ndarray
    value: float
    bound: float | None
    candidates: int


def search(
    evaluate: Evaluate, before: np.ndarray, criterion: Criterion, size: int, first: np.ndarray, h: float,
    exact: Evaluate | None = None,
) -> Choice:  # fmt: skip
    """The best impacts among candidates, refined.

    Arguments:
        evaluate: information of impacts.
        before: (draws, entries, entries), what is known already; not singular.
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.
        exact: `evaluate` with smaller errors, for impacts that are chosen: a candidate may be best by an error alone.
    """
    table = _Candidates(evaluate, exact or evaluate, criterion, before, first)
    moving = np.ptp(first, axis=0) > 0
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]) * moving
    chosen = table.exchanged(table.greedy(size))
    for _ in range(_LEVELS):
        h /= 2
        around = np.unique(np.concatenate([chosen, np.argsort(-table.rate(chosen))[:_PROMISING]]))
        table.add((table.points[around][:, None] + h * steps).reshape(-1, 2))
        chosen = table.exchanged(chosen)
    chosen = table.settled(chosen)
    total, rate, bound = table.total(chosen), table.rate(chosen), None
    if table.is_exact[np.argmax(rate)]:
        bound = float(criterion.value(total)) + size * float(rate.max()) - float(rate[chosen].sum())
    distinct, counts = np.unique(chosen, return_counts=True)
    points, total = table.moved(distinct, counts, total, h * moving)
    points, counts, total = table.merged(points, counts, total, 3 * h)
    value = float(criterion.value(total))
    return Choice(points, counts, total, value, None if bound is None else max(bound, value), len(table.points))


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
        total: np.ndarray = self.before + self.single[:, chosen].sum(axis=1)
        return total

    def rate(self, chosen: np.ndarray) -> np.ndarray:
        return self.criterion.rate(self.total(chosen), self.single)

    def add(self, points: np.ndarray) -> None:
        """Add points that are not among the candidates, clipped to the unit square."""
        known = {tuple(each) for each in self.points.round(9).tolist()}
        new = np.unique(np.clip(points, 0, 1).round(9), axis=0)
        new = np.array([each for each in new.tolist() if tuple(each) not in known]).reshape(-1, 2)
        if new.size:
            self.points = np.concatenate([self.points, new])
            self.single = np.concatenate([self.single, self.evaluate(new)], axis=1)
            self.is_exact = np.concatenate([self.is_exact, np.zeros(len(new), bool)])

    def _make_exact(self, which: np.ndarray) -> bool:
        """Compute the exact information of those that have not got it; False if there is none."""
        which = np.unique(which[~self.is_exact[which]])
        if which.size:
            self.single[:, which], self.is_exact[which] = self.exact(self.points[which]), True
        return bool(which.size)

    def greedy(self, size: int) -> np.ndarray:
        """Candidates chosen one by one, each the best in addition to those before it."""
        total, chosen = self.before, []
        for _ in range(size):
            best = int(np.argmax(self.criterion.value(total[:, None] + self.single)))
            chosen.append(best)
            total = total + self.single[:, best]
        return np.array(chosen)

    def exchanged(self, chosen: np.ndarray) -> np.ndarray:
        """The choice after Fedorov's exchange, repeated until the information of all its impacts is exact."""
        for _ in range(_CORRECTIONS):
            chosen = self._exchange(chosen.copy())
            if not self._make_exact(chosen):
                break
        return chosen

    def _exchange(self, chosen: np.ndarray) -> np.ndarray:
        """Each impact is replaced by the best candidate, until none is better."""
        value = float(self.criterion.value(self.total(chosen)))
        for _ in range(_ROUNDS):
            start = value
            for k in range(chosen.size):
                values = self.criterion.value(self.total(np.delete(chosen, k))[:, None] + self.single)
                best = int(np.argmax(values))
                if values[best] > value + _GAIN:
                    chosen[k], value = best, float(values[best])
            if value <= start + _GAIN:
                break
        return chosen

    def settled(self, chosen: np.ndarray) -> np.ndarray:
        """The choice after the most promising candidates, on which the bound depends, have exact information."""
        for _ in range(_CORRECTIONS):
            top = np.argsort(-self.rate(chosen))[:_TOP]
            if self.is_exact[top[0]]:
                break
            self._make_exact(top)
            chosen = self.exchanged(chosen)
        return chosen

    def moved(
        self, distinct: np.ndarray, counts: np.ndarray, total: np.ndarray, h: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The points of distinct impacts, each moved continuously to where it is best; and the information of all."""
        points = self.points[distinct].copy()
        free = np.flatnonzero(h > 0)
        for k in range(len(points)) if free.size else ():
            rest = total - counts[k] * self.single[:, distinct[k]]

            def with_point(at: np.ndarray, k: int = k, rest: np.ndarray = rest) -> np.ndarray:
                place = points[k].copy()
                place[free] = at
                information: np.ndarray = rest + counts[k] * self.exact(place[None])[:, 0]
                return information

            start = points[k][free]
            corners = np.vstack([start, start + np.diag(np.where(start < 0.5, 1, -1) * h[free])])
            best = minimize(
                lambda at, information=with_point: -float(self.criterion.value(information(at))), start,
                method="Nelder-Mead", bounds=[(0, 1)] * free.size,
                options={"maxfev": _STEPS, "initial_simplex": corners},
            )  # fmt: skip
            if -best.fun > self.criterion.value(total):
                total = with_point(best.x)
                points[k, free] = best.x
        return points, total

    def merged(
        self, points: np.ndarray, counts: np.ndarray, total: np.ndarray, near: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The impacts with neighbours as repetitions of one, as far as that costs next to nothing."""
        apart = np.abs(points[:, None] - points).max(axis=-1)
        for one, other in np.argwhere(np.triu(apart < near, 1)).tolist():
            into, gone = (one, other) if counts[one] >= counts[other] else (other, one)
            if counts[one] and counts[other]:
                fewer = counts.copy()
                fewer[into], fewer[gone] = counts[into] + counts[gone], 0
                kept = np.flatnonzero(fewer)
                again = self.before + np.einsum("c,mcij->mij", fewer[kept], self.exact(points[kept]))
                if self.criterion.value(again) > self.criterion.value(total) - _LOSS:
                    counts, total = fewer, again
        kept = np.flatnonzero(counts)
        return points[kept], counts[kept], total
