"""Curves from cells, on curves known in closed form."""

import math

import numpy as np
import pytest
from wetdoublet.solvers.boundaries.arcs import monotone, refined
from wetdoublet.solvers.boundaries.cells import Cells
from wetdoublet.solvers.boundaries.segments import Labels, crossings

RADIUS = 0.3


def circle(points: np.ndarray) -> np.ndarray:
    """1 inside a circle about the middle."""
    inside: np.ndarray = np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5) < RADIUS
    return inside.astype(int)


def cubic(points: np.ndarray) -> np.ndarray:
    """1 on the right of x = T3(y): folds at x = 0.2 and 0.8."""
    y = 2 * points[:, 1] - 1
    return (points[:, 0] > 0.5 + 0.3 * (4 * y**3 - 3 * y)).astype(int)


def three(points: np.ndarray) -> np.ndarray:
    """Three regions that meet at (0.4, 0.61), one of them a wedge of 0.01 rad."""
    x, y = points[:, 0] - 0.4, points[:, 1] - 0.61
    aside = y - 0.2 * x - np.where(x > 0, 0.1 * x**2, 0)
    return np.where(np.abs(aside) < 0.005 * x, 1, np.where(aside < 0, 0, 2))


def hyperbola(points: np.ndarray) -> np.ndarray:
    """1 above and below the branches of a hyperbola that nearly meet, 3e-4 apart, inside a cell."""
    x, y = points[:, 0] - 0.507, points[:, 1] - 0.503
    return (x * y + 1e-8 > 0).astype(int)


def strip(points: np.ndarray) -> np.ndarray:
    """1 in a bent strip 1e-7 wide, 0 below, 2 above."""
    above = points[:, 1] - 0.2 - 0.3 * points[:, 0] ** 2
    return np.where(above < 0, 0, np.where(above < 1e-7, 1, 2))


def gaps(points: np.ndarray) -> np.ndarray:
    """The circle, where a third of the labels is unknown."""
    return np.where(np.sin(1e10 * points @ np.array([1.0, 3.0])) > 0.5, -1, circle(points))


class Square:
    """A plane that is its own square."""

    def __init__(self, labels: Labels) -> None:
        self.labels = labels


def cells(labels: Labels) -> Cells:
    return Cells(labels, np.linspace(0, 1, 33), np.linspace(0, 1, 49))


def test_a_crossing_is_located() -> None:
    """Where a segment leaves a circle, to 1e-10; none where the labels asked for do not meet on it."""
    centre, along = np.array([[0.79, 0.5]] * 2), np.array([[1.0, 0.0]] * 2)
    found = crossings(circle, centre, along, np.full(2, 0.1), np.array([1, 0]), np.array([0, 1]))
    assert found[0] == pytest.approx([0.8, 0.5], abs=1e-10)
    assert np.isnan(found[1]).all()


@pytest.mark.parametrize("labels", [circle, gaps])
def test_a_closed_curve_is_cut_at_its_folds(labels: Labels) -> None:
    """Two parts with x ascending, whose chords are refined; below the lower one is outside."""
    (arc,), meetings = cells(labels).curves()
    assert np.hypot(*(arc.points - 0.5).T) == pytest.approx(RADIUS, abs=1e-8)
    steps = np.hypot(*np.diff(arc.points, axis=0).T)  # points on the edges of cells, and between them
    assert steps.max() < math.hypot(1 / 32, 1 / 48) / 2
    assert not meetings
    parts, folds = monotone(Square(circle), arc)  # type: ignore[arg-type]  # a plane of known curves
    assert sorted(place[0] for place in folds) == pytest.approx([0.2, 0.8], abs=1e-9)
    assert {(part.right, part.left) for part in parts} == {(0, 1), (1, 0)}
    for part in refined(Square(circle), parts, ascending=True):  # type: ignore[arg-type]  # a plane of known curves
        assert (np.diff(part.points[:, 0]) > 0).all()
        middle = 0.5 * (part.points[1:] + part.points[:-1])
        assert np.hypot(*(middle - 0.5).T) == pytest.approx(RADIUS, abs=4e-5)


