"""Energy and angular momentum of any collision."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import Scene

from .conditioning import decided
from .scenes import QUICK, parts, scenes
from .settings import examples
from .structures import STRUCTURES, Structure

LOSSES = ("normal_lubrication", "tangential_lubrication", "dry_contact", "friction")
STORED = ("capillary", "attraction", "strings")

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


@parts
@examples(16)
@given(st.data())
def test_the_ledger_closes(structures: list[Structure], data: st.DataObject) -> None:
    """Losses, work and the energy left add up to the energy before, to the steps' errors; no loss is negative."""
    terms = decided(data.draw(scenes(structures)), rtol=1e-10).to_dict()["energy"]
    size = max(abs(value) for value in terms.values())
    spent = sum(value for name, value in terms.items() if name not in ("initial", "residual"))
    assert abs(terms["initial"] - spent) <= 1e-8 * size
    assert terms["residual"] == pytest.approx(terms["initial"] - spent, abs=1e-12 * size)
    for name in LOSSES:
        assert terms.get(name, 0.0) >= -1e-9 * size


@examples(24)
@given(scenes([each for each in QUICK if not each["strings"] and each["partner"] != "wall"]))
def test_angular_momentum_is_kept(scene: Scene) -> None:
    """L after the collision is L before, to the rounding of its parts (mid-gap arm)."""
    collision = decided(scene, rtol=1e-10)
    speed, angle = scene.need_impact()
    spins = [abs(scene.entries.get(f"impact.{name}", 0.0)) for name in ("spin", "partner_spin")]
    parts = speed * math.tan(angle) + max(spins) * 2 * scene.particles.reduced_radius
    assume(parts > 1e-3 * speed)  # nothing turns: no drift is defined
    assert collision.angular_momentum_drift is not None
    assert collision.angular_momentum_drift <= 1e-8


@examples(24)
@given(scenes(STRUCTURES[:1]))
def test_restitution_stays_below_its_ceiling(scene: Scene) -> None:
    """e_n^2 <= 1 + (r0 tan(theta0)/4a)^2 (1 - m r0^2/I(x_f)) - 2 W/(m v0^2), with I and W by their definitions."""
    collision = decided(scene, rtol=1e-10)
    assume(collision.outcome != "stick")
    a, m, x0 = scene.particles.reduced_radius, scene.particles.reduced_mass, scene.liquid.film_thickness
    speed, angle = scene.need_impact()
    terms = collision.to_dict()["energy"]
    work = sum(terms.get(name, 0.0) for name in STORED)
    reach = x0
    if scene.bridge is not None:
        bridge = scene.bridge
        reach = 2 * a * bridge.volume ** (1 / 3) * (1 + bridge.contact_angle / 2)
        assume(bridge.rupture != "own")
    r0, inertia = 4 * a + x0, m * ((4 * a + reach) ** 2 + 6.4 * a * a)
    turning = (r0 * math.tan(angle) / (4 * a)) ** 2 * (1 - m * r0 * r0 / inertia)
    ceiling = 1 + turning - 2 * work / (m * speed**2)
    assert collision.restitution**2 <= ceiling + 1e-9 * (1 + turning + abs(work) / (m * speed**2))


@parts
@examples(16)
@given(st.data())
def test_the_budget_sums_to_the_restitution(structures: list[Structure], data: st.DataObject) -> None:
    """The shares sum to e_n^2 - 1; rotation is that of the rates, and rigid rotation that of L where L is kept."""
    collision = decided(data.draw(scenes(structures)), rtol=1e-10)
    assume(collision.outcome != "stick")
    assert collision.budget is not None and collision.energy is not None
    shares, scene, v0 = dict(collision.budget), collision.scene, collision.speed
    unit = collision.energy.initial / (scene.reduced_mass * v0**2 / 2)
    size = max(unit, *map(abs, shares.values()))
    assert abs(math.fsum(shares.values()) - collision.restitution**2 + 1) <= 1e-13 * size
    assert abs(shares["residual"]) <= 1e-8 * size
    if scene.wall:
        assume(collision.tangential_restitution is not None)
        after = (collision.tangential_restitution or 0.0) * math.tan(collision.angle)
        assert collision.final_spin is not None
        after = after**2 + 0.4 * (scene.reduced_radius * collision.final_spin / v0) ** 2
        assert abs(shares["sliding"] - (unit - 1 - after)) <= 1e-8 * size
        return
    assume("slip" in shares)
    m1, r1 = 2 * scene.particles.reduced_mass, 2 * scene.particles.reduced_radius
    m2, r2 = m1 * (scene.mass_ratio or 0.0), r1 * (scene.radius_ratio or 0.0)
    m, own = m1 * m2 / (m1 + m2), (0.4 * m1 * r1**2, 0.4 * m2 * r2**2)
    near, far = (m * (r1 + r2 + gap) ** 2 for gap in (scene.liquid.film_thickness, collision.final_gap or 0.0))
    spin, rate = collision.final_spin or 0.0, collision.final_rotation_rate or 0.0
    partner = spin if collision.final_spin_partner is None else collision.final_spin_partner
    after = (far * rate**2 + own[0] * spin**2 + own[1] * partner**2) / (m * v0**2)
    assert abs(shares["rigid_rotation"] + shares["slip"] - (unit - 1 - after)) <= 1e-8 * size
    if scene.pendulum is None:
        first, second = scene.material["impact_spin"], scene.material["impact_partner_spin"]
        momentum = near * v0 * math.tan(collision.angle) / (r1 + r2) + own[0] * first + own[1] * second
        released = momentum**2 * (1 / (near + sum(own)) - 1 / (far + sum(own))) / (m * v0**2)
        assert abs(shares["rigid_rotation"] - released) <= 1e-7 * size
