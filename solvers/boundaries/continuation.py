"""Curves between labelled regions of the unit square, followed by pseudo-arclength continuation.

Regions are given by their labels at points, and a curve separates two labels. The corrector of a step searches the
normal of the predicted tangent for the change of label, by batches of points that narrow it by a factor of 17 each. So
every point of a curve is a change of label, and the curve ends where there is no such change.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Labels = Callable[[np.ndarray], np.ndarray]
"""Points (n x 2) of the unit square -> whole numbers, -1 where the label is not known."""

LOCATED = 2e-11  # width of the interval that brackets a change of label
SHORTEST = 1e-6  # smallest step; below it a curve is lost
CIRCLE = 1e-5  # radius of the circle about a point on which its curves are searched
_DOUBT = 1e-8  # largest width of an interval without known labels that still locates a change
_PARTS = 17  # subdivisions of an interval
_FIRST = np.geomspace(1e-6, 1.0, 13)  # distances from the prediction that are tried first, relative to the reach
_REACH = 0.35  # reach of the search from the prediction, relative to the step
_TURN, _AIM = 0.3, 0.1  # rad; largest turn of a step, and target of the step control
_AROUND, _AHEAD = 768, 256  # points on a circle, and additional ones near a direction
_MOST = 20_000  # most points of a curve


@dataclass(frozen=True)
class Branch:
    """A curve that leaves a point: direction (rad) and the labels clockwise and counterclockwise of it."""

    direction: float
    right: int
    left: int


@dataclass(frozen=True)
class Followed:
    """Points of a curve in order, and its end: "edge" of the window, "closed", or "lost"."""

    points: np.ndarray
    end: str


def crossings(
    labels: Labels,
    centre: np.ndarray,
    along: np.ndarray,
    reach: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    located: float = LOCATED,
) -> np.ndarray:
    """Points of segments where label `low` changes to `high`, the nearest to each centre.

    Arguments:
        labels: function of points that returns their labels.
        centre, along: centres and unit directions of the segments (n x 2).
        reach: length of the segments to either side, clipped to the square.
        low, high: labels before and after (n).
        located: width of the interval that brackets a change in the end.

    Returns:
        Points, n x 2; NaN where no two neighbouring points have these labels.
    """
    least, most = _inside(centre, along, reach)
    first = np.concatenate([-_FIRST[::-1], [0.0], _FIRST])
    at = np.clip(reach[:, None] * first, least[:, None], most[:, None])
    result = np.full(centre.shape, np.nan)
    open_ = np.arange(centre.shape[0])
    for _ in range(20):
        if not open_.size:
            break
        points = centre[open_, None, :] + at[:, :, None] * along[open_, None, :]
        seen = labels(np.clip(points.reshape(-1, 2), 0.0, 1.0)).reshape(at.shape)
        kept, ends = [], []
        for row, k in enumerate(open_.tolist()):
            interval = _nearest(at[row], seen[row], int(low[k]), int(high[k]))
            if interval is None:
                continue
            wide = interval[1] - interval[0]
            stuck = wide < _DOUBT and not (seen[row, 1:-1] >= 0).any()
            if wide < located or stuck:
                result[k] = centre[k] + 0.5 * (interval[0] + interval[1]) * along[k]
            else:
                kept.append(k)
                ends.append(interval)
        open_ = np.array(kept, dtype=int)
        at = np.array([np.linspace(*pair, _PARTS + 1) for pair in ends]).reshape(len(ends), _PARTS + 1)
    return np.asarray(np.clip(result, 0.0, 1.0))


def _inside(centre: np.ndarray, along: np.ndarray, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The part of each segment that lies in the square."""
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.stack([(0.0 - centre) / along, (1.0 - centre) / along])
    both = np.where(np.isnan(both), 0.0, both)
    flat = np.abs(along) < 1e-300
    least = np.where(flat, -np.inf, both.min(axis=0)).max(axis=1)
    most = np.where(flat, np.inf, both.max(axis=0)).min(axis=1)
    return np.minimum(np.maximum(least, -reach), 0.0), np.maximum(np.minimum(most, reach), 0.0)


def _nearest(at: np.ndarray, seen: np.ndarray, low: int, high: int) -> tuple[float, float] | None:
    """The interval nearest to 0 between neighbouring known points with these labels."""
    known = np.flatnonzero(seen >= 0)
    where, labels = at[known], seen[known]
    change = np.flatnonzero((labels[:-1] == low) & (labels[1:] == high))
    if not change.size:
        return None
    middle = np.abs(where[change] + where[change + 1])
    k = change[int(np.argmin(middle))]
    return float(where[k]), float(where[k + 1])