def test_a_collision_decided_once_is_not_asked_again() -> None:
    """One that takes all steps may be decided in one batch and not in another; the curve is closed all the same."""
    decided: set[tuple[float, float]] = set()

    def once(points: np.ndarray) -> np.ndarray:
        places = [*map(tuple, points.tolist())]
        labels = np.where([place in decided for place in places], -1, circle(points))
        decided.update(places)
        return labels

    (arc,), meetings = cells(once).curves()
    assert not meetings
    assert np.hypot(*(arc.points - 0.5).T) == pytest.approx(RADIUS, abs=1e-8)


def test_a_folded_curve() -> None:
    """The folds of a cubic, at x 0.8 and 0.2, to 1e-9 in x and 1e-6 in y; it ends exactly on the edges."""
    (arc,), _ = cells(cubic).curves()
    y = 2 * arc.points[:, 1] - 1
    assert arc.points[:, 0] == pytest.approx(0.5 + 0.3 * (4 * y**3 - 3 * y), abs=1e-9)
    assert {arc.points[0, 1], arc.points[-1, 1]} == {0.0, 1.0}
    parts, folds = monotone(Square(cubic), arc)  # type: ignore[arg-type]  # a plane of known curves
    assert len(parts) == 3
    assert sorted(place[0] for place in folds) == pytest.approx([0.2, 0.8], abs=1e-9)
    assert sorted(place[1] for place in folds) == pytest.approx([0.25, 0.75], abs=1e-6)


def test_a_meeting_point_is_located() -> None:
    """Three curves meet, one region a narrow wedge: the point to 1e-8, and all three curves from it to an edge."""
    arcs, (point,) = cells(three).curves()
    assert point.place == pytest.approx([0.4, 0.61], abs=1e-8)
    assert point.located
    assert {frozenset((arc.right, arc.left)) for arc in arcs} == {*map(frozenset, ((0, 1), (1, 2), (0, 2)))}
    for arc in arcs:
        ends = arc.points[[0, -1]]
        assert sorted(np.any((ends <= 0) | (ends >= 1), axis=1)) == [False, True]
        assert (np.abs(ends - point.place).max(axis=1) == 0).any()


def test_curves_that_nearly_meet_are_told_apart() -> None:
    """Each branch of a hyperbola stays on its side."""
    arcs, meetings = cells(hyperbola).curves()
    assert not meetings
    assert len(arcs) == 2
    assert sorted(np.sign(arc.points[0, 0] - 0.507) for arc in arcs) == [-1, 1]
    for arc in arcs:
        assert len({*np.sign(arc.points[:, 0] - 0.507)}) == 1


def test_a_strip_thinner_than_any_spacing() -> None:
    """It lies between other labels, so that every line across it shows both its edges."""
    arcs, meetings = cells(strip).curves()
    assert not meetings
    assert sorted({arc.right, arc.left} == {0, 1} for arc in arcs) == [False, True]
    for arc in arcs:
        lower = {arc.right, arc.left} == {0, 1}
        curve = 0.2 + 0.3 * arc.points[:, 0] ** 2 + (0 if lower else 1e-7)
        assert arc.points[:, 1] == pytest.approx(curve, abs=1e-10)


def test_an_island_that_a_line_has_shown() -> None:
    """An island within a cell is not seen by its corners, and closed once a point inside is marked or divides it."""

    def island(points: np.ndarray) -> np.ndarray:
        return (np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.507) < 4e-3).astype(int)

    for column in (0.5, 0.501):
        grid = cells(island)
        assert grid.curves() == ([], [])
        if column == 0.5:
            grid.mark([(column, 0.507)])
        else:
            grid.divide_at([(column, 0.507)])
        (arc,), meetings = grid.curves()
        assert not meetings
        assert (arc.points[0] == arc.points[-1]).all()
        assert len(arc.points) > 4
        assert np.hypot(*(arc.points - [0.5, 0.507]).T) == pytest.approx(4e-3, abs=1e-10)
        assert math.isclose(abs(arc.points[:, 0].max() - 0.5), 4e-3, rel_tol=0.3)
