"""All boundaries in a plane of an entry and the Stokes number, and their meeting points: search and verification.

The search starts from a lattice of collisions and from seed lines (`trace`). Curves are followed (`survey`,
`continuation`), classified (`atlas_points`), and compared with the lines, the lattice and random collisions.
"""

import math
from collections.abc import Callable

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import ComputationError
from .arcs import CHORD, Arc, monotone, refined
from .atlas_points import FOLD, Stretch, named, stretches
from .changes import Change
from .continuation import crossings
from .plane import ANGLE, Plane
from .regions import Slab, apart, labelled, slabs
from .result import LATTICE, Atlas, Curve, Point
from .survey import Survey, lattice, passes, surveyed
from .trace import Traced, trace

_RANDOM = 4096  # random collisions for verification
_ROUNDS = 3  # rounds of refinement where results disagree
_FINER_ROWS, _MORE = 769, 12  # rows of a column through a collision that disagrees; most columns per round
_AGREES = 1e-6  # tolerance in ln St between a line and a curve
_ROUGHLY = 50 * CHORD  # the same near a vertical tangent, relative to the window
_NEAR = 2 * CHORD  # collisions closer to a curve are not compared, relative to the window


def curves_of(plane: Plane, lines: int, tell: Callable[[int, int], None]) -> Atlas:
    """The boundaries of a plane, found from a lattice of collisions and `lines` seed lines."""
    at, labels = lattice(plane, *LATTICE)
    x = np.linspace(*plane.span, lines)
    traced = _lines(plane, x, tell)
    survey = surveyed(plane, at, labels, _changes(plane, x, traced))
    return _settled(plane, survey, x, traced, at, labels)


def _lines(plane: Plane, x: np.ndarray, tell: Callable[[int, int], None]) -> Traced:
    """The changes of outcome on the seed lines."""
    if plane.over == ANGLE:
        return trace(plane.scene, x, plane.stokes, plane.rtol, lambda done: tell(done, x.size))
    whole = Traced([], [], 0, 0.0)
    for one in x.tolist():
        scene, angle = plane.scene_at(one)
        whole.add(trace(scene, np.array([angle]), plane.stokes, plane.rtol))
        tell(len(whole.changes), x.size)
    return whole


def _changes(plane: Plane, x: np.ndarray, traced: Traced) -> list[tuple[np.ndarray, int, int]]:
    return [
        (plane.points(np.array([at]), np.array([one.stokes]))[0], OUTCOMES.index(one.before), OUTCOMES.index(one.after))
        for at, line in zip(x.tolist(), traced.changes, strict=True)
        for one in line
    ]


