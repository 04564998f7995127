"""The regions of a plane: the outcomes between its curves."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .arcs import Arc


@dataclass(frozen=True)
class Slab:
    """A part of the window between two values of x in which no curve begins or ends.

    Attributes:
        low, high: range of x.
        arcs: the curves that cross it, from below to above.
        labels: outcomes between them, from the lower edge of the window to the upper.
    """

    low: float
    high: float
    arcs: tuple[Arc, ...]
    labels: tuple[int, ...]


def slabs(arcs: Sequence[Arc], column: np.ndarray, labels: np.ndarray) -> list[Slab]:
    """The slabs of the window, in the order of x.

    Arguments:
        arcs: arcs with x ascending, so that the right label is below and the left one above.
        column, labels: values of x and the outcomes there, which apply to slabs without curves.
    """
    ends = np.unique(np.concatenate([[0.0, 1.0], *([arc.points[[0, -1], 0] for arc in arcs])]))
    ends = ends[np.concatenate([[True], np.diff(ends) > 1e-12])]
    result = []
    for low, high in pairwise(ends.tolist()):
        middle = 0.5 * (low + high)
        crossing = [arc for arc in arcs if arc.points[0, 0] <= middle <= arc.points[-1, 0]]
        crossing.sort(key=lambda arc: float(np.interp(middle, arc.points[:, 0], arc.points[:, 1])))
        if crossing:
            between = [crossing[0].right, *(arc.left for arc in crossing)]
        else:
            between = [int(labels[int(np.argmin(np.abs(column - middle)))])]
        result.append(Slab(low, high, tuple(crossing), tuple(between)))
    return result


def labelled(parts: Sequence[Slab], points: np.ndarray) -> np.ndarray:
    """Labels of the regions at points (n x 2)."""
    labels = np.zeros(points.shape[0], dtype=int)
    which = np.searchsorted([slab.high for slab in parts], points[:, 0]).clip(0, len(parts) - 1)
    for k, slab in enumerate(parts):
        inside = np.flatnonzero(which == k)
        if not inside.size:
            continue
        x, y = points[inside, 0], points[inside, 1]
        heights = np.array([np.interp(x, arc.points[:, 0], arc.points[:, 1]) for arc in slab.arcs])
        below = (heights < y).sum(axis=0) if slab.arcs else np.zeros(inside.size, dtype=int)
        labels[inside] = np.array(slab.labels)[below]
    return labels


def apart(arcs: Sequence[Arc], points: np.ndarray) -> np.ndarray:
    """Distances in the window from points to the nearest curve."""
    distance = np.full(points.shape[0], np.inf)
    for arc in arcs:
        start, way = arc.points[:-1], np.diff(arc.points, axis=0)
        square = np.maximum((way**2).sum(axis=1), 1e-300)
        for k, point in enumerate(points):
            share = np.clip(((point - start) * way).sum(axis=1) / square, 0, 1)
            distance[k] = min(distance[k], float(np.min(np.linalg.norm(start + share[:, None] * way - point, axis=1))))
    return distance
