"""Every way of getting a scene wrong, each refused in one line that names the entry and what is accepted."""

import math

import pytest
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene.fields import Field
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.scene.schema import FIELDS

from ...helpers.entries import BASE, BRIDGE, PEOPLE, refused, tables


def spoilt(field: Field) -> list[object]:
    """Values that are none of an entry's in a file."""
    if field.flag:
        return ["true", False, 1]
    if field.choices:
        return [f"{next(iter(field.choices))}x", 3]
    low, high, unit = field.range.low, field.range.high, field.unit
    numbers = [math.nan, math.inf, -math.inf, *([low] if field.range.low_open and math.isfinite(low) else [])]
    numbers += [each for each in (low - 1, high + 1, *([high] if field.range.high_open else [])) if math.isfinite(each)]
    texts = ["wide", "3 cd", *(["0.9 m m"] if unit else ["0.9"]), [1.0], True, 10**400, *([0.5] if unit else [])]
    return [*(f"{number!r} {unit}" if unit else number for number in numbers), *texts]


@pytest.mark.parametrize("name", FIELDS)
def test_a_spoilt_entry_is_named(name: str):
    """Outside its range, not finite, of another unit or of none, of another type: by the entry's own name."""
    for value in spoilt(FIELDS[name]):
        assert refused({**BASE, name: value}).field == name


@pytest.mark.parametrize("name", FIELDS)
def test_a_misspelt_entry_is_told_the_nearest(name: str):
    """Its last letter twice: the name that was meant stands in the message."""
    wrong = name + name[-1]
    error = refused({**BASE, wrong: 1.0})
    assert error.field == wrong
    assert f"did you mean {name}?" in str(error)


@pytest.mark.parametrize(
    "name", [n for n, f in FIELDS.items() if f.required and not n.startswith(("bridge", "attraction", "pendulum"))]
)
def test_missing_entries(name):
    """Every required entry is named when it is missing."""
    assert refused({**BASE, name: None}).field == name


THINNING = {"liquid.law": "carreau", "liquid.flow_index": 0.5, "liquid.relaxation_time": "20 us"}
COATED = {**PEOPLE, "bridge.volume": "from coating"}
PARTNER = {"partner.diameter": "320 um", "partner.density": "2 g/cm^3", "partner.coating_thickness": "3 um"}


