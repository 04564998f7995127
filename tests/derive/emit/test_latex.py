"""The equations as LaTeX: complete, drawable, and the same mathematics that they were derived as."""

from functools import cache

import pytest
import sympy as sp
from matplotlib.mathtext import MathTextParser
from wetdoublet.derive.emit.casadi.printer import EmissionError
from wetdoublet.derive.emit.document.latex import NAMES, latex
from wetdoublet.derive.emit.document.theory import theory
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.forces import FILM, SHEAR, force_laws
from wetdoublet.derive.physics.law import fill
from wetdoublet.derive.physics.mechanics import F_n, F_t, S_n, S_t, doublet_inertia
from wetdoublet.derive.physics.pendulum import swing_squared
from wetdoublet.derive.vocabulary import quantities as q

CHOICES = [{slot: name} for slot, laws in LAWS.items() for name in laws]
drawn = cache(MathTextParser("path").parse)


@pytest.fixture(scope="module")
def lines():
    return theory()


@pytest.mark.slow
@pytest.mark.parametrize("choice", CHOICES, ids=lambda choice: "-".join(*choice.items()))
def test_every_law_can_be_drawn(choice):
    """Whatever law fills a slot, every line of the theory parses as mathtext, which is a subset of LaTeX."""
    for line in theory(choice):
        drawn(f"${line.latex}$")


def test_published_forms(lines):
    """Lubrication, inertia and the groups read as the paper writes them."""
    text = [line.latex for line in lines]
    assert r"F_{L,n} = \frac{6 \pi \mu a^{2} u}{x} \left( 1 - \frac{x}{x_0} \right)^{2}" in text
    assert r"F_{L,t} = 8 \pi \mu a^{2} \left( \omega - \xi \right) \, \ln \left( \frac{2 a}{x} \right)" in text
    assert r"St = \frac{m v_{n,0}}{6 \pi \mu a^{2}}" in text
    assert r"Ca = \frac{3 \mu a v_{n,0}}{\sigma x_0}" in text
    assert r"Ce = \frac{m \omega_0^{2}}{\sigma}" in text
    assert r"\omega_0 = \frac{v_{n,0}}{4 a} \, \tan \theta_0" in text


def test_rearranging_changes_nothing(lines):
    """What is shown of the forces and the inertia is identical to what the derivation has."""
    laws = {slot: LAWS[slot][name] for slot, name in (("film", "finite"), ("shear", "immersed"), ("strings", "exact"))}
    shown = {line.left: line.expression for line in lines}
    swing = swing_squared().subs(sp.Symbol("r", positive=True), q.r)
    for force in (F_n, F_t, S_n, S_t):
        derived = fill(force_laws()[force].subs({FILM: 1, SHEAR: 1}), laws)
        found = shown[latex(force)].subs(sp.Symbol("swing", positive=True) ** 2, swing)
        assert sp.simplify(found - derived) == 0, force
    assert sp.simplify(shown["I(x)"] - doublet_inertia()) == 0


def test_variants_differ_where_they_should():
    """The film's logarithm changes its own line only."""
    default = {line.left: line.latex for line in theory()}
    other = {line.left: line.latex for line in theory({"shear": "film"})}
    changed = {left for left in default if default[left] != other[left]}
    assert changed == {"F_{L,t}"}
    assert r"\frac{x_0}{x}" in other["F_{L,t}"]


def test_printer_is_strict():
    """A symbol without a LaTeX name and a function off the list are errors that name them."""
    with pytest.raises(EmissionError, match="unheard_of"):
        latex(sp.Symbol("unheard_of"))
    with pytest.raises(EmissionError, match="gamma"):
        latex(sp.gamma(q.x))


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (q.x / 2 - 1, r"\frac{x}{2} - 1"),
        (-(q.a * (q.x + q.x0)), r"-a \left( x_0 + x \right)"),
        (sp.Rational(1, 3) / q.x, r"\frac{1}{3 x}"),
        (sp.sqrt(q.a) * sp.sin(q.beta) ** 2, r"\sqrt{a} \, \sin^{2} \beta"),
        (sp.Float("0.34") * q.mu * q.a, r"0.34 \mu a"),
        (1 / (q.x + 1) ** 2, r"\frac{1}{\left( 1 + x \right)^{2}}"),
    ],
)
def test_notation(expression, text):
    """Fractions, signs, roots and the order of factors."""
    assert latex(expression) == text


def test_names_are_unambiguous():
    """No two quantities of the vocabulary share a symbol in print."""
    vocabulary = [NAMES[name] for name in q.VOCABULARY]
    assert len(set(vocabulary)) == len(vocabulary)
