"""Curves between labelled regions of the unit square, from cells whose corners are collisions.

The labels on the outline of a cell are a ring of changes, each bracketed to `LOCATED`. Where curves can join them from
side to side in one way only, without crossing, and are seen half way, these are the curves through the cell. Any other
cell is divided, until it is smaller than `SMALLEST`: there curves meet. So every point of a curve is a change of label,
no curve ends inside the square but at such a point, and what leaves no trace on the outline of a cell is not seen.
"""

import math
from bisect import bisect_left, bisect_right, insort
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain, pairwise

import numpy as np

from .arcs import Arc
from .segments import Labels, changes_on, crossings

SMALLEST = 3e-8  # size of a cell in which curves meet, relative to the window
_PARTS = 4  # divisions of a cell along each axis
_ASIDE = 1e-8 * np.array([[1, 2], [-2, 1], [-1, -2], [2, -1]])  # from a place without a known label
_MOST = 4000  # most cells that are divided
_BLUR = 1e-6  # points of a curve closer than this to its end have no direction worth keeping

Place = tuple[float, float]
Cell = tuple[float, float, float, float]
"""Low x, low y, high x, high y."""


@dataclass(frozen=True, eq=False)
class Crossing:
    """A place on a grid line where the label changes from `low` to `high`, in the direction of its coordinate."""

    place: Place
    low: int
    high: int


@dataclass(frozen=True)
class Meeting:
    """A place where curves meet.

    Attributes:
        pairs: the labels on both sides of each curve.
        located: False if labels near it are unknown, or too many cells had to be divided.
    """

    place: np.ndarray
    pairs: tuple[frozenset[int], ...]
    located: bool


Ring = list[tuple[Crossing, int]]
"""Changes on the outline of a cell, counterclockwise, and their sides: lower, right, upper, left."""


