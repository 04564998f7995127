"""The atlas of a scene: all curves between outcomes in a plane of an entry and the Stokes number, and where they meet.

The curves are sought from a lattice of collisions and from seed lines (`bounds`), followed (`survey`, `continuation`),
named (`atlas_points`), and held against the lines, the lattice and random collisions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from ..errors import ComputationError
from ..host.arguments import check_function, check_whole
from ..model.validity import warn
from ..scene.scene import Scene
from ..settings import RTOL, check_rtol
from .arcs import CHORD, Arc, monotone, refined
from .atlas_points import FOLD, Stretch, named, stretches
from .changes import Change
from .continuation import crossings
from .plane import ANGLE, Plane, check_plane
from .regions import Slab, apart, labelled, slabs
from .samples import OUTCOMES
from .survey import Survey, lattice, passes, surveyed
from .trace import STOKES, Boundaries, Traced, trace

LINES = 33
_MOST = 10_000  # lines
# Columns and rows of the lattice, and random collisions that are held against the regions; and where every collision is
# integrated one by one.
BY_KERNEL, BY_ROSENBROCK = (65, 193, 4096), (17, 49, 256)
_ROUNDS = 3  # in which what does not agree is looked at more closely
_FINER_ROWS, _MORE = 769, 12  # of a column through a collision that does not agree; most of those columns a round
_AGREES = 1e-6  # in ln St: a line and a curve
_ROUGHLY = 50 * CHORD  # of the window: a curve near a vertical tangent, and a line
_NEAR = 2 * CHORD  # of the window: closer to a curve nothing is said


@dataclass(frozen=True)
class Curve:
    """A boundary between outcomes, x ascending: `before` is below it, `after` above.

    Arguments:
        kind: as of a `Change`.
        x, stokes: points of it; x in rad, or SI.
    """

    before: str
    after: str
    kind: str
    x: tuple[float, ...]
    stokes: tuple[float, ...]

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of `wetdoublet boundary --angle LO:HI`."""
        return {
            "from": self.before,
            "to": self.after,
            "kind": self.kind,
            "x": list(self.x),
            "stokes": list(self.stokes),
        }


