"""The printer: exact numbers, right precedence, guarded branches, a refusal by name of what it does not know."""

from fractions import Fraction

import casadi
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from wetdoublet.derive.emit.casadi.printer import EmissionError, Printer
from wetdoublet.derive.physics.law import slot_call
from wetdoublet.derive.user.kinks import KinkError, rounded

x, y, z = sp.symbols("x y z", real=True)
p, q = sp.symbols("p q", positive=True)


def source(expression: sp.Expr) -> tuple[str, dict[str, object]]:
    """Printed text and the CasADi names it asks for, as a namespace."""
    printer = Printer()
    text = printer(expression)
    return text, {name: getattr(casadi, name) for name in printer.imports}


def evaluate(expression: sp.Expr, values: dict[str, float]) -> float:
    """The printed text, evaluated by CasADi at floats."""
    text, names = source(expression)
    symbols = {name: casadi.SX.sym(name) for name in values}
    value = eval(text, {"__builtins__": {}}, {**names, **symbols})
    function = casadi.Function("f", list(symbols.values()), [casadi.SX(value)])
    return float(function(*values.values()))


UNKNOWN = {
    "erf": sp.erf(x), "zeta": sp.zeta(x), "Heaviside": sp.Heaviside(x), "gamma": sp.gamma(p),
    "besselj": sp.besselj(0, x), "floor": sp.floor(x), "atan2": sp.atan2(x, y),
    "Derivative": sp.Derivative(sp.Function("f")(x), x), "Integral": sp.Integral(x, (x, 0, y)),
    "And": sp.And(x < 1, y < 2), "Equality": sp.Eq(x, y), "ImaginaryUnit": sp.I, "Exp1": sp.E,
    "EulerGamma": sp.EulerGamma, "Infinity": sp.oo, "NaN": sp.nan, "DiracDelta": sp.DiracDelta(x),
    "BooleanTrue": sp.true, "f": sp.Function("f")(x),
}  # fmt: skip


@pytest.mark.parametrize("name", UNKNOWN)
def test_an_unknown_node_is_refused_by_name(name: str):
    """A node without CasADi source is an error that names it, alone and deep inside an expression."""
    node = UNKNOWN[name]
    with pytest.raises(EmissionError, match=name):
        Printer()(node)
    if isinstance(node, sp.Expr) and node.is_finite is not False and node is not sp.nan:
        with pytest.raises(EmissionError, match=name):
            Printer()(sp.sin(2 + p * node))


@pytest.mark.parametrize("name", ["a b", "1x", "x'", ""])
def test_a_symbol_that_is_no_name_is_refused(name: str):
    """A symbol that Python could not parse is refused, quoted."""
    with pytest.raises(EmissionError, match="not a Python name"):
        Printer()(sp.Symbol(name))


def test_a_slot_call_goes_to_its_law():
    """A law's slot is printed as a call of the law."""
    assert Printer()(slot_call("bridge", "force", x / 2, y)) == "laws.bridge.force(x/2, y)"


# Numbers


@given(st.fractions(max_denominator=10**12).filter(lambda value: abs(value) < 10**15))
def test_a_rational_is_its_nearest_double(value: Fraction):
    """A rational's text, a decimal or p/q, is the correctly rounded double of the rational."""
    text, _ = source(sp.Rational(value.numerator, value.denominator))
    assert eval(text) == value.numerator / value.denominator  # Python's int/int rounds correctly


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_float_round_trips(value: float):
    """A double is printed by its repr and read back bit for bit."""
    text, _ = source(sp.Float(value))
    assert eval(text) == value


def test_a_float_of_more_digits_is_refused():
    """A number that no double holds is an error and not silently rounded."""
    with pytest.raises(EmissionError, match="round-trip"):
        Printer()(sp.Float("0.1", 40))


@pytest.mark.parametrize("denominator", range(1, 8))
def test_powers_of_every_rational(denominator: int):
    """p**(n/d) is evaluated with the double nearest n/d, negative powers as quotients."""
    for numerator in range(-15, 16):
        found = evaluate(p ** sp.Rational(numerator, denominator), {"p": 1.7})
        assert found == pytest.approx(1.7 ** (numerator / denominator), rel=1e-14)


# Precedence

leaves = st.one_of(
    st.sampled_from([x, y, z, p, q, sp.pi]),
    st.integers(-3, 3).map(sp.Integer),
    st.fractions(-3, 3, max_denominator=12).map(lambda value: sp.Rational(value.numerator, value.denominator)),
)


