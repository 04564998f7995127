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
        share: of the determinant's logarithm that counts beside the precision of `target`, by entry.
    """

    target: int | None
    share: float = 0.0

    def __call__(self, total: np.ndarray) -> np.ndarray:
        """Of sums of information (..., entries, entries), (...)."""
        values = np.linalg.slogdet(total)[1]
        if self.target is not None:
            precision = -np.log(np.linalg.inv(total)[..., self.target, self.target])
            values = precision + self.share * values / total.shape[-1]
        return np.asarray(values)


@dataclass(frozen=True)
class Choice:
    """Chosen impacts.

    Attributes:
        points: (distinct impacts, 2), in the unit square.
        counts: how often each is repeated.
        single: information of all candidates, (candidates, entries, entries).
    """

    points: np.ndarray
    counts: np.ndarray
    single: np.ndarray


def search(
    evaluate: Evaluate, before: np.ndarray, criterion: Criterion, size: int, first: np.ndarray, h: float
) -> Choice:
    """The best impacts among candidates, refined.

    Arguments:
        evaluate: information of impacts.
        before: (entries, entries), what is known already; not singular.
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.
    """
    points, single = first.round(9), evaluate(first)
    chosen = np.zeros(0, int)
    for _ in range(size):  # each the best in addition to those before it
        chosen = np.append(chosen, np.argmax(criterion(before + single[chosen].sum(axis=0) + single)))
    chosen, near = _exchanged(chosen, criterion, before, single), 3 * h / 2**_WIDE
    for level in range(_LEVELS):
        h /= 2
        one_more = criterion(before + single[chosen].sum(axis=0) + single)
        promising = np.argsort(-one_more)[: _PROMISING if level < _WIDE else 0]
        around = points[np.unique(np.concatenate([chosen, promising]))]
        finer = (around[:, None] + h * _AROUND * (np.ptp(first, axis=0) > 0)).reshape(-1, 2)
        every, index = np.unique(np.vstack([points, finer.clip(0, 1).round(9)]), axis=0, return_index=True)
        new = every[index >= len(points)]
        if new.size:
            points, single = np.vstack([points, new]), np.concatenate([single, evaluate(new)])
            chosen = _exchanged(chosen, criterion, before, single)
    chosen = _merged(chosen, criterion, before, points, single, near)
    distinct, counts = np.unique(chosen, return_counts=True)
    return Choice(points[distinct], counts, single)


def _exchanged(chosen: np.ndarray, criterion: Criterion, before: np.ndarray, single: np.ndarray) -> np.ndarray:
    """The choice after Fedorov's exchange: each impact is replaced by the best candidate, until none is better."""
    chosen = chosen.copy()
    value = float(criterion(before + single[chosen].sum(axis=0)))
    for _ in range(_ROUNDS):
        start = value
        for k in range(chosen.size):
            values = criterion(before + single[np.delete(chosen, k)].sum(axis=0) + single)
            best = int(np.argmax(values))
            if values[best] > value + _GAIN:
                chosen[k], value = best, float(values[best])
        if value <= start + _GAIN:
            break
    return chosen


def _merged(
    chosen: np.ndarray, criterion: Criterion, before: np.ndarray, points: np.ndarray, single: np.ndarray, near: float
) -> np.ndarray:
    """The choice with neighbours as repetitions of the more frequent, as far as that costs next to nothing."""
    distinct = np.unique(chosen)
    apart = np.abs(points[distinct][:, None] - points[distinct]).max(axis=-1)
    for pair in distinct[np.argwhere(np.triu(apart < near, 1))].tolist():
        gone, into = sorted(pair, key=lambda k: int((chosen == k).sum()))
        fewer = np.where(chosen == gone, into, chosen)
        now, merged = (float(criterion(before + single[choice].sum(axis=0))) for choice in (chosen, fewer))
        if merged > now - _LOSS:
            chosen = fewer
    return chosen
