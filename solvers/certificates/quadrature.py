"""Integrals between the points of a grid, by Gauss-Legendre rules."""

from collections.abc import Callable

import numpy as np

_GAPS = 49  # number of gaps ahead at which the margin of a certificate is evaluated
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


def gaps_ahead(gap: float, end: float) -> np.ndarray:
    """Gaps from one to a larger one, denser at small distances."""
    return gap + (end - gap) * np.linspace(0.0, 1.0, _GAPS) ** 3


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
