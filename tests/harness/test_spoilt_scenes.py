"""A scene with one spoilt entry is one line of InputError that names the entry."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.scene.schema import FIELDS

from .scenes import scenes
from .settings import examples

SPOILT = {
    "not a number": math.nan,
    "infinite": math.inf,
    "text": "much",
    "another unit": "3 furlong kg^2",
    "a list": [1.0],
    "below the range": None,
    "above the range": None,
}


def spoil(name: str, kind: str) -> object:
    """A value that is none for the entry; None where the range has no such side."""
    field = FIELDS[name]
    if kind == "below the range":
        return field.range.low - 1.0 if math.isfinite(field.range.low) else None
    if kind == "above the range":
        return field.range.high + 1.0 if math.isfinite(field.range.high) else None
    return SPOILT[kind]


@examples(100)
@given(scenes(moderate=False), st.sampled_from(sorted(SPOILT)), st.integers(0, 2**32 - 1))
def test_a_spoilt_entry_is_named(scene: Scene, kind: str, number: int) -> None:
    """By its dotted name, in one line that says what is accepted."""
    entries = {name: value for name, value in scene.si if isinstance(value, float)}
    name = sorted(entries)[number % len(entries)]
    value = spoil(name, kind)
    if value is None:
        return
    with pytest.raises(InputError) as caught:
        scene.with_entries({name: value})
    line = str(caught.value)
    assert caught.value.field == name
    assert len(line.splitlines()) == 1 and "accepted: " in line


@examples(30)
@given(scenes(moderate=False), st.integers(0, 2**32 - 1))
def test_a_misspelt_entry_is_told_the_nearest(scene: Scene, number: int) -> None:
    """Two letters exchanged: the name that was meant stands in the message."""
    names = sorted(name for name, value in scene.si if isinstance(value, float))
    name = names[number % len(names)]
    table, _, key = name.partition(".")
    place = number % (len(key) - 1)
    wrong = key[:place] + key[place + 1] + key[place] + key[place + 2 :]
    if wrong == key:
        return
    with pytest.raises(InputError, match=f"did you mean {name}") as caught:
        scene.with_entries({f"{table}.{wrong}": 1.0})
    assert len(str(caught.value).splitlines()) == 1
