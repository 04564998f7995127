"""Names of declarations: whatever a word means elsewhere, it is refused by name or does no harm."""

import keyword

import pytest
from wetdoublet.derive import user
from wetdoublet.derive.user.declarations import ModelFileError, collecting, quantity
from wetdoublet.derive.user.laws import law
from wetdoublet.derive.user.motion import event, force_on
from wetdoublet.derive.user.names import listed, taken
from wetdoublet.derive.vocabulary.quantities import sigma, x, x0

HEAD = "from wetdoublet.derive.user import *\n"
WORDS = sorted(word for word in taken() if word.islower())


def test_the_list_has_every_kind_of_word():
    """Keywords of Python, C and C++, functions of mathematics, and arguments, variables and imports of emitted code."""
    c = {"double", "int", "register", "restrict", "template", "new", "namespace", "near", "linux"}
    emitted = {"gap_over_radius", "film_force", "state", "groups", "laws", "distance", "result", "if_else", "fmax"}
    assert {*keyword.kwlist, *c, *emitted, "min", "sqrt", "exp", "viscosity"} <= taken().keys()


@pytest.mark.parametrize(
    "declare", [quantity, lambda word: event(word, guard=x), lambda word: quantity("q", group=word)]
)
def test_a_reserved_word_is_refused_by_name(declare):
    """No quantity that is a group as it is, and no event, bears a word that means something where it is written."""
    for word in WORDS:
        with collecting(), pytest.raises(ModelFileError, match="is taken already: it is|accepted: a name") as caught:
            declare(word)
        assert caught.value.value == word


def test_a_quantity_with_a_dimension_may_bear_a_name_of_a_structure():
    """Its group has another name, and only that one stands in the emitted structures."""
    with collecting():
        assert quantity("radius", unit="m").name == "radius"


def test_a_law_may_bear_any_word():
    """What is emitted of it always has its slot in front."""
    for word in (word for word in WORDS if word.isalpha()):
        with collecting() as declared:
            law("bridge", word, force=sigma * x)
        assert ("bridge", word) in declared.laws


def test_a_name_that_is_listed_may_be_used():
    """In a term, but for arguments of laws and the time; `rho`, `E`, `nu`, `x_b` are in no equation."""
    rows = {line[:16].strip(): line[16:24].strip() for line in listed(vars(user)).splitlines()}
    of_laws = {"approach", "distance", "gap", "h", "normal_velocity", "offset_squared", "opening", "t"}
    assert {"x", "sigma", "V", "phi", "mu", "p_gt", *of_laws} < rows.keys()
    for name in rows.keys() - of_laws:
        with collecting():
            force_on("gap", sigma * x0 * vars(user)[name] / quantity("unit_of_it", unit=rows[name]))
    for name in ("rho", "E", "nu", "x_b"):
        with collecting(), pytest.raises(ModelFileError, match="is not known to a term"):
            force_on("gap", sigma * x0 * vars(user)[name])
        assert name not in rows
