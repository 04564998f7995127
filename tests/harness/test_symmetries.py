"""What does not change a collision: units, names of the bodies, a partner that is a copy, a wall that is a sphere."""

import math
from functools import cache

import pint
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import Scene
from wetdoublet.solvers.scene.schema import FIELDS

from ..helpers.entries import tables
from .conditioning import Conditioned, decided
from .scenes import QUICK, scenes
from .settings import examples
from .structures import STRUCTURES

factors = st.floats(0.01, 100.0)

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


@cache
def units() -> pint.UnitRegistry:
    """A registry, made when the first unit is asked for."""
    return pint.UnitRegistry()


def powers(entry: str) -> dict[str, float]:
    """Powers of length, mass and time in an entry's unit."""
    unit = FIELDS[entry].unit
    found = units()(unit).dimensionality if unit and unit not in ("rad", "1") else {}
    return {name: float(found.get(f"[{name}]", 0)) for name in ("length", "mass", "time")}


@examples(20)
@given(scenes(QUICK), factors, factors, factors)
def test_similarity(scene: Scene, length: float, mass: float, time: float) -> None:
    """A scene measured in other units of length, mass and time collides alike."""
    scales = {"length": length, "mass": mass, "time": time}
    entries = {
        name: value * math.prod(scales[unit] ** power for unit, power in powers(name).items())
        for name, value in scene.si
        if isinstance(value, float)
    }
    computed = Conditioned(scene)
    other = decided(scene.with_entries(entries), rtol=1e-11)
    names = ("restitution", "tangential_restitution", "rotation")
    computed.agree(other, 1e-8, names)
    if other.outcome != "stick":
        assert other.contact_time == pytest.approx(computed.collision.contact_time * time, rel=1e-6)


@examples(6)
@given(scenes([STRUCTURES[0] | {"bridge": ""}]))  # which always parts
def test_a_partner_equal_to_the_sphere_is_the_sphere(scene: Scene) -> None:
    """The equations of unequal spheres give at ratio 1 what those of equal ones give."""
    entries = scene.entries
    radius, density = 2 * entries["particles.reduced_radius"], entries["particles.density"]
    computed = Conditioned(scene)
    other = decided(scene.with_entries({"partner.radius": radius, "partner.density": density}), rtol=1e-11)
    computed.agree(other, 1e-8)


@examples(12)
@given(scenes(STRUCTURES[9:10]))
def test_which_sphere_is_named_first_does_not_matter(scene: Scene) -> None:
    """Outcome and restitution are those of the exchanged pair."""
    entries = dict(scene.entries)
    radius, density = 2 * entries["particles.reduced_radius"], entries["particles.density"]
    spin = entries.get("impact.spin", 0.0)
    exchanged = {
        "particles.reduced_radius": entries["partner.radius"] / 2,
        "particles.density": entries["partner.density"],
        "partner.radius": radius,
        "partner.density": density,
        "impact.spin": entries.get("impact.partner_spin", spin),
        "impact.partner_spin": spin,
    }
    if "bridge.volume" in entries:  # V/R^3 is of the pair
        exchanged["bridge.volume"] = entries["bridge.volume"]
    computed = Conditioned(scene)
    speed, _ = scene.need_impact()
    other = decided(scene.with_entries(exchanged), speed=speed, rtol=1e-11)
    computed.agree(other, 1e-8, ("restitution", "tangential_restitution", "rotation", "contact_time"))


@pytest.mark.slow
@examples(12)
@given(scenes([each for each in STRUCTURES if each["partner"] == "wall" and not each["friction"]][1:2]))
def test_a_wall_is_a_huge_partner(scene: Scene) -> None:
    """Restitution tends to that beside a wall as 1/ratio: extrapolated in 1/ratio and its square it is that."""
    computed = Conditioned(scene)
    entries = {name: value for name, value in scene.entries.items() if name != "partner.wall"}
    radius = 2 * scene.entries["particles.reduced_radius"]
    mass = 4 / 3 * math.pi * radius**3 * scene.entries["particles.density"]
    speed, angle = scene.need_impact()
    assume(computed.collision.outcome != "stick")  # any orbit, however slow, parts what a cavitating film would hold
    assume(math.tan(angle) < 3)  # or its orbit matters all the same
    found = []
    for ratio in (2e3, 4e3, 8e3):
        partner = {"partner.radius": ratio * radius, "partner.mass": ratio * mass, "impact.partner_spin": 0.0}
        huge = Scene.from_dict(tables({**entries, **partner}))
        found.append(decided(huge, speed=speed, rtol=1e-11))
    assert {other.outcome for other in found} == {computed.collision.outcome}
    few, more, most = (other.restitution for other in found)
    limit = (8 * most - 6 * more + few) / 3
    scale = computed.collision.restitution + computed.slopes["restitution"]
    assert limit == pytest.approx(computed.collision.restitution, abs=1e-5 * scale)


@examples(6)
@given(scenes([STRUCTURES[1] | {"attraction": ""}]))
def test_a_reflection_changes_nothing(scene: Scene) -> None:
    """Along the line of centres the sense of the spins is arbitrary."""
    spins = {name: -value for name, value in scene.entries.items() if name in ("impact.spin", "impact.partner_spin")}
    computed = Conditioned(scene)
    computed.agree(decided(scene.with_entries(spins), rtol=1e-11), 1e-9, ("restitution", "contact_time"))
