"""Model files: declarations, groups found, laws brought to their slots, checks that name what fails."""

from pathlib import Path

import pytest
import sympy as sp
from wetdoublet.derive.checks.user import checks_of, model_checks
from wetdoublet.derive.emit.compare import same
from wetdoublet.derive.emit.document.document import document
from wetdoublet.derive.equations.model import derive
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.derive.physics.law import fill
from wetdoublet.derive.physics.structure import Structure, structures
from wetdoublet.derive.user.declarations import ModelFileError
from wetdoublet.derive.user.template import TEMPLATE
from wetdoublet.derive.vocabulary.allowed_values import Bounds, BoundsError
from wetdoublet.derive.vocabulary.dimensions import (
    FORCE,
    LENGTH,
    MASS,
    ONE,
    PRESSURE,
    TIME,
    UnitError,
    dimension_of_unit,
)

HEAD = "from wetdoublet.derive.user import *\n"


def model(body: str):
    """The model of a file with this body."""
    return read(Path("mine.py"), HEAD + body)


def failing(body: str) -> dict[str, str]:
    """Checks of a model file that fail: name -> figure."""
    return {check.name: check.figure for check in model_checks(Path("mine.py"), HEAD + body)[1] if not check.ok}


def test_the_old_name_of_the_normal_velocity_still_reads():
    """Model files written with `opening` mean `normal_velocity`."""
    old, new = (
        model(f'law("film", "mine", resistance=(1 - gap)**2/gap*(1 + {name}**2))')
        for name in ("opening", "normal_velocity")
    )
    assert old.laws[0]["resistance"].result == new.laws[0]["resistance"].result


def test_written_the_same_it_is_the_same():
    """The film's law as the paper prints it in SI is the law that the derivation integrates."""
    mine = model('law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2)').laws[0]
    assert sp.simplify(mine["resistance"].result - LAWS["film"]["finite"]["resistance"].result) == 0


@pytest.mark.parametrize(
    ("python", "exact"),
    [
        ("(V*R**3)**(1/3)", "V**Rational(1, 3)*R"),
        ("(R**1.5*V)**0.4*R**0.4", "R*V**Rational(2, 5)"),
        ("R*(0.1 + 0.2)", "R*Rational(3, 10)"),
    ],
)
def test_arithmetic_of_decimals_is_exact(python: str, exact: str):
    """A fraction by Python's division, and decimals that Python multiplied or added, are what was meant."""
    first, second = (model(f'law("bridge", "mine", force=sigma*R, rupture_distance={one})') for one in (python, exact))
    found, expected = (each.laws[0]["rupture_distance"].result for each in (first, second))
    assert sp.simplify(found - expected) == 0


@pytest.mark.parametrize(
    "spellings",
    [
        ("Piecewise((1, u>=0), (2, True))", "Piecewise((1, u/v0 >= 0), (2, True))", "Piecewise((2, m*u<0), (1, True))"),
        ("Piecewise((1, u>c), (2, True))", "Piecewise((1, u/c > 1), (2, True))", "Piecewise((2, u*m<=m*c), (1, True))"),
        ("Abs(u)/c", "sqrt(u**2)/c", "sqrt((u/c)**2)", "sqrt(u**2/c**2)"),
        ("Max(u, c)/v0", "Max(u/v0, c/v0)", "Max(mu*u, mu*c)/(mu*v0)"),
        ("sqrt(u**2 + c**2)/v0", "((u/v0)**2 + (c/v0)**2)**0.5", "Abs(sqrt(u**2 + c**2))/v0"),
        ("(x/x0)**k", "x**k/x0**k", "exp(k*log(x/x0))"),
        ("sqrt(let('part', x/x0)**2)", "let('part', x/x0)"),
    ],
)  # fmt: skip
def test_equivalent_spellings_are_equal(spellings: tuple[str, ...]):
    """A condition, an extreme, a root or a power means the same however its scale is written."""
    head = 'c = quantity("c_of", unit="m/s")\nk = quantity("k")\nlaw("bridge", "mine", force=sigma*R*(1 + k*c/v0))\n'
    at = {"gap": 0.3, "c_of_number": 0.2, "k": 0.7}
    films = [f'{head}law("film", "mine", resistance=mu*a**2*u/x*{spelling})' for spelling in spellings]
    laws = [model(film).laws[1]["resistance"] for film in films]
    for speed in (-0.8, -0.1, 0.1, 0.8):
        values = [float(law(*law.arguments).subs({s: at.get(s.name, speed) for s in law.arguments})) for law in laws]
        assert values == pytest.approx([values[0]] * len(values), rel=1e-14)