def follow(
    labels: Labels, start: np.ndarray, branch: Branch, step: float, longest: float, closes: bool = True
) -> Followed:
    """The curve that leaves `start` along `branch`, until it closes, meets an edge of the square or is lost.

    Arguments:
        step, longest: first and largest step, as lengths in the square.
        closes: True if the curve may return to its start.
    """
    points = [np.asarray(start, dtype=float)]
    heading = np.array([math.cos(branch.direction), math.sin(branch.direction)])
    first = heading
    while len(points) < _MOST:
        tried = _step(labels, points, heading, step, branch)
        if tried is None:
            step /= 4
            if step < SHORTEST:
                return Followed(np.array(points), "lost")
            continue
        new, at_edge = tried
        if closes and len(points) > 4 and _passes(points[-1], new[-1], points[0], first, step):
            return Followed(np.array([*points, points[0]]), "closed")
        chord = new[-1] - points[-1]
        before = heading
        points += new
        if at_edge:
            return Followed(np.array(points), "edge")
        heading = _tangent(points)
        turned = abs(_angle(before, heading))
        step = min(longest, float(np.linalg.norm(chord)) * min(2.0, max(0.5, _AIM / max(turned, 1e-9))))
    return Followed(np.array(points), "lost")


def _step(
    labels: Labels, points: list[np.ndarray], heading: np.ndarray, step: float, branch: Branch
) -> tuple[list[np.ndarray], bool] | None:
    """Points after half a step and a full step, and True if the latter is on an edge; None if the curve is lost."""
    last = points[-1]
    places = [_predicted(points, heading, part * step) for part in (0.5, 1.0)]
    if np.any((places[1] < 0) | (places[1] > 1)):
        crossed = _to_edge(labels, last, places[1], step, branch)
        return None if crossed is None else ([crossed], True)
    normals = np.array([[-heading[1], heading[0]]] * 2)
    reach = _REACH * step * np.array([0.5, 1.0])
    sides = np.array([branch.right] * 2), np.array([branch.left] * 2)
    crossed = crossings(labels, np.array(places), normals, reach, *sides)
    if np.isnan(crossed).any():
        return None
    chords = crossed[0] - last, crossed[1] - crossed[0]
    turns = abs(_angle(heading, chords[0])), abs(_angle(chords[0], chords[1]))
    if step > 2 * SHORTEST and max(turns) > _TURN:
        return None
    return [crossed[0], crossed[1]], bool(np.any((crossed[1] <= 0) | (crossed[1] >= 1)))


def _predicted(points: list[np.ndarray], heading: np.ndarray, ahead: float) -> np.ndarray:
    """Extrapolation by a length along a parabola through the last three points, or a line through fewer."""
    last = points[-1]
    if len(points) < 3:
        return last + ahead * heading
    one, two = np.linalg.norm(last - points[-2]), np.linalg.norm(points[-2] - points[-3])
    if min(one, two) <= 0:
        return last + ahead * heading
    near, far = (last - points[-2]) / one, (points[-2] - points[-3]) / two
    bend = (near - far) / (one + two)
    if ahead > 4 * (one + two):
        return last + ahead * heading
    return np.asarray(last + ahead * (near + bend * one) + ahead**2 * bend)


def _tangent(points: list[np.ndarray]) -> np.ndarray:
    """Direction at the last point of the parabola through the last three."""
    last = points[-1]
    one = np.linalg.norm(last - points[-2])
    near = (last - points[-2]) / one
    if len(points) > 2:
        two = np.linalg.norm(points[-2] - points[-3])
        near = near + (near - (points[-2] - points[-3]) / two) * one / (one + two)
    return np.asarray(near / np.linalg.norm(near))


def _to_edge(labels: Labels, last: np.ndarray, beyond: np.ndarray, step: float, branch: Branch) -> np.ndarray | None:
    """Intersection of the curve with the edge that the line from `last` to `beyond` crosses first."""
    way = beyond - last
    parts = [
        ((edge - last[axis]) / way[axis], axis, edge)
        for axis in (0, 1)
        for edge in (0.0, 1.0)
        if way[axis] != 0 and (edge - last[axis]) * way[axis] >= 0
    ]
    part, axis, edge = min(parts)
    place = last + part * way
    place[axis] = edge
    along = np.zeros(2)
    # towards the side of the left label
    along[1 - axis] = 1.0 if (way[0] if axis == 0 else -way[1]) > 0 else -1.0
    reach = np.array([_REACH * step])
    point = crossings(
        labels, np.clip(place, 0, 1)[None], along[None], reach, np.array([branch.right]), np.array([branch.left])
    )[0]
    return None if np.isnan(point).any() else point


