"""What is inferred: that a stick never separates, that nothing changes between boundaries, that a proof holds."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import ComputationError, Scene, boundary, collide, collide_many, prove
from wetdoublet.solvers.engines.taylor.undecided import SEPARATES

from .conditioning import decided
from .scenes import scenes
from .settings import examples, few
from .structures import STRUCTURES

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


@examples(14)
@given(scenes(few(STRUCTURES)))
def test_a_certified_stick_followed_on_never_separates(scene: Scene) -> None:
    """For twenty times the time in which its film is closed: it does not separate, and its bridge does not break."""
    collision = decided(scene)
    assume(collision.outcome == "stick" and collision.certified)
    later = 20 * scene.liquid.film_thickness / collision.speed + (collision.until or 0.0)
    try:
        followed = collide(scene, until=later)
    except ComputationError as error:
        assert SEPARATES not in str(error)
        assume(False)
    assert followed.outcome == "stick"
    assert "rupture" not in [event.kind for event in followed.events]


@examples(8)
@given(scenes(few([each for each in STRUCTURES if not each["friction"]], 9)), st.integers(0, 2**32 - 1))
def test_nothing_changes_between_boundaries(scene: Scene, seed: int) -> None:
    """Along a line of Stokes numbers each of forty collisions has the outcome that the changes on its sides say."""
    _, angle = scene.need_impact()
    found = boundary(scene, angle=np.array([angle]), stokes=(1e-3, 30.0))
    assume(not found.failures[0])
    changes = found.changes[0]
    assume(changes)
    stokes = 10 ** np.random.default_rng(seed).uniform(-3, math.log10(30.0), 40)
    outcomes = collide_many(scene, stokes=stokes, angle=np.full(40, angle), rtol=1e-10)["outcome"].values
    for one, outcome in zip(stokes, outcomes, strict=True):
        if outcome < 0 or any(abs(one / change.stokes - 1) < 1e-6 for change in changes):
            continue
        below = [change.after for change in changes if change.stokes < one]
        above = [change.before for change in changes if change.stokes > one]
        expected = {*below[-1:], *above[:1]}
        assert len(expected) <= 1
        assert not expected or OUTCOMES[outcome] in expected


PROVABLE = [each for each in STRUCTURES if not (each["strings"] or each["friction"] or each["attraction"])]


@pytest.mark.slow
@pytest.mark.usefixtures("released")
@examples(30)
@given(scenes([each | {"film": "finite", "tangential": "immersed", "glass": "literal"} for each in few(PROVABLE, 2)]))
def test_a_proof_holds_the_collision(scene: Scene) -> None:
    """Outcome and restitution of what is proved, and of collisions in a box that is."""
    proof, (speed, angle) = prove(scene), scene.need_impact()
    assume(proof)
    for each, beside in ((proof, [1.0]), (prove(scene, within={"impact.stokes": 1e-4}), [1 - 4e-5, 1 + 4e-5])):
        if each:
            found = collide_many(scene, speed=speed * np.array(beside), angle=angle)
            assert {OUTCOMES[k] for k in found["outcome"].values} == {each.outcome} == {proof.outcome}
            low, high = each.restitution or (0.0, 0.0)
            assert ((low - 1e-6 <= found["restitution"].values) & (found["restitution"].values <= high + 1e-6)).all()