@dataclass
class Cells:
    """A division of the unit square into cells, and the changes of label on their sides.

    Arguments:
        labels: function of points that returns their labels, -1 where unknown.
        columns, rows: coordinates of the grid lines, from 0 to 1.
    """

    labels: Labels
    columns: np.ndarray
    rows: np.ndarray
    divided: dict[Cell, list[Cell]] = field(default_factory=dict, init=False)
    _label: dict[Place, int] = field(default_factory=dict, init=False)
    _points: dict[tuple[int, float], list[float]] = field(default_factory=dict, init=False)
    _changes: dict[tuple[int, float, float, float], list[Crossing]] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        columns, rows = self.columns.tolist(), self.rows.tolist()
        self._add((x, y) for x in columns for y in rows)
        self._points = {(1, x): list(rows) for x in columns} | {(0, y): list(columns) for y in rows}
        self._complete(
            [(1, x, *ends) for x in columns for ends in pairwise(rows)]
            + [(0, y, *ends) for y in rows for ends in pairwise(columns)]
        )

    @property
    def lattice(self) -> tuple[np.ndarray, np.ndarray]:
        """Points of the undivided grid (columns x rows x 2), and their labels."""
        at = np.stack(np.meshgrid(self.columns, self.rows, indexing="ij"), axis=-1)
        labels = [self._label[x, y] for x, y in at.reshape(-1, 2).tolist()]
        return at, np.array(labels).reshape(at.shape[:2])

    def mark(self, places: Iterable[Place]) -> None:
        """Points on grid lines of constant x whose labels are to be told as well."""
        fresh = [(x, y) for x, y in places if (x, y) not in self._label]
        self._add(fresh)
        self._complete(list(chain.from_iterable(self._insert(1, x, y) for x, y in fresh)))

    def divide_at(self, places: Iterable[Place]) -> None:
        """Divide the cells around places, which become corners."""
        cells = {self._leaf(x, y): (x, y) for x, y in places if (x, y) not in self._label}
        self._divide([(cell, [x], [y]) for cell, (x, y) in cells.items()])

    def curves(self) -> tuple[list[Arc], list[Meeting]]:
        """The curves between different labels, and the points where they meet."""
        rings: dict[Cell, Ring] = {}
        halves: dict[Cell, list[np.ndarray]] = {}
        while True:
            cells = {cell for change in self._found() for cell in self._neighbours(change)}
            fresh = {cell: ring for cell in cells if (ring := self._ring(cell)) != rings.get(cell)}
            rings |= fresh
            halves |= self._halves(fresh)
            divided = [
                cell for cell, ring in fresh.items()
                if not (_is_small(cell) or _is_unknown(ring))
                and (_joined(ring)[1] or np.isnan(np.array(halves[cell])).any())
            ]  # fmt: skip
            if not divided or len(self.divided) > _MOST:
                break
            inner = np.arange(1, _PARTS) / _PARTS
            self._divide(
                [(cell, *((cell[k] + inner * (cell[k + 2] - cell[k])).tolist() for k in (0, 1))) for cell in divided]
            )
        leaves = [cell for cell in rings if cell not in self.divided]
        return _curves([(cell, rings[cell], halves[cell]) for cell in leaves])

    def _halves(self, rings: dict[Cell, Ring]) -> dict[Cell, list[np.ndarray]]:
        """A place half way along each curve through cells; NaN where none is seen there."""
        chords = [
            (cell, ring[first][0].place, ring[other][0].place, _outward(*ring[other]))
            for cell, ring in rings.items() for first, other in _joined(ring)[0]
        ]  # fmt: skip
        halves: dict[Cell, list[np.ndarray]] = {cell: [] for cell in rings}
        if not chords:
            return halves
        start, other, sides = (np.array([chord[k] for chord in chords]) for k in (1, 2, 3))
        way = other - start
        length = np.maximum(np.linalg.norm(way, axis=1), 1e-300)
        normal = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None]
        places = crossings(self.labels, 0.5 * (start + other), normal, 0.5 * length, sides[:, 0], sides[:, 1])
        for (cell, *_), place in zip(chords, places, strict=True):
            halves[cell].append(place)
        return halves

    # ---- the grid

    def _add(self, places: Iterable[Place]) -> None:
        """Compute the labels of places; where one is unknown that of a place beside it serves."""
        fresh = [*dict.fromkeys(place for place in places if place not in self._label)]
        if not fresh:
            return
        at = np.array(fresh)
        labels = self.labels(at)
        for step in _ASIDE:
            unknown = np.flatnonzero(labels < 0)
            if unknown.size:
                labels[unknown] = self.labels(np.clip(at[unknown] + step, 0, 1))
        self._label.update(zip(fresh, labels.tolist(), strict=True))

    def _insert(self, axis: int, line: float, at: float) -> list[tuple[int, float, float, float]]:
        """Put a point on a grid line; returns the sides to complete in place of the one that it divides."""
        points = self._points.setdefault((axis, line), [])
        k = bisect_left(points, at)
        if k < len(points) and points[k] == at:
            return []
        insort(points, at)
        if not 0 < k < len(points) - 1 or self._changes.pop((axis, line, points[k - 1], points[k + 1]), None) is None:
            return []
        return [(axis, line, points[k - 1], at), (axis, line, at, points[k + 1])]

    def _complete(self, sides: list[tuple[int, float, float, float]]) -> None:
        """Locate the changes on sides: parts of a line (axis along it, its coordinate) from one point to the next."""
        ends = [(_place(axis, line, low), _place(axis, line, high)) for axis, line, low, high in sides]
        differ = [k for k, (start, other) in enumerate(ends) if self._label[start] != self._label[other]]
        self._changes.update((side, []) for side in sides)
        if not differ:
            return
        low, high = (np.array([ends[k][end] for k in differ]) for end in (0, 1))
        pairs = [(self._label[ends[k][0]], self._label[ends[k][1]]) for k in differ]
        for k, changes in zip(differ, changes_on(self.labels, low, high, pairs), strict=True):
            self._changes[sides[k]] = [Crossing((place[0], place[1]), *pair) for place, *pair in changes]

    def _divide(self, cells: list[tuple[Cell, list[float], list[float]]]) -> None:
        """Divide cells at coordinates within them."""
        sides: dict[tuple[int, float, float, float], None] = {}
        grids = [([cell[0], *x, cell[2]], [cell[1], *y, cell[3]]) for cell, x, y in cells]
        self._add((x, y) for across, up in grids for x in across for y in up)
        for (cell, *_), (across, up) in zip(cells, grids, strict=True):
            self.divided[cell] = [(*low, *high) for low, high in _corners(across, up)]
            for axis, lines, points in ((1, across, up), (0, up, across)):
                for line in lines:
                    for at in points:
                        sides |= dict.fromkeys(self._insert(axis, line, at))
                    sides |= dict.fromkeys(
                        (axis, line, *ends) for ends in self._sides(axis, line, points[0], points[-1])
                    )
        table = self._points
        self._complete([
            side for side in sides if side not in self._changes
            and bisect_left(table[side[:2]], side[3]) - bisect_left(table[side[:2]], side[2]) == 1
        ])  # fmt: skip

    def _sides(self, axis: int, line: float, low: float, high: float) -> Iterable[Place]:
        points = self._points[axis, line]
        return pairwise(points[bisect_left(points, low) : bisect_right(points, high)])

    def _found(self) -> Iterable[tuple[int, float, float]]:
        """The sides with changes: axis, coordinate of the line, and a coordinate along it."""
        return ((axis, line, 0.5 * (low + high)) for (axis, line, low, high), places in self._changes.items() if places)

    def _neighbours(self, side: tuple[int, float, float]) -> list[Cell]:
        """The undivided cells on either side of a part of a line."""
        axis, line, along = side
        sides = (math.nextafter(line, -1), math.nextafter(line, 2))
        return [self._leaf(*_place(axis, at, along)) for at in sides if 0 <= at <= 1]

    def _leaf(self, x: float, y: float) -> Cell:
        """The undivided cell that contains a place."""
        columns, rows = self.columns, self.rows
        j = min(max(int(np.searchsorted(columns, x)), 1), columns.size - 1)
        k = min(max(int(np.searchsorted(rows, y)), 1), rows.size - 1)
        cell = (float(columns[j - 1]), float(rows[k - 1]), float(columns[j]), float(rows[k]))
        while cell in self.divided:
            cell = next(box for box in self.divided[cell] if box[0] <= x <= box[2] and box[1] <= y <= box[3])
        return cell

    def _ring(self, cell: Cell) -> Ring:
        """Changes on the outline of a cell, counterclockwise."""
        x0, y0, x1, y1 = cell
        sides = ((0, y0, x0, x1), (1, x1, y0, y1), (0, y1, x0, x1), (1, x0, y0, y1))
        return [(crossing, k) for k, side in enumerate(sides) for crossing in self._on(*side)[:: 1 if k < 2 else -1]]

    def _on(self, axis: int, line: float, low: float, high: float) -> list[Crossing]:
        return [change for ends in self._sides(axis, line, low, high) for change in self._changes[axis, line, *ends]]


