"""Kinks of laws: guards and sides, the written law on either side of each, and what is refused where it is declared."""

from pathlib import Path
from random import Random

import pytest
import sympy as sp
from wetdoublet.derive.checks.user import model_checks
from wetdoublet.derive.emit.taylor.law_slopes import slopes_header
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.derive.user.kinks import WIDTH

HEAD = "from wetdoublet.derive.user import *\n"
FILM = 'law("film", "mine", resistance=6*pi*mu*a**2*u/x*(1 - x/x0)**2*({}))'
KINKED = [
    "1 + Abs(u/v0 + 0.3)", "Max(x/x0 - 0.4, 0)**0.5", "Min(Abs(u)/v0, 0.2)**3", "Abs(u/v0)**0.7",
    "Piecewise((1 + u/v0, u < 0), (2, x > 0.3*x0), (x/x0, True))", "Piecewise((1, (u > 0) & (x < x0/2)), (3, True))",
    "Max(x - 0.4*x0, 0)/x0", "(sqrt(u**2 + v0**2/9)/v0)**(x/x0 - 1)", "Abs(u + Max(u, -v0/2))/v0",
    "sqrt((x/x0 - 0.6)**2)", "exp(-Abs(x/x0 - 0.5))", "1 + sp.sign(u)/2", "(1 - x/x0)**1.5", "acos(x/x0)",
    "asin(Abs(u)/v0)", "1 + atan(3*u/v0)", "Abs(log(Abs(u/v0)))",
    "asin(Min(1, 2*x/x0))", "acos(Max(-1, u/v0 - x/x0))",
]  # fmt: skip


def film(factor: str):
    """The film's resistance with this factor: as written and as emitted."""
    model = read(Path("mine.py"), HEAD + FILM.format(factor))
    return model.written[0]["resistance"], model.laws[0]["resistance"]


@pytest.mark.parametrize("factor", KINKED)
def test_on_either_side_the_law_is_the_written_one(factor: str):
    """Value and slopes away from kinks are those of sympy's functions, to the square of the width over the distance."""
    written, emitted = film(factor)
    given = [sp.Symbol("gap", positive=True), *(s for s in written.arguments if s.name == "normal_velocity")]
    random = Random(1)
    for _ in range(4):
        at = dict(zip(given, (random.uniform(0.05, 0.95), random.uniform(-1, 1)), strict=False))
        for variable in (None, *given):
            one, other = (each(*each.arguments) for each in (written, emitted))
            if variable is not None:
                step = sp.Rational(1, 10**6)
                one = (one.subs(variable, variable + step) - one.subs(variable, variable - step)) / (2 * step)
                other = other.diff(variable)
            expected = sp.re(one.subs(at).evalf(30))
            assert float(other.subs(at).evalf(30)) == pytest.approx(float(expected), rel=1e-7, abs=1e-9), at


@pytest.mark.parametrize(
    "kinked", ["Max(strong*exp(-x/debye), weak)", "weak*Piecewise((1, exp(-x/debye) < 0.5), (2, True))"]
)
def test_what_has_decayed_stays_a_number(kinked: str):
    """Far beyond the range of an attraction that decays fast the other one is left, though exp(x/debye) overflows."""
    units = {"debye": "m", "strong": "N", "weak": "N"}
    lines = [f'{name} = quantity("{name}", unit="{unit}")' for name, unit in units.items() if name in kinked]
    law = read(Path("mine.py"), "\n".join([HEAD, *lines, f'law("bridge", "mine", force={kinked})'])).laws[0]["force"]
    statements = list(law.definitions)
    compiled = sp.lambdify(law.arguments, law.result, modules=["math"], cse=lambda result: (statements, result))

    def at(gap: float) -> float:
        values = {"debye": 1e-5, "strong": 5.0, "weak": 2.0, "gap": gap}
        return float(compiled(*(values.get(symbol.name.split("_")[0], 0.1) for symbol in law.arguments)))

    assert at(0.3) == at(0.1) > 0