@pytest.mark.parametrize(
    ("scene", "changes", "field", "says"),
    [
        (BASE, {"particles.roughness": "8 um"}, "particles.roughness", 'below liquid.film_thickness = "8 um"'),
        (BASE, {**BRIDGE, "bridge.volume": 1e-6}, "bridge.volume", "above 0.000512"),
        (BASE, {**BRIDGE, "bridge.law": "mikhami"}, "bridge.law", "did you mean mikami?; accepted: one of mikami, "),
        (BASE, {**BRIDGE, "bridge.law": "lambert", "bridge.rupture": "own"}, "bridge.rupture", "one of mikami, "),
        (BASE, {**BRIDGE, "bridge.surface_tension": None}, "bridge.surface_tension", "missing"),
        (BASE, {"pendulum.length": "0.2 mm"}, "pendulum.length", "4a + x_f/2 = 0.000204 m"),
        (BASE, {"pendulum.gravity": "9.81 m/s^2"}, "pendulum.length", "missing"),
        (BASE, {"impact.stokes": 0.1, "impact.speed": "1 m/s"}, "impact.speed", "together with impact.stokes = 0.1"),
        (BASE, {"particles.radius": "0.1 mm"}, "particles.radius", 'together with particles.reduced_radius = "50 um"'),
        (BASE, {"particles.reduced_radius": None}, "particles.reduced_radius", "or particles.radius"),
        (BASE, {"particles.reduced_mass": "1e-320 kg", "liquid.viscosity": "1e20 Pa s"}, "particles.reduced_mass", ""),
        (
            BASE, {"particles.reduced_mass": None, "particles.mass": "1e-320 kg", "liquid.viscosity": "1e20 Pa s"},
            "particles.mass", "1e-320 kg",
        ),
        (BASE, {"particles.youngs_modulus": "70 GPa"}, "particles.poisson_ratio", "while particles.youngs_modulus"),
        (BASE, {"liquid.glass_transition_pressure": None, "particles.roughness": "0 um"}, "particles.roughness", ""),
        (BASE, {"liquid.viscosty": "2 Pa s"}, "liquid.viscosty", "an unknown name, did you mean liquid.viscosity?"),
        (BASE, {"liqid.viscosity": "2 Pa s"}, "liqid", "did you mean liquid?"),
        (BASE, {"liquid.flow_index": 0.5}, "liquid.flow_index", ""),
        (BASE, {"liquid.law": "cross"}, "liquid.flow_index", ""),
        (BASE, {**THINNING, "liquid.flow_index": 1.5}, "liquid.flow_index", ""),
        (BASE, {**THINNING, "liquid.yield_stress": "1 Pa"}, "liquid.yield_stress", ""),
        (BASE, {**THINNING, "model.film": "infinite"}, "model.film", ""),
        (BASE, {"liquid.law": "bingham"}, "liquid.law", ""), (BASE, {**THINNING, "custom.x": 1.0}, "custom.x", ""),
        (BASE, {"model.arm": "surface"}, "model.arm", "docs/reference/models.md"),
        (BASE, PARTNER, "partner.coating_thickness", "both coatings together"),
        (COATED, {"liquid.film_thickness": "8 um"}, "liquid.coating_thickness", "together with liquid.film_thickness"),
        (
            COATED, {"liquid.coating_thickness": None, "liquid.film_thickness": "8 um"},
            "bridge.volume", "without liquid.coat",
        ),
        (COATED, {"liquid.coating_thickness": "0 um"}, "liquid.coating_thickness", "makes no film"),
        (COATED, {"partner.wall": True}, "partner.coating_thickness", "0 um for a dry wall"),
        (
            COATED, {"partner.wall": True, "partner.coating_thickness": "3 um", "bridge.coating_fraction": 0.1},
            "bridge.coating_fraction", "beside a wall",
        ),
        (COATED, {"bridge.volume": 0.1, "bridge.coating_fraction": 0.1}, "bridge.coating_fraction", '"from coating"'),
        (COATED, {"bridge.coating_fraction": 1e-9}, "bridge.volume", "a larger bridge.coating_fraction"),
        (COATED, {"bridge.volume": "1e-30 m^3"}, "bridge.volume", "a volume above 5.12e-16 m^3"),
        (COATED, {"bridge.volume": "of coating"}, "bridge.volume", 'or "from coating"'),
        (COATED, {**PARTNER, "partner.radius": "1 mm"}, "partner.diameter", "together with partner.radius"),
        (COATED, {**PARTNER, "partner.diameter": "10 m"}, "partner.diameter", "too far from the sphere's"),
        (COATED, {"impact.speed": "1 m/s"}, "impact.relative_speed", "together with impact.speed"),
        (BASE, {"partner.radius": "150 um"}, "partner.mass", "or partner.density"),
        (BASE, {"partner.mass": "10 ug"}, "partner.radius", "missing"),
        (BASE, {"partner.radius": "150 um", "partner.wall": True}, "partner.wall", "given together"),
        (
            BASE, {"partner.radius": "0.1 mm", "partner.mass": "10 ug", "partner.density": "2.5 g/cm^3"},
            "partner.density", "together",
        ),
        (BASE, {"partner.radius": "1 km", "partner.mass": "10 ug"}, "partner.radius", "wall = true"),
        (BASE, {"partner.wall": True, "pendulum.length": "0.5 m"}, "partner.wall", "strings"),
        (
            BASE, {"attraction.hamaker": "1e-19 J", "particles.roughness": "0 um"},
            "particles.roughness", "without bounds",
        ),
        (
            {**BASE, **BRIDGE}, {"model.film": "constant-volume", "model.glass": "film-corrected"},
            "model.glass", "rim",
        ),
        (
            BASE, {"particles.contact_tangential_restitution": 0.3},
            "particles.contact_tangential_restitution", "without particles.friction",
        ),
    ],
)  # fmt: skip
def test_entries_that_do_not_go_together(scene, changes, field, says):
    """Each mistake is refused by the name of its entry, with what is accepted."""
    error = refused({**scene, **changes})
    assert error.field == field
    assert says in str(error)


def test_bad_tables():
    """A table that is none, an empty one that needs entries, a missing one, and a name that is no text."""
    changes = (
        ({"liquid": 3}, "liquid"), ({"custom": 3}, "custom"), ({"bridge": {}}, "bridge.surface_tension"),
        ({"name": 3}, "name"),
    )  # fmt: skip
    for change, field in changes:
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
    for name, says in (
        ("pendulun", "did you mean pendulum"),
        ("no/such.toml", "neither a file"),
        (tmp_path, "directory"),
    ):
        with pytest.raises(InputError, match=says):
            Scene.load(name)


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
