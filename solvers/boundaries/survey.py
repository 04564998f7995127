"""Search for all boundaries in a plane, from a lattice and seed lines; curves are followed between meeting points."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from .arcs import CHORD, Arc, refined
from .continuation import CIRCLE, SHORTEST, Branch, branches, crossings, follow, meeting
from .plane import Plane
from .regions import apart

LONGEST = 0.03  # step of the continuation, relative to the window
_MOST_CURVES = 400
_SAME = 3e-5  # meeting points closer than this are identical, relative to the window
_COVERED, _SLACK = (5e-3, 5e-4)  # distances within which a known curve accounts for a seed or an edge of the lattice
_SAME_PLACE = 1e-6  # distance within which a seed lies on it
_STEP = 1e-3  # first step from a seed
_ZOOMS = 4  # rounds of dividing an interval that contains a third outcome


@dataclass
class Meeting:
    """A point where curves meet; branches already followed are `used`."""

    place: np.ndarray
    leaving: list[Branch]
    used: set[int] = field(default_factory=set)


@dataclass
class Survey:
    """Curves of a plane found so far, and places that could not be followed."""

    plane: Plane
    arcs: list[Arc] = field(default_factory=list)
    meetings: list[Meeting] = field(default_factory=list)
    failures: list[tuple[np.ndarray, str]] = field(default_factory=list)
    _waiting: list[tuple[Meeting, int]] = field(default_factory=list)

    def seek(self, at: np.ndarray, labels: np.ndarray) -> None:
        """Follow the curves that labels (n) of a polyline of points (n x 2) show and that are not known yet."""
        known = np.flatnonzero(labels >= 0)
        for one, other in pairwise(known.tolist()):
            if labels[one] != labels[other] and not self._covered(at[one], at[other], labels[one], labels[other]):
                self._seek_between(at[one], at[other])

    def seed(self, place: np.ndarray, below: int, above: int) -> None:
        """Follow the curve through a change of label in upward direction at a place, unless it is known."""
        near = np.array([0.0, _COVERED])
        for y in self._between(np.clip(place - near, 0, 1), np.clip(place + near, 0, 1), below, above):
            if abs(y - place[1]) < 2 * CHORD:
                return
            # chords of a curve deviate from it
            points = self._crossing(np.array([place[0], y]), np.array([0.0, 1.0]), _COVERED, below, above)
            if abs(points[1] - place[1]) < _SAME_PLACE:
                return
        self._start(place, below, above)

    def _crossing(self, centre: np.ndarray, along: np.ndarray, reach: float, low: int, high: int) -> np.ndarray:
        ends = np.array([reach]), np.array([low]), np.array([high])
        points: np.ndarray = crossings(self.plane.labels, centre[None], along[None], *ends)[0]
        return points

    def _seek_between(self, low: np.ndarray, high: np.ndarray, zooms: int = _ZOOMS) -> None:
        parts = np.linspace(0, 1, 50)[:, None]
        at = low + parts * (high - low)
        labels = self.plane.labels(at)
        known = np.flatnonzero(labels >= 0)
        for one, other in pairwise(known.tolist()):
            right, left = int(labels[one]), int(labels[other])
            if right == left or self._covered(at[one], at[other], right, left):
                continue
            way = at[other] - at[one]
            length = float(np.linalg.norm(way))
            centre, along = 0.5 * (at[one] + at[other]), way / length
            points = self._crossing(centre, along, length / 2, right, left)
            if not np.isnan(points).any():
                self._start(points, right, left)
            elif zooms:  # there is a third outcome between them
                self._seek_between(at[one], at[other], zooms - 1)
            elif not any(np.linalg.norm(point.place - centre) < _SAME for point in self.meetings):
                self.failures.append((centre, "a change of outcome was seen and could not be located"))

    def _start(self, place: np.ndarray, one: int, other: int) -> None:
        """Follow the curve through a place in both directions."""
        for radius in (CIRCLE, CIRCLE / 10, CIRCLE / 100):
            leaving = branches(self.plane.labels, place, radius)
            same = [branch for branch in leaving if {branch.right, branch.left} == {one, other}]
            edge = bool(np.any((place < radius) | (place > 1 - radius)))
            if len(same) == len(leaving) == 2 - edge or (edge and 0 < len(leaving) == len(same) <= 2):
                break
        else:
            centre, leaving = meeting(self.plane.labels, place)
            if len(leaving) > 2:
                self._meet(centre, leaving)
                self._empty()
            else:
                self.failures.append((place, "the curve through a change of outcome could not be followed"))
            return
        forth = follow(self.plane.labels, place, same[0], _STEP, LONGEST)
        points = forth.points
        if forth.end != "closed":
            points = self._ended(Arc(points, same[0].right, same[0].left), forth.end)
            if len(same) > 1:
                back = follow(self.plane.labels, place, same[1], _STEP, LONGEST, closes=False)
                before = self._ended(Arc(back.points, same[1].right, same[1].left), back.end)
                points = np.vstack([before[:0:-1], points])
        self._keep(Arc(points, same[0].right, same[0].left))
        self._empty()

    def _empty(self) -> None:
        """Follow the remaining branches of the meeting points."""
        while self._waiting:
            point, k = self._waiting.pop()
            if k in point.used:
                continue
            point.used.add(k)
            branch = point.leaving[k]
            curve = follow(self.plane.labels, point.place, branch, CIRCLE, LONGEST, closes=False)
            if len(curve.points) < 2 or len(self.arcs) > _MOST_CURVES:
                self.failures.append((point.place, "a curve that leaves this point could not be followed"))
                continue
            arc = Arc(curve.points, branch.right, branch.left)
            self._keep(Arc(self._ended(arc, curve.end), branch.right, branch.left))

    def _ended(self, arc: Arc, end: str) -> np.ndarray:
        """The points of a curve, completed by the meeting point at its end."""
        if end != "lost":
            return arc.points
        last = arc.points[-1]
        way = last - arc.points[-2] if len(arc.points) > 1 else np.array([1.0, 0.0])
        ahead = math.atan2(way[1], way[0])
        known = [one for one in self.meetings if np.linalg.norm(one.place - last) < _SAME]
        if known:
            point = min(known, key=lambda one: float(np.linalg.norm(one.place - last)))
        else:
            place, leaving = meeting(self.plane.labels, last, ahead)
            if len(leaving) < 2:
                self.failures.append((last, "a curve ends here, and no other is seen to leave"))
                return arc.points
            point = self._meet(place, leaving)
        k = _coming(point, arc, ahead)
        if k is not None:
            point.used.add(k)
        kept = arc.points
        while len(kept) > 2 and np.linalg.norm(kept[-1] - point.place) < 10 * SHORTEST:
            kept = kept[:-1]  # close to the meeting point the directions of chords are noise
        return np.vstack([kept, point.place])

    def _meet(self, place: np.ndarray, leaving: list[Branch]) -> Meeting:
        point = Meeting(place, leaving)
        self.meetings.append(point)
        self._waiting += [(point, k) for k in range(len(leaving))]
        return point

    def _keep(self, arc: Arc) -> None:
        """Add a curve unless known ones cover it. A curve that was lost at a corner may be found from its other end."""
        if len(arc.points) > 1:
            [fine] = refined(self.plane, [arc])  # so that points on it are recognised
            alike = [one for one in self.arcs if {one.right, one.left} == {arc.right, arc.left}]
            points = np.vstack([fine.points, (fine.points[1:] + fine.points[:-1]) / 2])
            if not alike or (apart(alike, points) > 2 * CHORD).any():
                self.arcs.append(fine)

    def _covered(self, low: np.ndarray, high: np.ndarray, right: int, left: int) -> bool:
        """True if a known curve with these labels passes between two points of a vertical or horizontal line."""
        return next(self._between(low, high, right, left), None) is not None

    def _between(self, low: np.ndarray, high: np.ndarray, right: int, left: int) -> Iterator[float]:
        """Places where known curves with these labels pass between two points of a vertical or horizontal line."""
        axis = int(abs(high[1] - low[1]) > abs(high[0] - low[0]))
        for arc in self.arcs:
            for place, along in passes(arc.points, 1 - axis, low[1 - axis]):
                # for a curve towards larger x, its right side is below
                forward = along > 0 if axis == 1 else along < 0
                sides = (arc.right, arc.left) if forward else (arc.left, arc.right)
                if low[axis] - _SLACK <= place <= high[axis] + _SLACK and sides == (right, left):
                    yield place


def passes(points: np.ndarray, axis: int, value: float) -> Iterator[tuple[float, float]]:
    """Crossings of a polyline with a value of one coordinate: the other coordinate, and the change of the first."""
    along, other = points[:, axis], points[:, 1 - axis]
    change = np.diff(along)
    low, high = np.minimum(along[:-1], along[1:]), np.maximum(along[:-1], along[1:])
    for k in np.flatnonzero((low <= value) & (value <= high) & (change != 0)).tolist():
        part = (value - along[k]) / change[k]
        yield float(other[k] + part * (other[k + 1] - other[k])), float(change[k])


def _coming(point: Meeting, arc: Arc, ahead: float) -> int | None:
    """Index of the branch of a meeting point along which a curve arrived."""
    alike = [k for k, one in enumerate(point.leaving) if (one.right, one.left) == (arc.left, arc.right)]
    alike = [k for k in alike if k not in point.used] or alike
    if not alike:
        return None
    return min(alike, key=lambda k: -math.cos(point.leaving[k].direction - ahead - math.pi))


def lattice(plane: Plane, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of an even lattice (columns x rows x 2), and their labels."""
    across, up = np.linspace(0, 1, columns), np.linspace(0, 1, rows)
    at = np.stack(np.meshgrid(across, up, indexing="ij"), axis=-1)
    return at, plane.labels(at.reshape(-1, 2)).reshape(columns, rows)


def surveyed(
    plane: Plane, at: np.ndarray, labels: np.ndarray, changes: Iterable[tuple[np.ndarray, int, int]]
) -> Survey:
    """The survey of a lattice and of changes on lines (place, label below, label above)."""
    survey = Survey(plane)
    for column, line_labels in zip(at, labels, strict=True):
        survey.seek(column, line_labels)
    for row, line_labels in zip(at.transpose(1, 0, 2), labels.T, strict=True):
        survey.seek(row, line_labels)
    for place, below, above in changes:
        survey.seed(place, below, above)
    return survey
