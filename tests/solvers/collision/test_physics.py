"""One collision against closed forms, limits, similarity and the paper's statements."""

import math

import pytest
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide_many

from ...helpers.reference import collide

ENGINES = ("cvodes", "rosenbrock")


# neither glass nor elasticity before a roughness of x0/10


def film_loss(s: float) -> float:
    """Lf(s) = ln(1/s) - 3/2 + 2s - s^2/2: loss of u/v0 times St between x0 and s x0."""
    return math.log(1 / s) - 1.5 + 2 * s - s * s / 2


def dry_scene(**entries: object) -> Scene:
    """Granulation without a bridge, some entries changed."""
    return Scene.load("granulation-dry-bridge").with_entries(entries)


@pytest.mark.parametrize("engine", ENGINES)
def test_head_on_glass_rebound_has_a_closed_form(engine: str) -> None:
    """Film only, head-on, reversed where (1 - Lf(s)/St)/s^2 first reaches the glass number."""
    scene, stokes = dry_scene(), 0.2
    a, mu, x0, p_gt = 50e-6, 2.0, 8e-6, 20e6
    speed = scene.speed_of(stokes)
    glass = p_gt * x0**2 / (3 * mu * a * speed)
    s = brentq(lambda s: (1 - film_loss(s) / stokes) / s**2 - glass, 0.5, 1.0, xtol=1e-15)
    before = 1 - film_loss(s) / stokes
    found = collide(scene, stokes=stokes, angle=0.0, rtol=1e-11, engine=engine)
    assert found.reversal == "glass"
    assert found.restitution == pytest.approx(0.99 * before - film_loss(s) / stokes, rel=1e-9)


def test_rebound_at_initial_contact_without_a_bridge_ruptures_at_once() -> None:
    """Glass already met at x0, no bridge: e_n = e_dry, no contact time, no rotation."""
    found = collide(dry_scene(), stokes=0.3, angle="70 deg")
    assert (found.outcome, found.reversal) == ("bounce", "glass")
    assert found.restitution == 0.99
    assert found.tangential_restitution == 1.0
    assert (found.contact_time, found.rotation) == (0.0, 0.0)
    assert [event.kind for event in found.events] == ["glass", "rupture"]


def test_without_capillary_force_only_head_on_sticks() -> None:
    """No bridge: an oblique doublet always separates, however slow; head-on at the same St sticks."""
    assert collide("granulation-dry-bridge", stokes=0.01, angle=0.0).outcome == "stick"
    for angle in ("0.1 deg", "5 deg", "80 deg"):
        assert collide("granulation-dry-bridge", stokes=0.01, angle=angle).outcome == "stick-rotate-separate"


def test_slow_escape_follows_the_one_fifth_power() -> None:
    """An oblique doublet held by the film alone: e_n ~ St^(1/5) for small St."""
    low, high = (
        collide("granulation-dry-bridge", stokes=stokes, angle="45 deg", rtol=1e-10).restitution
        for stokes in (1e-6, 1e-5)
    )
    assert math.log10(high / low) == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize("angle", [5e-324, 1e-300])
def test_an_angle_whose_rotation_rate_underflows_is_head_on(angle: float) -> None:
    """At the smallest positive numbers, too, alone and in a batch."""
    alone = [collide("granulation", stokes=stokes, angle=angle) for stokes in (0.01, 3.0)]
    batch = collide_many("granulation", stokes=[0.01, 3.0], angle=angle)
    head_on = collide_many("granulation", stokes=[0.01, 3.0], angle=0.0)
    assert [one.restitution for one in alone] == pytest.approx(head_on.restitution.values, rel=1e-9)
    assert batch.restitution.values.tolist() == head_on.restitution.values.tolist()