@dataclass(frozen=True)
class Point:
    """A place where curves meet, turn, or change in kind."""

    kind: str
    x: float
    stokes: float

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of `wetdoublet boundary --angle LO:HI`."""
        return {"kind": self.kind, "x": self.x, "stokes": self.stokes}


@dataclass(frozen=True)
class Atlas(Boundaries):
    """Boundaries in a plane: the seed lines as `Boundaries` has them, the curves, and where they meet.

    Attributes:
        over: dotted name of x.
        span: of x, rad or SI.
        at: x of the lines; `angles` are their impact angles.
        curves, points: boundaries, and where they meet, turn or change in kind.
        unsettled: places (x, St) that could not be brought into agreement, and why.
        sought: what the curves were sought with: lattice and lines.
        lattice: its columns and rows; fewer where there is no kernel for the scene.
    """

    over: str = ANGLE
    span: tuple[float, float] = (0.0, 1.0)
    at: tuple[float, ...] = ()
    curves: tuple[Curve, ...] = ()
    points: tuple[Point, ...] = ()
    unsettled: tuple[tuple[float, float, str], ...] = ()
    background: str = OUTCOMES[0]
    lattice: tuple[int, int] = BY_KERNEL[:2]

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --angle LO:HI --json`."""
        found = {
            "curves": [one.to_dict() for one in self.curves],
            "points": [one.to_dict() for one in self.points],
            "resolution": self.sought,
        }
        if self.unsettled:
            found["unsettled"] = [{"x": x, "stokes": stokes, "reason": why} for x, stokes, why in self.unsettled]
        return found

    @property
    def sought(self) -> dict[str, float | str]:
        """Distances in x and relative distances in St within which the curves were sought, and their precision."""
        decades = math.log(self.window[1] / self.window[0])
        across = self.span[1] - self.span[0]
        return {
            "over": self.over,
            "lines": len(self.at),
            "line_spacing": across / max(len(self.at) - 1, 1),
            "line_stokes": self.resolution,
            "lattice_spacing": across / (self.lattice[0] - 1),
            "lattice_stokes": math.expm1(decades / (self.lattice[1] - 1)),
            "chord_stokes": math.expm1(CHORD * decades),
        }

    def region(self, x: Any, stokes: Any) -> np.ndarray:
        """Outcomes (0 stick, 1 stick-rotate-separate, 2 bounce) of the regions that points of the plane lie in.

        Arguments:
            x, stokes: arrays of one shape; x in rad, or SI. Points that are not in the window have -1.
        """
        x, stokes = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(stokes, dtype=float))
        inside = (x >= self.span[0]) & (x <= self.span[1]) & (stokes >= self.window[0]) & (stokes <= self.window[1])
        found = np.full(x.shape, -1, dtype=np.int8)
        found[inside] = labelled(self.slabs(), self.unit(x[inside], stokes[inside]))[0]
        return found

    def unit(self, x: Any, stokes: Any) -> np.ndarray:
        """Points of the unit square, n x 2, at values of x and Stokes numbers."""
        across = (np.asarray(x) - self.span[0]) / (self.span[1] - self.span[0])
        up = np.log(np.asarray(stokes) / self.window[0]) / math.log(self.window[1] / self.window[0])
        return np.column_stack([across, up])

    def slabs(self) -> list[Slab]:
        """The window cut into parts between whose curves lies one outcome each."""
        arcs = [
            Arc(self.unit(one.x, one.stokes), OUTCOMES.index(one.before), OUTCOMES.index(one.after))
            for one in self.curves
        ]
        return slabs(arcs, np.array([0.5]), np.array([OUTCOMES.index(self.background)]))

    def __str__(self) -> str:
        angle = self.over == ANGLE
        name, shown = ("angle (deg)", math.degrees) if angle else (self.over, float)
        lines = [f"{'curve':<42} {'kind':<16} {name} and St, from ... to"]
        for one in self.curves:
            ends = " ... ".join(f"{shown(one.x[k]):.6g}, {one.stokes[k]:.6g}" for k in (0, -1))
            lines.append(f"{one.before + ' -> ' + one.after:<42} {one.kind:<16} {ends}")
        lines += [] if self.curves else [f"none: {self.background} everywhere"]
        if self.points:
            lines += ["", f"{'point':<24} {name:<18} St"]
            lines += [f"{one.kind:<24} {shown(one.x):<18.10g} {one.stokes:.10g}" for one in self.points]
        lines += [f"not settled at {shown(x):.6g}, St {stokes:.6g}: {why}" for x, stokes, why in self.unsettled]
        sought, spacing = self.sought, self.sought["line_spacing"]
        assert isinstance(spacing, float)
        told = (
            f"sought with {len(self.at)} lines, {shown(spacing):.3g} apart, and strips of {self.resolution:.2%} in St "
            f"on them; {self.collisions} collisions; straight lines between the points of a curve are within "
            f"{sought['chord_stokes']:.1e} of St"
        )
        if self.lattice != BY_KERNEL[:2]:
            told += (
                f"; without the compiled kernel, from a lattice of {self.lattice[0]} by {self.lattice[1]} collisions"
            )
        return "\n".join([*lines, "", told])


def atlas(
    scene: Scene | str | FilePath,
    *,
    over: str = ANGLE,
    span: Sequence[Any],
    stokes: tuple[float, float] = STOKES,
    lines: int = LINES,
    rtol: float = RTOL,
    progress: Callable[[int, int], None] | None = None,
) -> Atlas:
    """All boundaries between outcomes in the plane of an entry of the scene and the Stokes number.

    Every curve is followed by its collisions: it is a change of outcome everywhere, up to the edge of the window, back
    to its start, or to a point where others meet it. What is sought from is stated in the result: islands smaller than
    the lattice, and narrower on every line than it can see, are not found.

    Arguments:
        scene: a Scene, a path or a preset's name.
        over: dotted name of the entry across: the impact's angle, or a number of the scene at the scene's angle.
        span: its lowest and highest value, SI (rad) or text with a unit.
        stokes: lowest and highest Stokes number.
        lines: how many lines of constant x are traced as well, both edges included.
        rtol: relative tolerance of the integrations.
        progress: told of (lines traced, lines in all).

    Returns:
        Atlas: `curves` (x and St, outcomes below and above), `points` (where they meet), the lines.

    Raises:
        InputError: a name, span or number that cannot be. What cannot be settled is no error, it is in `unsettled`.

    Example:
        >>> from wetdoublet.solvers import atlas
        >>> found = atlas("granulation", span=("15 deg", "60 deg"), stokes=(0.01, 0.5), lines=5)
        >>> [(one.before, one.after) for one in found.curves][0], found.points[0].kind
        (('stick', 'bounce'), 'triple point')
    """
    loaded = Scene.load(scene)
    plane = check_plane(loaded, over, span, stokes, check_rtol(rtol))
    lines = check_whole(lines, "lines", 2, _MOST)
    tell = check_function(progress, "progress") or (lambda *_: None)
    warn(loaded)
    at, labels = lattice(plane, *(BY_KERNEL if plane.kernel else BY_ROSENBROCK)[:2])
    x = np.linspace(*plane.span, lines)
    traced = _lines(plane, x, tell)
    survey = surveyed(plane, at, labels, _changes(plane, x, traced))
    return _settled(plane, survey, x, traced, at, labels)


