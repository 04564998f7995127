"""Every way of getting a scene wrong, each refused in one line that names the entry and what is accepted."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.scene.schema import FIELDS

from ...helpers.entries import BASE, BRIDGE, refused, tables

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
        ({**BRIDGE, "bridge.volume": 1e-6}, "bridge.volume", "above 0.000512"),
        (
            {**BRIDGE, "bridge.law": "mikhami"},
            "bridge.law",
            "did you mean mikami?; accepted: one of mikami, mikami-log10",
        ),
        ({**BRIDGE, "bridge.surface_tension": None}, "bridge.surface_tension", "missing"),
        ({"pendulum.length": "0.2 mm"}, "pendulum.length", "4a + x_f/2 = 0.000204 m"),
        ({"pendulum.gravity": "9.81 m/s^2"}, "pendulum.length", "missing"),
        ({"impact.angle": 1.0}, "impact.angle", "has no unit"),
        ({"impact.stokes": 0.1, "impact.speed": "1 m/s"}, "impact.speed", "together with impact.stokes = 0.1"),
        ({"impact.stokes": True}, "impact.stokes", "is not a number"),
        ({"impact.stokes": 10**400}, "impact.stokes", "is not finite"),
        ({"particles.radius": "100 um"}, "particles.radius", 'together with particles.reduced_radius = "50 um"'),
        ({"partner.wall": "true"}, "partner.wall", "accepted: true, for a wall"),
        ({"particles.mass": "1 g"}, "particles.mass", "together with particles.reduced_mass"),
        ({"particles.reduced_radius": None}, "particles.reduced_radius", "or particles.radius"),
        ({"particles.reduced_mass": None}, "particles.reduced_mass", "or particles.density"),
        (
            {"particles.reduced_mass": "1e-320 kg", "liquid.viscosity": "1e20 Pa s"},
            "particles.reduced_mass",
            "is too far off",
        ),
        ({"particles.youngs_modulus": "70 GPa"}, "particles.poisson_ratio", "while particles.youngs_modulus"),
        ({"particles.poisson_ratio": 0.2}, "particles.youngs_modulus", "while particles.poisson_ratio"),
        (
            {"liquid.viscosty": "2 Pa s"},
            "liquid.viscosty",
            '"2 Pa s" has an unknown name, did you mean liquid.viscosity?',
        ),
        ({"particles.viscosity": "2 Pa s"}, "particles.viscosity", "did you mean liquid.viscosity?"),
        ({"liqid.viscosity": "2 Pa s"}, "liqid", "did you mean liquid?"),
        ({"model.arm": "mid"}, "model.arm", "one of midgap"),
        ({"model.arm": "surface"}, "model.arm", "docs/reference/models.md"),
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
