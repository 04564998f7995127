"""Scenes: presets, entries, their way into the model, both ways of the impact, and the way to a file and back."""

import copy
import math
import pickle
from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.derive.vocabulary.quantities import VOCABULARY
from wetdoublet.solvers import collide
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene import scenefile
from wetdoublet.solvers.scene.groups import scaled
from wetdoublet.solvers.scene.quantities import Ways, quantities
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.scene.scenefile import PRESETS
from wetdoublet.solvers.scene.schema import FIELDS, Particles

from ...harness.scenes import scenes
from ...helpers.data import COLLISIONS as REFERENCE
from ...helpers.entries import BASE, BRIDGE, refused, tables

IMPACTS = (
    {"stokes": 0.02}, {"speed": "54 cm/s"}, {"relative_speed": 1.5, "angle": "20 deg"}, {"angle": 0.0},
    {"stokes": "0.3", "angle": 1}, {"relative_speed": "2 m/s"},
)  # fmt: skip
BARE = "".join(Scene.load("pendulum").to_toml().partition("[impact]")[:1])


@pytest.mark.parametrize(
    "scene",
    [*map(Scene.load, PRESETS), Scene.from_toml(BARE), Scene.load("granulation").with_entries({"partner.wall": True})],
    ids=[*PRESETS, "without impact", "wall"],
)
def test_another_impact_is_the_scene_with_those_entries(scene):
    """Every field is what the whole construction gives, also of an impact after an impact; the first scene is left."""
    before = pickle.dumps(scene)
    for first in IMPACTS:
        for impact in IMPACTS:
            found = scene.with_impact(**first).with_impact(**impact)
            whole = Scene(found.name, found.given, found.comments, found.package, found.held)
            assert {field.name: getattr(found, field.name) for field in fields(Scene)} == {
                field.name: getattr(whole, field.name) for field in fields(Scene)
            }
            assert (found.si, found.impact, found.to_toml()) == (whole.si, whole.impact, whole.to_toml())
            assert (found.speed, found.stokes, found.material) == (whole.speed, whole.stokes, whole.material)
            assert found.rupture_gap == whole.rupture_gap
            assert Scene.from_toml(found.to_toml()) == found
    assert pickle.loads(before) == scene


@pytest.mark.parametrize("name", PRESETS)
def test_presets_run_and_say_where_they_are_from(name):
    """Every preset collides, every entry has a comment, and what is no one's number is marked as assumed."""
    scene = Scene.load(name)
    assert collide(scene, ledger=False, engine="rosenbrock").outcome in ("bounce", "stick-rotate-separate")
    assert {entry for entry, _ in scene.comments} == set(scene.entries)
    assert set(dict(scene.guesses)) < set(scene.entries)
    assert len(scenefile.description(name)) < 80


def test_comments_stay_with_their_entries():
    """Comments behind entries survive a change of another entry, and a # within text is none."""
    text = Scene.load("lactose-pvp").to_toml().replace('name = "lactose-pvp"', 'name = "a # b"')
    scene = Scene.from_toml(text).with_entries({"liquid.viscosity": "9 mPas"})
    assert "liquid.viscosity" not in dict(scene.comments)
    assert "impact.angle" not in dict(scene.with_impact(angle="30 deg").guesses)
    assert dict(scene.comments)["particles.diameter"] == "a sieve fraction of granules"
    assert Scene.from_toml(scene.to_toml()).comments == scene.comments


def test_presets_are_the_papers():
    """Presets hold the printed values, an impact, and say what is assumed."""
    granulation, pendulum, dry = (Scene.load(name) for name in scenefile.OF_THE_PAPER)
    assert (granulation.stokes, granulation.angle) == (0.03, pytest.approx(math.radians(60)))
    assert (pendulum.stokes, pendulum.angle) == (1.3, pytest.approx(math.radians(45)))
    assert pendulum.bridge is None and pendulum.pendulum is not None and pendulum.pendulum.length == 0.5
    assert [len(scene.assumed) for scene in (granulation, pendulum, dry)] == [2, 3, 2]
    assert "pendulum.length = 0.5 m (assumed" in pendulum.assumed[2]
    without = {name: value for name, value in granulation.entries.items() if not name.startswith("bridge.")}
    assert dry.entries == without


