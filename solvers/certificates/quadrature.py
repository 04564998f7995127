"""Integrals between the points of a grid, by Gauss-Legendre rules."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


def panels(integrand: Callable[[np.ndarray], np.ndarray], edges: np.ndarray) -> np.ndarray:
    """Integral over each panel between neighbouring edges.

    Arguments:
        integrand: takes a vector of points, returns its values there.
        edges: n + 1 points, rising or falling.

    Returns:
        n integrals, each from the panel's first edge to its second.
    """
    low, high = edges[:-1], edges[1:]
    nodes = low + np.outer(_NODES + 1, high - low) / 2
    values = integrand(nodes.ravel()).reshape(nodes.shape)
    integrals: np.ndarray = (_WEIGHTS @ values) * (high - low) / 2
    return integrals