def test_a_consistency_has_a_unit_with_an_exponent_of_the_model():
    """K (u/x0)^n of a K in Pa s^n over the library's scale: as in SI, by numbers, at any n."""
    mine = model(
        'n = quantity("n")\nK = quantity("consistency", unit="Pa s^n", default="2 Pa s^n")\n'
        'law("film", "mine", resistance=6*pi*K*a**2*u/x*(1 + (u/x0)**2*x0**2/v0**2)**((n - 1)/2)*(v0/x0)**(n - 1))'
    )
    resistance, (_, group) = mine.laws[0]["resistance"], mine.groups
    si = {"reduced_radius": 3e-4, "film_thickness": 2e-5, "speed": 0.3, "viscosity": 1.5, "consistency": 2.0, "n": 0.6}
    number = float(group.definition.subs({s: si[s.name] for s in group.definition.free_symbols}))
    at = {"gap": 0.4, "normal_velocity": 0.5, "aspect": 2e-5 / 3e-4, "n": 0.6, "consistency_number": number}
    found = float(resistance(*resistance.arguments).subs({s: at[s.name] for s in resistance.arguments}))
    rate = 0.3 / 2e-5
    wanted = 2.0 * rate ** (0.6 - 1) / 1.5 / 0.4 * (1 + 0.5**2) ** ((0.6 - 1) / 2)  # over 6 pi mu a^2 u/x0
    assert found == pytest.approx(wanted, rel=1e-13)


@pytest.mark.parametrize(
    ("declaration", "law", "definition"),
    [
        ('k = quantity("k", unit="Pa")', 'law("bridge", "mine", force=k*a**2)', "reduced_radius*k/surface_tension"),
        ('k = quantity("k", unit="Pa")', 'law("film", "mine", resistance=k*a**2*u/v0)', "k*reduced_radius/(speed*viscosity)"),  # noqa: E501 # a row
        ('k = quantity("k", unit="Pa", over=mu*v0/x0)', 'law("film", "mine", resistance=k*a**2*u/v0)', "film_thickness*k/(speed*viscosity)"),  # noqa: E501 # a row
        ('k = quantity("k", unit="m")', 'law("bridge", "mine", force=exp(-x/k))', "k/reduced_radius"),
        ('k = quantity("k")', 'law("bridge", "mine", force=k*h)', "k"),
    ],
)  # fmt: skip
def test_groups_are_found(declaration: str, law: str, definition: str):
    """A declared quantity becomes a group over quantities of the slot's own scale, or those that `over` names."""
    found = model(f"{declaration}\n{law}")
    names = {s.name: s for s in found.groups[0].definition.free_symbols}
    assert sp.simplify(found.groups[0].definition - sp.sympify(definition, locals=names)) == 0


def test_extended_structure_without_its_quantity_is_the_librarys():
    """With no yield stress the template's equations are those of the library with Willett's closed form."""
    mine = read(Path("mine.py"), TEMPLATE)
    nothing = {mine.groups[0].symbol: 0}
    for structure in (Structure(True, True, False, reduced=True), Structure(False, True, True)):
        library = derive(structure)
        own = mine.extended(library)
        assert own.groups == (*library.groups, mine.groups[0].symbol)
        for function in ("right_hand_side", "energy_rates", "inward_force"):
            for (key, one), (_, other) in zip(own[function].outputs, library[function].outputs, strict=True):
                filled = fill(own.expanded(one), _laws(mine.default("bridge"))).subs(nothing)
                assert same(filled, fill(library.expanded(other), _laws(LAWS["bridge"]["willett-simple"]))), key


def _laws(bridge):
    return {slot: next(iter(laws.values())) for slot, laws in LAWS.items()} | {"bridge": bridge}


def test_a_rupture_distance_is_a_length_or_a_number_of_radii():
    """2 a in SI is one radius."""
    found = [model(f'law("bridge", "mine", force=1, rupture_distance={text})').laws[0] for text in ("2*a", "1")]
    assert [law["rupture_distance"].result for law in found] == [1, 1]


def test_structures_without_the_slot_are_untouched():
    """A bridge law changes no equation of a structure without a bridge."""
    mine = read(Path("mine.py"), TEMPLATE)
    for structure in structures():
        if not structure.bridge:
            assert mine.extended(derive(structure)) == derive(structure)


