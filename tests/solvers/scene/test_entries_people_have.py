"""Entries as people have them, each against the same scene written in the model's own quantities."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, band, collide_many, gradients_many, sensitivities
from wetdoublet.solvers.sensitivity.uncertainty import deviations

from ...helpers.entries import BASE, BRIDGE, refused, tables
from ...helpers.reference import collide

ELASTIC = {"particles.youngs_modulus": "1 GPa", "particles.poisson_ratio": 0.3}


def scene(*parts):
    """Return a scene of dotted entries."""
    entries = {}
    for part in parts:
        entries |= part
    return Scene.from_dict(tables(entries), from_file=True)


def test_without_a_glass_pressure_nothing_says_glass():
    """A liquid without glass-transition pressure collides as one that never reaches it, by either engine."""
    with_, without = (
        scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": "1e30 Pa"}),
        scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": None}),
    )
    stokes, angle = np.geomspace(0.01, 5, 6), np.tile([0.0, 0.7, 1.3], 2)
    for engine in ("taylor", "rosenbrock"):
        one, other = (collide_many(each, stokes=stokes, angle=angle, engine=engine) for each in (with_, without))
        assert np.array_equal(one.restitution, other.restitution)
        assert np.array_equal(one.outcome, other.outcome)
    said = str(collide(without, stokes=3.0, angle=0.7))
    assert "roughness" in said
    assert "glass" not in said


def test_something_must_stop_the_approach():
    """Without glass criterion, roughness and elastic constants no criterion is left, which is refused."""
    smooth = {**BASE, "liquid.glass_transition_pressure": None, "particles.roughness": "0 um"}
    assert refused(smooth).field == "particles.roughness"
    assert scene(smooth, ELASTIC).liquid.glass_transition_pressure is None


R, H, LAYER = 1e-4, 4e-6, 3e-6  # radius and coating of a sphere, the partner's coating, m
PEOPLE = {
    "particles.diameter": "200 um", "particles.density": "2.5 g/cm^3", "particles.roughness": "0.2 um",
    "particles.dry_restitution": 0.9, "liquid.viscosity": "20 mPa s", "liquid.coating_thickness": "4 um",
    "bridge.surface_tension": "50 mN/m", "impact.relative_speed": "6 m/s", "impact.angle": "50 deg",
}  # fmt: skip
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
        PAIR,
        {"partner.radius": 1.6e-4, "partner.density": 2000.0},
        H + LAYER,
        2 * R * 1.6e-4 / (R + 1.6e-4),
        cap(R, 1.6e-4) * shell(R, H) + cap(1.6e-4, R) * shell(1.6e-4, LAYER),
    ),
    "wall": (WALL, {"partner.wall": "true"}, H + LAYER, 2 * R, shell(R, H) / 2 + math.pi * R**2 * LAYER),
}


@pytest.mark.parametrize("volume", ["5e-5 mm^3", "from coating"])
@pytest.mark.parametrize("beside", BESIDE)
def test_the_same_collision_in_other_words(beside, volume):
    """Diameters, coatings, volumes and relative speeds are what they make in the model's own entries."""
    theirs, ours, film, length, flowing = BESIDE[beside]
    said = scene(PEOPLE, theirs, {"bridge.volume": volume})
    absolute = 5e-14 if volume != "from coating" else flowing
    written = {"liquid.film_thickness": film, "bridge.volume": absolute / length**3}
    plain = Scene.from_dict(tables({**OWN, **ours, **written}))
    one, other = collide(said, engine="rosenbrock"), collide(plain, engine="rosenbrock")
    assert one.outcome == other.outcome != "stick"
    assert one.restitution == pytest.approx(other.restitution, rel=1e-9)
    assert one.contact_time == pytest.approx(other.contact_time, rel=1e-9)
    assert Scene.from_toml(said.to_toml()) == said


VARIED = {  # scenes, and their entries whose derivatives are looked at
    ("pair", "from coating"): (
        "particles.diameter",
        "partner.diameter",
        "liquid.coating_thickness",
        "partner.coating_thickness",
    ),
    ("wall", "from coating"): ("liquid.coating_thickness", "partner.coating_thickness"),
    ("equal", "5e-5 mm^3"): ("bridge.volume", "particles.diameter", "impact.relative_speed", "impact.angle"),
}


@pytest.mark.parametrize(("beside", "volume"), VARIED)
@pytest.mark.slow
def test_each_entry_varies_alone(beside, volume):
    """Derivatives by an entry are central differences of scenes, and of batches, that differ in it alone."""
    said = scene(PEOPLE, BESIDE[beside][0], {"bridge.volume": volume})
    names = VARIED[beside, volume]
    found = sensitivities(said, wrt=names, engine="taylor")
    for name in names:
        at = found.reference[name]
        assert at == pytest.approx(said.entries[name], rel=1e-14)
        sides = at * np.array([1 - 1e-5, 1 + 1e-5])
        if name.startswith("impact."):
            moved = [said.with_impact(**{name.partition(".")[2]: float(side)}) for side in sides]
            low, high = (collide(each, rtol=1e-12, engine="taylor", ledger=False).restitution for each in moved)
        else:
            many = collide_many(said, vary={name: said.as_given(name, sides)}, rtol=1e-12, engine="taylor")
            low, high = many.restitution.values.tolist()
            one = collide(said.with_si({name: float(sides[0])}), rtol=1e-12, engine="taylor", ledger=False)
            assert one.restitution == pytest.approx(low, rel=1e-12)
        slope = (high - low) / np.diff(sides).item()
        assert found.gradient["restitution"][name] == pytest.approx(slope, rel=2e-5, abs=1e-7 / at)