def _settled(plane: Plane, survey: Survey, x: np.ndarray, traced: Traced, at: np.ndarray, labels: np.ndarray) -> Atlas:
    """The verified boundaries of a survey, after refinement where collisions disagree with it."""
    random = np.random.default_rng(20121).random((_RANDOM, 2))
    points = np.vstack([at.reshape(-1, 2), random])
    outcomes = np.concatenate([labels.ravel(), plane.labels(random)])
    column, middle = _along(plane, at, labels)
    for attempt in range(_ROUNDS + 1):
        pieces = [monotone(plane, arc) for arc in survey.arcs]
        arcs = refined(plane, [part for parts, _ in pieces for part in parts], ascending=True)
        regions = slabs(arcs, column, middle)
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
    folds = [place for _, folded in pieces for place in folded]
    parts, inner = stretches(plane, arcs)
    parts, meetings = named(plane, survey.meetings, parts)
    places = [*meetings, *((FOLD, place) for place in folds), *inner]
    return _made(plane, parts, places, unsettled, x, traced, int(middle[middle.size // 2]), labels.shape)


def _along(plane: Plane, at: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where outcomes are known in the middle row of a lattice, and these; ComputationError where none is."""
    row = labels.shape[1] // 2
    known = labels[:, row] >= 0
    if not known.any():
        stokes = float(plane.stokes_at(at[0, row]))
        raise ComputationError(f"no collision could be computed at St {stokes:.6g}", advice="try other Stokes numbers")
    return at[known, row, 0], labels[known, row]


def _wrong(arcs: list[Arc], regions: list[Slab], points: np.ndarray, outcomes: np.ndarray) -> np.ndarray:
    """Indices of collisions whose outcome differs from their region's, except close to a curve."""
    says, _ = labelled(regions, points)
    differ = np.flatnonzero((says != outcomes) & (outcomes >= 0))
    return differ[apart(arcs, points[differ]) > _NEAR]


def _some(wrong: np.ndarray, points: np.ndarray) -> np.ndarray:
    """A few of the indices, spread in x."""
    if wrong.size <= _MORE:
        return wrong
    ordered = wrong[np.argsort(points[wrong, 0], kind="stable")]
    return np.asarray(ordered[np.linspace(0, ordered.size - 1, _MORE).round().astype(int)])


def _against_lines(plane: Plane, arcs: list[Arc], x: np.ndarray, traced: Traced) -> list[tuple[np.ndarray, str]]:
    """Places where a line and the curves disagree."""
    differences: list[tuple[np.ndarray, str]] = []
    for at, line, failure in zip(x.tolist(), traced.changes, traced.failures, strict=True):
        across = float(plane.points(np.array([at]), np.array([plane.stokes[0]]))[0, 0])
        if failure:
            differences.append((np.array([across, 0.5]), f"this line could not be traced: {failure}"))
            continue
        crossed = [
            (y, OUTCOMES[arc.right], OUTCOMES[arc.left]) for arc in arcs for y, _ in passes(arc.points, 0, across)
        ]
        changes = [(plane.points(np.array([at]), np.array([one.stokes]))[0], one) for one in line]
        differences += [
            (place, f"the line here changes from {one.before} to {one.after}, where no curve passes")
            for place, one in changes
            if not any(_is(one, place, passing) for passing in crossed)
        ]
        differences += [
            (np.array([across, passing[0]]), "a curve passes here, which the line does not show")
            for passing in crossed
            if 0 < passing[0] < 1 and not any(_is(one, place, passing) for place, one in changes)
        ]
        differences += _apart(plane, changes)
    return differences


def _apart(plane: Plane, changes: list[tuple[np.ndarray, Change]]) -> list[tuple[np.ndarray, str]]:
    """Changes on a line without a change of outcome of collisions at that place."""
    if not changes:
        return []
    places = np.array([place for place, _ in changes])
    low, high = (np.array([OUTCOMES.index(getattr(one, side)) for _, one in changes]) for side in ("before", "after"))
    count = len(changes)
    located = crossings(plane.labels, places, np.tile([0.0, 1.0], (count, 1)), np.full(count, 1e-4), low, high)
    distance = np.abs(located[:, 1] - places[:, 1]) * plane.log_height
    return [
        (place, f"the line changes here, and collisions {_beside(far)}")
        for (place, _), far in zip(changes, distance.tolist(), strict=True)
        if not far < _AGREES
    ]


def _beside(far: float) -> str:
    return "beside it do not" if math.isnan(far) else f"do so {far:.1e} beside it (relative, in St)"


def _is(change: Change, at: np.ndarray, place: tuple[float, str, str]) -> bool:
    """True if a change on a line lies on a curve, within the error of the curve's chords."""
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
        rtol=plane.rtol,
        over=plane.over,
        span=(plane.edge, plane.span[1]),
        at=(plane.edge, *x[1:].tolist()),
        curves=tuple(curves),
        points=tuple(points),
        unsettled=tuple((float(plane.x(at)), float(plane.stokes_at(at)), why) for at, why in unsettled),
        background=OUTCOMES[background],
        lattice=(size[0], size[1]),
    )
