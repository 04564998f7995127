"""Unequal spheres and walls against Newton's law in the laboratory frame, and their limits."""

import math

import pytest
from wetdoublet.solvers import Scene

from ...helpers.reference import collide

pytestmark = pytest.mark.slow


def test_beside_a_wall_nothing_turns():
    """No centrifugal number, rotation or drift of an angular momentum; the wall has no spin."""
    one = collide(Scene.load("granulation").with_entries({"partner.wall": True}), stokes=0.3, angle="50 deg")
    assert (one.centrifugal, one.rotation, one.final_rotation_rate) == (0.0, 0.0, 0.0)
    assert one.angular_momentum_drift is None and one.final_spin_partner == 0.0


@pytest.mark.parametrize(
    ("ratio", "outcome"), [(-1.0, "stick"), (-0.99, "stick-rotate-separate"), (1.0, "stick-rotate-separate")]
)
def test_spins_that_cancel_leave_nothing_that_opens_a_film(ratio, outcome):
    """Head-on in a film alone: opposite spins die out and the doublet sticks, proved; any rest of L parts it."""
    scene = Scene.load("granulation-dry-bridge").with_entries({"impact.spin": 1e5, "impact.partner_spin": ratio * 1e5})
    one = collide(scene, stokes=0.02, angle="0 deg")
    assert (one.outcome, one.certified) == (outcome, outcome == "stick")


@pytest.mark.parametrize("partner", [{"partner.radius": 2e-4, "partner.mass": 8e-8}, {"partner.wall": True}])
def test_the_picture_shows_the_partner(partner):
    """Spheres are drawn to scale about their centre of mass, and a wall as a wall, as far away as the gap says."""
    scene = Scene.load("granulation").with_entries(partner)
    one = collide(scene, stokes=0.5, angle="60 deg", trajectory=True)
    figure = one.plot()
    patches = figure.axes[-1].patches
    spheres = [patch for patch in patches if patch.get_gid() == "sphere"]
    walls = [patch for patch in patches if patch.get_gid() == "wall"]
    if scene.wall:
        assert {ball.radius for ball in spheres} == {1.0} and len(walls) == len(spheres)
        gap = walls[0].get_x() - spheres[0].center[0] - 1
    else:
        assert [ball.radius for ball in spheres[:2]] == [1.0, pytest.approx(2.0)] and not walls
        gap = math.dist(spheres[0].center, spheres[1].center) - 3
    assert gap == pytest.approx(scene.liquid.film_thickness / 1e-4, rel=1e-9)