@pytest.mark.parametrize(
    ("body", "name", "figure"),
    [
        ('law("bridge", "mine", force=pi*R*sigma + mu*a)', "dimensions", "law bridge mine, force: term"),
        ('law("bridge", "mine", force=x + R*sigma)', "dimensions", "beside x of dimension L in R*sigma + x"),
        ('law("bridge", "mine", force=mu*u*a**2)', "dimensions", "expected M L T^-2 or a pure number"),
        ('law("bridge", "mine", force=mu*a*u)', "groups", "depends on normal_velocity"),
        ('law("bridge", "mine", force=m*omega**2*a)', "groups", "rotation_rate"),
        ('k = quantity("k", unit="Pa")\nlaw("bridge", "mine", force=2*cos(phi))', "groups", "k: declared, but no law"),
        ('n = quantity("n", bounds="0 to 1")\nlaw("film", "mine", resistance=(gap - n)/gap)', "dissipation: film mine", "resistance = "),  # noqa: E501 # a row
        ('law("film", "mine", resistance=mu*a**2/x*sqrt(Abs(u)*v0))', "dissipation: film mine", "u*Abs(u)**(n - 1)"),
        ('law("bridge", "mine", force=1/(h - h))', "dimensions", "zoo"),
        ('law("bridge", "mine", force=log(V - 0.05))', "limits: bridge mine", "volume = 0.001"),
        ('law("bridge", "mine", force=1 + h, falls=True)', "force falls: mine", "dF/dh = 1"),
        ('law("film", "mine", resistance=(1 - gap)**2/gap, stopping=1 - gap)', "stopping: mine", "gap"),
        ('law("film", "mine", resistance=(1 - gap)/gap, braking=log(1/gap))', "braking: mine", "1"),
        ('law("glass", "mine", pressure=approach/gap**2, reach=approach/glass_number)', "reach of the glass criterion, mine", "left over: glass_number"),  # noqa: E501 # a row
        ('law("bridge", "mine", force=sqrt(positive(h - 0.05)))', "limits: bridge mine", "is not a finite number"),
        ('k = quantity("k")\nlaw("bridge", "mine", force=k, rupture_distance=k)', "groups", "may depend on volume, contact_angle only"),  # noqa: E501 # a row
        ('law("arm", "mine", lever=2 + (distance - 4)/3)', "angular momentum: arm mine", "dL/dt"),
        ('law("strings", "mine", rise=offset_squared/2, stiffness=offset_squared)', "potential: strings mine", "left over"),  # noqa: E501 # a row
    ],
)  # fmt: skip
def test_checks_fail_by_name(body: str, name: str, figure: str):
    """What is wrong with a law is found by the check of that name, and shown."""
    assert figure in failing(body)[name]


def test_a_known_violation_can_be_accepted():
    """A model may say which check it is known to fail; the figure stays."""
    body = 'law("arm", "mine", lever=2 + 0*distance, accept=("angular momentum",))'
    _, checks = model_checks(Path("mine.py"), HEAD + body)
    assert all(check.ok is not False for check in checks)
    (known,) = (check for check in checks if "accepted by the model" in check.figure)
    assert known.ok is None  # neither what holds nor what fails
    assert 'accept=("angular momentum",)' in failing(body.partition(", accept")[0] + ")")["angular momentum: arm mine"]


