"""Changes of label along segments of the unit square, enclosed together (`boundaries.brackets`)."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .brackets import Brackets, enclose

Labels = Callable[[np.ndarray], np.ndarray]
"""Points (n x 2) of the unit square -> whole numbers, -1 where the label is not known."""

LOCATED = 2e-11  # width of the interval that brackets a change of label
_DOUBT = 1e-8  # largest width of an interval without known labels that still locates a change
_SAMPLES = 7  # of a segment in a round
_FIRST = np.geomspace(1e-6, 1.0, 13)  # distances from the centre that are tried first, relative to the reach


@dataclass(frozen=True)
class _Segments:
    """Segments that begin at `start`, along unit directions `way` (n x 2)."""

    labels: Labels
    start: np.ndarray
    way: np.ndarray

    def at(self, line: np.ndarray, along: np.ndarray) -> np.ndarray:
        """Points at distances along segments."""
        return np.asarray(np.clip(self.start[line] + along[:, None] * self.way[line], 0.0, 1.0))

    def narrowed(self, changes: Brackets) -> Brackets:
        """The changes enclosed to `LOCATED`; those between a known and an unknown label stay as they are.

        Where labels between are unknown over more than rounding, they change to -1 and back. Labels of ends are never
        computed again: a collision that takes about all steps may be decided in one batch and not in another.
        """
        certain = np.minimum(changes.before, changes.after) >= 0
        count = _SAMPLES * int(certain.sum())
        some = changes.subset(certain)
        narrow = enclose(lambda *on: self.labels(self.at(*on)), some, LOCATED, at_once=count, unknown=-1)
        dark = 2 * narrow.error > _DOUBT
        edges, unknown = narrow.subset(dark), np.full(int(dark.sum()), -1)
        ends = replace(edges, high=edges.low, after=unknown), replace(edges, low=edges.high, before=unknown)
        return Brackets.joined([changes.subset(~certain), narrow.subset(~dark), *ends])


def changes_on(
    labels: Labels, low: np.ndarray, high: np.ndarray, ends: list[tuple[int, int]]
) -> list[list[tuple[list[float], int, int]]]:
    """All changes of label that show along segments: places, and the labels before and after.

    Arguments:
        low, high: ends of the segments (n x 2), and `ends`: their labels. Where labels between are unknown over more
            than rounding, they change to -1 and back.
    """
    length, line = np.linalg.norm(high - low, axis=1), np.arange(len(low))
    segments = _Segments(labels, low, (high - low) / length[:, None])
    changes = segments.narrowed(Brackets(line, np.zeros(line.size), length, *np.array(ends).T))
    result: list[list[tuple[list[float], int, int]]] = [[] for _ in line]
    columns = (changes.line, segments.at(changes.line, changes.place), changes.before, changes.after)
    for k, place, *pair in zip(*(column.tolist() for column in columns), strict=True):
        result[k].append((place, *pair))
    return result


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
    segments = _Segments(labels, centre, along)
    at = np.clip(reach[:, None] * np.concatenate([-_FIRST[::-1], [0.0], _FIRST]), least[:, None], most[:, None]).ravel()
    line = np.repeat(np.arange(len(centre)), 2 * _FIRST.size + 1)
    label = labels(segments.at(line, at))

    def nearest(changes: Brackets, third: bool) -> Brackets:
        """The nearest change with these labels; without one, the nearest in which a `third` may lie between them."""
        matches = np.stack([changes.before == low[changes.line], changes.after == high[changes.line]])
        exact = matches.all(axis=0)
        order = np.lexsort((np.abs(changes.place), ~exact, changes.line))
        order = order[np.asarray(matches.any(axis=0) if third else exact)[order]]
        return changes.subset(order[np.unique(changes.line[order], return_index=True)[1]])

    mask = label >= 0
    first = nearest(Brackets.between(line[mask], at[mask], label[mask]), True)
    change = nearest(segments.narrowed(first), False)
    result = np.full(centre.shape, np.nan)
    result[change.line] = segments.at(change.line, change.place)
    return result


def _inside(centre: np.ndarray, along: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The part of each segment that lies in the square."""
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([(0.0 - centre) / along, (1.0 - centre) / along])
    both = np.where(np.isnan(both), 0.0, both)
    flat = np.abs(along) < 1e-300
    least = np.where(flat, -np.inf, both.min(axis=0)).max(axis=1)
    most = np.where(flat, np.inf, both.max(axis=0)).min(axis=1)
    return np.minimum(np.maximum(least, -reach), 0.0), np.maximum(np.minimum(most, reach), 0.0)