@pytest.mark.parametrize("case", REFERENCE, ids=lambda case: case["name"])
def test_reference_speeds_and_lengths(case):
    """Speed, rupture gap and elastic length are those of the independent reference."""
    tables = case["scene"] | {"model": case["scene"]["model"] | {"arm": "midgap"}}
    scene = Scene.from_dict(tables, from_file=True).with_impact(**case["impact"])
    assert scene.speed == pytest.approx(case["speed"], rel=1e-14)
    assert scene.rupture_gap == pytest.approx(case["rupture_gap"], rel=1e-14)
    elastic = scaled("elastic_gap", scene, scene.speed) * scene.liquid.film_thickness
    assert elastic == pytest.approx(case["elastic_length"], rel=1e-14)
    assert scene.with_impact(speed=scene.speed).stokes == pytest.approx(case["impact"]["stokes"], rel=1e-14)


def test_defaults():
    """What may be left out takes the documented value, and is no entry."""
    scene = Scene.from_dict(tables({**BASE, **BRIDGE, "pendulum.length": "0.5 m"}))
    assert scene.pendulum.gravity == 9.81 and scene.pendulum.law == "exact" and scene.bridge.law == "mikami"
    assert (scene.model.arm, scene.model.tangential, scene.model.glass) == ("midgap", "immersed", "literal")
    assert scene.particles.youngs_modulus is None and scene.speed is None
    assert "pendulum.gravity" not in scene.entries
    with pytest.raises(InputError, match="impact.stokes: missing; accepted: .*--stokes"):
        scene.need_impact()
    with pytest.raises(InputError, match="impact.angle: missing; accepted: .*--angle"):
        scene.with_impact(stokes=1).need_impact()


def test_python_numbers_are_si():
    """A plain number from Python is SI; from a file it lacks its unit."""
    assert Scene.from_dict(tables({**BASE, "liquid.viscosity": 2})).liquid.viscosity == 2.0
    assert "has no unit" in str(refused({**BASE, "liquid.viscosity": 2}))
    assert Scene.from_dict(tables({**BASE, "particles.dry_restitution": "0.9"})).particles.dry_restitution == 0.9
    assert "is text" in str(refused({**BASE, "particles.dry_restitution": "0.9"}))


@pytest.mark.parametrize("volumes", [[0.1, "5e-5 mm^3"], ["5e-5 mm^3", "6e-5 mm^3"], (0.1, 0.2)])
def test_a_scene_has_one_number_for_an_entry(volumes):
    """A list is no number, of one kind or of both: what is accepted is one value, and no list."""
    with pytest.raises(InputError, match=r"bridge.volume: .* is not a number; accepted: a number V/R\^3"):
        Scene.load("granulation").with_entries({"bridge.volume": volumes})


def test_a_table_without_what_it_needs_is_none():
    """Made by hand, a table asks for what has no default, as a function does; what may be left out is None."""
    with pytest.raises(TypeError, match="'reduced_radius', 'reduced_mass', 'roughness', and 'dry_restitution'"):
        Particles()
    made = Particles(reduced_radius="50 um", reduced_mass="5.2e-6 g", roughness="0.2 um", dry_restitution=0.99)
    assert (made.reduced_radius, made.friction) == (50e-6, None)


def test_with_entries_and_impact_leave_the_original_alone():
    """Changes make a new scene, validated; an assumed value that is changed is no longer assumed."""
    scene = Scene.load("granulation")
    changed = scene.with_entries(
        {"liquid.viscosity": "3 Pa s", "particles.youngs_modulus": 6e10, "bridge.volume": "0.2"}
    )
    assert (changed.liquid.viscosity, changed.bridge.volume) == (3.0, 0.2)
    assert len(changed.assumed) == 1 and 'viscosity = "3 Pa s"' in changed.to_toml()
    assert 'youngs_modulus = "60000000000.0 Pa"' in changed.to_toml() and "volume = 0.2" in changed.to_toml()
    assert scene.liquid.viscosity == 2.0
    hit = scene.with_impact(speed="54 cm/s", angle="75 deg")
    assert hit.entries["impact.speed"] == 0.54 and "impact.stokes" not in hit.entries
    assert hit.stokes == pytest.approx(hit.stokes_of(0.54)) and hit.speed_of(hit.stokes) == pytest.approx(0.54)
    assert scene.with_impact(angle=1.0).angle == 1.0 and scene.with_impact() is scene
    with pytest.raises(InputError, match=r"impact.speed: 1.0 is given together with impact.stokes"):
        scene.with_impact(stokes=1.0, speed=1.0)
    with pytest.raises(InputError, match="bridge.surface_tension: missing"):
        Scene.load("pendulum").with_entries({"bridge.volume": 0.1})
    with pytest.raises(InputError, match="particles.radius.*particles.reduced_radius"):
        scene.with_entries({"particles.radius": "100 um"})


