"""Scenes: presets, entries, both ways of the impact, and every way of getting one wrong."""

import copy
import json
import math
import pickle
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.solvers import collide
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene import Scene
from wetdoublet.solvers.scenefile import PRESETS
from wetdoublet.solvers.schema import BRIDGE_LAWS, FIELDS

REFERENCE = json.loads((Path(__file__).parents[1] / "data" / "collisions.json").read_text())
BASE = {  # granulation, as a file has it
    "particles.reduced_radius": "50 um",
    "particles.reduced_mass": "5.2e-6 g",
    "particles.roughness": "0.2 um",
    "particles.dry_restitution": 0.99,
    "liquid.viscosity": "2 Pa s",
    "liquid.film_thickness": "8 um",
    "liquid.glass_transition_pressure": "20 MPa",
}
BRIDGE = {"bridge.surface_tension": "0.025 N/m", "bridge.volume": 0.1, "bridge.contact_angle": "0 deg"}


def tables(entries):
    """Return nested tables of dotted entries, leaving out those that are None."""
    nested = {}
    for name, value in entries.items():
        table, _, key = name.partition(".")
        if value is not None:
            nested.setdefault(table, {})[key] = value
    return nested


def refused(entries, from_file=True):
    """Return the InputError that a scene of these entries raises, checked to be one full line."""
    with pytest.raises(InputError) as caught:
        Scene.from_dict(tables(entries), from_file=from_file)
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    assert line.startswith(caught.value.field + ": ") and "; accepted: " in line
    return caught.value


@pytest.mark.parametrize("name", PRESETS)
def test_preset_round_trips(name):
    """A preset written as TOML is the same scene again, comments on assumed values and spelling of units included."""
    scene = Scene.load(name)
    again = Scene.from_toml(scene.to_toml())
    assert again == scene and again.given == scene.given and again.assumed == scene.assumed
    assert Scene.from_dict(scene.to_dict(), from_file=True) == scene
    assert scene.name == name
    assert Scene.load(scene) is scene


def test_presets_are_the_papers():
    """Presets hold the printed values, an impact, and say what is assumed."""
    granulation, pendulum, dry = (Scene.load(name) for name in PRESETS)
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
    scene = Scene.from_dict(case["scene"], from_file=True).with_impact(**case["impact"])
    assert scene.speed == pytest.approx(case["speed"], rel=1e-14)
    assert scene.rupture_gap == pytest.approx(case["rupture_gap"], rel=1e-14)
    assert scene.elastic_length(scene.speed) == pytest.approx(case["elastic_length"], rel=1e-14)
    assert scene.with_impact(speed=scene.speed).stokes == pytest.approx(case["impact"]["stokes"], rel=1e-14)


