"""Interpolation of results on a segment between changes of outcome, and the quadrature over it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np


@dataclass(frozen=True)
class SegmentMap:
    """Place on a segment, from 0 to 1, as a function g of the variable in which results are interpolated.

    Attributes:
        at_nodes: g at the nodes of the interpolation.
        at_points, rate, weight: g, g' and weights at the points of the quadrature.
        interpolate: (points, nodes), from values at the nodes to values at the points.
    """

    at_nodes: np.ndarray
    at_points: np.ndarray
    rate: np.ndarray
    weight: np.ndarray
    interpolate: np.ndarray


Function = Callable[[np.ndarray], np.ndarray]
_MAPS: tuple[tuple[Function, Function], ...] = (  # g, and its derivative
    (lambda t: t, np.ones_like),
    (lambda t: t**2, lambda t: 2 * t),
    (lambda t: t * (2 - t), lambda t: 2 - 2 * t),
    (lambda t: t**2 * (3 - 2 * t), lambda t: 6 * t * (1 - t)),
)


@lru_cache(maxsize=16)
def _fejer(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Fejer's first rule on 0 to 1."""
    angle = np.pi * (np.arange(count) + 0.5) / count
    order = np.arange(1, count // 2 + 1)
    weight = 1 - 2 * (np.cos(2 * np.outer(angle, order)) / (4 * order**2 - 1)).sum(axis=1)
    return (1 - np.cos(angle)) / 2, weight / count


@lru_cache(maxsize=64)
def segment_map(kind: int, nodes: int, points: int) -> SegmentMap:
    """The map of a segment whose lower end (1), upper end (2) or both (3) are changes."""
    t = (1 - np.cos(np.pi * (np.arange(nodes) + 0.5) / nodes)) / 2
    s, w = _fejer(points)
    g, rate = _MAPS[kind]
    basis = np.polynomial.chebyshev.chebvander(2 * t - 1, nodes - 1)
    matrix = np.polynomial.chebyshev.chebvander(2 * s - 1, nodes - 1) @ np.linalg.inv(basis)
    return SegmentMap(g(t), g(s), rate(s), w, matrix)


@lru_cache(maxsize=256)
def extension(known: tuple[bool, ...], degree: int) -> np.ndarray:
    """From values at some of the nodes to values at all of them, by a polynomial of this degree at most.

    Arguments:
        known: which of the nodes have a value.
    """
    nodes, kept = len(known), np.flatnonzero(known)
    t = (1 - np.cos(np.pi * (np.arange(nodes) + 0.5) / nodes)) / 2
    basis = np.polynomial.chebyshev.chebvander(2 * t - 1, min(degree, kept.size - 1))
    found = np.zeros((nodes, nodes))
    found[:, kept] = basis @ np.linalg.pinv(basis[kept])
    found[kept] = np.eye(nodes)[kept]
    return found
