"""Near a boundary there is no derivative: it is refused by the boundary's name, with the distance."""

import math
import re
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from wetdoublet import solvers
from wetdoublet.solvers import ComputationError, Scene, boundary, collide
from wetdoublet.solvers.sensitivity import boundary_distance as distances
from wetdoublet.solvers.sensitivity.boundary_distance import AT_ONCE, CONTACT, GLASS, Course, along_speed, limit

from ...helpers.reference import sensitivities

pytestmark = pytest.mark.slow

# preset, degrees, which change, its name
EDGES = [
    ("granulation", 55, 0, "saddle"),
    ("granulation", 55, 1, "graze of the glass criterion"),
    ("pendulum", 20, 0, "rim"),
]


@cache
def changes(preset: str, degrees: int) -> tuple[float, ...]:
    """The Stokes numbers at which the outcome changes."""
    return tuple(change.stokes for change in boundary(preset, angle=math.radians(degrees), rtol=1e-11).changes[0])


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("edge", EDGES, ids=lambda edge: f"{edge[0]} {edge[1]} {edge[3]}")
def test_within_the_limit_it_is_refused(edge: tuple[str, int, int, str], side: int) -> None:
    """At half the limit on either side: the boundary's name, and the distance that `boundary` says it is."""
    preset, degrees, k, name = edge
    away = 0.5 * limit(1e-9)
    stokes = changes(preset, degrees)[k] * (1 + side * away)
    with pytest.raises(ComputationError, match=name) as refused:
        sensitivities(preset, wrt=["liquid.viscosity"], stokes=stokes, angle=math.radians(degrees))
    said = re.search(r"relative distance of (\S+) in impact.stokes", str(refused.value))
    assert said
    # St* is located to 1e-9; the distance is printed with two digits
    assert float(said[1]) == pytest.approx(away, rel=0.05)


@pytest.mark.parametrize("edge", EDGES[1:], ids=lambda edge: f"{edge[0]} {edge[1]} {edge[3]}")
def test_beyond_the_limit_the_nearest_boundary_is_named(edge: tuple[str, int, int, str]) -> None:
    """At three times the limit on the separating side there is a derivative, and the result says what it is near."""
    preset, degrees, k, name = edge
    away = 3 * limit(1e-9)
    stokes = changes(preset, degrees)[k] * (1 + away)
    found = sensitivities(preset, wrt=["impact.stokes"], stokes=stokes, angle=math.radians(degrees))
    assert found.near is not None
    assert name in found.near.boundary
    assert found.near.distance == pytest.approx(away, rel=0.01)
    assert found.near.boundary in str(found)


def test_square_root_at_the_rim() -> None:
    """Past the rim e_n ~ sqrt(St - St*): e_n/(de_n/dSt) is twice the distance, in the limit."""
    edge = changes("pendulum", 45)[0]
    away = 3e-5
    found = sensitivities("pendulum", wrt=["impact.stokes"], stokes=edge * (1 + away), angle=math.radians(45))
    e_n, slope = found.value["restitution"], found.gradient["restitution"]["impact.stokes"]
    assert e_n is not None
    # the strings make e_n^2 bend by some thousand times the distance: 2.7 % measured
    assert e_n / float(slope or 0) / edge == pytest.approx(2 * away, rel=0.04)


def test_logarithm_at_the_saddle() -> None:
    """Past the saddle t_f ~ -ln(St - St*)/lambda: dt_f/dSt times the distance is the same at any small distance."""
    edge = changes("granulation", 55)[0]
    products = []
    for away in (2e-5, 2e-4):
        found = sensitivities("granulation", ["contact_time"], ["impact.stokes"], stokes=edge * (1 + away),
                              angle=math.radians(55))  # fmt: skip
        products.append(float(found.gradient["contact_time"]["impact.stokes"] or 0) * away)
    assert products[0] < 0
    assert products[0] == pytest.approx(products[1], rel=0.05)  # the next term is linear in the distance


def test_cvodes_refuses_beside_a_saddle() -> None:
    """Its derivatives of e_n differ from Rosenbrock's by 2e-3 of the largest there: an error names the saddle."""
    stokes = changes("granulation", 55)[0] * (1 + 1e-4)
    with pytest.raises(ComputationError, match="no derivative by cvodes.*saddle.*rosenbrock"):
        solvers.sensitivities("granulation", stokes=stokes, angle=math.radians(55), engine="cvodes")


def test_chatter_is_refused() -> None:
    """A doublet that rests before it separates: its rebounds do not end, so no derivative is given.

    No scene is known to do this (what holds at rest goes on holding), so a course is told that it did.
    """
    rests = Course(True, ("glass", "rests", "rupture"), speed=0.1)
    with pytest.raises(ComputationError, match="chatter"):
        distances.checked(lambda factors: [rests] * factors.size, True, 1e-9)


