"""Continuation of curves between labels, on curves known in closed form."""

import math

import numpy as np
import pytest
from wetdoublet.solvers.boundaries.arcs import Arc, monotone, refined
from wetdoublet.solvers.boundaries.continuation import Branch, Followed, Labels, branches, crossings, follow, meeting

RADIUS = 0.3


def circle(points: np.ndarray) -> np.ndarray:
    """1 inside a circle about the middle."""
    inside: np.ndarray = np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5) < RADIUS
    return inside.astype(int)


def cubic(points: np.ndarray) -> np.ndarray:
    """1 on the right of x = T3(y): folds at x = 0.2 and 0.8."""
    y = 2 * points[:, 1] - 1
    return (points[:, 0] > 0.5 + 0.3 * (4 * y**3 - 3 * y)).astype(int)


def cusp(points: np.ndarray) -> np.ndarray:
    """1 inside y^2 < x^3 about (0.3, 0.5)."""
    x, y = np.maximum(points[:, 0] - 0.3, 0), points[:, 1] - 0.5
    return (y**2 < x**3).astype(int)


def three(points: np.ndarray) -> np.ndarray:
    """Three regions that meet at (0.4, 0.6), one of them a wedge of 0.1 rad."""
    x, y = points[:, 0] - 0.4, points[:, 1] - 0.6
    wedge = (x > 0) & (np.abs(y - 0.2 * x - 0.1 * x**2) < 0.05 * x)
    return np.where(wedge, 1, np.where(y < 0.2 * x, 0, 2))


class Square:
    """A plane that is its own square."""

    def __init__(self, labels: Labels) -> None:
        self.labels = labels


def both_ways(labels: Labels, start: tuple[float, float]) -> tuple[list[Branch], list[Followed]]:
    """The curve through a point, followed from there."""
    leaving = branches(labels, np.array(start), 1e-5)
    return leaving, [follow(labels, np.array(start), one, 1e-3, 0.05) for one in leaving]


def test_a_crossing_is_located() -> None:
    """Where a segment leaves a circle, to 1e-10; none where the labels asked for do not meet on it."""
    centre, along = np.array([[0.79, 0.5]] * 2), np.array([[1.0, 0.0]] * 2)
    found = crossings(circle, centre, along, np.full(2, 0.1), np.array([1, 0]), np.array([0, 1]))
    assert found[0] == pytest.approx([0.8, 0.5], abs=1e-10)
    assert np.isnan(found[1]).all()


def test_a_folded_curve_is_followed_through_its_folds() -> None:
    """The folds of a cubic, at x 0.8 and 0.2, to 1e-9 in x and 1e-6 in y; it ends exactly on the edges."""
    leaving, (one, other) = both_ways(cubic, (0.5, 0.5))
    assert [one.end, other.end] == ["edge", "edge"]
    points = np.vstack([other.points[:0:-1], one.points])
    y = 2 * points[:, 1] - 1
    assert points[:, 0] == pytest.approx(0.5 + 0.3 * (4 * y**3 - 3 * y), abs=1e-9)
    assert {points[0, 1], points[-1, 1]} == {0.0, 1.0}
    parts, folds = monotone(Square(cubic), Arc(points, leaving[0].right, leaving[0].left))  # type: ignore[arg-type]  # a plane of known curves
    assert len(parts) == 3
    assert sorted(place[0] for place in folds) == pytest.approx([0.2, 0.8], abs=1e-9)
    assert sorted(place[1] for place in folds) == pytest.approx([0.25, 0.75], abs=1e-6)


def test_a_cusp_ends_both_its_branches() -> None:
    """Where a curve has no tangent it is lost: at the cusp."""
    _, found = both_ways(cusp, (0.8, 0.5 + 0.5**1.5))
    assert sorted(one.end for one in found) == ["edge", "lost"]
    (lost,) = (one for one in found if one.end == "lost")
    assert lost.points[-1] == pytest.approx([0.3, 0.5], abs=1e-5)


def test_a_meeting_point_is_located() -> None:
    """Three curves meet, one region a narrow wedge: the point to 1e-9, and all three curves."""
    _, found = both_ways(three, (0.2, 0.56))
    (lost,) = (one for one in found if one.end == "lost")
    way = lost.points[-1] - lost.points[-2]
    place, leaving = meeting(three, lost.points[-1], math.atan2(way[1], way[0]))
    assert place == pytest.approx([0.4, 0.6], abs=1e-9)
    directions = sorted(one.direction for one in leaving)
    assert directions == pytest.approx([math.atan(0.15), math.atan(0.25), math.pi + math.atan(0.2)], abs=1e-4)


def test_labels_that_are_not_known_are_passed_over() -> None:
    """A curve is followed where a third of the labels is not known."""

    def gaps(points: np.ndarray) -> np.ndarray:
        return np.where(np.sin(1e10 * points @ np.array([1.0, 3.0])) > 0.5, -1, circle(points))

    leaving = branches(circle, np.array([0.8, 0.5]), 1e-5)
    found = follow(gaps, np.array([0.8, 0.5]), leaving[0], 1e-3, 0.05)
    assert found.end == "closed"
    assert np.hypot(*(found.points - 0.5).T) == pytest.approx(RADIUS, abs=1e-8)


def test_a_circle_is_cut_at_its_folds() -> None:
    """Two parts with x ascending between the folds, whose chords are refined; below the lower one is outside."""
    leaving, (found, _) = both_ways(circle, (0.5 + RADIUS * math.cos(1), 0.5 + RADIUS * math.sin(1)))
    parts, folds = monotone(Square(circle), Arc(found.points, leaving[0].right, leaving[0].left))  # type: ignore[arg-type]  # a plane of known curves
    assert sorted(place[0] for place in folds) == pytest.approx([0.2, 0.8], abs=1e-9)
    assert {(part.right, part.left) for part in parts} == {(0, 1), (1, 0)}
    for part in refined(Square(circle), parts):  # type: ignore[arg-type]  # a plane of known curves
        assert (np.diff(part.points[:, 0]) > 0).all()
        middle = 0.5 * (part.points[1:] + part.points[:-1])
        assert np.hypot(*(middle - 0.5).T) == pytest.approx(RADIUS, abs=4e-5)
