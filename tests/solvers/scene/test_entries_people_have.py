"""Entries as people have them, each against the same scene written in the model's own quantities."""

import math

import numpy as np
import pint
import pytest
from wetdoublet.solvers import InputError, Scene, collide, collide_many, gradients_many, sensitivities
from wetdoublet.solvers.sensitivity.uncertainty import deviations

from ...helpers.entries import BASE, BRIDGE, PEOPLE, tables


def scene(*parts):
    """Return a scene of dotted entries."""
    entries = {}
    for part in parts:
        entries |= part
    return Scene.from_dict(tables(entries), from_file=True)


def test_without_a_glass_pressure_nothing_says_glass():
    """A liquid without glass-transition pressure collides as one that never reaches it."""
    stokes, angle = np.geomspace(0.01, 5, 6), np.tile([0.0, 0.7, 1.3], 2)
    without = scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": None})
    never = scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": "1e30 Pa"})
    one, other = (collide_many(each, stokes=stokes, angle=angle) for each in (without, never))
    assert np.array_equal(one.restitution, other.restitution)
    said = str(collide(without, stokes=3.0, angle=0.7))
    assert "roughness" in said and "glass" not in said
    elastic = {"particles.youngs_modulus": "1 GPa", "particles.poisson_ratio": 0.3, "particles.roughness": "0 um"}
    assert scene(BASE, {**elastic, "liquid.glass_transition_pressure": None}).liquid.glass_transition_pressure is None


def scene_in_si(entries):
    """Return a scene of dotted entries in SI."""
    return Scene.from_dict(tables(entries))


R, H, LAYER = 1e-4, 4e-6, 3e-6  # radius and coating of a sphere, the partner's coating, m
OWN = {
    "particles.radius": R, "particles.density": 2500.0, "particles.roughness": 2e-7, "particles.dry_restitution": 0.9,
    "liquid.viscosity": 0.02, "bridge.surface_tension": 0.05, "bridge.contact_angle": 0.0,
    "impact.speed": 6 * math.cos(math.radians(50)), "impact.angle": math.radians(50),
}  # fmt: skip
PAIR = {"partner.diameter": "320 um", "partner.density": "2 g/cm^3", "partner.coating_thickness": "3 um"}
WALL = {"partner.wall": True, "partner.coating_thickness": "3 um"}


def shell(radius, thickness):
    """Volume of a coating."""
    return 4 / 3 * math.pi * ((radius + thickness) ** 3 - radius**3)


def cap(radius, other):
    """The part of a sphere that lies in the shadow of another, as Shi & McCarthy (2008) have it."""
    return (1 - math.sqrt(1 - (other / (radius + other)) ** 2)) / 2


BESIDE = {  # what stands beside the sphere: as people say it; the film, R = 2a, the bridge's volume from coatings
    "equal": ({}, {}, 2 * H, R, 2 * cap(R, R) * shell(R, H)),
    "pair": (
        PAIR, {"partner.radius": 1.6e-4, "partner.density": 2000.0}, H + LAYER, 2 * R * 1.6e-4 / (R + 1.6e-4),
        cap(R, 1.6e-4) * shell(R, H) + cap(1.6e-4, R) * shell(1.6e-4, LAYER),
    ),
    "wall": (WALL, {"partner.wall": "true"}, H + LAYER, 2 * R, shell(R, H) / 2 + math.pi * R**2 * LAYER),
}  # fmt: skip


@pytest.mark.parametrize("volume", ["5e-5 mm^3", "from coating"])
@pytest.mark.parametrize("beside", BESIDE)
def test_the_same_collision_in_other_words(beside, volume):
    """Diameters, coatings, volumes and relative speeds are what they make in the model's own entries."""
    theirs, ours, film, length, flowing = BESIDE[beside]
    said = scene(PEOPLE, theirs, {"bridge.volume": volume})
    absolute = 5e-14 if volume != "from coating" else flowing
    plain = scene_in_si({**OWN, **ours, "liquid.film_thickness": film, "bridge.volume": absolute / length**3})
    assert said.speed == pytest.approx(plain.speed, rel=1e-15)
    assert said.material == pytest.approx(plain.material, rel=1e-14)
    assert Scene.from_toml(said.to_toml()) == said


