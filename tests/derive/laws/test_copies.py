"""What the library's laws are declared with is what a user has: a copy of each is the same law by another name."""

from dataclasses import replace
from pathlib import Path

import pytest
from wetdoublet.derive.checks.user import checks_of
from wetdoublet.derive.emit.casadi.modules import features, law_module
from wetdoublet.derive.emit.casadi.printer import EmissionError
from wetdoublet.derive.emit.interval.header import law_header as interval_header
from wetdoublet.derive.emit.taylor.law_header import law_header
from wetdoublet.derive.emit.taylor.law_slopes import slopes_header
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.laws.modelfile import read
from wetdoublet.derive.physics.law import Law
from wetdoublet.derive.user.structures import UserModel

from ...helpers.copied_laws import FILES, copied

COPIED: dict[str, UserModel] = {}


def copy(file: str) -> UserModel:
    """The model of a copied file."""
    if file not in COPIED:
        COPIED[file] = read(Path("copies.py"), copied(file))
    return COPIED[file]


def enclosure(law: Law) -> str:
    """The text of a law's enclosure, or why it has none."""
    try:
        return interval_header(law)
    except EmissionError as error:
        return str(error)


def test_every_law_is_copied():
    """The files have each law of the library once."""
    names = [(law.slot, law.name.removesuffix("-copy")) for file in FILES for law in copy(file).laws]
    assert sorted(names) == sorted((slot, name) for slot, laws in LAWS.items() for name in laws)


@pytest.mark.parametrize("file", FILES)
def test_a_copy_is_emitted_as_the_law(file: str):
    """Python, recurrences, slopes and enclosures are the same text but for the name; no group or argument is new."""
    model = copy(file)
    assert (model.groups, model.extra) == ((), {})
    for law in model.laws:
        named = replace(law, name=law.name.removesuffix("-copy"))
        library = LAWS[named.slot][named.name]
        assert law.name != library.name
        for text in (law_module, law_header, slopes_header, enclosure, features):
            assert text(named) == text(library), (library.name, text)
        texts = [(each.meaning, each.source, each.references, each.validity) for each in (named, library)]
        assert texts[0] == texts[1]


@pytest.mark.slow
@pytest.mark.parametrize("file", FILES)
def test_a_copy_passes_every_check(file: str):
    """The checks of a user's model hold for the library's laws."""
    checks = checks_of(copy(file))
    assert len(checks) > 3
    assert [check for check in checks if not check.ok] == []
