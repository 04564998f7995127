"""Bodies that arrive with spins, beside references written from the physics alone."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers import in_space
from ...helpers.random_spinning import impact_of, scenes, tables
from ...helpers.spinning import FILM, PARTNER, SPIN, TURNING, Planar, U
from ...helpers.two_bodies import bodies_of

DRAWN = list(scenes(60, 2012, 60))
SEPARATE = (3, 5, 6, 7, 8, 10, 25, 44, 50, 53, 57)
STICK = (2, 13)
SAME = 1e-8

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


def drawn(number: int) -> Scene:
    return Scene.from_dict(tables(*DRAWN[number]))


def surface_speeds(scene: Scene, rates: Sequence[float | None]) -> np.ndarray:
    """Spins of both and the rotation rate, as surface speeds over the largest ones at initial contact."""
    bodies, impact = bodies_of(scene), impact_of(scene)
    lengths = (*bodies.radii, bodies.contact)
    used = [(0.0 if math.isinf(length) else length) * (rate or 0.0) for length, rate in zip(lengths, rates)]
    fastest = impact.speed * (1 + math.tan(impact.angle))
    return np.array(used) / (fastest + abs(impact.spin) * bodies.radii[0])


@pytest.mark.parametrize("number", SEPARATE)
def test_spinning_bodies_part_as_the_reference_says(number: int) -> None:
    """Outcome, restitution, both spins and the rotation rate: pairs and walls, films, laws, attraction, head-on."""
    scene = drawn(number)
    course = Planar(bodies_of(scene), impact_of(scene))
    end = course.run()
    found = collide(scene, rtol=1e-11, engine="cvodes", ledger=False)
    assert found.outcome == end.outcome != "stick"
    assert found.restitution == pytest.approx(end.state[U] / course.speed, rel=SAME)
    expected = surface_speeds(scene, (end.state[SPIN], end.state[PARTNER], end.state[TURNING]))
    partner = found.final_spin_partner if scene.partner or "impact.partner_spin" in scene.entries else found.final_spin
    rates = surface_speeds(scene, (found.final_spin, partner, found.final_rotation_rate))
    assert rates == pytest.approx(expected, abs=SAME)


@pytest.mark.parametrize("number", STICK)
def test_spinning_bodies_that_stick(number: int) -> None:
    """The reference holds them together too."""
    scene = drawn(number)
    assert Planar(bodies_of(scene), impact_of(scene)).run().outcome == "stick"
    assert collide(scene, rtol=1e-11, engine="cvodes", ledger=False).outcome == "stick"


def test_a_resting_doublet_that_its_spins_lift_is_released_once() -> None:
    """At release no force is left: rounding decides neither the direction nor the events (head-on, unequal spins)."""
    entries = {
        "particles": {"radius": 3.5e-3, "mass": 2.1e-3, "roughness": 1e-8, "dry_restitution": 0.0},
        "liquid": {"viscosity": 4.2e-3, "film_thickness": 5.3e-5, "glass_transition_pressure": 6.6},
        "impact": {"stokes": 5.3, "angle": 0.0, "partner_spin": -1.05, "spin": -1.5},
        "bridge": {"surface_tension": 8.8e-9, "volume": 6e-4, "contact_angle": 0.85, "law": "constant"},
        "attraction": {"hamaker": 3.0e-14},
        "model": {"film": "cavitating", "glass": "film-corrected"},
    }
    scene = Scene.from_dict(entries)
    course = Planar(bodies_of(scene), impact_of(scene))
    end = course.run()
    for engine in ("rosenbrock", "taylor"):
        found = collide(scene, rtol=1e-11, engine=engine)
        assert [event.kind for event in found.events] == ["glass", "rests", "released", "film edge", "rupture"]
        assert found.outcome == end.outcome == "bounce"
        assert found.restitution == pytest.approx(end.state[U] / course.speed, rel=SAME)


@pytest.mark.parametrize("number", [8, 44])
def test_the_references_agree(number: int) -> None:
    """A pair and a wall: the plane's end is that in space, whose energies and momenta add up."""
    scene = drawn(number)
    bodies, impact = bodies_of(scene), impact_of(scene)
    end = Planar(bodies, impact).run()
    axes = (2 / 3, -1 / 3, 2 / 3), (1 / 3, -2 / 3, -2 / 3)
    arrival = in_space.planar_arrival(bodies, impact, axes, (0.3 * impact.speed, 0.0, impact.speed))
    course = in_space.Spatial(bodies, arrival)
    space = course.run()
    assert space.outcome == end.outcome
    assert course.opening(space.state, space.state)[0] == pytest.approx(end.state[U], abs=1e-11 * impact.speed)
    out = in_space.cross(*axes)
    spins = [in_space.dot(in_space.at(space.state, each), out) for each in (in_space.SPIN, in_space.OTHER_SPIN)]
    both = surface_speeds(scene, (*spins, 0.0)), surface_speeds(scene, (end.state[SPIN], end.state[PARTNER], 0.0))
    assert both[0] == pytest.approx(both[1], abs=1e-11)
    spent = sum(space.state[in_space.FILM :]) + space.dry
    assert course.kinetic(space.state) + spent == pytest.approx(course.energy, rel=1e-12)
    assert Planar(bodies, impact).kinetic(end.state) + sum(end.state[FILM:]) + end.dry == pytest.approx(
        course.energy, rel=1e-12
    )
    if not bodies.wall:
        before, after = (np.array(course.angular_momentum(y)) for y in (space.start, space.state))
        assert after == pytest.approx(before, abs=1e-11 * bodies.m * bodies.contact * course.fastest)