def _angle(one: np.ndarray, other: np.ndarray) -> float:
    return math.atan2(one[0] * other[1] - one[1] * other[0], float(one @ other))


def _passes(last: np.ndarray, new: np.ndarray, start: np.ndarray, first: np.ndarray, step: float) -> bool:
    """True if the step from `last` to `new` passes the start of the curve in its direction."""
    way = new - last
    length = float(np.linalg.norm(way))
    if length == 0 or float(way @ first) < 0.7 * length:
        return False
    along = float((start - last) @ way) / length
    aside = abs(way[0] * (start - last)[1] - way[1] * (start - last)[0]) / length
    return 0 < along <= length and aside < 0.05 * step


def branches(labels: Labels, centre: np.ndarray, radius: float, ahead: float | None = None) -> list[Branch]:
    """The curves that cross a circle about a point, counterclockwise, with directions and labels.

    Arguments:
        ahead: a direction (rad) near which more points are computed.
    """
    angles = np.linspace(0, math.tau, _AROUND, endpoint=False)
    if ahead is not None:
        angles = np.unique(np.concatenate([angles, (ahead + np.linspace(-0.1, 0.1, _AHEAD)) % math.tau]))
    inside = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    rounding = 1e-9 * radius
    kept = np.all((inside >= -rounding) & (inside <= 1 + rounding), axis=1)
    seen = np.full(angles.size, -1)
    seen[kept] = labels(np.clip(inside[kept], 0, 1))
    known = np.flatnonzero(seen >= 0)
    if known.size < 2:
        return []
    at, known_labels = angles[known], seen[known]
    following, then = np.roll(at, -1), np.roll(known_labels, -1)
    following[-1] += math.tau
    change = np.flatnonzero((known_labels != then) & (following - at < 0.5))
    located = []
    for k in change.tolist():
        low, high, right, left = at[k], following[k], int(known_labels[k]), int(then[k])
        for _ in range(5):
            trial = np.linspace(low, high, _PARTS + 1)
            ring = centre + radius * np.column_stack([np.cos(trial), np.sin(trial)])
            interval = _nearest(trial - 0.5 * (low + high), labels(np.clip(ring, 0, 1)), right, left)
            if interval is None:
                break
            low, high = interval[0] + 0.5 * (trial[0] + trial[-1]), interval[1] + 0.5 * (trial[0] + trial[-1])
        located.append(Branch(0.5 * (low + high) % math.tau, right, left))
    return located


def meeting(
    labels: Labels, near: np.ndarray, ahead: float | None = None, radius: float = CIRCLE
) -> tuple[np.ndarray, list[Branch]]:
    """The meeting point of curves near a place, and the branches that leave it.

    It is the intersection of the lines through each curve's crossings with two circles, which shrink about it.
    """
    centre, leaving = np.asarray(near, dtype=float), branches(labels, near, radius, ahead)
    for size in (radius, radius / 3, radius / 10):
        inner, outer = branches(labels, centre, size, ahead), branches(labels, centre, 2 * size, ahead)
        if not _alike(inner, leaving) or not _alike(outer, leaving) or len(inner) < 2:
            break
        at, ways = np.zeros((len(inner), 2)), np.zeros((len(inner), 2))
        for k, one in enumerate(inner):
            alike = [each for each in outer if (each.right, each.left) == (one.right, one.left)]
            beyond = min(alike, key=lambda each: 1 - math.cos(each.direction - one.direction)).direction
            here, there = (np.array([math.cos(angle), math.sin(angle)]) for angle in (one.direction, beyond))
            at[k], way = centre + size * here, size * (2 * there - here)
            ways[k] = way / np.linalg.norm(way)
        across = np.column_stack([-ways[:, 1], ways[:, 0]])
        place, _, rank, _ = np.linalg.lstsq(across, np.sum(across * at, axis=1), rcond=1e-6)
        if rank < 2 or np.linalg.norm(place - centre) > 2 * radius:
            break
        centre, leaving = np.clip(place, 0, 1), inner
    return centre, branches(labels, centre, radius, ahead) or leaving


def _alike(some: list[Branch], others: list[Branch]) -> bool:
    """True if two circles cross the same curves."""
    pairs = [(one.right, one.left) for one in some]
    wanted = [(one.right, one.left) for one in others]
    return len(pairs) == len(wanted) and sorted(pairs) == sorted(wanted)
