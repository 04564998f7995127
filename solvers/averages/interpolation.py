"""Averages of many pairs of sizes by interpolation between fewer: Chebyshev series in the logarithms of the radii."""

from dataclasses import dataclass

import numpy as np

FINEST = 25
"""Nodes along an axis of the finest grid, whose points include those of the coarser ones."""
STEPS = (4, 2, 1)
"""Steps between the nodes of the grids, in those of the finest."""
CHECKS = 32
"""Pairs that are computed beside the nodes, and compared with the interpolation."""
_POINTS = -np.cos(np.pi * np.arange(FINEST) / (FINEST - 1))


def nodes(radii: np.ndarray) -> np.ndarray:
    """The radii of the finest grid of nodes."""
    low, high = np.log(radii.min()), np.log(radii.max())
    return np.asarray(np.exp(low + (high - low) * (1 + _POINTS) / 2))


@dataclass(frozen=True)
class Interpolation:
    """Interpolation from the nodes of a grid.

    Attributes:
        step: between its nodes, in those of the finest grid.
        axes: radii of the pairs that are asked for.
    """

    step: int
    axes: tuple[np.ndarray, ...]

    @property
    def which(self) -> np.ndarray:
        """Flat indices of the nodes in the finest grid."""
        along = np.arange(0, FINEST, self.step)
        return np.ravel_multi_index(np.meshgrid(*[along] * len(self.axes), indexing="ij"), [FINEST] * len(self.axes))

    def __call__(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The values of every pair, (pairs, columns), and the sum of the coefficients of the two highest degrees.

        Arguments:
            values: at the nodes, shaped as `which`, with the columns last.
        """
        points = _POINTS[:: self.step]
        degree = points.size - 1
        to_series = np.linalg.inv(np.polynomial.chebyshev.chebvander(points, degree))
        series = values
        for axis in range(len(self.axes)):
            series = np.moveaxis(np.tensordot(to_series, series, (1, axis)), 0, axis)
        highest = np.indices(series.shape[:-1]).max(axis=0) > degree - 2
        found = series
        for axis, radii in enumerate(self.axes):
            low, high = np.log(radii.min()), np.log(radii.max())
            at = np.polynomial.chebyshev.chebvander(2 * (np.log(radii) - low) / (high - low) - 1, degree)
            found = np.moveaxis(np.tensordot(at, found, (1, axis)), 0, axis)
        return found.reshape(-1, values.shape[-1]), np.abs(series[highest]).sum(axis=0)
