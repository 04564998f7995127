"""Units: the table in front of pint says what pint says, and nothing wrong gets past either."""

import math
from decimal import Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.scene.units import COMMON, DIMENSIONS, quantity


def read(text: str, si: str = "m") -> float:
    """Read a quantity of a field called `f`."""
    return quantity(text, si, "f", "something else")


@pytest.fixture(scope="module")
def registry():
    """Pint's own registry, without any cache or table of ours."""
    import pint

    return pint.UnitRegistry()


def test_table_equals_pint(registry):
    """Every entry of the table is what pint makes of the same text."""
    for unit, (si, factor) in COMMON.items():
        theirs = registry.Quantity(1.0, unit).to(si).magnitude
        assert theirs == pytest.approx(float(factor), rel=4e-16), unit


def test_every_dimension_has_its_si_unit_in_the_table():
    """The SI unit that names a dimension is itself in the table, with factor one."""
    assert all(COMMON[si] == (si, Decimal(1)) for si in DIMENSIONS)


OTHERS = (
    ("3.7 inch", "m"), ("0.2 lb", "kg"), ("2 kg/(m s)", "Pa s"), ("2 lbf/ft^2", "Pa"), ("3 g/s^2", "N/m"),
    ("0.1 turn", "rad"), ("60 ft/min", "m/s"), ("1.2 lb/ft^3", "kg/m^3"), ("1 ft/s^2", "m/s^2"), ("4 minute", "s"),
    ("2 thou", "m"),
)  # fmt: skip


@pytest.mark.parametrize(("text", "si"), OTHERS)
def test_other_units_are_what_pint_says(registry, text, si):
    """A unit outside the table is converted as pint converts it, prefixes and grams included."""
    number, unit = text.split(" ", 1)
    assert read(text, si) == pytest.approx(registry.Quantity(float(number), unit).to(si).magnitude, rel=1e-14)


@given(st.decimals(-1000, 1000, allow_nan=False, places=12), st.sampled_from(sorted(COMMON)))
def test_common_units_are_correctly_rounded(number, unit):
    """The double is the one nearest to the exact product of number and factor."""
    si, factor = COMMON[unit]
    exact = Fraction(number) * Fraction(factor)
    assert read(f"{number} {unit}", si) == exact.numerator / exact.denominator


SPELT = (
    ("2.5 g/cm3", "kg/m^3", 2500.0), ("2500 kg/m3", "kg/m^3", 2500.0), ("2500 kg m-3", "kg/m^3", 2500.0),
    ("2500 kg·m⁻³", "kg/m^3", 2500.0), ("0.3 N s/m2", "Pa s", 0.3), ("0.3 Ns/m2", "Pa s", 0.3),
    ("0.3 Pa.s", "Pa s", 0.3), ("0.3Pa*s", "Pa s", 0.3), ("7 mPas", "Pa s", 0.007), ("7 mPa.s", "Pa s", 0.007),
    ("7 cP", "Pa s", 0.007), ("72.7 mN m-1", "N/m", 0.0727), ("5e-5 mm3", "m^3", 5e-14), ("9.81 m/s2", "m/s^2", 9.81),
    ("90 deg", "rad", math.pi / 2), ("5 µm", "m", 5e-6), ("5 μm", "m", 5e-6), ("5um", "m", 5e-6),
    *((text, "Pa s", 2.0) for text in ("2 Pa s", "2Pa s", " 2  Pa  s ", "2 Pa*s", "2 Pa·s", "2000 mPa s", "2 N s/m²")),
    ("2 kg/m/s", "Pa s", 2.0),
)  # fmt: skip


@pytest.mark.parametrize(("text", "si", "value"), SPELT)
def test_units_as_people_write_them(text, si, value):
    """Powers without a caret, products with a dot or joined, micro signs, spaces: the double of our spelling."""
    assert read(text, si) == value


WRONG = (
    ("2 m", "Pa s", "is a length, not a viscosity"), ("2 inch", "Pa s", "not a viscosity"),
    ("5 percent", "rad", "not an angle"), ("5 percent", "m", "is a plain number, not a length"),
    ("5 lbf", "m", "is a force, not a length"), ("5 psi", "Pa s", "is a pressure, not a viscosity"),
    ("5 mph", "m", "is a speed, not a length"), ("5 J", "N/m", "is an energy, not a surface tension"),
    ("5 kg m", "Pa s", "is in kg m, not a viscosity"), ("5 um rad", "m", "is in m rad, not a length"),
    ("5", "m", "has no unit"), ("5 umm", "m", "did you mean um?"), ("5 m/ss", "m/s^2", "unknown unit"),
    ("nan m", "m", "is not finite"), ("-inf m", "m", "is not finite"), ("1e999 m", "m", "is not finite"),
    ("1e308 km", "m", "is not finite"), ("wide", "m", "is not a number"), ("", "m", "is not a number"),
    ("1" * 500 + " m", "m", "is not a number"), ("1_000 m", "m", "unknown unit"), ("1 m^9^9^9^9", "m", "unknown unit"),
    ("1 degC", "m", "not a length"), ("1 (m", "m", "unknown unit"), ("0,02 mm", "m", "comma in place of a decimal"),
    # what pint reads as a grain, a style sheet's pixel, an angle of artillery, counts per second
    ("2.5 gr/cm3", "kg/m^3", "a gram is g"), ("3 kgr", "kg", "a gram is g"), ("150 px", "m", "scale"),
    ("2 mil", "m", "thou"), ("2 mil", "rad", "thou"), ("7 cps", "Pa s", "cP"),
)  # fmt: skip


@pytest.mark.parametrize(("text", "si", "problem"), WRONG)
def test_bad_quantities(text, si, problem):
    """Each names the field, shows the value, says what is wrong and what is accepted, on one line."""
    with pytest.raises(InputError) as error:
        read(text, si)
    line = str(error.value)
    assert line.startswith('f: "') and problem in line and "; accepted: " in line
    assert len(line.splitlines()) == 1


@given(st.text(max_size=30) | st.from_regex(r"[0-9.]{1,3} ?[A-Za-z^*/() 0-9_-]{0,12}", fullmatch=True))
def test_junk_is_an_input_error(text):
    """Whatever is written, it is a finite number of metres or an InputError."""
    try:
        assert math.isfinite(read(text))
    except InputError as error:
        assert len(str(error).splitlines()) == 1


def test_units_as_programs_write_them():
    """A revolution is 2 pi, not a radian; Tracker escapes the letter of a micrometre."""
    assert quantity("2 rev/s", "rad/s", "spin", "") == pytest.approx(4 * math.pi, rel=1e-15)
    assert quantity("60 rev/min", "rad/s", "spin", "") == pytest.approx(2 * math.pi, rel=1e-15)
    assert quantity(r"3 \u00B5m", "m", "radius", "") == 3e-6
