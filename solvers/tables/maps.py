"""Coordinates across a cell that undo the singularities at its ends: square roots and logarithms.

A cell is an interval between two boundaries (or two ends of an angle panel), w in 0..1. The coordinate s of its series
is g(w) scaled to 0..1, where g is w, or a sum of sqrt(w) or ln(w) for the lower end and of -sqrt(1 - w) or
-ln(1 - w) for the upper one.
"""

import numpy as np

LINEAR, ROOT, LOG = 0, 1, 2  # code of an end; a map is low + 3 high
MAPS = tuple(range(9))
LEAST = 3e-7  # distance in ln St from a logarithmic end within which an impact counts as one at this distance
MOST_NEAR = 0.25
_TINY = 1e-30
_LOGIT = 40.0  # bisection covers w from exp(-40)


def near(height: np.ndarray) -> np.ndarray:
    """LEAST as a part of the height of a cell."""
    return np.asarray(np.minimum(LEAST / np.maximum(height, _TINY), MOST_NEAR))


def forward(
    code: np.ndarray | int, w: np.ndarray, least: np.ndarray | float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The coordinate s, ds/dw and ds/dleast.

    Arguments:
        code: of the map, one or one for each w.
        least: smallest distance from a logarithmic end, as a part of the cell.
    """
    low, high = np.broadcast_arrays(np.asarray(code) % 3, np.asarray(code) // 3)
    first = np.where(low == LOG, least, 0.0)
    last = np.where(high == LOG, least, 0.0)
    inner = np.clip(w, first, 1.0 - last)
    start, start_slope = _raw(low, high, first + 0.0 * w)
    end, end_slope = _raw(low, high, 1.0 - last - 0.0 * w)
    value, slope = _raw(low, high, inner)
    wide = end - start
    s = (value - start) / wide
    start_slope, end_slope = np.where(low == LOG, start_slope, 0.0), np.where(high == LOG, -end_slope, 0.0)
    return s, np.where(inner == w, slope / wide, 0.0), (-start_slope - s * (end_slope - start_slope)) / wide


def _raw(low: np.ndarray, high: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """g(w) and its slope."""
    v, u = np.maximum(w, _TINY), np.maximum(1.0 - w, _TINY)
    root_v, root_u = np.sqrt(v), np.sqrt(u)
    plain = (low == LINEAR) & (high == LINEAR)
    value = np.where(plain, w, 0.0)
    slope = np.where(plain, 1.0, 0.0)
    value = value + np.where(low == ROOT, root_v, np.where(low == LOG, np.log(v), 0.0))
    slope = slope + np.where(low == ROOT, 0.5 / root_v, np.where(low == LOG, 1.0 / v, 0.0))
    value = value - np.where(high == ROOT, root_u, np.where(high == LOG, np.log(u), 0.0))
    slope = slope + np.where(high == ROOT, 0.5 / root_u, np.where(high == LOG, 1.0 / u, 0.0))
    return value, slope


def inverse(code: int, s: np.ndarray, least: np.ndarray | float) -> np.ndarray:
    """The place w of a coordinate s, by bisection."""
    if code == 0:
        return s
    low, high = np.full(s.shape, -_LOGIT), np.full(s.shape, _LOGIT)
    for _ in range(56):
        middle = 0.5 * (low + high)
        below = forward(code, 1 / (1 + np.exp(-middle)), least)[0] < s
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray(1 / (1 + np.exp(-0.5 * (low + high))))
