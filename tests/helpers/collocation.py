"""Stiff equations: Radau IIA with ten stages, order 19, for states that are scaled to order one."""

from collections.abc import Callable, Iterator

import numpy as np

STAGES = 10
TOLERANCE = 1e-12  # of the last Legendre coefficient of the rates over a step
SMALLEST = 1e-3  # a component below this is judged as if it were as large
Function = Callable[[np.ndarray], np.ndarray]


def _nodes() -> np.ndarray:
    """Radau's points on (0, 1], the last of which is 1: zeros of P_s - P_(s-1)."""
    both = np.zeros(STAGES + 1)
    both[STAGES], both[STAGES - 1] = 1.0, -1.0
    found = np.sort(np.polynomial.legendre.legroots(both).real)
    for _ in range(3):
        slope = np.polynomial.legendre.legder(both)
        found -= np.polynomial.legendre.legval(found, both) / np.polynomial.legendre.legval(found, slope)
    return (1 + found) / 2


def _weights(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Matrix of the method, and what turns stage values into Legendre coefficients."""
    t = 2 * nodes - 1
    values = np.polynomial.legendre.legvander(t, STAGES - 1)
    to_coefficients = np.linalg.inv(values)
    integrals = np.empty_like(values)
    for k in range(STAGES):
        one = np.zeros(STAGES)
        one[k] = 1.0
        integrals[:, k] = np.polynomial.legendre.legval(t, np.polynomial.legendre.legint(one, lbnd=-1)) / 2
    return integrals @ to_coefficients, to_coefficients


NODES = _nodes()
MATRIX, TO_COEFFICIENTS = _weights(NODES)


def _jacobian(rates: Function, z: np.ndarray, here: np.ndarray) -> np.ndarray:
    found = np.empty((z.size, z.size))
    for k in range(z.size):
        step = 1e-7 * max(abs(z[k]), SMALLEST)
        moved = z.copy()
        moved[k] += step
        found[:, k] = (rates(moved) - here) / step
    return found


def _step(rates: Function, z: np.ndarray, h: float, slopes: np.ndarray) -> tuple[np.ndarray, float] | None:
    """State after h, and the error in tolerances; None where Newton's method fails."""
    n, weight = z.size, np.maximum(np.abs(z), SMALLEST)
    matrix = np.eye(STAGES * n) - h * np.kron(MATRIX, slopes)
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return None
    stages, last = np.tile(z, (STAGES, 1)), np.inf
    for _ in range(25):
        values = np.array([rates(each) for each in stages])
        if not np.abs(values).max() < 1e29:
            return None
        residual = z + h * MATRIX @ values - stages
        change = (inverse @ residual.ravel()).reshape(STAGES, n)
        stages = stages + change
        size = float((np.abs(change) / weight).max())
        if size < 1e-15 or (size < 1e-12 and size > 0.3 * last):
            break
        if size > 2 * last:
            return None
        last = size
    else:
        return None
    tail = h * (TO_COEFFICIENTS @ values)[-2:]
    damped = np.linalg.solve(np.eye(n) - h * slopes, tail.T).T  # as the equations damp it: stiff rates are noisy
    return stages[-1], float((np.abs(damped) / weight).max()) / TOLERANCE


def steps(rates: Function, z: np.ndarray, first: float, most: float) -> Iterator[tuple[float, np.ndarray]]:
    """Times and states after each step from (0, z), up to the time `most`."""
    t, h = 0.0, min(first, most)
    while t < most:
        slopes = _jacobian(rates, z, rates(z))
        while True:
            found = _step(rates, z, h, slopes)
            if found is not None and found[1] <= 1.0:
                break
            h *= 0.25 if found is None else max(0.2, 0.8 * found[1] ** (-1 / STAGES))
            if h < 1e-14 * max(t, first):
                raise ArithmeticError(f"no step from {t}")
        z, error = found
        left = h >= (most - t) * (1 - 1e-15)
        t = most if left else t + h
        yield t, z
        h = min(h * min(4.0, 0.8 * max(error, 1e-10) ** (-1 / STAGES)), most - t)