def test_a_preset_does_not_wait_for_pint():
    """Reading a preset imports what its emitted formulas need (casadi), not pint, sympy, click or xarray."""
    code = (
        "import sys; from wetdoublet.solvers.scene import Scene; Scene.load('granulation').with_impact(angle='75 deg');"
        "print(sorted({'pint', 'sympy', 'click', 'xarray', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_spheres_from_radius_mass_or_density():
    """A = R/2, m = M/2, M = 4/3 pi R^3 rho; the entries keep what was given."""
    rest = {name: value for name, value in BASE.items() if "reduced" not in name}
    sphere = Scene.from_dict(tables({"particles.radius": "100 um", "particles.density": "2500 kg/m^3", **rest}))
    assert sphere.particles.reduced_radius == 50e-6
    assert sphere.particles.reduced_mass == pytest.approx(2 / 3 * math.pi * 1e-12 * 2500)
    assert list(sphere.entries)[:2] == ["particles.radius", "particles.density"]
    assert sphere.entries["particles.radius"] == 100e-6
    heavy = Scene.from_dict(tables({"particles.radius": "100 um", "particles.mass": "1.04e-5 g", **rest}))
    assert heavy.particles.reduced_mass == pytest.approx(5.2e-9)


def test_defaults():
    """What may be left out takes the documented value, and is no entry."""
    scene = Scene.from_dict(tables({**BASE, **BRIDGE, "pendulum.length": "0.5 m"}))
    assert scene.pendulum.gravity == 9.81 and scene.pendulum.law == "exact" and scene.bridge.law == "mikami"
    assert (scene.model.arm, scene.model.tangential, scene.model.glass) == ("midgap", "immersed", "literal")
    assert scene.elastic_length(1.0) is None and scene.speed is None
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
    with pytest.raises(InputError, match="bridge.surface_tension: missing .*bridge.contact_angle"):
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


POSITIVE = [field.name for field in FIELDS.values() if field.range.text == "> 0" and not field.choices]


@pytest.mark.parametrize("name", POSITIVE)
def test_positive_quantities(name):
    """What must be positive is refused at zero, below, at NaN and infinity, by its own name."""
    for number in ("0", "-1", "nan", "inf"):
        value = f"{number} {FIELDS[name].unit}" if FIELDS[name].unit else float(number)
        assert refused({name: value, **{k: v for k, v in BASE.items() if k != name}}).field == name


@pytest.mark.parametrize(
    ("changes", "field", "says"),
    [
        ({"particles.roughness": "8 um"}, "particles.roughness", 'below liquid.film_thickness = "8 um"'),
        ({"particles.roughness": "-1 um"}, "particles.roughness", ">= 0"),
        ({**BRIDGE, "bridge.volume": 1e-6}, "bridge.volume", "above 0.000512"),
        ({**BRIDGE, "bridge.contact_angle": "91 deg"}, "bridge.contact_angle", "from 0 deg to 90 deg"),
        (
            {**BRIDGE, "bridge.law": "mikhami"},
            "bridge.law",
            "did you mean mikami?; accepted: one of mikami, mikami-log10",
        ),
        ({**BRIDGE, "bridge.surface_tension": None}, "bridge.surface_tension", "missing"),
        ({"pendulum.length": "0.2 mm"}, "pendulum.length", "4a + x_f/2 = 0.000204 m"),
        ({"pendulum.gravity": "9.81 m/s^2"}, "pendulum.length", "missing"),
        ({"impact.angle": "90 deg"}, "impact.angle", ">= 0 deg and < 90 deg"),
        ({"impact.angle": "-1 deg"}, "impact.angle", ">= 0 deg and < 90 deg"),
        ({"impact.angle": 1.0}, "impact.angle", "has no unit"),
        ({"impact.stokes": 0.1, "impact.speed": "1 m/s"}, "impact.speed", "together with impact.stokes = 0.1"),
        ({"impact.stokes": True}, "impact.stokes", "is not a number"),
        ({"impact.stokes": [1]}, "impact.stokes", "[1] is not a number"),
        ({"impact.stokes": 10**400}, "impact.stokes", "is not finite"),
        ({"particles.radius": "100 um"}, "particles.radius", 'together with particles.reduced_radius = "50 um"'),
        ({"particles.mass": "1 g"}, "particles.mass", "together with particles.reduced_mass"),
        ({"particles.reduced_radius": None}, "particles.reduced_radius", "or particles.radius"),
        ({"particles.reduced_mass": None}, "particles.reduced_mass", "or particles.density"),
        (
            {"particles.reduced_mass": "1e-320 kg", "liquid.viscosity": "1e20 Pa s"},
            "particles.reduced_mass",
            "is too far off",
        ),
        ({"particles.dry_restitution": 1.01}, "particles.dry_restitution", "from 0 to 1"),
        ({"particles.youngs_modulus": "70 GPa"}, "particles.poisson_ratio", "while particles.youngs_modulus"),
        ({"particles.poisson_ratio": 0.2}, "particles.youngs_modulus", "while particles.poisson_ratio"),
        ({"particles.poisson_ratio": -1.0}, "particles.poisson_ratio", "> -1 and <= 0.5"),
        ({"particles.poisson_ratio": 0.51}, "particles.poisson_ratio", "> -1 and <= 0.5"),
        ({"liquid.viscosity": "2 m"}, "liquid.viscosity", "is a length, not a viscosity"),
        (
            {"liquid.viscosty": "2 Pa s"},
            "liquid.viscosty",
            '"2 Pa s" has an unknown name, did you mean liquid.viscosity?',
        ),
        ({"particles.viscosity": "2 Pa s"}, "particles.viscosity", "did you mean liquid.viscosity?"),
        ({"liqid.viscosity": "2 Pa s"}, "liqid", "did you mean liquid?"),
        ({"model.arm": "mid"}, "model.arm", "one of midgap, surface"),
        ({"model.glass": 3}, "model.glass", "one of literal, film-corrected"),
    ],
)
def test_bad_entries(changes, field, says):
    """Each mistake is refused by the name of its entry, with what is accepted."""
    error = refused({**BASE, **changes})
    assert error.field == field
    assert says in str(error)


@pytest.mark.parametrize(
    "name", [n for n, f in FIELDS.items() if f.required and not n.startswith(("bridge", "attraction", "pendulum"))]
)
def test_missing_entries(name):
    """Every required entry is named when it is missing."""
    assert refused({**BASE, name: None}).field == name


def test_bad_tables():
    """A table that is none, an empty one that needs entries, a missing one, and a name that is no text."""
    for change, field in (({"liquid": 3}, "liquid"), ({"bridge": {}}, "bridge.surface_tension"), ({"name": 3}, "name")):
        with pytest.raises(InputError) as caught:
            Scene.from_dict({**tables(BASE), **change})
        assert caught.value.field == field
    with pytest.raises(InputError, match="particles.reduced_radius: missing"):
        Scene.from_dict({})


def test_files(tmp_path):
    """Broken TOML is reported with file and line, what is no file with the nearest preset."""
    broken = tmp_path / "broken.toml"
    for text, line in (("[particles]\nroughness = = 1\n", 2), ("a = 1\na = 2\n", 2), ('name = "x', 1), ("[x\n", 1)):
        broken.write_text(text)
        with pytest.raises(InputError, match=rf"broken.toml, line {line}: .*; accepted: a scene in TOML"):
            Scene.load(broken)
    broken.write_bytes(b"# fine\n\xff\n")
    with pytest.raises(InputError, match="line 2: is not UTF-8"):
        Scene.load(str(broken))
    broken.write_text("x = " + "[" * 5000)
    with pytest.raises(InputError, match=r"broken.toml"):
        Scene.load(broken)
    for name, says in (
        ("pendulun", "did you mean pendulum"),
        ("no/such.toml", "neither a file"),
        (tmp_path, "directory"),
    ):
        with pytest.raises(InputError, match=says):
            Scene.load(name)


positive = st.floats(1e-3, 1e3)
lengths = positive.map(lambda v: f"{v!r} um") | positive.map(lambda v: f"{v!r} mm") | positive.map(lambda v: v * 1e-6)


@st.composite
def scenes(draw):
    """Draw a valid scene, tables and spellings at will."""
    film = draw(positive)
    entries = {
        "particles.reduced_radius": f"{film * draw(st.floats(1, 100))!r} um",
        "particles.reduced_mass": draw(st.sampled_from(["3 mg", "1e-3 lb", 2.5e-6])),
        "particles.roughness": f"{film * draw(st.floats(0, 0.9))!r} um",
        "particles.dry_restitution": draw(st.floats(0, 1)),
        "liquid.viscosity": draw(positive),
        "liquid.film_thickness": f"{film!r} um",
        "liquid.glass_transition_pressure": draw(positive.map(lambda v: f"{v!r} MPa")),
    }
    if draw(st.booleans()):
        volume = {"bridge.volume": draw(st.floats(0.2, 5)), "bridge.law": draw(st.sampled_from(BRIDGE_LAWS))}
        entries |= {"bridge.surface_tension": "20 mN/m", "bridge.contact_angle": draw(st.floats(0, 1.5)), **volume}
    if draw(st.booleans()):
        entries |= {"pendulum.length": "3 km", "pendulum.law": "small-angle"}
    if draw(st.booleans()):
        entries |= {"impact.stokes": draw(positive), "impact.angle": draw(st.floats(0, 1.57))}
    name = draw(st.text(st.characters(exclude_categories=["Cs"]), max_size=20))
    return Scene(name, tuple(entries.items()))


@given(scenes())
def test_any_scene_round_trips(scene):
    """Whatever is valid is the same scene, to the last bit, after a journey through TOML."""
    assert Scene.from_toml(scene.to_toml()) == scene


junk = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.dates(),
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.text(max_size=4), inner, max_size=2),
    max_leaves=4,
)


