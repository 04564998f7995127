"""The most informative impacts: greedy choice and exchange among candidates, which are refined where they matter.

Information adds up over impacts, so a design is as good as a function of the sum of its impacts' matrices.
"""

from collections.abc import Callable

import numpy as np

_WIDE, _LEVELS = 3, 6  # levels of refinement about the most promising candidates, and in all
_PROMISING = 24  # candidates around which finer ones are tried, beside those of the design
_ROUNDS = 30
_GAIN, _LOSS = 1e-6, 3e-3  # of the criterion: least that is worth an exchange, and that neighbours cost by becoming one
_AROUND = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)])


def worth(total: np.ndarray, target: int | None = None, share: float = 0.0) -> np.ndarray:
    """What is maximised, of information (..., entries, entries): the logarithm of its determinant.

    With a target the logarithm of that entry's precision, and a share of the former, by entry. Without it a design may
    leave the other entries open, where the target does not depend on them to first order; they are then so uncertain
    that first order is not enough.
    """
    values = np.linalg.slogdet(total)[1]
    if target is not None:
        values = share * values / total.shape[-1] - np.log(np.linalg.inv(total)[..., target, target])
    return np.asarray(values)


def search(
    evaluate: Callable[[np.ndarray], np.ndarray], criterion: Callable[[np.ndarray], np.ndarray], size: int,
    first: np.ndarray, h: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """The best impacts among candidates, refined.

    Arguments:
        evaluate: from points in the unit square (points, 2) to information (points, entries, entries).
        criterion: of the sum of the impacts' information.
        size: number of impacts.
        first: (candidates, 2), the candidates to begin with.
        h: their spacing; it is halved at every level.

    Returns:
        The chosen points, (distinct impacts, 2), by the second coordinate and the first; how often each is repeated;
        and the information of all candidates.
    """
    points, single, near = first.round(9), evaluate(first), 3 * h / 2**_WIDE

    def value(chosen: np.ndarray) -> float:
        return float(criterion(single[chosen].sum(axis=0)))

    def with_each(chosen: np.ndarray) -> np.ndarray:
        return criterion(single[chosen].sum(axis=0) + single)

    def exchanged(chosen: np.ndarray) -> np.ndarray:
        """The choice after Fedorov's exchange: each impact is replaced by the best candidate, until none is better."""
        best, chosen = value(chosen), chosen.copy()
        for _ in range(_ROUNDS):
            start = best
            for k in range(size):
                values = with_each(np.delete(chosen, k))
                if values.max() > best + _GAIN:
                    chosen[k], best = np.argmax(values), float(values.max())
            if best <= start + _GAIN:
                break
        return chosen

    chosen = np.zeros(0, int)
    for _ in range(size):  # each the best in addition to those before it
        chosen = np.append(chosen, np.argmax(with_each(chosen)))
    chosen = exchanged(chosen)
    for level in range(_LEVELS):
        h /= 2
        promising = np.argsort(-with_each(chosen))[: _PROMISING if level < _WIDE else 0]
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
