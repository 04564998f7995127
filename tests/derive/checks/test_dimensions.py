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


t, POISSON = sp.Symbol("time", real=True), sp.Symbol("poisson_ratio", real=True)
PATH, RESISTANCE = sp.Function("path")(t), sp.Function("film.resistance")
RIGHT = [
    *((function(x / a), ONE) for function in (sp.exp, sp.log, sp.sin, sp.cos, sp.tan, sp.atan)),
    ((x / a) ** POISSON, ONE), (x ** (2 * POISSON - 1) / (a * x0) ** POISSON, LENGTH**-1), (sp.Integer(0), None),
    (sp.Add(x, sp.Integer(0), evaluate=False), LENGTH), (RESISTANCE(x / x0), ONE), (PATH.diff(t), SPEED),
    (sp.Piecewise((x, x < x0), (x0, True)), LENGTH), (sp.Max(x, x0), LENGTH),
]  # fmt: skip
WRONG = [
    *((function(x), "separation.*pure number") for function in (sp.exp, sp.log, sp.sin, sp.cos, sp.tan, sp.atan)),
    *((bad, "pure number|has dimension")
      for bad in (2**x, x ** (x * POISSON), x + x**POISSON, x + a * x**POISSON / x0**2)),
    (x + sp.Symbol("unheard_of"), "unheard_of"), (sp.erf(x / a), "erf"), (RESISTANCE(x), "pure number"),
    (RESISTANCE(m * u), "pure number"), (sp.Piecewise((x, x < x0), (m, True)), "dimension"),
    (sp.Max(x, m), "dimension"), (sp.Piecewise((x, x < m), (x0, True)), "dimension"),
]  # fmt: skip


def walked(expression: sp.Expr) -> Dimension | None:
    return dimension_of(expression, {**DIMENSIONS, PATH: LENGTH}, slots=lambda _: ONE)


@pytest.mark.parametrize(("expression", "dimension"), RIGHT, ids=[str(each[0]) for each in RIGHT])
def test_a_homogeneous_expression_has_its_dimension(expression: sp.Expr, dimension: Dimension | None):
    """Functions of ratios are pure numbers, powers and derivatives have theirs, zero fits anywhere."""
    assert walked(expression) == dimension


@pytest.mark.parametrize(("expression", "said"), WRONG, ids=[str(each[0]) for each in WRONG])
def test_what_has_no_dimension_is_named(expression: sp.Expr, said: str):
    """Arguments, exponents and slots of a dimension, branches that disagree, what the walker does not know."""
    with pytest.raises(DimensionError, match=said):
        walked(expression)


def test_a_whole_equation_of_the_wrong_dimension_is_named():
    """A homogeneous equation of the wrong dimension is refused under its own name; zero is of any."""
    with pytest.raises(DimensionError, match="film force: .* expected M L T\\^-2"):
        demand_dimension("film force", mu * a * u * x, FORCE, DIMENSIONS)
    demand_dimension("film force", mu * a * u, FORCE, DIMENSIONS)
    demand_dimension("nothing", sp.Integer(0), FORCE, DIMENSIONS)
    assert str(dimension_of(x ** (POISSON - 1), DIMENSIONS)) == "L^(poisson_ratio - 1)"


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
