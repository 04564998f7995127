"""The dimension walker looks at every term and names what is wrong; all checks hold of the derivation."""

from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.derive.vocabulary.dimensions import (
    FORCE,
    LENGTH,
    ONE,
    SPEED,
    Dimension,
    DimensionError,
    demand_dimension,
    dimension_of,
)
from wetdoublet.derive.vocabulary.quantities import DIMENSIONS, a, m, mu, u, x, x0
from wetdoublet.solvers.verify.verdicts import findings

ANY = sp.Symbol("unheard_of")


@pytest.mark.parametrize("wrong", [m * u, x**2 * mu, x0])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_wrong_addend_is_named_wherever_it_stands(wrong: sp.Expr, place: int):
    """An addend of another dimension is found in first, second or third place, and named."""
    right = [6 * sp.pi * mu * a * u, mu * x * u]
    terms = [*right[:place], wrong, *right[place:]]
    total = sp.Add(*terms, evaluate=False)
    with pytest.raises(DimensionError, match="has dimension") as caught:
        dimension_of(total, DIMENSIONS)
    assert str(wrong) in str(caught.value)
    assert dimension_of(sp.Add(*right), DIMENSIONS) == FORCE


@pytest.mark.parametrize("function", [sp.exp, sp.log, sp.sin, sp.cos, sp.tan, sp.atan])
def test_a_transcendental_of_a_length_is_refused(function: type):
    """log(x) is refused and log(x/a) is a pure number."""
    with pytest.raises(DimensionError, match="separation.*pure number"):
        dimension_of(function(x), DIMENSIONS)
    assert dimension_of(function(x / a), DIMENSIONS) == ONE


def test_a_dimensional_exponent_is_refused():
    """2^x has no dimension; x^e with a number e has one of its own, that of no length."""
    exponent = sp.Symbol("poisson_ratio", real=True)
    for bad in (2**x, x ** (x * exponent), x + x**exponent, x + a * x**exponent / x0**2):
        with pytest.raises(DimensionError, match="pure number|has dimension"):
            dimension_of(bad, DIMENSIONS)
    assert dimension_of((x / a) ** exponent, DIMENSIONS) == ONE
    assert dimension_of(x ** (2 * exponent - 1) / (a * x0) ** exponent, DIMENSIONS) == LENGTH**-1
    assert str(dimension_of(x ** (exponent - 1), DIMENSIONS)) == "L^(poisson_ratio - 1)"


def test_an_unknown_symbol_is_named():
    """A symbol outside the vocabulary is an error that names it."""
    with pytest.raises(DimensionError, match="unheard_of"):
        dimension_of(x + ANY, DIMENSIONS)


def test_an_unknown_function_is_named():
    """A function the walker does not know is an error that names it, not a guess."""
    with pytest.raises(DimensionError, match="erf"):
        dimension_of(sp.erf(x / a), DIMENSIONS)


def test_a_whole_equation_of_the_wrong_dimension_is_named():
    """A homogeneous equation of the wrong dimension is refused under its own name."""
    with pytest.raises(DimensionError, match="film force: .* expected M L T\\^-2"):
        demand_dimension("film force", mu * a * u * x, FORCE, DIMENSIONS)
    demand_dimension("film force", mu * a * u, FORCE, DIMENSIONS)


def test_zero_fits_anywhere():
    """An exact zero has no dimension of its own, alone, as a factor or as an addend."""
    assert dimension_of(sp.Integer(0), DIMENSIONS) is None
    demand_dimension("nothing", sp.Integer(0), FORCE, DIMENSIONS)
    kept = sp.Add(x, sp.Integer(0), evaluate=False)
    assert dimension_of(kept, DIMENSIONS) == LENGTH


@pytest.mark.parametrize("slot_argument", [x, m * u])
def test_slots_take_pure_numbers(slot_argument: sp.Expr):
    """A law slot is handed dimensionless arguments or refused."""
    call = sp.Function("film.resistance")
    with pytest.raises(DimensionError, match="pure number"):
        dimension_of(call(slot_argument), DIMENSIONS, slots=lambda _: ONE)
    assert dimension_of(call(x / x0), DIMENSIONS, slots=lambda _: ONE) == ONE


def test_derivatives_divide_by_their_variable():
    """dx/dt is a speed."""
    t = sp.Symbol("time", real=True)
    path = sp.Function("path")(t)
    assert dimension_of(path.diff(t), {**DIMENSIONS, path: LENGTH}) == SPEED


def test_piecewise_and_extrema_need_one_dimension():
    """All branches of Piecewise, Min and Max must agree, and so must the sides of a condition."""
    ok = sp.Piecewise((x, x < x0), (x0, True))
    assert dimension_of(ok, DIMENSIONS) == LENGTH
    assert dimension_of(sp.Max(x, x0), DIMENSIONS) == LENGTH
    for bad in (sp.Piecewise((x, x < x0), (m, True)), sp.Max(x, m), sp.Piecewise((x, x < m), (x0, True))):
        with pytest.raises(DimensionError, match="dimension"):
            dimension_of(bad, DIMENSIONS)


powers = st.fractions(min_value=-4, max_value=4, max_denominator=6)
dimensions = st.builds(Dimension, powers, powers, powers)


@given(dimensions, dimensions, powers)
def test_dimensions_are_a_vector_space(one: Dimension, other: Dimension, power: Fraction):
    """Products add exponents and powers scale them: (A B)^p = A^p B^p, A/A = 1."""
    assert (one * other) ** power == one**power * other**power
    assert one / one == ONE
    assert one * other / other == one


@given(powers)
def test_walker_takes_powers_as_they_are(power: Fraction):
    """A power of a length has that power of length and of nothing else."""
    found = dimension_of(x ** sp.Rational(power.numerator, power.denominator), DIMENSIONS)
    assert found == Dimension(length=power)


@pytest.mark.slow
def test_every_symbolic_check_holds(healthy):
    """All checks hold of the derivation, but for notes, where no proof exists."""
    assert [check for check in healthy.values() if check.ok is False] == []
    assert {name for name, check in healthy.items() if check.ok is None} == {
        *(f"certificate: oblique{more}" for more in ("", "_bridge_strings")),
        "film's rim: infinite",
    }
    assert all(check.statement and check.figure for check in healthy.values())


@pytest.mark.slow
def test_checks_of_a_scenes_laws_are_those_laws_alone(healthy):
    """With laws chosen, each check of a law is of the one chosen; each name stands once, and none is new."""
    names = [check.name for check in findings({"shear": "film"})]
    assert len(set(names)) == len(names)
    assert set(names) < healthy.keys()
    left_out = healthy.keys() - set(names)
    assert left_out == {name for name in healthy if "immersed" in name}