def _lines(plane: Plane, x: np.ndarray, tell: Callable[[int, int], None]) -> Traced:
    """The seed lines."""
    if plane.over == ANGLE:
        return trace(plane.scene, x, plane.stokes, plane.rtol, lambda done: tell(done, x.size))
    whole = Traced([], [], 0, 0.0)
    for one in x.tolist():
        scene, angle = plane.scene_at(one)
        part = trace(scene, np.array([angle]), plane.stokes, plane.rtol)
        whole.changes += part.changes
        whole.failures += part.failures
        whole.collisions += part.collisions
        whole.resolution = max(whole.resolution, part.resolution)
        tell(len(whole.changes), x.size)
    return whole


def _changes(plane: Plane, x: np.ndarray, traced: Traced) -> list[tuple[np.ndarray, int, int]]:
    return [
        (plane.points(np.array([at]), np.array([one.stokes]))[0], OUTCOMES.index(one.before), OUTCOMES.index(one.after))
        for at, line in zip(x.tolist(), traced.changes, strict=True)
        for one in line
    ]


def _settled(plane: Plane, survey: Survey, x: np.ndarray, traced: Traced, at: np.ndarray, labels: np.ndarray) -> Atlas:
    """The atlas of a survey, after what does not agree with it has been looked at more closely."""
    random = np.random.default_rng(20121).random(((BY_KERNEL if plane.kernel else BY_ROSENBROCK)[2], 2))
    points = np.vstack([at.reshape(-1, 2), random])
    outcomes = np.concatenate([labels.ravel(), plane.seen(random, most=0)[0]])
    middle = _known_along(plane, at[:, at.shape[1] // 2], labels[:, labels.shape[1] // 2])
    for attempt in range(_ROUNDS + 1):
        pieces = [monotone(plane, arc) for arc in survey.arcs]
        arcs = refined(plane, [part for parts, _ in pieces for part in parts], ascending=True)
        regions = slabs(arcs, at[:, 0, 0], middle)
        wrong = _wrong(arcs, regions, points, outcomes)
        if attempt == _ROUNDS or not wrong.size:
            break
        for k in _some(wrong, points).tolist():
            column = np.column_stack([np.full(_FINER_ROWS, points[k, 0]), np.linspace(0, 1, _FINER_ROWS)])
            survey.seek(column, plane.labels(column))
            row = column[:, ::-1].copy()
            row[:, 1] = points[k, 1]
            survey.seek(row, plane.labels(row))
    unsettled = [(place, why) for place, why in survey.failures]
    unsettled += [
        (points[k], f"a collision here is a {OUTCOMES[outcomes[k]]}, which the curves do not say")
        for k in _some(wrong, points).tolist()
    ]
    unsettled += _against_lines(plane, arcs, x, traced)
    folds = [place for _, own in pieces for place in own]
    parts, inner = stretches(plane, arcs)
    parts, meetings = named(plane, survey.meetings, parts)
    places = [*meetings, *((FOLD, place) for place in folds), *inner]
    return _made(plane, parts, places, unsettled, x, traced, int(middle[middle.size // 2]), labels.shape)


def _known_along(plane: Plane, points: np.ndarray, outcomes: np.ndarray) -> np.ndarray:
    """Outcomes at points, those that are not known (-1) asked for once more; ComputationError where that fails."""
    found = outcomes.copy()
    for k in np.flatnonzero(found < 0).tolist():
        found[k] = plane.seen(points[k : k + 1], most=1)[0][0]
        if found[k] < 0:
            x, stokes = float(plane.x(points[k])), float(plane.stokes_at(points[k]))
            raise ComputationError(
                f"no collision could be computed at {plane.over} = {x:.6g}, St {stokes:.6g}, which tells regions apart",
                advice="try another span, or other Stokes numbers",
            )
    return found


def _wrong(arcs: list[Arc], regions: list[Slab], points: np.ndarray, outcomes: np.ndarray) -> np.ndarray:
    """Which collisions have another outcome than their region, and are not beside a curve."""
    says, _ = labelled(regions, points)
    differ = np.flatnonzero((says != outcomes) & (outcomes >= 0))
    return differ[apart(arcs, points[differ]) > _NEAR]


def _some(wrong: np.ndarray, points: np.ndarray) -> np.ndarray:
    """A few of them, spread in x."""
    if wrong.size <= _MORE:
        return wrong
    ordered = wrong[np.argsort(points[wrong, 0], kind="stable")]
    some: np.ndarray = ordered[np.linspace(0, ordered.size - 1, _MORE).round().astype(int)]
    return some


def _against_lines(plane: Plane, arcs: list[Arc], x: np.ndarray, traced: Traced) -> list[tuple[np.ndarray, str]]:
    """Where a line and the curves do not agree."""
    found: list[tuple[np.ndarray, str]] = []
    for at, line, failure in zip(x.tolist(), traced.changes, traced.failures, strict=True):
        across = float(plane.points(np.array([at]), np.array([plane.stokes[0]]))[0, 0])
        if failure:
            found.append((np.array([across, 0.5]), f"this line could not be traced: {failure}"))
            continue
        crossed = [
            (y, OUTCOMES[arc.right], OUTCOMES[arc.left]) for arc in arcs for y, _ in passes(arc.points, 0, across)
        ]
        own = [(plane.points(np.array([at]), np.array([one.stokes]))[0], one) for one in line]
        found += [
            (place, f"the line here changes from {one.before} to {one.after}, where no curve passes")
            for place, one in own
            if not any(_is(one, place, passing) for passing in crossed)
        ]
        found += [
            (np.array([across, passing[0]]), "a curve passes here, which the line does not show")
            for passing in crossed
            if 0 < passing[0] < 1 and not any(_is(one, place, passing) for place, one in own)
        ]
        found += _apart(plane, own)
    return found


def _apart(plane: Plane, changes: list[tuple[np.ndarray, Change]]) -> list[tuple[np.ndarray, str]]:
    """Changes on a line that do not lie where collisions change their outcome."""
    if not changes:
        return []
    places = np.array([place for place, _ in changes])
    low, high = (np.array([OUTCOMES.index(getattr(one, side)) for _, one in changes]) for side in ("before", "after"))
    count = len(changes)
    located = crossings(plane.labels, places, np.tile([0.0, 1.0], (count, 1)), np.full(count, 1e-4), low, high)
    distance = np.abs(located[:, 1] - places[:, 1]) * plane.decades
    return [
        (place, f"the line changes here, and collisions {_beside(far)}")
        for (place, _), far in zip(changes, distance.tolist(), strict=True)
        if not far < _AGREES
    ]


def _beside(far: float) -> str:
    return "beside it do not" if math.isnan(far) else f"do so {far:.1e} beside it (relative, in St)"


def _is(change: Change, at: np.ndarray, place: tuple[float, str, str]) -> bool:
    """Whether a change on a line is where a curve passes; straight lines between its points are less exact."""
    return place[1:] == (change.before, change.after) and abs(place[0] - at[1]) < _ROUGHLY


def _made(
    plane: Plane,
    parts: list[Stretch],
    places: list[tuple[str, np.ndarray]],
    unsettled: list[tuple[np.ndarray, str]],
    x: np.ndarray,
    traced: Traced,
    background: int,
    size: tuple[int, ...],
) -> Atlas:
    curves = [
        Curve(
            OUTCOMES[one.arc.right], OUTCOMES[one.arc.left], one.kind,
            tuple(plane.shown(one.arc.points).tolist()), tuple(plane.stokes_at(one.arc.points).tolist()),
        )
        for one in parts
    ]  # fmt: skip
    curves.sort(key=lambda one: (one.x[0], one.stokes[0], one.x[-1]))
    points = [Point(name, float(plane.shown(place)), float(plane.stokes_at(place))) for name, place in places]
    points.sort(key=lambda one: (one.x, one.stokes))
    angles = x if plane.over == ANGLE else np.full(x.size, plane.scene.angle)
    return Atlas(
        angles=tuple(angles.tolist()),
        changes=tuple(traced.changes),
        collisions=plane.collisions + traced.collisions,
        failures=tuple(traced.failures),
        resolution=traced.resolution,
        scene=plane.scene,
        window=plane.stokes,
        over=plane.over,
        span=(plane.edge, plane.span[1]),
        at=(plane.edge, *x[1:].tolist()),
        curves=tuple(curves),
        points=tuple(points),
        unsettled=tuple((float(plane.x(at)), float(plane.stokes_at(at)), why) for at, why in unsettled),
        background=OUTCOMES[background],
        lattice=(size[0], size[1]),
    )