def test_guards_are_what_vanishes():
    """A kink in the velocity has the velocity as its guard, whatever positive factor it is written with."""
    forms = (
        "Piecewise((1, u >= 0), (2, True))",
        "Piecewise((1, u/v0 >= 0), (2, True))",
        "Piecewise((2, 3*u < 0), (1, True))",
    )
    laws = [film(form)[1] for form in forms]
    values = [dict(law.definitions)[kink] for law in laws for kink, _ in law.kinks]
    assert [value.name for value in values] == ["normal_velocity"] * 3
    velocity = sp.Symbol("normal_velocity", real=True)
    sides = [[law(*law.arguments).subs(velocity, at) for law in laws] for at in (-0.5, 0.5)]
    for each in sides:
        assert sp.simplify(each[0] - each[1]) == sp.simplify(each[0] - each[2]) == 0


def test_positive_quantities_are_no_kinks():
    """The gap and sums of positive terms are emitted as they are written."""
    written, emitted = film("(x/x0)**0.7 + Abs(x) / x0 + sqrt(1 + x/x0) + Max(x/x0, 0)")
    assert (written.result, emitted.kinks) == (emitted.result, ()) or emitted.kinks == ()


def test_what_is_zero_over_a_range_stays_zero():
    """A root of Max(k, 0) is no force where k is negative: less than any tolerance, not the root of the width."""
    _, emitted = film("1 + Max(u/v0, 0)**0.5")
    gap, velocity = sp.Symbol("gap", positive=True), sp.Symbol("normal_velocity", real=True)
    value = emitted(*emitted.arguments).subs({gap: sp.Rational(1, 2), velocity: -sp.Rational(1, 2)})
    assert float(value.evalf(40) - sp.Rational(1, 2)) == pytest.approx(0.0, abs=float(WIDTH) ** 1.4)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (FILM.format("1 + sp.besselj(0, x/x0)"), "no dimension is known for besselj"),
        (FILM.format("1 + asin(2*x/x0)"), "is not a finite number"),
        (FILM.format("1 + v0/u"), "does not vanish at rest"),
        (FILM.format("Piecewise((1, u > 0), (2, u < 0))"), "says nothing elsewhere"),
        (FILM.format("1 + 1/Abs(x/x0 - 0.37)"), ""),
    ],
)
def test_what_no_engine_has_is_refused(body: str, said: str):
    """`generate` refuses a law with the reason; a pole inside a branch is found where it is met."""
    failing = [check.figure for check in model_checks(Path("mine.py"), HEAD + body)[1] if not check.ok]
    assert any(said in figure for figure in failing) or not said


@pytest.mark.parametrize("factor", ["asin(Min(1, x0/x/2))", "1 + asin(Max(-1, 1 - x/x0))/4"])
def test_an_arc_may_stay_at_the_end_of_its_domain(factor: str):
    """Where its argument is bounded by 1 an arcsine is constant, by CasADi and by the kernel's recurrences."""
    body = f'law("bridge", "mine", force=pi*R*sigma*({factor}))'
    assert [check.figure for check in model_checks(Path("mine.py"), HEAD + body)[1] if not check.ok] == []


@pytest.mark.parametrize("bounds", ["0 to 1", "> 0"])
def test_an_arc_of_a_bounded_quantity(bounds: str):
    """The least of a quantity and a length over x may be far above 1 beside it; without a bound it may be itself."""
    body = f'k = quantity("k", default=0.5, bounds="{bounds}")\n'
    body += 'law("bridge", "mine", force=pi*R*sigma*(1 + asin(Min(k, x0/x))))'
    failing = [check.figure for check in model_checks(Path("mine.py"), HEAD + body)[1] if not check.ok]
    assert failing == [] if bounds == "0 to 1" else "bounds= of k say which values to expect" in failing[0]


def test_several_kinks_below_a_fraction():
    """The emitted slope of a law stays short: each extreme is a part, which no expansion multiplies out."""
    factor = "1 + 1/(1 + Min((x/x0)**2, Abs(x/x0 - 0.5), 0.371)**2)"
    model = read(Path("mine.py"), HEAD + FILM.format(factor))
    assert len(slopes_header(model.laws[0])) < 20_000
    gap = sp.Rational(3, 5)  # where the least is 0.1
    value = model.laws[0]["resistance"](*model.laws[0]["resistance"].arguments).subs(
        sp.Symbol("gap", positive=True), gap
    )
    library = (1 - gap) ** 2 / gap
    assert float((value / library).evalf(30)) == pytest.approx(1 + 1 / 1.01, rel=1e-12)
