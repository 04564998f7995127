"""The most informative impacts: greedy choice and exchange among candidates, which are refined where they matter.

Information adds up over impacts, so a design is as good as a function of the sum of its impacts' matrices.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

_WIDE, _LEVELS = 3, 6  # levels of refinement about the most promising candidates, and in all
_PROMISING = 24  # candidates around which finer ones are tried, beside those of the design
_ROUNDS = 30
_GAIN, _LOSS = 1e-6, 3e-3  # of that logarithm: least worth an exchange, and what neighbours may cost by becoming one
_AROUND = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])


def search(
    evaluate: Callable[[np.ndarray], np.ndarray], prior: np.ndarray, size: int, first: np.ndarray, h: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The impacts, among candidates that are refined, whose information has the largest determinant.

    Arguments:
        evaluate: from points in the unit square (points, 2) to information (points, entries, entries).
        prior: information without any impact, (entries, entries).
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.

    Returns:
        The chosen points, (distinct impacts, 2), by the second coordinate and the first; how often each is repeated;
        and the information of all candidates.
    """
    points, single, near = first.round(9), evaluate(first), 3 * h / 2**_WIDE

    def value(chosen: np.ndarray, more: np.ndarray | float = 0.0) -> Any:
        """The logarithm of the determinant, with each of some more impacts."""
        return np.linalg.slogdet(prior + single[chosen].sum(axis=0) + more)[1]

    def exchanged(chosen: np.ndarray) -> np.ndarray:
        """The choice after Fedorov's exchange: each impact is replaced by the best candidate, until none is better."""
        best, chosen = value(chosen), chosen.copy()
        for _ in range(_ROUNDS):
            start = best
            for k in range(size):
                values = value(np.delete(chosen, k), single)
                if values.max() > best + _GAIN:
                    chosen[k], best = np.argmax(values), float(values.max())
            if best <= start + _GAIN:
                break
        return chosen

    chosen = np.zeros(0, int)
    for _ in range(size):  # each the best in addition to those before it
        chosen = np.append(chosen, np.argmax(value(chosen, single)))
    chosen = exchanged(chosen)
    for level in range(_LEVELS):
        h /= 2
        promising = np.argsort(-value(chosen, single))[: _PROMISING if level < _WIDE else 0]
        around = points[np.unique(np.concatenate([chosen, promising]))]
        finer = (around[:, None] + h * _AROUND * (np.ptp(first, axis=0) > 0)).reshape(-1, 2)
        every, index = np.unique(np.vstack([points, finer.clip(0, 1).round(9)]), axis=0, return_index=True)
        new = every[index >= len(points)]
        if new.size:
            points, single = np.vstack([points, new]), np.concatenate([single, evaluate(new)])
            chosen = exchanged(chosen)
    distinct = np.unique(chosen)
    apart = np.abs(points[distinct][:, None] - points[distinct]).max(axis=-1)
    for pair in distinct[np.argwhere(np.triu(apart < near, 1))].tolist():  # neighbours become the more frequent
        gone, into = sorted(pair, key=lambda k: int((chosen == k).sum()))
        fewer = np.where(chosen == gone, into, chosen)
        chosen = fewer if value(fewer) > value(chosen) - _LOSS else chosen
    distinct, counts = np.unique(chosen, return_counts=True)
    order = np.lexsort(points[distinct].T)
    return points[distinct][order], counts[order], single
