"""One collision against closed forms, limits, similarity and the paper's statements."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide_many

from ...helpers.reference import collide

ENGINES = ("cvodes", "rosenbrock")


# neither glass nor elasticity before a roughness of x0/10
RIGID = {
    "liquid.glass_transition_pressure": "1e6 GPa",
    "particles.youngs_modulus": "1e9 GPa",
    "particles.roughness": "0.8 um",
}


def film_loss(s: float) -> float:
    """Lf(s) = ln(1/s) - 3/2 + 2s - s^2/2: loss of u/v0 times St between x0 and s x0."""
    return math.log(1 / s) - 1.5 + 2 * s - s * s / 2


def dry_scene(**entries: object) -> Scene:
    """Granulation without a bridge, some entries changed."""
    return Scene.load("granulation-dry-bridge").with_entries(entries)


@pytest.mark.parametrize("engine", ENGINES)
def test_head_on_roughness_rebound_has_a_closed_form(engine: str) -> None:
    """Film only, head-on, rebound by roughness: e_n = e_dry (1 - Lf/St) - Lf/St."""
    scene = dry_scene(**RIGID)
    stokes = 3.0
    loss = film_loss(0.1) / stokes
    found = collide(scene, stokes=stokes, angle=0.0, rtol=1e-11, engine=engine)
    assert found.outcome == "bounce"
    assert found.reversal == "rough"
    assert found.restitution == pytest.approx(0.99 * (1 - loss) - loss, rel=1e-9)
    assert found.smallest_gap == pytest.approx(0.8e-6, rel=1e-12)


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


def test_critical_stokes_of_the_film_alone() -> None:
    """Film only, roughness 0.1 x0: below St = Lf(0.1) the film stops the spheres, above 2 Lf/(1 + 1/e) they part."""
    scene = dry_scene(**RIGID)
    critical = film_loss(0.1) * (1 + 1 / 0.99)
    below = collide(scene, stokes=critical * (1 - 1e-7), angle=0.0, rtol=1e-11)
    above = collide(scene, stokes=critical * (1 + 1e-7), angle=0.0, rtol=1e-11)
    assert (below.outcome, above.outcome) == ("stick", "bounce")
    assert below.certified
    assert below.until is not None


def test_rebound_at_initial_contact_without_a_bridge_ruptures_at_once() -> None:
    """Glass already met at x0, no bridge: e_n = e_dry, no contact time, no rotation."""
    found = collide(dry_scene(), stokes=0.3, angle="70 deg")
    assert (found.outcome, found.reversal) == ("bounce", "glass")
    assert found.restitution == 0.99
    assert found.tangential_restitution == 1.0
    assert (found.contact_time, found.rotation) == (0.0, 0.0)
    assert [event.kind for event in found.events] == ["glass", "rupture"]


def test_figure_1_of_the_paper() -> None:
    """Pendulum at 45 deg: St 1.0 sticks, 1.3 sticks, rotates and separates, 1.5 bounces."""
    outcomes = [collide("pendulum", stokes=stokes, angle="45 deg").outcome for stokes in (1.0, 1.3, 1.5)]
    assert outcomes == ["stick", "stick-rotate-separate", "bounce"]


def test_restitution_may_exceed_one() -> None:
    """Granulation at 75 deg and St 0.02: e_n > 1, and below the ceiling that L and the ledger set."""
    found = collide("granulation", stokes=0.02, angle="75 deg")
    a, m, x0, x_f = 50e-6, 5.2e-9, 8e-6, found.scene.rupture_gap
    inertia = m * a**2 * ((4 + x_f / a) ** 2 + 32 / 5)
    assert found.energy is not None
    r0 = 4 * a + x0
    ceiling = (
        1
        + (r0 * math.tan(found.angle) / (4 * a)) ** 2 * (1 - m * r0**2 / inertia)
        - 2 * found.energy.capillary / (m * found.speed**2)
    )
    assert 1 < found.restitution**2 < ceiling


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


def test_long_strings_do_nothing() -> None:
    """Strings of near-infinite length at no gravity to speak of leave the collision without strings."""
    strings = Scene.load("pendulum").with_entries({"pendulum.length": "1e9 m", "pendulum.gravity": "1e-6 m/s^2"})
    tables = {key: value for key, value in strings.to_dict().items() if key != "pendulum"}
    free = Scene.from_dict(tables)
    one, other = (collide(scene, stokes=1.3, angle="60 deg", rtol=1e-11) for scene in (strings, free))
    assert one.outcome == other.outcome == "stick-rotate-separate"
    assert one.restitution == pytest.approx(other.restitution, rel=1e-8)


def test_small_angles_join_head_on() -> None:
    """Outcome and e_n are continuous at theta0 = 0, where other equations are integrated."""
    head_on = collide("granulation", stokes=0.14, angle=0.0, rtol=1e-11)
    nearly = collide("granulation", stokes=0.14, angle=1e-6, rtol=1e-11)
    assert nearly.restitution == pytest.approx(head_on.restitution, rel=1e-9)
    assert (head_on.tangential_restitution, head_on.rotation, head_on.centrifugal) == (None, 0.0, 0.0)
    assert nearly.tangential_restitution is not None
    assert np.isfinite(nearly.tangential_restitution)


@pytest.mark.parametrize("angle", [5e-324, 1e-300])
def test_an_angle_whose_rotation_rate_underflows_is_head_on(angle: float) -> None:
    """At the smallest positive numbers, too, alone and in a batch."""
    alone = [collide("granulation", stokes=stokes, angle=angle) for stokes in (0.01, 3.0)]
    batch = collide_many("granulation", stokes=[0.01, 3.0], angle=angle)
    head_on = collide_many("granulation", stokes=[0.01, 3.0], angle=0.0)
    assert [one.restitution for one in alone] == pytest.approx(head_on.restitution.values, rel=1e-9)
    assert batch.restitution.values.tolist() == head_on.restitution.values.tolist()
