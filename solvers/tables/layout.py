"""Layout of a plane: angle panels in which no boundary begins or ends, and the boundaries that cross each.

A boundary lies between two signatures: outcomes with the sequences of events at which the equations change.
"""

from dataclasses import dataclass, field

import numpy as np

from ..boundaries.arcs import CHORD, Arc, monotone, refined
from ..boundaries.continuation import crossings
from ..boundaries.regions import Slab, apart, labelled, slabs
from ..boundaries.survey import Survey, lattice, surveyed
from ..boundaries.trace import trace
from .collisions import UNKNOWN, Collisions
from .fit import Order, Unresolved, fit
from .series import Forest

_LINES, _RANDOM = 33, 4096  # numbers of seed lines, and of random collisions with which the curves are compared
_BESIDE = 1e-6  # distance in the square from a traced change at which the signatures on both sides are taken
_THIN = 3e-7  # rad; a narrower panel is part of its neighbour
# numbers of points on a line of a further search, of places per round that it starts from, and of rounds
_FINER, _MORE, _ROUNDS = 385, 8, 3
_LOCATED = 1e-9  # width in the square to which a boundary is located
EDGE_ORDER = Order((16, 1), 5e-8, most=400, checks=8)
_NARROW, _END = 1 / 100, 2e-3  # parts of a panel: width of a patch that shows a kink; its distance from the ends
_DIVISIONS = 4  # most rounds of divisions at kinks
_REACHES = (1e-4, 1e-3, 1e-2, 0.1)  # distances from its polyline in the square to which a boundary is searched for


@dataclass
class Panel:
    """An interval of angles in which the same boundaries lie one above the other.

    Attributes:
        low, high: angles, rad.
        arcs: boundaries from below to above.
        labels: signatures below, between and above them.
    """

    low: float
    high: float
    arcs: tuple[Arc, ...]
    labels: tuple[int, ...]


@dataclass
class Layout:
    """The panels of a plane, and messages about collisions that contradict them (`failures`)."""

    plane: Collisions
    panels: list[Panel]
    failures: list[str] = field(default_factory=list)

    @property
    def signatures(self) -> tuple[tuple[int, ...], ...]:
        """The signatures of each panel, from below to above."""
        return tuple(panel.labels for panel in self.panels)

    def log_stokes(self, which: int, k: int, angle: np.ndarray) -> np.ndarray:
        """Logarithms of St of boundary k (from below) of panel `which` at these angles, rad.

        They are searched for up and down from its polyline; NaN where no such change of signature is found.
        """
        panel, plane = self.panels[which], self.plane
        arc = panel.arcs[k]
        below, above = panel.labels[k], panel.labels[k + 1]
        across = (angle - plane.span[0]) / (plane.span[1] - plane.span[0])
        centre = np.column_stack([across, np.interp(across, arc.points[:, 0], arc.points[:, 1])])
        heights = np.full(angle.size, np.nan)
        for reach in _REACHES:
            left = np.flatnonzero(np.isnan(heights))
            if not left.size:
                break
            up = np.tile([0.0, 1.0], (left.size, 1))
            sides = np.full(left.size, below), np.full(left.size, above)
            heights[left] = crossings(plane.labels, centre[left], up, np.full(left.size, reach), *sides, _LOCATED)[:, 1]
        return np.asarray(np.log(plane.stokes[0]) + heights * plane.log_height)