def test_template_says_what_it_is_without_stress():
    """All checks of the template hold, and it finds the law of the library that it contains."""
    found = checks_of(read(Path("mine.py"), TEMPLATE))
    assert all(check.ok for check in found)
    assert "yield_stress_number = 0 gives willett-simple" in [check.figure for check in found]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("law('brige', 'mine', force=1)", "line 2: law: 'brige' is not a slot"),
        ("law('bridge', 'mikami', force=1)", "is a law of the library"),
        ("for name in ('near', 'far'): law('attraction', name, force=1/gap**2)", "'far' is a second one"),
        ("law('bridge', 'mine', pull=1)", "accepted: the functions force"),
        ("law('bridge', 'mine')", "law bridge mine.force"),
        ("law('film', 'mine', resistance=1/gap, suction=0.5/gap)", "law film mine.suction"),
        ("law('bridge', 'mine', force=1, source=5)", "law bridge mine.source"),
        ("law('bridge', 'mine', force=1, validity={'volume': (0, 'h')})", "(least, largest), a number each, or None"),
        ("law('bridge', 'mine', force=1, validity={'volume': (1, 0.1)})", "(least, largest), a number each, or None"),
        ("law('bridge', 'mine', force=1, validity={'volume': 3})", "(least, largest), a number each, or None"),
        ("law('bridge', 'mine', force=1, validity={'volume': (float('nan'), 1)})", "(least, largest), a number each"),
        ("law('bridge', 'mine', force=1, validity=3)", "law bridge mine.validity"),
        (
            "law('bridge', 'mine', force=1, source=Reference('k', 'Me, A.', *'tjavp', 2024))",
            '("Family, Initials", ...)',
        ),
        (
            "law('bridge', 'mine', force=1, source=Reference('k', ('Me, A.',), *'tja', 3, 'p', 2024))",
            "all else as text",
        ),
        ("law('bridge', 'mine', force=1, spread=True)", "law bridge mine.spread"),
        ("law('bridge', 'mine', force=1, validity={'angle': (0, 1)})", "accepted: volume, contact_angle, separation"),
        ("law('bridge', 'mine', force='x')", "a sympy expression"),
        ("k = quantity('viscosity')", "is taken already"),
        ("k = quantity('k', 'kg')", 'is a unit, where the symbol in print stands; accepted: unit="kg"'),
        ("k = quantity('k', unit='ergs')", "unknown unit 'ergs'"),
        ("k = quantity('k', bounds='small')", "k.bounds"),
        ("law('bridge', 'mine', force=undefined)", "line 2: None NameError: name 'undefined'"),
        ("law('bridge', 'mine', force=undefined)", "accepted: a name of `wetdoublet generate --names`"),
        ("law('bridge', 'mine', force=h if h < 1 else 0)", "accepted: Piecewise((value, condition), (value, True))"),
        ("import numpy\nlaw('bridge', 'mine', force=numpy.exp(h))", "accepted: the functions of a model file"),
        ("k = quantity('k', unit='Pa s^0.5')", "'s^0.5', whose exponent is not whole"),
        ("law('bridge', 'mine', force=", "is not Python"),
        ("pass", "declares no law"),
    ],
)
def test_bad_model_files_are_named(body: str, said: str):
    """A file that cannot be a model is an error with file, line, what is wrong and what is accepted."""
    with pytest.raises(ModelFileError) as caught:
        model(body)
    assert str(caught.value).startswith("mine.py")
    assert said in str(caught.value)
    assert "accepted: " in str(caught.value)


@pytest.mark.parametrize(
    ("unit", "dimension"),
    [("Pa", PRESSURE), ("N/m^2", PRESSURE), ("kg m/s^2", FORCE), ("1/s", TIME**-1), ("kg/m^3", MASS / LENGTH**3), ("1", ONE)],  # noqa: E501 # a row
)  # fmt: skip
def test_units_have_dimensions(unit: str, dimension):
    """Coherent SI in words has the dimension that mechanics says."""
    assert dimension_of_unit(unit) == dimension


@pytest.mark.parametrize("unit", ["", "um", "kg/m/s m", "Pa^x", "kg//m"])
def test_other_units_are_errors(unit: str):
    """Prefixes, other systems and broken words are no coherent SI."""
    with pytest.raises(UnitError):
        dimension_of_unit(unit)


def test_bounds_in_words():
    """Bounds are read with their open and closed ends; nonsense and empty intervals are errors."""
    assert Bounds.read("> 0 and <= 5").to_json() == {
        "text": "> 0 and <= 5", "low": 0.0, "high": 5.0, "low_open": True, "high_open": False,
    }  # fmt: skip
    assert Bounds.read("0 to 1").not_negative
    for text in ("small", "5 to 1", "> 1 and < 0", ""):
        with pytest.raises(BoundsError):
            Bounds.read(text)


def test_document_has_the_models_own_lines():
    """Table 1 of a model shows its force over its quantities, its parts, and its group; strings are left out."""
    laws = {slot: next(iter(known)) for slot, known in LAWS.items()} | {"bridge": "yielding"}
    made = document("mine", laws, read(Path("mine.py"), TEMPLATE), ("strings",))
    tex = made.tex()
    assert r"\tau_y" in tex
    assert r"S = \frac{x}{2 a \sqrt{V}}".partition(" = ")[2] in tex
    assert r"\frac{a \tau_y}{\sigma}" in tex
    assert "F_{S,n}" not in tex
    assert tex.count(r"\begin{align*}") == tex.count(r"\end{align*}")
