"""Terms and criteria in the derivation: what is refused, what is conserved, and how they are printed."""

from pathlib import Path

import pytest
import sympy as sp
from wetdoublet.derive.checks.user import checks_of
from wetdoublet.derive.checks.words import conserved, in_words
from wetdoublet.derive.emit.document.document import document
from wetdoublet.derive.emit.document.theory import DEFAULTS
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.derive.physics.structure import Structure
from wetdoublet.derive.user.declarations import ModelFileError
from wetdoublet.derive.user.structures import UserModel

OBLIQUE = Structure(True, True, False)
HEAD = (
    'from wetdoublet.derive.user import *\nk = quantity("k", unit="N m", bounds=">= 0")\n'
    'd = quantity("d", unit="m")\nn = quantity("n", unit="1", bounds="> 0")\n'
)
USES = "\nenergy(k*n*d/x0)"


def model(body: str) -> UserModel:
    """The model of a file with these lines."""
    return read(Path("mine.py"), HEAD + body + USES)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('force_on("angle", k)', "force_on: 'angle' is no coordinate; accepted: gap, rotation, spin"),
        ('force_on("gap", k)', "force_on gap: 'k' has dimension M L^2 T^-2; accepted: dimension M L T^-2"),
        ('force_on("gap", k/x0*t*v0/x0)', "force_on gap: 't' is in a term"),
        ('force_on("gap", -k/x0*Abs(u)/v0)', "has a kink where it vanishes; accepted: a smooth expression"),
        ("energy(m*u*omega*a)", "is neither a potential nor a kinetic energy; accepted: a potential of x and beta"),
        ("energy(m*u**4/v0**2)", "is neither a potential nor a kinetic energy"),
        ("energy(k*Max(x, d)/x0)", "has a kink where it vanishes"),
        ('criterion("soft", gap=k)', "criterion soft.gap: 'k' has dimension M L^2 T^-2; accepted: dimension L"),
        ('criterion("soft", gap=x/2)', "criterion soft.gap: 'x' varies along a trajectory"),
        ('criterion("glass", gap=d)', "criterion: 'glass' is a word of the library"),
        ('criterion("soft", gap=d)\ncriterion("soft", gap=d)', "'soft' is taken already"),
        ('law("bridge", "mine", force=1, falls=3)', "law bridge mine.falls: 3 is not accepted; accepted: True, False"),
        ('law("film", "mine", resistance=1, spread=3)', "law film mine.spread: 3 is not accepted"),
        ('law("bridge", "mine", force=1, accept="limits")', "law bridge mine.accept: 'limits' is no list of them"),
    ],
)
def test_bad_declarations_are_named(body: str, said: str):
    """What cannot be is one line with file, line, what is wrong and what is accepted."""
    with pytest.raises(ModelFileError) as caught:
        model(body)
    assert str(caught.value).startswith("mine.py, line ")
    assert said in str(caught.value)
    assert "accepted: " in str(caught.value)


def test_what_a_law_accepts_is_a_check():
    """A name of no check fails, with those that there are."""
    checks = checks_of(model('law("bridge", "mine", force=1, accept=("nonsense",))'))
    (failing,) = (check for check in checks if check.ok is False)
    assert failing.name == "accept"
    assert "'nonsense' is none; accepted: dimensions" in failing.figure
    assert "limits" in failing.figure


L = "angular momentum L = m [r^2 omega + (32/5) a^2 xi]"


@pytest.mark.parametrize(
    ("body", "kept"),
    [
        ('force_on("gap", -k/x0*u/v0)', [L]),
        ("energy(k*x/x0 + n*m*u**2)", [L]),
        ('force_on("spin", k*x0/v0*(omega - xi))\nforce_on("rotation", k*x0/v0*(xi - omega))', [L]),
        ('force_on("rotation", k)', []),
        ("energy(k*beta**2)", []),
        ("energy(n*m*a**2*xi**2)", ["orbital_momentum + (2*(5*n + 16)/5) spin: a combination of momenta"]),
    ],
)
def test_what_is_conserved(body: str, kept: list[str]):
    """Angular momentum while no term exerts a torque; with an inertia the whole one; and the checks say what is not."""
    made = model(body)
    assert list(conserved(made)) == kept
    checks = {check.name: check for check in checks_of(made)}
    assert checks["energy: terms"].ok is True
    assert checks["angular momentum: terms"].ok is (True if kept == [L] else None)
    if not kept:
        assert any(line.startswith("Angular momentum is not conserved: d/dt of L") for line in in_words(made))


@pytest.mark.parametrize(
    ("body", "rotates", "drives", "barrier"),
    [
        ('force_on("gap", -k/x0*u/v0)', False, False, True), ('force_on("gap", k/x0*u/v0)', False, False, False),
        ("energy(k*x/x0 + n*m*u**2)", False, False, True), ('force_on("rotation", k)', True, True, False),
        ('force_on("rotation", -k*omega*x0/v0)', True, False, False), ("energy(k*cos(beta + 1))", True, True, False),
        ("energy(k*cos(beta))", True, False, False),
    ],
)  # fmt: skip
def test_what_decides_structures_and_certificates(body: str, rotates: bool, drives: bool, barrier: bool):
    """Whether terms speak of a rotation, turn what does not turn, and leave the energy's barrier."""
    terms = model(body).terms
    assert (terms.rotates, terms.drives, terms.admits_barrier) == (rotates, drives, barrier)
    made = model(body).derived(OBLIQUE)
    assert ("effective_potential" in made) is barrier
    assert not any(function.certificate for function in made.functions)


def test_the_angle_is_a_state_where_a_term_watches_it():
    """Not head-on, where nothing turns, and not with strings, which have it already."""
    made = model("energy(k*cos(beta))")
    assert [symbol.name for symbol in made.derived(OBLIQUE).states][-1] == "angle_turned"
    assert len(made.derived(Structure(False, True, False)).states) == 2
    assert [symbol.name for symbol in made.derived(Structure(True, False, True)).states][-1] == "rotation"


def test_terms_are_printed():
    """The equations of motion have the inertia and the forces, with a line for each."""
    made = model('energy(n*m*u**2*x0/x)\nforce_on("rotation", -k*omega*x0/v0)')
    lines = document("mine", DEFAULTS, made).lines
    by_left = {left: right for _, left, _, right, _ in lines}
    assert r"\left( m + M_x \right) \frac{d u}{dt}" in by_left
    assert "Q_x" in by_left[r"\left( m + M_x \right) \frac{d u}{dt}"]
    assert {"M_x", "Q_x", r"Q_\beta"} <= by_left.keys()


def test_a_criterion_is_a_group_of_contact():
    """Its gap over x0, and the roughness or it in the group of the roughness: structures stay as they are."""
    made = model('criterion("soft layer", gap=2*d)')
    (known,) = made.criteria
    assert (known.word, known.group.name) == ("soft layer", "soft_layer_gap")
    assert {symbol.name for symbol in made.gaps} == {"soft_layer_gap", "rough_gap"}
    rough = next(value for symbol, value in made.gaps.items() if symbol.name == "rough_gap")
    assert isinstance(rough, sp.Max)