@pytest.mark.slow
def test_each_entry_varies_alone():
    """Derivatives by an entry are central differences of batches, and of scenes, that differ in it alone."""
    said = scene(PEOPLE, {"bridge.volume": "from coating"})
    names = ("particles.diameter", "liquid.coating_thickness")
    found = sensitivities(said, wrt=names)
    for name in names:
        at = found.reference[name]
        assert at == pytest.approx(said.entries[name], rel=1e-14)
        sides = at * np.array([1 - 1e-5, 1 + 1e-5])
        low, high = collide_many(said, vary={name: said.as_given(name, sides)}, rtol=1e-12).restitution.values.tolist()
        one = collide(said.with_si({name: float(sides[0])}), rtol=1e-12, ledger=False)
        assert one.restitution == pytest.approx(low, rel=1e-12)
        slope = (high - low) / np.diff(sides).item()
        assert found.gradient["restitution"][name] == pytest.approx(slope, rel=2e-5, abs=1e-7 / at)


def test_many_gradients_hold_what_the_scene_gives():
    """With a relative speed the derivative by the angle holds it, at every collision of a batch."""
    said = scene(PEOPLE, {"bridge.volume": 0.05})
    angle, of = np.array([0.8, 0.9]), ["restitution", "contact_time", "final_rotation_rate"]
    names = ("impact.angle", "impact.relative_speed", "impact.speed", "liquid.coating_thickness")
    many = gradients_many(said, angle=angle, of=of, wrt=names)
    assert many.attrs["hold"] == "relative_speed"
    for k in range(2):
        one = sensitivities(said, of=of, wrt=names, angle=float(angle[k]), engine="rosenbrock").gradient
        expected = [[one[quantity][name] for name in names] for quantity in of]
        np.testing.assert_allclose(many.gradient.values[:, k], expected, rtol=1e-6)


def test_a_coating_says_what_is_assumed():
    """How much of the coating flows into the bridge is shown with the result, and where that is from."""
    said = str(collide(scene(PEOPLE, {"bridge.volume": "from coating"})))
    assert "(assumed: 0.067 of each coating, Shi & McCarthy 2008)" in said
    wall = scene(PEOPLE, {**WALL, "bridge.volume": "from coating"}).assumed
    assert any(
        "(assumed: 0.5 of the sphere's coating and the wall's layer beneath the sphere, " in line for line in wall
    )


def test_a_volume_is_kept_as_it_was_given():
    """Text with its unit in the unit that it has, a quantity of pint's as text in SI."""
    for volume, kept in (("5e-5 mm^3", "5e-5 mm^3"), (pint.Quantity(1e-13, "m^3"), "1e-13 m^3")):
        given = Scene.load("granulation").with_entries({"bridge.volume": volume})
        assert f'volume = "{kept}"' in given.to_toml().splitlines()


def test_a_volume_varies_in_either_way():
    """What varies says itself whether it is V/R^3 or a volume, whatever the scene has."""
    said = scene(PEOPLE, {"bridge.volume": "from coating"})
    ratio = collide_many(said, vary={"bridge.volume": [0.05, 0.1]})
    volume = collide_many(said, vary={"bridge.volume": ["5e-5 mm^3", "1e-13 m^3"]})
    assert volume.restitution.values == pytest.approx(ratio.restitution.values, rel=1e-9)
    assert volume["bridge.volume"].attrs["units"] == "m^3"


def test_a_volume_is_meant_as_the_scene_gives_it():
    """Deviations of V/R^3 are no volumes; a list of both is refused; an impossible one is marked, wherever it is."""
    granulation = Scene.load("granulation")
    with pytest.raises(InputError, match="is a volume, where the scene gives V/R"):
        deviations(granulation, {"bridge.volume": "1e-5 mm^3"})
    assert deviations(granulation, {"bridge.volume": 0.01}) == {"bridge.volume": 0.01}
    with pytest.raises(InputError, match="is a list of both"):
        collide_many(granulation, stokes=0.1, angle=1.0, vary={"bridge.volume": ["5e-5 mm^3", 0.1]})
    for volumes in ([1e-9, 0.1], ["1e-12 mm^3", "1e-4 mm^3"]):
        found = collide_many(granulation, stokes=0.1, angle=1.0, vary={"bridge.volume": volumes})
        assert found.outcome.values.tolist() == [-1, 1]
