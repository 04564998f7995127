"""One collision against closed forms, limits, similarity and the paper's statements."""

import math

import pytest
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide_many

from ...helpers.reference import collide

X0, X_B, E_DRY = 8e-6, 2e-7, 0.9


def lost(film: str, s: float) -> float:
    """What a film takes of St u/v0 between x0 and s x0, by hand: the integral of the resistance."""
    return math.log(1 / s) - (0.0 if film == "infinite" else 1.5 - 2 * s + s**2 / 2)


def dry_scene(**entries: object) -> Scene:
    """Granulation without a bridge, some entries changed."""
    return Scene.load("granulation-dry-bridge").with_entries(entries)


@pytest.mark.parametrize("engine", ["cvodes", "rosenbrock"])
def test_head_on_glass_rebound_has_a_closed_form(engine: str) -> None:
    """Film only, head-on, reversed where (1 - Lf(s)/St)/s^2 first reaches the glass number."""
    scene, stokes = dry_scene(), 0.2
    glass = 20e6 * X0**2 / (3 * 2.0 * 50e-6 * scene.speed_of(stokes))
    s = brentq(lambda s: (1 - lost("finite", s) / stokes) / s**2 - glass, 0.5, 1.0, xtol=1e-15)
    taken = lost("finite", s) / stokes
    found = collide(scene, stokes=stokes, angle=0.0, rtol=1e-11, engine=engine)
    assert found.reversal == "glass"
    assert found.restitution == pytest.approx(0.99 * (1 - taken) - taken, rel=1e-9)


@pytest.mark.parametrize("film", ["finite", "infinite", "cavitating"])
def test_head_on_rough_rebound_has_a_closed_form(film: str) -> None:
    """The outcome changes where the closed form says, and below it the stick is proved.

    A reversed doublet leaves with e_dry (1 - L/St) - L/St, or, cavitating, with e_dry (1 - L/St): there is no suction.
    """
    never = {"liquid.glass_transition_pressure": "1e6 GPa", "particles.youngs_modulus": "1e9 GPa"}
    alone = dry_scene(**never, **{"particles.dry_restitution": E_DRY, "model.film": film})
    level, suction = lost(film, X_B / X0), film != "cavitating"
    threshold = level * (1 + suction / E_DRY)
    below, *above = (collide(alone, stokes=threshold * f, angle=0.0) for f in (1 - 1e-5, 1 + 1e-5, 1.2, 4.0))
    assert (below.outcome, below.certified) == ("stick", True)
    assert {(each.outcome, each.reversal) for each in above} == {("bounce", "rough")}
    for one in above[1:]:
        taken = level / one.scene.stokes_of(one.speed)
        assert one.restitution == pytest.approx(E_DRY * (1 - taken) - suction * taken, rel=1e-7)


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