def test_scenes_are_values():
    """A scene pickles, copies and hashes, and is what it is."""
    scene = Scene.load("pendulum")
    assert pickle.loads(pickle.dumps(scene)) == scene == copy.deepcopy(scene)
    assert hash(Scene.load("pendulum")) == hash(scene) != hash(Scene.load("granulation"))
    with pytest.raises(AttributeError):
        scene.name = "other"
    with pytest.raises(InputError, match="liquid.viscosity"):
        type(scene.liquid)(viscosity=-1.0, film_thickness=1e-6, glass_transition_pressure=1e6)


@given(scenes(moderate=False), st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20))
def test_any_scene_round_trips(scene, name):
    """Whatever is valid is the same scene, to the last bit, after a journey through TOML, whatever its name."""
    named = scene.with_entries({"name": name})
    assert Scene.from_toml(named.to_toml()) == named


NUMBERS = [name for name, field in FIELDS.items() if field.numeric]
FULL = {
    "particles.radius": 1e-4, "particles.density": 2500.0, "particles.roughness": 2e-7,
    "particles.dry_restitution": 0.9, "particles.friction": 0.2, "particles.contact_tangential_restitution": 0.3,
    "particles.youngs_modulus": 7e10, "particles.poisson_ratio": 0.2, "liquid.viscosity": 2.0,
    "liquid.film_thickness": 8e-6, "liquid.glass_transition_pressure": 2e7, "liquid.density": 1e3,
    "bridge.surface_tension": 0.025, "bridge.volume": 0.1, "bridge.contact_angle": 0.3, "attraction.hamaker": 1e-19,
    "partner.radius": 2e-4, "partner.density": 2000.0, "pendulum.length": 0.5, "pendulum.gravity": 9.8,
    "impact.stokes": 0.03, "impact.angle": 1.0, "impact.spin": 300.0, "impact.partner_spin": -200.0,
    "partner.contact_angle": 0.5,
}  # fmt: skip
LIQUID = {
    "liquid.flow_index": 0.5, "liquid.relaxation_time": 1e-5, "liquid.infinite_shear_viscosity": 0.01,
    "liquid.yield_stress": 20.0, "liquid.reference_rate": 10.0, "liquid.plateau_rate": 0.1, "liquid.measured_to": 1e3,
}  # fmt: skip
OTHERS = {
    "particles.reduced_radius": ("particles.radius", 5e-5), "particles.reduced_mass": ("particles.density", 5e-9),
    "particles.mass": ("particles.density", 1e-8), "partner.mass": ("partner.density", 7e-8),
    "impact.speed": ("impact.stokes", 0.5), "impact.relative_speed": ("impact.stokes", 0.5),
    "particles.diameter": ("particles.radius", 2e-4), "partner.diameter": ("partner.radius", 3e-4),
    "liquid.coating_thickness": ("liquid.film_thickness", 4e-6),
    "partner.coating_thickness": ("liquid.film_thickness", 4e-6, ("liquid.coating_thickness", 4e-6)),
    "bridge.coating_fraction": (
        "liquid.film_thickness", 0.1, ("liquid.coating_thickness", 4e-6), ("bridge.volume", "from coating"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", NUMBERS)
def test_every_number_reaches_the_model(name: str) -> None:
    """What an entry is, or takes part in, are quantities of the derivation; and they change with it."""
    entries = FULL | (LIQUID if name in LIQUID else {})
    if name in OTHERS:
        instead, value, *others = OTHERS[name]
        del entries[instead]
        entries |= {name: value, **dict(others)}
    ways = Ways.of(entries)
    before = quantities(entries, ways)
    after = quantities(entries | {name: entries[name] * 1.01}, ways)
    assert {key for key in before if before[key] != after[key]}
    of_laws = {each.partition(".")[2] for each in LIQUID} if name in LIQUID else set()
    assert set(before) <= {*VOCABULARY, *of_laws}
    if FIELDS[name].quantity not in ("", "reduced_radius", "reduced_mass", "contact_angle"):  # those are the pair's
        factor = before[FIELDS[name].quantity] / entries[name]
        assert after[FIELDS[name].quantity] == pytest.approx(1.01 * factor * entries[name], rel=1e-12)
