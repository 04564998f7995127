"""Interpolation of results along the segments of a line, by Chebyshev polynomials.

The variable of the polynomials is one in which a square root at a change of outcome is smooth too.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

_Function = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class SegmentMap:
    """Place on a segment, from 0 to 1, as a function g of the variable in which results are interpolated.

    Attributes:
        kind: as of `Segments`.
        at_nodes: g at the nodes of the interpolation.
        at_points, rate, weight: g, g' and weights at the points of the quadrature.
        interpolate: (points, nodes), from values at the nodes to values at the points.
    """

    kind: int
    at_nodes: np.ndarray
    at_points: np.ndarray
    rate: np.ndarray
    weight: np.ndarray
    interpolate: np.ndarray


_MAPS: tuple[tuple[_Function, _Function], ...] = (  # g with a square at an end that is a change, and its derivative
    (lambda t: t, np.ones_like),
    (lambda t: t**2, lambda t: 2 * t),
    (lambda t: t * (2 - t), lambda t: 2 - 2 * t),
    (lambda t: t**2 * (3 - 2 * t), lambda t: 6 * t * (1 - t)),
)


def _chebyshev_nodes(count: int) -> np.ndarray:
    return np.asarray((1 - np.cos(np.pi * (np.arange(count) + 0.5) / count)) / 2)


@lru_cache(maxsize=64)
def segment_map(kind: int, nodes: int, points: int) -> SegmentMap:
    """The map of a segment whose lower end (1), upper end (2) or both (3) are changes."""
    t, s = _chebyshev_nodes(nodes), _chebyshev_nodes(points)
    angle, order = np.pi * (np.arange(points) + 0.5) / points, np.arange(1, points // 2 + 1)  # Fejer's first rule
    weight = 1 - 2 * (np.cos(2 * np.outer(angle, order)) / (4 * order**2 - 1)).sum(axis=1)
    g, rate = _MAPS[kind]
    chebyshev = np.polynomial.chebyshev.chebvander
    matrix = chebyshev(2 * s - 1, nodes - 1) @ np.linalg.inv(chebyshev(2 * t - 1, nodes - 1))
    return SegmentMap(kind, g(t), g(s), rate(s), weight / points, matrix)


@lru_cache(maxsize=256)
def extension(mask: tuple[bool, ...], degree: int) -> np.ndarray:
    """From values at some of the nodes to values at all of them, by a polynomial of this degree at most.

    Arguments:
        mask: which of the nodes have a value.
    """
    nodes, places = len(mask), np.flatnonzero(mask)
    basis = np.polynomial.chebyshev.chebvander(2 * _chebyshev_nodes(nodes) - 1, min(degree, places.size - 1))
    matrix = np.zeros((nodes, nodes))
    matrix[:, places] = basis @ np.linalg.pinv(basis[places])
    matrix[places] = np.eye(nodes)[places]
    return matrix