ROUGH, GLASSY = ("rough", "rupture"), ("glass", "rupture")


@pytest.mark.parametrize(
    ("below", "above", "name"),
    [
        (Course(False, ("rough",), 0.0), Course(True, ROUGH, 0.3), "saddle"),
        (Course(False, ("rough", "fell back", "rough"), 0.0), Course(True, ROUGH, 0.3), "saddle"),
        (Course(True, ("turned", "rupture"), 0.3), Course(True, ROUGH, 0.3), CONTACT),
        (Course(False, ("turned",), 0.0), Course(True, GLASSY, 0.3), GLASS),
        (Course(True, ROUGH, 0.3), Course(True, GLASSY, 0.3), GLASS),
        (Course(True, ROUGH, 0.3), Course(True, ("glass" + AT_ONCE, "rupture"), 0.3), "initial contact"),
        (Course(True, GLASSY, 0.3), Course(True, ("glass" + AT_ONCE, "rupture"), 0.3), "initial contact"),
        (Course(True, ("elastic", "rupture"), 0.3), Course(True, ROUGH, 0.3), "tie"),
        (Course(True, ROUGH, 0.3), Course(False, ("rough", "half turn"), 0.0), "half turn"),
        (Course(True, ROUGH, 0.3), Course(True, ("rough", "pop", "rupture"), 0.3), "event pop"),
        (Course(None, (), 0.0), Course(None, (), 0.0), None),
        (Course(True, ("rupture",), 0.3), Course(True, ("fell back", "turned", "rupture"), 0.3), None),
    ],
)  # fmt: skip
@pytest.mark.parametrize("place", [-2e-3, 3e-8, 0.2])
def test_a_boundary_is_named_by_what_differs(below: Course, above: Course, name: str | None, place: float) -> None:
    """Courses that change at a known speed: the distance to 1 %, and the name. Turning points alone change nothing."""
    near = along_speed(lambda factors: [above if factor > 1 + place else below for factor in factors], distances.LADDER)
    if name is None:
        assert near is None
    else:
        assert near is not None
        assert name in near.boundary
        assert near.distance == pytest.approx(abs(place), rel=0.01)


def test_a_graze_beside_a_stick_that_is_proved_at_once_is_told_by_its_opening_speed() -> None:
    """It varies with the root of the distance."""

    def courses(factors: np.ndarray) -> list[Course]:
        past = (factors - 1.01).tolist()
        return [Course(True, GLASSY, 0.4 - 0.1 * math.sqrt(d)) if d > 0 else Course(False, (), 0.0) for d in past]

    near = along_speed(courses, distances.LADDER)
    assert near is not None
    assert GLASS in near.boundary


@pytest.mark.parametrize(
    ("preset", "changes", "stokes", "angle", "distance"),
    [
        ("granulation", {"liquid.glass_transition_pressure": "1e12 Pa"}, 0.18113421633, 0.27012544955, 1.2e-3),
        ("glass-beads-water", {}, 49.715145149, 1.07492249099, 2.6e-4),
    ],
    ids=["creeps past the saddle", "just reaches the rim"],
)
def test_beside_a_separatrix(
    preset: str, changes: dict[str, object], stokes: float, angle: float, distance: float
) -> None:
    """Beside a separatrix the trajectory is landed and integrated more sharply: derivatives stay within 1e-6.

    Differences of collisions at 1e-12, with steps of a part of the distance (for their error grows with that part),
    extrapolated. The speed squared with which the trajectory passes is up to 13 times the distance.
    """
    of = ("restitution", "rotation", "contact_time")
    scene = Scene.load(preset).with_entries(changes)
    found = sensitivities(scene, of, ["impact.stokes"], stokes=stokes, angle=angle, engine="rosenbrock")
    assert found.near is not None
    assert found.near.distance == pytest.approx(distance, rel=0.1)

    def values(part: float) -> np.ndarray:
        one = collide(scene, stokes=stokes * (1 + part), angle=angle, rtol=1e-12, engine="rosenbrock", ledger=False)
        return np.array([getattr(one, name) for name in of])

    rows = [(values(h) - values(-h)) / (2 * h) for h in distance / 8 / 2.0 ** np.arange(3)]
    for order in (4, 16):
        rows = [(order * fine - coarse) / (order - 1) for coarse, fine in pairwise(rows)]
    slopes = [found.gradient[name]["impact.stokes"] * stokes for name in of]
    assert slopes == pytest.approx(rows[0], rel=1e-6)