def test_many_gradients_hold_what_the_scene_gives():
    """With a relative speed the derivative by the angle holds it, at every collision of a batch."""
    said = scene(PEOPLE, {"bridge.volume": 0.05})
    angle = np.array([0.8, 0.9])
    of = ["restitution", "contact_time", "final_rotation_rate"]
    names = ("impact.angle", "impact.relative_speed", "impact.speed", "liquid.coating_thickness")
    many = gradients_many(said, angle=angle, of=of, wrt=names, engine="taylor")
    assert many.attrs["hold"] == "relative_speed"
    for k in range(2):
        one = sensitivities(said, of=of, wrt=names, angle=float(angle[k]), engine="rosenbrock")
        for name in names:
            for quantity in of:
                got = float(many.gradient.sel(quantity=quantity, parameter=name)[k])
                assert got == pytest.approx(one.gradient[quantity][name], rel=1e-6)


def test_relative_speed_is_kept_and_replaced():
    """An angle alone keeps the relative speed; a normal speed or Stokes number replaces it."""
    said = scene(PEOPLE, {"bridge.volume": 0.05})
    assert said.speed == 6 * math.cos(math.radians(50))
    assert said.with_impact(angle="60 deg").speed == pytest.approx(3.0)
    assert said.with_impact(speed=1.5).speed == 1.5
    assert "impact.relative_speed" not in said.with_impact(stokes=0.1).entries
    many = collide_many(said, angle=[0.0, 1.0])
    assert many.speed.values == pytest.approx([6.0, 6 * math.cos(1.0)], rel=1e-15)


@pytest.mark.parametrize(
    ("changes", "field", "says"),
    [
        ({"liquid.film_thickness": "8 um"}, "liquid.coating_thickness", "together with liquid.film_thickness"),
        ({"liquid.coating_thickness": None, "liquid.film_thickness": "8 um"}, "bridge.volume", "without liquid.coat"),
        ({"liquid.coating_thickness": "0 um"}, "liquid.coating_thickness", "makes no film"),
        ({"partner.wall": True}, "partner.coating_thickness", "0 um for a dry wall"),
        ({**WALL, "bridge.coating_fraction": 0.1}, "bridge.coating_fraction", "beside a wall"),
        ({"bridge.volume": 0.1, "bridge.coating_fraction": 0.1}, "bridge.coating_fraction", '"from coating"'),
        ({"bridge.coating_fraction": 1e-9}, "bridge.volume", "a larger bridge.coating_fraction"),
        ({"bridge.volume": "1e-30 m^3"}, "bridge.volume", "a volume above 5.12e-16 m^3"),
        ({"bridge.volume": "of coating"}, "bridge.volume", 'or "from coating"'),
        ({"particles.radius": "1 mm"}, "particles.diameter", "together with particles.radius"),
        ({**PAIR, "partner.radius": "1 mm"}, "partner.diameter", "together with partner.radius"),
        ({**PAIR, "partner.diameter": "10 m"}, "partner.diameter", "too far from the sphere's"),
        ({"impact.speed": "1 m/s"}, "impact.relative_speed", "together with impact.speed"),
    ],
)
def test_every_new_way_of_being_wrong(changes, field, says):
    """Each mistake is refused by its entry, in one line with what is accepted."""
    error = refused({**PEOPLE, "bridge.volume": "from coating", **changes})
    assert error.field == field
    assert says in str(error)


def test_coatings_go_with_coatings():
    """A partner's coating stands beside the sphere's own, not beside the film that is both."""
    assert "both coatings together" in str(refused({**BASE, **PAIR})).partition("; accepted: ")[2]


def test_a_coating_says_what_is_assumed():
    """How much of the coating flows into the bridge is shown with the result, and where that is from."""
    said = str(collide(scene(PEOPLE, {"bridge.volume": "from coating"})))
    assert "(assumed: 0.067 of each coating, Shi & McCarthy 2008)" in said
    wall = scene(PEOPLE, {**WALL, "bridge.volume": "from coating"}).assumed
    assert any(
        "(assumed: 0.5 of the sphere's coating and the wall's layer beneath the sphere, " in line for line in wall
    )


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


def test_an_entry_left_to_its_default_is_uncertain_all_the_same():
    """The band of a contact angle that the scene leaves out is that of 0 deg written down."""
    given = {name: value for name, value in Scene.load("granulation").given if name != "bridge.contact_angle"}
    left_out = Scene("", tuple(given.items()))
    bands = [
        band(one, {"bridge.contact_angle": "5 deg"}, "impact.stokes", [0.1, 0.2], samples=8)
        for one in (left_out, left_out.with_entries({"bridge.contact_angle": "0 deg"}))
    ]
    for name in bands[0].data_vars:
        np.testing.assert_array_equal(bands[0][name], bands[1][name])


def test_the_entries_of_a_result_make_its_scene_again():
    """The scene of a JSON object collides to the same numbers where the volume is given in its unit."""
    given = Scene.load("granulation").with_entries({"bridge.volume": "5e-14 m^3"})
    one = collide(given, stokes=0.1, angle="75 deg")
    again = Scene.load("granulation").with_entries(one.to_dict()["scene"])
    assert collide(again).restitution == one.restitution
