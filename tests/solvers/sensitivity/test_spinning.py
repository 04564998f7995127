"""Derivatives of collisions in which spheres arrive spinning, beside central differences of collisions."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers.reference import sensitivities

pytestmark = pytest.mark.slow

SPIN, SPEED = 2e5, 9.0
OF = ("restitution", "final_spin", "final_rotation_rate", "contact_time")
GRANULATION = Scene.load("granulation").with_entries({"impact.spin": SPIN})


def values(scene: Scene, speed: float) -> np.ndarray:
    found = collide(scene, speed=speed, angle=0.0, rtol=1e-12, engine="rosenbrock", ledger=False)
    return np.array([getattr(found, name) for name in OF])


def differences(scene: Scene) -> np.ndarray:
    """Derivatives by spin and speed, (results, 2)."""
    step = 1e-4
    by_spin = [values(scene.with_entries({"impact.spin": SPIN * (1 + way * step)}), SPEED) for way in (1, -1)]
    by_speed = [values(scene, SPEED * (1 + way * step)) for way in (1, -1)]
    scales = (SPIN, SPEED)
    return np.column_stack([(up - low) / (2 * step * size) for (up, low), size in zip((by_spin, by_speed), scales)])


def test_derivatives_along_the_line_of_centres() -> None:
    """At angle zero, by spin and by speed; there is no e_t, nor a spin of a partner, whatever else is asked for."""
    wrt, undefined = ["impact.spin", "impact.speed"], ["tangential_restitution", "final_spin_partner"]
    found = sensitivities(GRANULATION, [*OF, *undefined], wrt, speed=SPEED, angle=0.0, rtol=1e-10, hold="speed")
    assert [found.value[name] for name in undefined] == [None, None]
    gradient = np.array([[found.gradient[name][each] for each in wrt] for name in OF], dtype=float)
    assert gradient == pytest.approx(differences(GRANULATION), rel=1e-6)


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
