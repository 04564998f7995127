"""Integrals between the points of a grid, by Gauss-Legendre rules."""

from collections.abc import Callable

import numpy as np

_GAPS = 49  # number of gaps ahead at which the margin of a certificate is evaluated
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_FEW = [0, 2, 4, 6, 8, 10]  # of the nodes, whose own rule differs from that of all where a kink is between any two
_OF_FEW = np.linalg.solve(np.polynomial.legendre.legvander(_NODES[_FEW], 5).T, [2.0, *np.zeros(5)])
_SMOOTH, _ROUNDING = 1e-6, 1e-13  # differences of the rules that are passed over: relative to the panel, to the whole
_HALVINGS = 32


def gaps_ahead(gap: float, end: float) -> np.ndarray:
    """Gaps from one to a larger one, denser at small distances."""
    return gap + (end - gap) * np.linspace(0.0, 1.0, _GAPS) ** 3


def panels(integrand: Callable[[np.ndarray], np.ndarray], edges: np.ndarray) -> np.ndarray:
    """Integral over each panel between neighbouring edges; one with a kink or a jump is halved towards it.

    Arguments:
        integrand: takes a vector of points, returns its values there.
        edges: n + 1 points, rising or falling.

    Returns:
        n integrals, each from the panel's first edge to its second.
    """
    return _integrals(integrand, edges[:-1], edges[1:], _HALVINGS, 0.0)


def _integrals(
    integrand: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray, halvings: int, least: float
) -> np.ndarray:
    nodes = low + np.outer(_NODES + 1, high - low) / 2
    values = integrand(nodes.ravel()).reshape(nodes.shape)
    integrals: np.ndarray = (_WEIGHTS @ values) * (high - low) / 2
    apart, sizes = np.abs((_WEIGHTS @ values) - (_OF_FEW @ values[_FEW])), np.abs(values).max(axis=0)
    least = least or _ROUNDING * float(np.sum(sizes * np.abs(high - low)))
    rough = (apart > _SMOOTH * sizes) & (apart * np.abs(high - low) > least)
    if halvings and rough.any():
        first, last = low[rough], high[rough]
        middle = (first + last) / 2
        halves = _integrals(integrand, np.append(first, middle), np.append(middle, last), halvings - 1, least)
        integrals[rough] = halves.reshape(2, -1).sum(axis=0)
    return integrals
