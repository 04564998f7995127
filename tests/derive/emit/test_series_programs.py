"""Series programs: which recurrences an expression becomes, what has none, and slopes by the chain rule."""

import math
import random
import re
from dataclasses import replace

import pytest
import sympy as sp
from wetdoublet.derive.emit.casadi.printer import EmissionError
from wetdoublet.derive.emit.taylor.chain_rule import Chain
from wetdoublet.derive.emit.taylor.constants import Constants
from wetdoublet.derive.emit.taylor.header import structure_header
from wetdoublet.derive.emit.taylor.law_header import antiderivative, law_header, moves
from wetdoublet.derive.emit.taylor.law_slopes import slope_program
from wetdoublet.derive.emit.taylor.loops import Loops
from wetdoublet.derive.emit.taylor.program import Program
from wetdoublet.derive.emit.taylor.recurrences import Recurrences
from wetdoublet.derive.equations.model import derive
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.law import Law, LawFunction
from wetdoublet.derive.physics.scaling import as_product
from wetdoublet.derive.physics.structure import Structure

x, y = sp.symbols("x y", positive=True)
c = sp.Symbol("c", positive=True)


@pytest.mark.parametrize(
    "expression", [sp.asin(x), sp.Piecewise((x, x < 1), (1, True)), sp.Abs(x - 1), sp.besselj(0, x)]
)
def test_an_operation_without_a_recurrence_is_named(expression: sp.Expr):
    """What has no recurrence is an error that names it, before anything is emitted."""
    with pytest.raises(EmissionError, match=f"no Taylor recurrence for {type(expression).__name__}"):
        Program((x, y)).series(expression)


FORCES = [sp.exp(c * x + 2) + 3 * c, x**2 / c, 1 - x / sp.sqrt(x**2 + c), (x - 1) ** 2 / x]


@pytest.mark.parametrize("force", FORCES, ids=map(str, FORCES))
def test_work_in_closed_form(force: sp.Expr):
    """The derivative of the antiderivative is the force."""
    work = antiderivative(force, x)
    assert work is not None
    assert sp.simplify(work.diff(x) - force) == 0


def test_every_law_has_its_header():
    """Every law of the library becomes recurrences; which forces close their work is known."""
    closed = set()
    for slot, laws in LAWS.items():
        for law in laws.values():
            text = law_header(law)
            assert f"{slot}_" in text
            if "_WORK 1" in text:
                closed.add(law.name)
    assert {"mikami", "mikami-log10", "soulie", "lambert", "constant", "van-der-waals", "finite"} <= closed
    assert "willett" not in closed


def test_intermediates_that_change_with_the_gap_through_others():
    """A force by way of two intermediates is the force itself, and so is its work."""
    mikami = LAWS["bridge"]["mikami"]
    gap = mikami["force"].arguments[0]
    square, shifted = sp.symbols("square shifted", positive=True)
    force = replace(mikami["force"], definitions=((square, gap**2), (shifted, square + 1)), result=shifted)
    plain = replace(force, definitions=(), result=gap**2 + 1)
    chained, direct = (law_header(replace(mikami, functions=(each,))) for each in (force, plain))
    work = re.compile(r"bridge_force_work\(.*?\n}", re.S)
    assert work.search(chained)[0] == work.search(direct)[0]


def test_arguments_that_move():
    """Of a law's arguments those are series that are no groups, a user's groups included."""
    assert moves(LAWS["bridge"]["mikami"]["force"].arguments) == (True, False, False)
    assert moves(LAWS["shear"]["immersed"]["edge"].arguments) == (False,)
    assert moves(LAWS["strings"]["exact"]["stiffness"].arguments) == (False, True)
    assert moves((x, c), {c}) == (True, False)


def test_margins_of_what_attracts():
    """An attraction on strings, or without, has the margins of its own proof, for laws that fall with the gap alone."""
    for strings in (False, True):
        text = structure_header(derive(Structure(oblique=True, strings=strings, bridge=True)))
        assert "#if defined(BRIDGE_FORCE_FALLS)\n#define ATTRACTION_MARGINS" in text
        assert "*hold_margin = hold;" in text
        assert not re.search(r"vec_(max|min)\(", text)
    assert "BRIDGE_FORCE_FALLS" in law_header(LAWS["bridge"]["mikami"])
    assert "BRIDGE_FORCE_FALLS" not in law_header(LAWS["bridge"]["rabinovich"])


def test_margins_of_the_stick_proof_hand_nan_on():
    """Rotating strings with a film alone have the proof's margins, by maxima that are NaN where either argument is."""
    text = structure_header(derive(Structure(oblique=True, bridge=False, strings=True)))
    assert "#if defined(FILM_BRAKING) && defined(FILM_STOPPING) && defined(GLASS_REACH)" in text
    assert "vec_larger(y[ORBITAL_MOMENTUM], spun_up)" in text
    assert not re.search(r"vec_(max|min)\(", text)
    without = structure_header(derive(Structure(oblique=True, strings=True, bridge=True)))
    assert "pendulum_stops" not in without


