"""Queries of an attack: random ones, and ones beside the boundaries, angles and edges of a table."""

import numpy as np

from .data import Data
from .read import Place, slice_of

_NEAREST, _FARTHEST = -9.0, -1.5  # decimal logarithms of distances from a boundary


def queries(data: Data, count: int, random: np.random.Generator) -> np.ndarray:
    """Queries (3 x count: third variable, angle, ln St); 40 % random, 40 % beside boundaries, the rest beside cuts."""
    low, high = data.low[:, None], data.high[:, None]
    at = low + random.random((3, count)) * (high - low)
    kind = random.random(count)
    beside = np.flatnonzero(kind > 0.6)
    cut = np.flatnonzero((kind > 0.4) & (kind < 0.7))  # some of them are beside a boundary as well
    edge = np.flatnonzero(kind < 0.02)
    at[1, cut] = _beside(random, *_cuts(data, at[0, cut]))
    at[2, beside] = _beside(random, *heights(data, at[0, beside], np.clip(at[1, beside], low[1], high[1])))
    axis = random.integers(0, 3, edge.size)
    ends = np.where(random.random(edge.size) < 0.5, data.low[axis], data.high[axis])
    at[axis, edge] = ends
    return np.asarray(np.clip(at, low, high))


def _beside(random: np.random.Generator, places: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Values near one of the first `count` of each column of places."""
    size = count.size
    which = (random.random(size) * count).astype(int)
    sign = np.where(random.random(size) < 0.5, -1.0, 1.0)
    return np.asarray(places[which, np.arange(size)] + sign * 10 ** random.uniform(_NEAREST, _FARTHEST, size))


def _cuts(data: Data, third: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angles between panels (cuts x n, padded with the last), and their number."""
    part, t = slice_of(data, third)
    first, last = data.first_panel[part], data.first_panel[part + 1]
    most, none = int((last - first).max(initial=1)), np.zeros(third.size)
    places = [data.shapes.values(data.cuts[first, 0], t, none, none)[0][:, 0]]
    ends = (data.cuts[np.minimum(first + k, last - 1), 1] for k in range(most))
    places += [data.shapes.values(end, t, none, none)[0][:, 0] for end in ends]
    return np.array(places), last - first + 1


def heights(data: Data, third: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Boundaries at angles as ln St, and both ends of the range (places x n, padded), and their number."""
    none = np.zeros(angle.size)
    place = Place(data, np.stack([third, angle, none + data.low[2]]), False)
    panel, t, x = place.panel, place.t, place.x
    first, last = data.first_edge[panel], data.first_edge[panel + 1]
    places = [none + data.low[2], none + data.high[2]]
    for k in range(int((last - first).max(initial=0))):
        there = np.flatnonzero(first + k < last)
        top = none + data.high[2]
        top[there] = data.shapes.values(data.edges[first[there] + k], t[there], x[there], none[there])[0][:, 0]
        places.append(top)
    return np.array(places), last - first + 2
