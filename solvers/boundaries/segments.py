"""Changes of label along segments of the unit square, narrowed by batches of points.

A round computes points in every interval at whose ends the labels differ, and goes on with the parts whose ends do.
"""

from collections.abc import Callable

import numpy as np

Labels = Callable[[np.ndarray], np.ndarray]
"""Points (n x 2) of the unit square -> whole numbers, -1 where the label is not known."""

LOCATED = 2e-11  # width of the interval that brackets a change of label
_DOUBT = 1e-8  # largest width of an interval without known labels that still locates a change
_PARTS = 8  # divisions of an interval
_FIRST = np.geomspace(1e-6, 1.0, 13)  # distances from the centre that are tried first, relative to the reach
_ROUNDS = 25

Interval = tuple[float, float, int, int]
"""Ends along a segment, and the labels there."""


def changes_on(
    labels: Labels, low: np.ndarray, high: np.ndarray, ends: list[tuple[int, int]]
) -> list[list[tuple[list[float], int, int]]]:
    """All changes of label that show along segments: places, and the labels before and after.

    Arguments:
        low, high: ends of the segments (n x 2), and `ends`: their labels. Where labels between are unknown over more
            than rounding, they change to -1 and back.
    """
    length = np.linalg.norm(high - low, axis=1)
    at = length[:, None] * np.linspace(0, 1, _PARTS + 1)
    way = (high - low) / length[:, None]

    def whole(_: int, where: np.ndarray, seen: np.ndarray) -> list[Interval]:
        return _changes(where, seen)

    return [
        [((low[k] + 0.5 * (start + other) * way[k]).tolist(), *pair) for start, other, *pair in intervals]
        for k, intervals in enumerate(_narrowed(labels, low, way, at, np.array(ends), whole))
    ]


def crossings(
    labels: Labels, centre: np.ndarray, along: np.ndarray, reach: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Points of segments where label `low` changes to `high`, the nearest to each centre.

    Arguments:
        labels: function of points that returns their labels.
        centre, along: centres and unit directions of the segments (n x 2).
        reach: length of the segments to either side, clipped to the square.
        low, high: labels before and after (n).

    Returns:
        Points, n x 2; NaN where no two neighbouring points have these labels.
    """
    least, most = _inside(centre, along, reach)
    at = np.clip(reach[:, None] * np.concatenate([-_FIRST[::-1], [0.0], _FIRST]), least[:, None], most[:, None])
    pairs = list(zip(low.tolist(), high.tolist(), strict=True))

    def nearest(k: int, where: np.ndarray, seen: np.ndarray) -> list[Interval]:
        """The nearest interval with these labels; without one, the nearest in which a third may lie between them."""
        changes = sorted(_changes(where, seen), key=lambda span: abs(span[0] + span[1]))
        wanted = [span for span in changes if span[2:] == pairs[k]]
        return (wanted or [span for span in changes if span[2] == pairs[k][0] or span[3] == pairs[k][1]])[:1]

    ends = centre[:, None, :] + at[:, [0, -1], None] * along[:, None, :]
    labels_at_ends = labels(np.clip(ends.reshape(-1, 2), 0.0, 1.0)).reshape(-1, 2)
    result = np.full(centre.shape, np.nan)
    for k, intervals in enumerate(_narrowed(labels, centre, along, at, labels_at_ends, nearest)):
        for start, other, *pair in intervals:
            if tuple(pair) == pairs[k]:
                result[k] = centre[k] + 0.5 * (start + other) * along[k]
    return np.asarray(np.clip(result, 0.0, 1.0))


def _narrowed(
    labels: Labels,
    start: np.ndarray,
    way: np.ndarray,
    at: np.ndarray,
    ends: np.ndarray,
    chosen: Callable[[int, np.ndarray, np.ndarray], list[Interval]],
) -> list[list[Interval]]:
    """Intervals of each segment `start` + distance * `way` that locate changes, ascending.

    Arguments:
        at: distances of the first points, n x m, ascending.
        ends: labels of the first and last of these, n x 2. Labels of ends are never computed again: a collision that
            takes about all steps may be decided in one batch and not in another.
        chosen: the intervals to go on with, of a segment's index, distances and their labels.
    """
    result: list[list[Interval]] = [[] for _ in start]
    owner, open_ = np.arange(len(start)), list[Interval]()
    for turn in range(_ROUNDS):
        if not owner.size:
            break
        points = start[owner, None, :] + at[:, 1:-1, None] * way[owner, None, :]
        inner = labels(np.clip(points.reshape(-1, 2), 0.0, 1.0)).reshape(len(at), -1)
        seen = np.column_stack([ends[:, 0], inner, ends[:, 1]])
        owners, open_ = [], []
        for k, where, row in zip(owner.tolist(), at, seen, strict=True):
            for interval in chosen(k, where, row):
                wide = interval[1] - interval[0]
                unknown = not (row[1:-1] >= 0).any()
                if wide < LOCATED or min(interval[2:]) < 0 or (unknown and wide < _DOUBT):
                    result[k].append(interval)
                else:
                    owners.append(k)
                    open_.append(interval)
        owner, parts = np.array(owners, dtype=int), _PARTS + turn % 2  # others where all of a round are unknown
        at = np.array([np.linspace(low, other, parts + 1) for low, other, *_ in open_]).reshape(len(open_), parts + 1)
        ends = np.array([labels_at for _, _, *labels_at in open_], dtype=int).reshape(len(open_), 2)
    for k, (low, other, before, after) in zip(owner.tolist(), open_, strict=True):
        result[k] += [(low, low, before, -1), (other, other, -1, after)]
    return [sorted(intervals) for intervals in result]


def _changes(at: np.ndarray, seen: np.ndarray) -> list[Interval]:
    """Intervals between neighbouring known points, and the ends, whose labels differ."""
    mask = seen >= 0
    mask[[0, -1]] = True
    where, labels = at[mask].tolist(), seen[mask].tolist()
    change = np.flatnonzero(np.diff(labels)).tolist()
    return [(where[k], where[k + 1], labels[k], labels[k + 1]) for k in change]


def _inside(centre: np.ndarray, along: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The part of each segment that lies in the square."""
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([(0.0 - centre) / along, (1.0 - centre) / along])
    both = np.where(np.isnan(both), 0.0, both)
    flat = np.abs(along) < 1e-300
    least = np.where(flat, -np.inf, both.min(axis=0)).max(axis=1)
    most = np.where(flat, np.inf, both.max(axis=0)).min(axis=1)
    return np.minimum(np.maximum(least, -reach), 0.0), np.maximum(np.minimum(most, reach), 0.0)