def _looped(terms: list[sp.Expr]) -> tuple[str, str, dict[str, sp.Expr]]:
    """C text of the values and of the recurrences of a sum, and what is prepared for both."""
    program = Program((x, y))
    total = program.series(sp.Add(*terms), "total")
    constants = Constants({c: "c->c"})
    recurrences = Recurrences(program, constants, lambda series: series, loops=Loops(program.operations))
    return "\n".join(recurrences.values([total])), "\n".join(recurrences.lines()), constants.prepared


def test_terms_that_differ_in_constants_are_a_loop():
    """Executed as Python, the loop gives the sum; a seventh term is no more text than a sixth."""
    weights = [sp.Rational(k, 7) for k in range(1, 8)]
    terms = [k / (2 + (1 + k * x) ** 3 * y) + k * sp.exp(-k * c * x * y - c * k**2) for k in weights]
    text, recurrences, prepared = _looped(terms)
    assert text.count("for (") == recurrences.count("for (") == 1
    assert text.count("vec_exp") == 1
    assert len(_looped(terms[:6])[1].splitlines()) == len(recurrences.splitlines())
    body = text.replace("c->", "").replace("vec_exp", "exp").replace(";", "").replace("const ", "")
    body = re.sub(r"^(?:static )?(?:double|vec) (\w+)\[(\d+)\]$", r"\1 = [0.0]*\2", body, flags=re.M)
    body = re.sub(r"^(?:static )?(?:double|vec) (\w+)(?:\[\d+\])? = ", r"\1 = ", body, flags=re.M)
    body = re.sub(r"= \{(.*)\}$", r"= [\1]", body, flags=re.M)
    body = re.sub(r"for \(int node = 0 node < (\d+) node\+\+\) \{", r"for node in range(\1):", body).replace("}", "")
    found = {"exp": math.exp, "splat": float, "x": 0.3, "y": 0.7, "c": 1.1}
    found |= {name: float(value.subs(c, 1.1)) for name, value in prepared.items()}
    exec(body, found)
    assert found["total"] == pytest.approx(float(sp.Add(*terms).subs({x: 0.3, y: 0.7, c: 1.1})), rel=1e-14)


LIBRARY = [law for laws in LAWS.values() for law in laws.values()]


@pytest.mark.parametrize("law", LIBRARY, ids=lambda law: law.module)
def test_slopes_of_a_law(law: Law) -> None:
    """Each function of a law by each argument, with names kept, is the slope of the function written out."""
    draw = random.Random(3)
    for each in law.functions:
        chain, written = Chain(each.definitions), sp.lambdify(each.arguments, each(*each.arguments), "math")
        at = {symbol: draw.uniform(0.3, 0.6) for symbol in each.arguments}
        at |= {symbol: 5.0 for symbol in at if symbol.name == "string_ratio"}  # strings longer than the spheres
        for argument in each.arguments:
            found = chain.by(each.result, argument)
            for symbol, value in (*reversed(chain.named), *reversed(each.definitions)):
                found = found.subs(symbol, value)
            low, high = (written(*(at | {argument: at[argument] + step}).values()) for step in (-1e-5, 1e-5))
            slope = float(sp.lambdify(list(at), found, "math")(*at.values()))
            assert math.isclose(slope, (high - low) / 2e-5, rel_tol=1e-6, abs_tol=1e-8), (each.name, argument)


@pytest.mark.parametrize("count", [3, 30])
def test_a_law_with_many_roots(count: int, monkeypatch: pytest.MonkeyPatch):
    """Up to seven are factored: sympy takes hours for thirty. The form that costs least has the value of the slope."""
    widest, factor, gap = 0, sp.factor, sp.Symbol("gap", positive=True)

    def watched(expression: sp.Expr) -> sp.Expr:
        nonlocal widest
        widest = max(widest, len({part for part in expression.atoms(sp.Pow) if part.exp == sp.Rational(1, 2)}))
        assert widest <= 7
        return factor(expression)

    monkeypatch.setattr(sp, "factor", watched)
    law = sp.Add(*(sp.sqrt(1 + k * gap) for k in range(1, count + 1))) / (1 + gap) ** 2
    _, _, program, results = slope_program(LawFunction("force", (gap,), law, ""), (gap,))
    assert isinstance(results[gap], str)
    assert program.cost < 40 * count
    assert widest == (3 if count == 3 else 0)
    here = {gap: sp.Rational(1, 3)}
    assert as_product(law.diff(gap)).subs(here).n() == pytest.approx(law.diff(gap).subs(here).n(), rel=1e-14)
