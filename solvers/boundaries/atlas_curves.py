"""All boundaries in a plane of an entry and the Stokes number, and their meeting points: search and verification.

The search starts from a lattice of collisions and from seed lines (`trace`). Curves are joined from cell to cell
(`cells`), classified (`atlas_points`), and compared with the lines, the lattice and random collisions.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import ComputationError
from .arcs import CHORD, Arc, monotone, refined
from .atlas_points import FOLD, Stretch, named, stretches
from .cells import Cells
from .changes import Change
from .plane import ANGLE, Plane
from .regions import Slab, apart, labelled, slabs
from .result import LATTICE, Atlas, Curve, Point
from .trace import Traced, trace

_RANDOM = 4096  # random collisions for verification
_ROUNDS = 3  # rounds of refinement where results disagree
_MORE = 12  # most collisions that disagree whose cells are divided in a round
_SAME_COLUMN = 1e-9  # distance of two columns, relative to the window
_ROUGHLY = (
    50 * CHORD
)  # largest height between a line's change and a curve near a vertical tangent, relative to the window
_NEAR = 2 * CHORD  # collisions closer to a curve are not compared, relative to the window


def curves_of(plane: Plane, lines: int, tell: Callable[[int, int], None]) -> Atlas:
    """The boundaries of a plane, found from a lattice of collisions and `lines` seed lines."""
    x = np.linspace(*plane.span, lines)
    traced = _lines(plane, x, tell)
    across = np.linspace(0, 1, lines)
    columns = np.union1d(np.linspace(0, 1, LATTICE[0]), across)
    columns = columns[np.concatenate([[True], np.diff(columns) > _SAME_COLUMN])]
    cells = Cells(plane.labels, columns, np.linspace(0, 1, LATTICE[1]))
    for at, line in zip(across, traced.changes, strict=True):
        column = float(columns[np.argmin(np.abs(columns - at))])
        heights = plane.points(np.full(len(line), x[0]), np.array([change.stokes for change in line]))[:, 1]
        cells.mark((column, 0.5 * (low + high)) for low, high in pairwise(heights.tolist()))
    return _settled(plane, cells, x, traced)


def _lines(plane: Plane, x: np.ndarray, tell: Callable[[int, int], None]) -> Traced:
    """The changes of outcome on the seed lines."""
    if plane.over == ANGLE:
        return trace(plane.scene, x, plane.stokes, plane.rtol, lambda done: tell(done, x.size))
    whole = Traced([], [], 0, 0.0)
    for value in x.tolist():
        scene, angle = plane.scene_at(value)
        whole.add(trace(scene, np.array([angle]), plane.stokes, plane.rtol))
        tell(len(whole.changes), x.size)
    return whole


def _settled(plane: Plane, cells: Cells, x: np.ndarray, traced: Traced) -> Atlas:
    """The verified boundaries of a plane, after more cells were divided where collisions disagree with them."""
    random = np.random.default_rng(20121).random((_RANDOM, 2))
    at, labels = cells.lattice
    points = np.vstack([at.reshape(-1, 2), random])
    outcomes = np.concatenate([labels.ravel(), plane.labels(random)])
    column, middle = _along(plane, at, labels)
    for attempt in range(_ROUNDS + 1):
        curves, meetings = cells.curves()
        pieces = [monotone(plane, arc) for arc in refined(plane, curves)]
        arcs = refined(plane, [arc for parts, _ in pieces for arc in parts], ascending=True)
        wrong = _wrong(arcs, slabs(arcs, column, middle), points, outcomes)
        if attempt == _ROUNDS or not wrong.size:
            break
        cells.divide_at([(x, y) for x, y in points[_few(wrong, points)].tolist()])
    unsettled = [
        (end.place, "curves end here, where collisions are not decided") for end in meetings if not end.located
    ]
    unsettled += [
        (points[k], f"a collision here is a {OUTCOMES[outcomes[k]]}, which the curves do not say")
        for k in _few(wrong, points).tolist()
    ]
    unsettled += _against_lines(plane, arcs, x, traced)
    folds = [(FOLD, place) for _, folded in pieces for place in folded]
    parts, inner = stretches(plane, arcs)
    places = [*named([meeting for meeting in meetings if meeting.located]), *folds, *inner]
    return _made(plane, parts, places, unsettled, x, traced, int(middle[middle.size // 2]))


def _along(plane: Plane, at: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where outcomes are known in the middle row of a lattice, and these; ComputationError where none is."""
    row = labels.shape[1] // 2
    mask = labels[:, row] >= 0
    if not mask.any():
        stokes = float(plane.stokes_at(at[0, row]))
        raise ComputationError(f"no collision could be computed at St {stokes:.6g}", advice="try other Stokes numbers")
    return at[mask, row, 0], labels[mask, row]


def _wrong(arcs: list[Arc], regions: list[Slab], points: np.ndarray, outcomes: np.ndarray) -> np.ndarray:
    """Indices of collisions whose outcome differs from their region's, except close to a curve."""
    differ = np.flatnonzero((labelled(regions, points) != outcomes) & (outcomes >= 0))
    return differ[apart(arcs, points[differ]) > _NEAR]


def _few(wrong: np.ndarray, points: np.ndarray) -> np.ndarray:
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
            (float(np.interp(across, *arc.points.T)), OUTCOMES[arc.right], OUTCOMES[arc.left])
            for arc in arcs
            if arc.points[0, 0] <= across <= arc.points[-1, 0]
        ]
        changes = [(plane.points(np.array([at]), np.array([change.stokes]))[0], change) for change in line]
        differences += [
            (place, f"the line here changes from {change.before} to {change.after}, where no curve passes")
            for place, change in changes
            if not any(_is(change, place, passing) for passing in crossed)
        ]
        differences += [
            (np.array([across, passing[0]]), "a curve passes here, which the line does not show")
            for passing in crossed
            if 0 < passing[0] < 1 and not any(_is(change, place, passing) for place, change in changes)
        ]
    return differences


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
) -> Atlas:
    curves = [
        Curve(
            OUTCOMES[stretch.arc.right], OUTCOMES[stretch.arc.left], stretch.kind,
            tuple(plane.values(stretch.arc.points).tolist()), tuple(plane.stokes_at(stretch.arc.points).tolist()),
        )
        for stretch in parts
    ]  # fmt: skip
    curves.sort(key=lambda curve: (curve.x[0], curve.stokes[0], curve.x[-1]))
    points = [Point(name, float(plane.values(place)), float(plane.stokes_at(place))) for name, place in places]
    points.sort(key=lambda point: (point.x, point.stokes))
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
    )
