"""A scene with one spoilt entry is one line of InputError that names the entry."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wetdoublet.solvers import InputError, Scene

from .scenes import scenes
from .settings import examples


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
