"""Adaptive fit of a function on the unit square by a tree of tensor Chebyshev series."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .series import Forest, chebyshev, nodes, transform

Sample = Callable[[np.ndarray], np.ndarray]
"""Points (n x 2: x and z) -> values at all nodes of t (n x t x results), NaN where there is none."""

_CORNER = 1e-4  # distance of checks from the edges of a patch


class Coarse(Exception):
    """The nodes of t do not resolve the function; the message says what."""


class Unresolved(Exception):
    """A function is not resolved by the smallest patches; `place` is a point (x, z)."""

    def __init__(self, place: np.ndarray, reason: str) -> None:
        super().__init__(reason)
        self.place = place


@dataclass(frozen=True)
class Order:
    """How a function is fitted.

    Arguments:
        count: coefficients of a patch in x and z before truncation; 1 where the function does not depend on one.
        tolerance: largest error, times the magnitude of a result where that is above 1.
        most: largest number of patches.
        checks: collisions inside each patch that have to agree.
        depth: largest number of divisions.
    """

    count: tuple[int, int]
    tolerance: float
    most: int = 2000
    checks: int = 12
    depth: int = 44


def fit(forest: Forest, sample: Sample, order: Order, seed: int = 0) -> int:
    """Add the tree of a function to a forest; returns its root.

    Raises:
        Coarse: the series in t does not converge.
        Unresolved: there would be too many patches.
    """
    root = forest.node()
    waiting = [(root, np.zeros(2), np.ones(2), 0)]
    random = np.random.default_rng(20121 + seed)
    at = np.stack(np.meshgrid(*(nodes(n) for n in order.count), indexing="ij"), axis=-1).reshape(-1, 2)
    patches = 0
    while waiting:
        patches += len(waiting)
        if patches > order.most:
            node, low, wide, _ = max(waiting, key=lambda one: one[3])
            raise Unresolved(low + 0.5 * wide, f"more than {order.most} patches would be needed")
        inside = _checks(random, len(waiting), order.checks)
        points = np.concatenate([np.broadcast_to(at, (len(waiting), *at.shape)), inside], axis=1)
        corner = np.array([low for _, low, _, _ in waiting])[:, None]
        size = np.array([wide for _, _, wide, _ in waiting])[:, None]
        samples = sample((corner + points * size).reshape(-1, 2))
        samples = samples.reshape(len(waiting), points.shape[1], *samples.shape[1:])
        following = []
        for (node, low, wide, depth), values, check_points in zip(waiting, samples, inside, strict=True):
            grid = values[: len(at)].reshape(*order.count, *values.shape[1:])
            series, errors = _series(grid)
            wrong = _disagreement(series, check_points, values[len(at) :])
            scale = order.tolerance * np.maximum(1.0, np.abs(series[:, 0, 0, 0]))
            tails = np.array([float(np.max(error / scale)) for error in errors])
            settled = bool(np.isfinite(grid).all()) and tails.max() <= 1 and wrong <= 1.5 * float(scale.max())
            if settled:
                forest.leaf(node, low, wide, truncated(series, 0.2 * scale))
                continue
            if tails[0] > 1 and tails[1:].max() <= 1:
                raise Coarse("a result")
            axis = _worst(tails[1:], wide, order.count)
            if depth >= order.depth or wide[axis] < 1e-9:
                raise Unresolved(low + 0.5 * wide, "collisions there follow no smooth law")
            half = wide.copy()
            half[axis] *= 0.5
            upper = low.copy()
            upper[axis] += half[axis]
            first, second = forest.divide(node, axis, float(upper[axis]))
            following += [(first, low, half, depth + 1), (second, upper, half, depth + 1)]
        waiting = following
    return root


def _checks(random: np.random.Generator, patches: int, count: int) -> np.ndarray:
    """Places of checks in each patch, denser towards its edges, where a series is least accurate, and its corners."""
    free = 0.5 - 0.5 * np.cos(np.pi * random.random((patches, count, 2)))
    corners = np.array([(x, z) for x in (_CORNER, 1 - _CORNER) for z in (_CORNER, 1 - _CORNER)])
    edges = np.where(random.random((patches, 4, 1)) < 0.5, _CORNER, 1 - _CORNER)
    along = (
        np.concatenate([edges[:, :2], free[:, :2, :1]], axis=2),
        np.concatenate([free[:, 2:4, :1], edges[:, 2:]], axis=2),
    )
    return np.concatenate([free, np.broadcast_to(corners, (patches, 4, 2)), *along], axis=1)


def _worst(tails: np.ndarray, wide: np.ndarray, count: tuple[int, int]) -> int:
    """The axis to divide."""
    if 1 in count:
        return 1 if count[0] == 1 else 0
    if not np.isfinite(tails).all():
        return int(wide[1] >= wide[0])
    return int(tails[1] >= tails[0])


def _series(grid: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Coefficients (results x t x x x z) of values (x x z x t x results), and tails in t, x and z (results each)."""
    n_x, n_z, n_t, _ = grid.shape
    series = np.einsum("ti,xj,zk,jkim->mtxz", transform(n_t), transform(n_x), transform(n_z), grid, optimize=True)
    size = np.abs(series)
    tails = []
    for axis, count in ((1, n_t), (2, n_x), (3, n_z)):
        last = np.take(size, [count - 2, count - 1], axis=axis) if count > 2 else 0 * size
        tails.append(last.sum(axis=(1, 2, 3)))
    return series, tails


def _disagreement(series: np.ndarray, at: np.ndarray, values: np.ndarray) -> float:
    """Largest difference of a series from values (n x t x results) at points in its patch; unknown values agree."""
    if not len(at):
        return 0.0
    n_t = series.shape[1]
    basis_t = chebyshev(2 * nodes(n_t) - 1, n_t)[0]
    basis_x, basis_z = (chebyshev(2 * at[:, k] - 1, series.shape[2 + k])[0] for k in (0, 1))
    series_values = np.einsum("mijk,ti,nj,nk->ntm", series, basis_t, basis_x, basis_z, optimize=True)
    return float(np.nan_to_num(np.abs(series_values - values), nan=0.0).max())


def truncated(series: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """The smallest block of coefficients that leaves out at most `allowed` of each result."""
    size = np.abs(series)
    kept = list(series.shape[1:])
    left = allowed.copy()
    while True:
        costs = []
        for axis in range(3):
            if kept[axis] > 1:
                block = size[:, : kept[0], : kept[1], : kept[2]]
                costs.append((np.take(block, -1, axis=axis + 1).sum(axis=(1, 2)), axis))
        fits = [(cost, axis) for cost, axis in costs if (cost <= left).all()]
        if not fits:
            return series[:, : kept[0], : kept[1], : kept[2]].copy()
        cost, axis = min(fits, key=lambda one: float(np.max(one[0])) * kept[one[1]])
        left = left - cost
        kept[axis] -= 1
