"""Random scenes of the covering structures, as hypothesis draws and shrinks them."""

import pytest
from hypothesis import assume
from hypothesis import strategies as st
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.verify.stress.sample import NUMBERS, scene_of

from .structures import STRUCTURES, Structure, name

QUICK = STRUCTURES[::3]  # each structure has its kernels
parts = pytest.mark.parametrize(
    "structures",
    [QUICK, pytest.param([each for each in STRUCTURES if each not in QUICK], marks=pytest.mark.slow)],
    ids=["some", "the others"],
)


@st.composite
def scenes(draw: st.DrawFn, structures: list[Structure] = STRUCTURES, moderate: bool = True) -> Scene:
    """A valid scene of one of the structures, with its impact."""
    structure = draw(st.sampled_from(structures))
    point = draw(st.lists(st.floats(0.0, 1.0), min_size=NUMBERS, max_size=NUMBERS))
    try:
        return scene_of(name(structure), structure, point, moderate)
    except InputError:  # an impossible scene, such as a film thicker than its bridge
        assume(False)
        raise