def _grow(children: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    two = st.tuples(children, children)
    half, third = sp.Rational(1, 2), sp.Rational(1, 3)
    safe_power = st.sampled_from([-2, -1, -half, third, half, 3 * half, 2, 3])
    return st.one_of(
        st.lists(children, min_size=2, max_size=4).map(lambda terms: sp.Add(*terms)),
        st.lists(children, min_size=2, max_size=3).map(lambda factors: sp.Mul(*factors)),
        two.map(lambda pair: pair[0] - pair[1]),
        two.map(lambda pair: pair[0] / (2 + pair[1] ** 2)),
        two.map(lambda pair: (1 + pair[0] ** 2) ** sp.cos(pair[1])),
        st.tuples(children, safe_power).map(lambda pair: (2 + sp.sin(pair[0])) ** pair[1]),
        st.tuples(children, st.sampled_from([2, 3])).map(lambda pair: pair[0] ** pair[1]),
        children.map(lambda child: -child),
        children.map(sp.Abs),
        children.map(sp.cos),
        children.map(lambda child: sp.exp(-(child**2))),
        children.map(lambda child: sp.log(1 + child**2)),
        children.map(sp.tanh),
        two.map(lambda pair: sp.Min(*pair)),
        two.map(lambda pair: sp.Max(*pair)),
        two.map(lambda pair: sp.Mul(sp.Integer(-1), sp.Add(*pair), evaluate=False)),
        children.map(lambda child: sp.Pow(sp.Rational(-2, 3), 2, evaluate=False) * sp.Pow(-child, 2, evaluate=False)),
        two.map(lambda pair: sp.Mul(sp.Rational(-2, 3), pair[0], -pair[1] - x, evaluate=False)),
        two.map(lambda pair: sp.Pow(sp.Pow(2 + sp.cos(pair[0]), half, evaluate=False), 2 + sp.cos(pair[1]))),
    )


trees = st.recursive(leaves, _grow, max_leaves=8)
VALUES = {"x": 0.7, "y": -1.3, "z": 0.4, "p": 1.9, "q": 0.6}


EXACTLY = {symbol: sp.Rational(Fraction(VALUES[symbol.name])) for symbol in (x, y, z, p, q)}


@settings(max_examples=60, deadline=None, derandomize=True)
@given(trees)
def test_printed_text_means_what_the_expression_means(tree: sp.Expr):
    """Any tree of the whitelist evaluates, as printed, to what sympy makes of it in 30 digits."""
    # what sympy may make of Abs; not in the whitelist
    assume(not tree.has(sp.re, sp.im, sp.arg, sp.atan2, sp.sign, sp.I))
    exact = tree.subs(EXACTLY).evalf(30)
    assume(exact.is_real and abs(exact) < 1e6)
    # Rounding in any node moves the result by at most a few hundred ulps (8 leaves, slopes of order one) of the
    # largest number on the way.
    on_the_way = (node.subs(EXACTLY).evalf() for node in sp.preorder_traversal(tree) if isinstance(node, sp.Expr))
    largest = max([1.0, *(abs(float(value)) for value in on_the_way if value.is_real)])
    assert abs(evaluate(tree, VALUES) - float(exact)) <= 1e-13 * largest, source(tree)[0]


# Branches

BRANCHED = {
    "root | log": (sp.Piecewise((sp.sqrt(1 - x), x < 1), (sp.log(x), True)), (-2.0, 0.3, 1.7, 4.0)),
    "log | root": (sp.Piecewise((sp.log(x), x > 1), (sp.sqrt(1 - x), True)), (-2.0, 0.3, 1.7, 4.0)),
    "inclusive": (sp.Piecewise((sp.log(2 - x), x <= 1), (sp.log(x), True)), (-2.0, 0.3, 1.7, 4.0)),
    "chain": (
        sp.Piecewise((sp.sqrt(1 - x), x < 1), (sp.sqrt(x - 1) * sp.sqrt(3 - x), x < 3), (sp.log(x - 3), True)),
        (-1.0, 0.5, 1.5, 2.9, 3.5, 9.0),
    ),
    "positive": (sp.Piecewise((sp.log(p) * sp.sqrt(1 - p), p < 1), (1 / p, True)), (0.01, 0.5, 1.5, 7.0)),
    "two symbols": (sp.Piecewise((sp.sqrt(1 - x), (x < 1) & (y < 1)), (sp.log(x), True)), (-2.0, 0.3)),
    "symbolic bound": (sp.Piecewise((sp.sqrt(y**2 - x), x < y**2), (sp.log(x - y**2), True)), (-2.0, 1.0, 2.5)),
    "of a product": (3 * x - 2 * sp.Piecewise((sp.sqrt(1 - x), x < 1), (sp.log(x), True)), (-2.0, 1.7)),
}


@pytest.mark.parametrize("name", BRANCHED)
def test_a_branch_not_taken_yields_no_nan(name: str):
    """Value, gradient (forward and reverse) and second derivative are the taken branch's, where the other is NaN."""
    expression, points = BRANCHED[name]
    (variable,) = expression.free_symbols - {y}
    text, names = source(rounded(expression))
    point, other = casadi.SX.sym(variable.name), casadi.SX.sym("y")
    value = eval(text, {"__builtins__": {}}, {**names, variable.name: point, "y": other})
    forward, reverse = casadi.jtimes(value, point, 1), casadi.jtimes(value, point, 1, True)
    second = casadi.jtimes(reverse, point, 1, True)
    function = casadi.Function("f", [point, other], [value, forward, reverse, second])
    backward = function.reverse(1)
    for at in points:
        here = {variable: sp.Float(at, 30), y: sp.Float(VALUES["y"], 30)}
        exact = [expression.diff(variable, order).subs(here) for order in (0, 1, 1, 2)]
        found = [float(each) for each in function(at, VALUES["y"])]
        assert found == pytest.approx([float(each.evalf(25)) for each in exact], rel=1e-12), at
        seeded = backward(at, VALUES["y"], *found, 1, 0, 0, 0)
        assert float(seeded[0]) == pytest.approx(found[1], rel=1e-12)


@pytest.mark.parametrize("last", [True, False])
def test_a_piecewise_has_conditions_that_are_comparisons_and_covers_everything(last: bool):
    """What is no comparison, and a last branch with a condition of its own, is refused by name."""
    odd = sp.Symbol("odd_condition")
    wrong = sp.Piecewise((x, odd), (1, True), evaluate=False) if last else sp.Piecewise((x, x < 1), (1, x < 2))
    with pytest.raises(KinkError, match="odd_condition is no comparison" if last else "says nothing elsewhere"):
        rounded(wrong)
