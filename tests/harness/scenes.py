"""Random scenes of the covering structures, as hypothesis draws and shrinks them."""

import numpy as np
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
    # not floats, which lean to 0 and 1: most of such scenes meet no film
    point = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).uniform(size=NUMBERS).tolist()
    try:
        return scene_of(name(structure), structure, point, moderate)
    except InputError:  # an impossible scene, such as a film thicker than its bridge
        assume(False)
        raise
