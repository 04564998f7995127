"""Splitting of curves at folds into arcs with monotonic x, and their refinement."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .plane import Plane
from .segments import crossings

CHORD = 2e-5  # largest distance of a curve from its chords, relative to the window
_ROUNDS = 4
_FLAT = 1e-9  # changes of x below this are rounding
_ZOOMS = (1.0, 0.3, 0.1)  # subdivisions of the neighbourhood of a fold


@dataclass
class Arc:
    """Points of the unit square along a curve, and the labels to its right and left."""

    points: np.ndarray
    right: int
    left: int

    def reversed(self) -> Arc:
        return Arc(self.points[::-1], self.left, self.right)


def monotone(plane: Plane, arc: Arc) -> tuple[list[Arc], list[np.ndarray]]:
    """The arcs of a curve between its folds, each with x ascending, and the folds."""
    points, last = arc.points, len(arc.points) - 1
    closed = last > 3 and bool(np.all(points[0] == points[-1]))
    if closed:  # start at a fold
        points = np.roll(points[:-1], -int(np.argmax(points[:-1, 0])), axis=0)
        points = np.vstack([points, points[:1]])
    turns = _reversals_of_x(points[:, 0])
    folds = {k: _fold(plane, points[k - 1 : k + 2], arc) for k in turns}
    places = dict(folds)
    if closed:
        folds[0] = places[0] = places[last] = _fold(plane, points[[-2, 0, 1]], arc)
    parts = []
    for first, k in pairwise([0, *turns, last]):
        begin, end = places.get(first, points[first]), places.get(k, points[k])
        forward = Arc(np.vstack([begin, points[first + 1 : k], end]), arc.right, arc.left)
        parts.append(_ascending(forward if end[0] > begin[0] else forward.reversed()))
    return parts, list(folds.values())


def _ascending(arc: Arc) -> Arc:
    """The points between the ends whose x is above that of the point before."""
    x = arc.points[:, 0]
    highest = np.maximum.accumulate(x)
    mask = np.concatenate([[True], x[1:] > highest[:-1]]) & (x < x[-1])
    mask[0] = mask[-1] = True
    return Arc(arc.points[mask], arc.right, arc.left)


def _reversals_of_x(x: np.ndarray) -> list[int]:
    """Indices at which x reverses by more than rounding."""
    turns, direction, extreme = [], 0, 0
    for k in range(1, x.size):
        if direction == 0:
            if abs(x[k] - x[0]) > _FLAT:
                direction, extreme = (1 if x[k] > x[0] else -1), k
        elif direction * (x[k] - x[extreme]) > 0:
            extreme = k
        elif direction * (x[extreme] - x[k]) > _FLAT:
            turns.append(extreme)
            direction, extreme = -direction, k
    return turns


def _fold(plane: Plane, near: np.ndarray, arc: Arc) -> np.ndarray:
    """The extremum of x near the middle of three points, from crossings of horizontal lines with the curve."""
    place: np.ndarray = near[1]
    half = 0.5 * abs(near[2, 1] - near[0, 1])
    low, high = (arc.left, arc.right) if near[2, 1] > near[0, 1] else (arc.right, arc.left)
    if half < 1e-9:
        return place  # a cusp or similar
    for zoom in _ZOOMS:
        heights = np.clip(place[1] + zoom * half * np.linspace(-1, 1, 7), 0, 1)
        reach = max(1e-7, 2 * float(np.ptp(near[:, 0])))
        centres = np.column_stack([np.full(7, place[0]), heights])
        across = np.tile([1.0, 0.0], (7, 1))
        points = crossings(plane.labels, centres, across, np.full(7, reach), np.full(7, low), np.full(7, high))
        points = points[~np.isnan(points[:, 0])]
        if len(points) < 5:
            return place
        at = (points[:, 1] - place[1]) / (zoom * half)
        fit = np.polynomial.Polynomial.fit(at, points[:, 0], 4 if len(points) > 5 else 2)
        roots = fit.deriv().roots()
        real = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and abs(root.real) <= 1.2]
        if not real:
            return place
        root = min(real, key=abs)
        place = np.array([float(fit(root)), place[1] + root * zoom * half])
    return place


def refined(plane: Plane, arcs: list[Arc], ascending: bool = False) -> list[Arc]:
    """The curves with more points where chords deviate from the curve; with `ascending` x stays ascending."""
    for _ in range(_ROUNDS):
        chords = [(k, j) for k, arc in enumerate(arcs) for j in _coarse(arc.points)]
        if not chords:
            break
        start = np.array([arcs[k].points[j] for k, j in chords])
        other = np.array([arcs[k].points[j + 1] for k, j in chords])
        way = other - start
        length = np.linalg.norm(way, axis=1)
        normal = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None]
        right, left = (np.array([getattr(arcs[k], side) for k, _ in chords]) for side in ("right", "left"))
        places = crossings(plane.labels, 0.5 * (start + other), normal, length, right, left)
        arcs = [_with(arc, k, chords, places, ascending) for k, arc in enumerate(arcs)]
    return arcs


def _coarse(points: np.ndarray) -> list[int]:
    """Indices of chords farther from the curve than CHORD, estimated from the turning angles of the polyline."""
    way = np.diff(points, axis=0)
    length = np.linalg.norm(way, axis=1)
    heading = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    if length.size < 2:
        return [0] if length.size and length[0] > 1e-3 else []
    turn = np.abs(np.diff(heading)) / np.maximum(0.5 * (length[1:] + length[:-1]), 1e-300)
    bend = np.maximum(np.concatenate([turn[:1], turn]), np.concatenate([turn, turn[-1:]]))
    return np.flatnonzero(bend * length**2 / 8 > CHORD).tolist()


def _with(arc: Arc, k: int, chords: list[tuple[int, int]], places: np.ndarray, ascending: bool) -> Arc:
    inserted = [(j, place) for (which, j), place in zip(chords, places, strict=True) if which == k]
    fits = [
        (j, place)
        for j, place in inserted
        if not math.isnan(place[0]) and (not ascending or arc.points[j, 0] < place[0] < arc.points[j + 1, 0])
    ]
    if not fits:
        return arc
    points = np.insert(arc.points, [j + 1 for j, _ in fits], np.array([place for _, place in fits]), axis=0)
    return Arc(points, arc.right, arc.left)