def _place(axis: int, line: float, along: float) -> Place:
    """A place on a line along an axis (0: of constant y)."""
    return (along, line) if axis == 0 else (line, along)


def _corners(across: list[float], up: list[float]) -> Iterable[tuple[Place, Place]]:
    return (((x0, y0), (x1, y1)) for x0, x1 in pairwise(across) for y0, y1 in pairwise(up))


def _joined(ring: Ring) -> tuple[list[tuple[int, int]], list[int]]:
    """Pairs of changes (indices of a ring) that a curve joins, and those that meet; unknown labels are left out."""
    alike: dict[frozenset[int], list[int]] = {}
    for k, (crossing, _) in enumerate(ring):
        if min(crossing.low, crossing.high) >= 0:
            alike.setdefault(frozenset((crossing.low, crossing.high)), []).append(k)
    pairs: list[tuple[int, int]] = []
    meet: list[int] = []
    for places in alike.values():
        ways = _ways_through(ring, places)
        if len(ways) == 1:
            pairs += ways[0]
        else:
            meet += places
    return pairs, meet


def _ways_through(ring: Ring, places: list[int]) -> list[list[tuple[int, int]]]:
    """All ways to join changes of one pair of labels by curves that do not cross, each from one side to another."""
    if not places:
        return [[]]
    first = places[0]
    return [
        [(first, places[k]), *within, *beyond]
        for k in range(1, len(places), 2)
        if ring[first][1] != ring[places[k]][1] and _outward(*ring[first]) == _outward(*ring[places[k]])[::-1]
        for within in _ways_through(ring, places[1:k])
        for beyond in _ways_through(ring, places[k + 1 :])
    ]