@given(st.sampled_from(sorted(FIELDS)) | st.text(max_size=12), junk, st.booleans())
def test_junk_values_are_input_errors(name, value, from_file):
    """Any value of any type under any name makes a scene or an InputError of one line."""
    nested = tables({**BASE, **BRIDGE})
    table, dot, key = name.partition(".")
    nested[table] = {**nested.get(table, {}), key: value} if dot else value
    try:
        Scene.from_dict(nested, from_file=from_file)
    except InputError as error:
        assert len(str(error).splitlines()) == 1


@given(st.text(max_size=60) | st.text("[]{}='\"\n\\#.,abc019 ", max_size=60))
def test_junk_files_are_input_errors(text):
    """Any text at all is an InputError of one line: no such text is a scene."""
    with pytest.raises(InputError) as caught:
        Scene.from_toml(text)
    assert len(str(caught.value).splitlines()) == 1


def test_an_impact_replaced_keeps_text_and_order():
    """An impact given as text stands in the file as it was given, stokes or speed before the angle."""
    scene = Scene.load("granulation").with_impact(angle="20deg").with_impact(speed="1 m/s")
    assert scene.to_toml().endswith('[impact]\nspeed = "1 m/s"\nangle = "20deg"\n')
    assert [*scene.to_dict()] == [*Scene.load("granulation").to_dict()]
    first = Scene.from_toml(scene.to_toml().partition("[impact]")[0]).with_impact(angle=1.0, stokes=0.1)
    assert first.to_toml().endswith('[impact]\nstokes = 0.1\nangle = "1.0 rad"\n')


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('reduced_radius = "5 um"', 'reduced_radius: "5 um" has an unknown name, belongs in [particles]; accepted'),
        ('density = "1 g/cm^3"', "belongs in [particles] or [partner] or [liquid]; accepted"),
        ('liquids = "1 g/cm^3"', "did you mean liquid?; accepted"),
    ],
)
def test_an_entry_outside_its_table_is_told_where_it_belongs(line, says):
    """An entry before any table names the table that it belongs in."""
    with pytest.raises(InputError) as error:
        Scene.from_toml(line + "\n" + Scene.load("granulation").to_toml())
    assert says in str(error.value)


def test_a_plain_angle_is_radians():
    """An angle of 75 is told that plain numbers are radians; one that is wrong in degrees as well is not."""
    with pytest.raises(InputError, match='75 is out of range: plain numbers are radians, did you mean "75 deg"'):
        Scene.load("granulation").with_impact(angle=75)
    with pytest.raises(InputError, match="90 is out of range; accepted"):
        Scene.load("granulation").with_impact(angle=90)


def test_the_other_way_of_saying_it():
    """A radius beside the scene's reduced radius is told what to set instead; both at once stay an error."""
    with pytest.raises(InputError, match=r"set particles\.reduced_radius here, or edit the scene file"):
        Scene.load("granulation").with_entries({"particles.radius": "100 um"})


def test_a_stokes_number_comes_back_as_it_was_given():
    """The Stokes number of a result is the one asked for, to the bit, and not what is left of it after the speed."""
    for stokes in (1.5, 0.005, 0.03, 1.3):
        assert collide("pendulum", stokes=stokes, angle="10 deg", ledger=False, rtol=1e-6).stokes == stokes