def layout_of(plane: Collisions, doubts: np.ndarray | None = None) -> Layout:
    """The layout of a plane, from a lattice, seed lines and random collisions.

    Arguments:
        doubts: points (angle, St) near which boundaries are searched for as well.
    """
    at, labels = lattice(plane, 65, 193)
    survey = surveyed(plane, at, labels, _traced(plane))
    if doubts is not None and len(doubts):
        _look(plane, survey, np.clip(plane.points(doubts[:, 0], doubts[:, 1]), 0, 1))
    random = np.random.default_rng(20121).random((_RANDOM, 2))
    points, seen = np.vstack([at.reshape(-1, 2), random]), np.concatenate([labels.ravel(), plane.labels(random)])
    middle = labels[:, labels.shape[1] // 2]
    for attempt in range(_ROUNDS):
        arcs = _arcs(plane, survey)
        regions = slabs(arcs, at[:, 0, 0], middle)
        by_regions = labelled(regions, points)[0]
        wrong = np.flatnonzero((by_regions != seen) & (seen >= 0))
        wrong = wrong[apart(arcs, points[wrong]) > 2 * CHORD]
        if not wrong.size or attempt == _ROUNDS - 1:
            break
        some = wrong[np.argsort(points[wrong, 0], kind="stable")]
        some = some[np.unique(np.linspace(0, some.size - 1, _MORE).astype(int))]
        _look(plane, survey, points[some])
    failures = [
        f"{plane.signatures.said(int(seen[k]))} at {_place(plane, points[k])}, which the traced boundaries do not say"
        for k in wrong[:3].tolist()
    ]
    return Layout(plane, _panels(plane, regions), failures)


def _arcs(plane: Collisions, survey: Survey) -> list[Arc]:
    pieces = [monotone(plane, arc)[0] for arc in survey.arcs]
    return refined(plane, [part for parts in pieces for part in parts], ascending=True)


def _panels(plane: Collisions, regions: list[Slab]) -> list[Panel]:
    low, high = plane.span
    panels: list[Panel] = []
    for slab in regions:
        ends = [low + end * (high - low) for end in (slab.low, slab.high)]
        if slab.high >= 1:
            ends[1] = high
        if ends[1] - ends[0] < _THIN and panels:
            panels[-1].high = ends[1]
            continue
        if panels and panels[-1].high - panels[-1].low < _THIN:
            ends[0] = panels.pop().low
        panels.append(Panel(ends[0], ends[1], slab.arcs, slab.labels))
    return panels


def _traced(plane: Collisions) -> list[tuple[np.ndarray, int, int]]:
    """Changes of outcome on seed lines, with the signatures on both sides: a lattice does not show narrow strips."""
    angles = np.linspace(*plane.span, _LINES)
    lines = trace(plane.scene, angles, plane.stokes, plane.rtol)
    places = [
        plane.points(np.array([at]), np.array([one.stokes]))[0]
        for at, line in zip(angles.tolist(), lines.changes, strict=True)
        for one in line
    ]
    if not places:
        return []
    at = np.array(places)
    aside = np.array([0.0, _BESIDE])
    below, above = (plane.labels(np.clip(at + way * aside, 0, 1)) for way in (-1, 1))
    changes = zip(places, below.tolist(), above.tolist(), strict=True)
    return [(place, one, other) for place, one, other in changes if one != other and UNKNOWN not in (one, other)]


def _look(plane: Collisions, survey: Survey, points: np.ndarray) -> None:
    """Search for boundaries on a column and a row through each point."""
    for point in points:
        column = np.column_stack([np.full(_FINER, point[0]), np.linspace(0, 1, _FINER)])
        row = np.column_stack([np.linspace(0, 1, _FINER), np.full(_FINER, point[1])])
        for line, axis in ((column, 1), (row, 0)):
            close = point[axis] + np.concatenate([-np.geomspace(1e-2, 1e-6, 24), [0.0], np.geomspace(1e-6, 1e-2, 24)])
            more = np.tile(point, (close.size, 1))
            more[:, axis] = close
            both = np.vstack([line, np.clip(more, 0, 1)])
            both = both[np.argsort(both[:, axis], kind="stable")]
            survey.seek(both, plane.labels(both))


def _place(plane: Collisions, point: np.ndarray) -> str:
    return f"{np.degrees(float(plane.x(point))):.6g} deg, St {float(plane.stokes_at(point)):.6g}"


def with_kinks(layout: Layout) -> Layout:
    """The layout with panels divided where a boundary has a corner."""
    for _ in range(_DIVISIONS):
        panels: list[Panel] = []
        for which, panel in enumerate(layout.panels):
            cut = _kink(layout, which)
            if cut is None:
                panels.append(panel)
            else:
                panels += [
                    Panel(panel.low, cut, panel.arcs, panel.labels), Panel(cut, panel.high, panel.arcs, panel.labels)
                ]  # fmt: skip
        if len(panels) == len(layout.panels):
            break
        layout.panels = panels
    return layout


def _kink(layout: Layout, which: int) -> float | None:
    """The angle of the sharpest kink inside a panel."""
    panel, sharpest = layout.panels[which], (_NARROW, 0.0)
    for k in range(len(panel.arcs)):
        forest = Forest(1)

        def sample(points: np.ndarray, k: int = k) -> np.ndarray:
            angle = panel.low + points[:, 0] * (panel.high - panel.low)
            return layout.log_stokes(which, k, angle)[:, None, None]

        try:
            fit(forest, sample, EDGE_ORDER)
        except Unresolved:
            continue
        for low, _, per, _ in forest.box:
            middle = low + 0.5 / per
            if _END < middle < 1 - _END and 1 / per < sharpest[0]:
                sharpest = 1 / per, middle
    return None if not sharpest[1] else panel.low + sharpest[1] * (panel.high - panel.low)
