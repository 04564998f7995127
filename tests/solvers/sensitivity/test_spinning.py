"""Derivatives of collisions in which spheres arrive spinning, beside central differences of collisions."""

import math

import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers.reference import sensitivities

pytestmark = pytest.mark.slow

SPEED = 9.0


def test_where_nothing_spins_yet_spins_have_derivatives() -> None:
    """Head-on, the spins and the rotation after a collision are odd in those before it."""
    plain = Scene.load("granulation")
    found = sensitivities(plain, ["final_spin", "rotation", "restitution"], ["impact.spin"], speed=SPEED, angle=0.0)
    near = collide(plain.with_entries({"impact.spin": 1.0}), speed=SPEED, angle=0.0, rtol=1e-11, engine="rosenbrock")
    # the next term is the square of the spin's tangential speed over the normal one: 1e-11
    assert found.gradient["final_spin"]["impact.spin"] == pytest.approx(near.final_spin, rel=1e-8)
    assert found.gradient["rotation"]["impact.spin"] == pytest.approx(near.rotation, rel=1e-8)
    assert found.gradient["restitution"]["impact.spin"] == 0.0
    assert math.isfinite(found.value["restitution"])


def test_a_spin_is_kept_where_the_doublet_parts_at_initial_contact() -> None:
    """Thrown apart at initial contact, a sphere keeps the spin that it came with; of nothing else it has one."""
    wrt = ["impact.spin", "liquid.viscosity"]
    for angle in (0.0, 0.5):
        found = sensitivities("granulation-dry-bridge", ["final_spin"], wrt, stokes=0.4, angle=angle, engine="taylor")
        assert found.engine == "taylor"
        assert found.gradient["final_spin"] == {"impact.spin": 1.0, "liquid.viscosity": 0.0}
