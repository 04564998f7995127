"""The impacts that tell most: greedy choice and exchange among candidates, which are refined where they matter.

Information adds up over impacts, so a design is as good as a function of the sum of its impacts' matrices. Both
functions used here are concave in that sum, which bounds how much better any other choice among the candidates can be.
"""

from __future__ import annotations

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
_TWO = 2.0


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
        if self.target is None:
            found = np.linalg.slogdet(total)[1]
        else:
            found = -np.log(np.linalg.inv(total)[..., self.target, self.target])
            found = found + self.part * np.linalg.slogdet(total)[1] / total.shape[-1]
        mean: np.ndarray = found.mean(axis=0)
        return mean

    def rate(self, total: np.ndarray, single: np.ndarray) -> np.ndarray:
        """Derivatives of the value by the weights of single impacts (draws, impacts, entries, entries)."""
        inverse = np.linalg.inv(total)
        if self.target is None:
            found = np.einsum("mij,mcji->mc", inverse, single)
        else:
            row = inverse[:, self.target]
            found = np.einsum("mi,mcij,mj->mc", row, single, row) / row[:, None, self.target]
            found += self.part * np.einsum("mij,mcji->mc", inverse, single) / total.shape[-1]
        mean: np.ndarray = found.mean(axis=0)
        return mean


@dataclass(frozen=True)
class Found:
    """A design.

    Attributes:
        points: (distinct impacts, 2), in the unit square.
        counts: how often each is repeated.
        information: (draws, entries, entries), of all of them and what was known before.
        value: of the criterion.
        bound: what `value` cannot exceed by any choice of as many impacts among the candidates; None where the
            information of what promises most is too uncertain.
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
) -> Found:  # fmt: skip
    """The best design that is found.

    Arguments:
        evaluate: information of impacts.
        before: (draws, entries, entries), what is known already; not singular.
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.
        exact: `evaluate` without its errors, for impacts that are chosen: what is best by an error is not.
    """
    exact = exact or evaluate
    table = _Table(first, evaluate(first), np.zeros(len(first), bool))
    chosen = table.best(criterion, before, _greedy(criterion, before, table.single, size), exact)
    moving = np.ptp(first, axis=0) > 0
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]) * moving
    for _ in range(_LEVELS):
        h /= _TWO
        rate = criterion.rate(before + table.single[:, chosen].sum(axis=1), table.single)
        around = np.unique(np.concatenate([chosen, np.argsort(-rate)[:_PROMISING]]))
        table.add((table.points[around][:, None] + h * steps).reshape(-1, 2), evaluate)
        chosen = table.best(criterion, before, chosen, exact)
    chosen = table.settled(criterion, before, chosen, exact)
    points, single = table.points, table.single
    total = before + single[:, chosen].sum(axis=1)
    rate = criterion.rate(total, single)
    bound = None
    if table.sure[np.argmax(rate)]:
        bound = float(criterion.value(total)) + size * float(rate.max()) - float(rate[chosen].sum())
    distinct, counts = np.unique(chosen, return_counts=True)
    places, total = _moved(exact, criterion, total, points[distinct], single[:, distinct], counts, h * moving)
    places, counts, total = _merged(exact, criterion, before, total, places, counts, 3 * h)
    value = float(criterion.value(total))
    return Found(places, counts, total, value, None if bound is None else max(bound, value), len(points))


@dataclass
class _Table:
    """Candidates, their information, and whether that is exact."""

    points: np.ndarray
    single: np.ndarray
    sure: np.ndarray

    def add(self, points: np.ndarray, evaluate: Evaluate) -> None:
        """Add points that are not among the candidates, clipped to the unit square."""
        known = {tuple(each) for each in self.points.round(9).tolist()}
        new = np.unique(np.clip(points, 0, 1).round(9), axis=0)
        new = np.array([each for each in new.tolist() if tuple(each) not in known]).reshape(-1, 2)
        if new.size:
            self.points = np.concatenate([self.points, new])
            self.single = np.concatenate([self.single, evaluate(new)], axis=1)
            self.sure = np.concatenate([self.sure, np.zeros(len(new), bool)])

    def best(self, criterion: Criterion, before: np.ndarray, chosen: np.ndarray, exact: Evaluate) -> np.ndarray:
        """The exchanged design, of impacts whose information is exact."""
        for _ in range(_CORRECTIONS):
            chosen = _exchanged(criterion, before, self.single, chosen)
            unsure = np.unique(chosen[~self.sure[chosen]])
            if not unsure.size:
                break
            self.single[:, unsure], self.sure[unsure] = exact(self.points[unsure]), True
        return chosen

    def settled(self, criterion: Criterion, before: np.ndarray, chosen: np.ndarray, exact: Evaluate) -> np.ndarray:
        """The same, after the candidates that promise most have been made exact, on which the bound depends."""
        for _ in range(_CORRECTIONS):
            rate = criterion.rate(before + self.single[:, chosen].sum(axis=1), self.single)
            top = np.argsort(-rate)[:_TOP]
            if self.sure[top[0]]:
                break
            unsure = top[~self.sure[top]]
            self.single[:, unsure], self.sure[unsure] = exact(self.points[unsure]), True
            chosen = self.best(criterion, before, chosen, exact)
        return chosen


def _greedy(criterion: Criterion, before: np.ndarray, single: np.ndarray, size: int) -> np.ndarray:
    """Candidates chosen one by one, each the best in addition to those before it."""
    total, chosen = before, []
    for _ in range(size):
        best = int(np.argmax(criterion.value(total[:, None] + single)))
        chosen.append(best)
        total = total + single[:, best]
    return np.array(chosen)


def _exchanged(criterion: Criterion, before: np.ndarray, single: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Fedorov's exchange: each impact is replaced by the best candidate, until none is better."""
    chosen = chosen.copy()
    value = float(criterion.value(before + single[:, chosen].sum(axis=1)))
    for _ in range(_ROUNDS):
        start = value
        for k in range(chosen.size):
            rest = before + single[:, np.delete(chosen, k)].sum(axis=1)
            values = criterion.value(rest[:, None] + single)
            best = int(np.argmax(values))
            if values[best] > value + _GAIN:
                chosen[k], value = best, float(values[best])
        if value <= start + _GAIN:
            break
    return chosen


