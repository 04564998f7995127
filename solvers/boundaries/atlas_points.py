"""Kinds of change along the curves of a plane, and classification of the points where the kind changes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arcs import Arc
from .brackets import Brackets, enclose
from .cells import Meeting
from .changes import FREE, GRAZE, REVERSED
from .plane import Plane
from .segments import crossings

TRIPLE, FOLD, CROSSING = "triple point", "fold", "crossing"
CRITERION, KIND = "criterion change", "graze meets escape"
BESIDE = 1e-8  # distance from a curve of the collisions that determine its kind, relative to the window
_AT = 1e-9  # places closer than this are identical, relative to the window
_PARTS = 16  # places between two in a round, to locate a change of kind along a curve
_NONE = -9  # unknown


@dataclass(frozen=True)
class Stretch:
    """A part of a curve with one kind of change.

    Arguments:
        arc: with x ascending.
        kind: as in `Change`.
        criterion: the rebound criterion that is met beyond it, -1 for none.
    """

    arc: Arc
    kind: str
    criterion: int


def stretches(plane: Plane, arcs: Sequence[Arc]) -> tuple[list[Stretch], list[tuple[str, np.ndarray]]]:
    """The curves split where the kind changes, and these places with their names."""
    result: list[Stretch] = []
    points: list[tuple[str, np.ndarray]] = []
    for arc in arcs:
        codes = _filled(_codes(plane, arc, arc.points[1:-1])) if len(arc.points) > 2 else np.zeros(0, dtype=int)
        if not codes.size:
            codes = _filled(_codes(plane, arc, arc.points.mean(axis=0)[None]))
        codes = np.concatenate([codes[:1], codes, codes[-1:]])[: len(arc.points)]
        for piece, code in _cut(plane, arc, codes, points):
            kind = FREE if code <= 0 else REVERSED if code > 3 else GRAZE
            criterion = -1 if code <= 0 else (code - 1) % 3
            result.append(Stretch(piece, kind, criterion))
    return result, points


def _codes(plane: Plane, arc: Arc, at: np.ndarray) -> np.ndarray:
    """Codes of the kind of change and the criterion at places on a curve."""
    if 2 not in (arc.right, arc.left):
        return np.zeros(len(at), dtype=int)
    aside = BESIDE * _normals(arc, at) * (1 if arc.left == 2 else -1)
    labels, reversal = plane.seen(np.clip(at + aside, 0, 1))
    criterion = np.where(labels == 2, reversal, -2)
    codes: np.ndarray = 1 + np.maximum(criterion, 0)
    mask = criterion >= 0
    if 0 in (arc.right, arc.left):
        before = plane.first_criterion(np.clip(at - aside, 0, 1))
        codes += 3 * (before >= 0)
        mask &= before > -2
    return np.where(mask, codes, _NONE)


def _normals(arc: Arc, at: np.ndarray) -> np.ndarray:
    """Unit normals, towards the left of the curve, at places on it."""
    way = np.diff(arc.points, axis=0)
    k = np.clip(np.searchsorted(arc.points[:, 0], at[:, 0]) - 1, 0, len(way) - 1)
    normal = np.column_stack([-way[k, 1], way[k, 0]])
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])


def _filled(codes: np.ndarray) -> np.ndarray:
    """Codes with unknown ones replaced by the nearest known ones."""
    indices = np.flatnonzero(codes != _NONE)
    if not indices.size:
        return np.zeros_like(codes)
    nearest = np.abs(np.arange(codes.size)[:, None] - indices).argmin(axis=1)
    return np.asarray(codes[indices[nearest]])


def _cut(plane: Plane, arc: Arc, codes: np.ndarray, points: list[tuple[str, np.ndarray]]) -> list[tuple[Arc, int]]:
    """A curve split into parts of one code each; the places between them are located and named."""
    parts, first, begin = [], 0, arc.points[0]
    for k in np.flatnonzero(np.diff(codes)).tolist():
        place = _located(plane, arc, k, int(codes[k]))
        points.append((KIND if (codes[k] > 3) != (codes[k + 1] > 3) else CRITERION, place))
        parts.append((Arc(np.vstack([begin, arc.points[first + 1 : k + 1], place]), arc.right, arc.left), codes[k]))
        first, begin = k, place
    parts.append((Arc(np.vstack([begin, arc.points[first + 1 :]]), arc.right, arc.left), codes[-1]))
    return [(piece, int(code)) for piece, code in parts]


def _located(plane: Plane, arc: Arc, k: int, before: int) -> np.ndarray:
    """Place between two points of a curve where the code ceases to be `before`."""
    start, way = arc.points[k], arc.points[k + 1] - arc.points[k]
    length = max(float(np.linalg.norm(way)), 1e-15)
    normal, reach = np.array([-way[1], way[0]]) / length, max(0.2 * length, 1e-9)

    def places(at: np.ndarray) -> np.ndarray:
        """Places on the curve beside parts of the chord; NaN where it is not seen."""
        alike = (np.full(at.size, value) for value in (reach, arc.right, arc.left))
        return crossings(plane.labels, start + at[:, None] * way, np.tile(normal, (at.size, 1)), *alike)

    def labels(_: np.ndarray, at: np.ndarray) -> np.ndarray:
        points, codes = places(at), np.full(at.size, _NONE)
        seen = np.flatnonzero(~np.isnan(points[:, 0]))
        codes[seen] = _codes(plane, arc, points[seen])
        return np.where(codes == _NONE, _NONE, codes != before)

    whole = Brackets(*(np.array([value]) for value in (0, 0.0, 1.0, 0, 1)))
    middle = enclose(labels, whole, _AT / length, at_once=_PARTS, unknown=_NONE).place[:1]
    place = places(middle)[0]
    return np.asarray(start + middle * way if np.isnan(place[0]) else place)


def named(meetings: Sequence[Meeting]) -> list[tuple[str, np.ndarray]]:
    """The points where curves meet, with their names."""
    three = [len(meeting.pairs) == 3 and len(frozenset().union(*meeting.pairs)) == 3 for meeting in meetings]
    return [(TRIPLE if triple else CROSSING, meeting.place) for triple, meeting in zip(three, meetings, strict=True)]