def _is_small(cell: Cell) -> bool:
    return max(cell[2] - cell[0], cell[3] - cell[1]) < SMALLEST


def _is_unknown(ring: Ring) -> bool:
    return any(min(crossing.low, crossing.high) < 0 for crossing, _ in ring)


def _outward(crossing: Crossing, side: int) -> tuple[int, int]:
    """Labels to the right and left of a curve that leaves a cell through a change on its outline."""
    return (crossing.low, crossing.high) if side < 2 else (crossing.high, crossing.low)


def _curves(cells: list[tuple[Cell, Ring, list[np.ndarray]]]) -> tuple[list[Arc], list[Meeting]]:
    """The curves through cells, each from the edge or a meeting point to another, or closed."""
    links: dict[Crossing, list[Link]] = {}
    meetings: list[Meeting] = []
    for cell, ring, halves in cells:
        pairs, meet = _joined(ring)
        for pair, half in zip(pairs, halves, strict=True):
            for here, end in (pair, pair[::-1]):
                through = [] if np.isnan(half).any() else [half]
                links.setdefault(ring[here][0], []).append((ring[end][0], through, _outward(*ring[end])))
        if not meet:
            continue
        changes = [ring[k][0] for k in meet]
        alike = tuple(frozenset((crossing.low, crossing.high)) for crossing in changes)
        place = np.mean([crossing.place for crossing in changes], axis=0)
        for k in meet:
            links.setdefault(ring[k][0], []).append((None, [place], _outward(*ring[k])[::-1]))
        meetings.append(Meeting(place, alike, _is_small(cell) and not _is_unknown(ring)))
    arcs: list[Arc] = []
    passed: set[Crossing] = set()
    for start in sorted(links, key=lambda crossing: len(links[crossing])):  # ends first, so that what is left is closed
        if start in passed:
            continue
        ahead, closed = _way(links, start, links[start][0], passed)
        back = [] if closed or len(links[start]) < 2 else _way(links, start, links[start][1], passed)[0]
        points = np.array([*reversed(back), start.place, *ahead])
        arcs.append(Arc(_clear(points), *links[start][0][2]))
    return [arc for arc in arcs if len(arc.points) > 1], meetings


Link = tuple[Crossing | None, list[np.ndarray], tuple[int, int]]
"""From a change to the next, or a meeting point: places on the way, and the labels to the right and left."""


def _way(
    links: dict[Crossing, list[Link]], start: Crossing, link: Link, passed: set[Crossing]
) -> tuple[list[np.ndarray], bool]:
    """Places of a curve after its start, and True if it returns there."""
    places: list[np.ndarray] = []
    here = start
    passed.add(start)
    while True:
        target, through, _ = link
        places += through
        if target is None:
            return places, False
        places.append(np.array(target.place))
        further = [candidate for candidate in links[target] if candidate[0] is not here]
        if target in passed or not further:
            passed.add(target)
            return places, target is start
        passed.add(target)
        here, link = target, further[0]


def _clear(points: np.ndarray) -> np.ndarray:
    """Points of a curve without those too close to the one before, or to an end, for a direction."""
    indices = [0]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - points[indices[-1]]) > _BLUR:
            indices.append(k)
    last = len(points) - 1
    while len(indices) > 1 and np.linalg.norm(points[indices[-1]] - points[last]) <= _BLUR:
        indices.pop()
    return np.asarray(points[[*indices, last]])