def _moved(
    evaluate: Evaluate, criterion: Criterion, total: np.ndarray, points: np.ndarray, single: np.ndarray,
    counts: np.ndarray, h: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """The design's points moved continuously, one after the other; and its information."""
    points = points.copy()
    free = np.flatnonzero(h > 0)
    for k in range(len(points)) if free.size else ():
        rest = total - counts[k] * single[:, k]

        def lack(at: np.ndarray, k: int = k, rest: np.ndarray = rest) -> float:
            place = points[k].copy()
            place[free] = at
            return -float(criterion.value(rest + counts[k] * evaluate(place[None])[:, 0]))

        start = points[k][free]
        corners = np.vstack([start, start + np.diag(np.where(start < 0.5, 1, -1) * h[free])])
        found = minimize(
            lack, start, method="Nelder-Mead", bounds=[(0, 1)] * free.size,
            options={"maxfev": _STEPS, "initial_simplex": corners},
        )  # fmt: skip
        if -found.fun > criterion.value(total):
            points[k, free] = found.x
            total = rest + counts[k] * evaluate(points[k][None])[:, 0]
    return points, total


def _merged(
    evaluate: Evaluate, criterion: Criterion, before: np.ndarray, total: np.ndarray, points: np.ndarray,
    counts: np.ndarray, near: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """The design with neighbours as repetitions of one impact, as far as that costs next to nothing."""
    apart = np.abs(points[:, None] - points).max(axis=-1)
    for one, other in np.argwhere(np.triu(apart < near, 1)).tolist():
        into, gone = (one, other) if counts[one] >= counts[other] else (other, one)
        if counts[one] and counts[other]:
            fewer = counts.copy()
            fewer[into], fewer[gone] = counts[into] + counts[gone], 0
            kept = np.flatnonzero(fewer)
            again = before + np.einsum("c,mcij->mij", fewer[kept], evaluate(points[kept]))
            if criterion.value(again) > criterion.value(total) - _LOSS:
                counts, total = fewer, again
    kept = np.flatnonzero(counts)
    return points[kept], counts[kept], total
