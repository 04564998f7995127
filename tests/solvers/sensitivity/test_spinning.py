"""Derivatives of collisions in which spheres arrive spinning, beside central differences of collisions."""

import math
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide, gradients_many

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


def test_the_kernel_differentiates_by_spins() -> None:
    """As above by the kernel, for collisions at zero and at other angles; what is undefined at zero is NaN."""
    wrt: dict[str, Any] = {"wrt": ["impact.spin", "impact.speed"], "hold": "speed", "rtol": 1e-10}
    of = [*OF, "tangential_restitution"]
    found = gradients_many(GRANULATION, speed=[SPEED, SPEED], angle=[0.0, 0.5], of=of, engine="taylor", **wrt)
    assert set(found["engine"].values.tolist()) == {"taylor"}
    assert found["gradient"].values[: len(OF), 0] == pytest.approx(differences(GRANULATION), rel=1e-6)
    assert np.isnan(found["value"].values[-1, 0]) and np.all(np.isnan(found["gradient"].values[-1, 0]))
    beside = sensitivities(GRANULATION, of, speed=SPEED, angle=0.5, engine="rosenbrock", **wrt)
    rows = np.array([[beside.gradient[name][each] for each in wrt["wrt"]] for name in of], dtype=float)
    assert found["gradient"].values[:, 1] == pytest.approx(rows, rel=1e-7)


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


@pytest.mark.parametrize("partner", [{}, {"partner.wall": True}], ids=["sphere", "wall"])
def test_slip_restitution_has_derivatives(partner: dict[str, object]) -> None:
    """By angle and spin, beside central differences; there is none head-on, where nothing slips."""
    scene = GRANULATION.with_entries(partner).with_impact(speed=SPEED, angle=0.5)
    found = sensitivities(scene, ["slip_restitution"], ["impact.angle", "impact.spin"], hold="speed")
    for name, p in found.reference.items():

        def value(part: float, name: str = name, p: float = p) -> float:
            changed = scene.with_entries({name: p * (1 + part)})
            one = collide(changed, rtol=1e-12, engine="rosenbrock", ledger=False).slip_restitution
            assert one is not None
            return one

        assert value(0) == pytest.approx(found.value["slip_restitution"], rel=1e-8)
        slope = (8 * (value(1e-3) - value(-1e-3)) - (value(2e-3) - value(-2e-3))) / (12e-3 * p)  # of fourth order
        assert found.gradient["slip_restitution"][name] == pytest.approx(slope, rel=1e-7)
    still = sensitivities("granulation", ["slip_restitution"], ["impact.angle"], speed=SPEED, angle=0.0)
    assert still.value["slip_restitution"] is still.gradient["slip_restitution"]["impact.angle"] is None
