"""`solve` on any scene: the value at which a collision was made is among those that are found from its result."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import InputError, Scene, collide, solve

from .conditioning import RESULTS, decided
from .scenes import parts, scenes
from .settings import examples
from .structures import Structure

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
_IMPACT = ("impact.stokes", "impact.angle")


def changed(scene: Scene, free: str, value: float) -> Scene:
    """The scene with another value of an entry."""
    if free in _IMPACT:
        return scene.with_impact(**{free.partition(".")[2]: value})
    return scene.with_entries({free: value})


@parts
@examples(2)
@given(st.data())
def test_a_collision_is_found_again_from_its_result(structures: list[Structure], data: st.DataObject) -> None:
    """An entry within a factor of 5 of the scene's: all that is found gives the result, what was sought is among it."""
    scene = data.draw(scenes(structures))
    numbers = {name: value for name, value in scene.si if not isinstance(value, str) and not name.startswith("impact.")}
    numbers |= {"impact.stokes": scene.stokes, "impact.angle": scene.angle}
    free = data.draw(st.sampled_from(sorted(name for name, value in numbers.items() if value)))
    low, high = sorted((numbers[free] / 5, numbers[free] * 5))
    high = min(high, 1.5) if free == "impact.angle" else high
    place = low * (high / low) ** data.draw(st.floats(0.02, 0.98))
    try:
        scene.si_number(free, low, free), scene.si_number(free, high, free)
        sought = changed(scene, free, place)
    except InputError:  # of a scene that does not exist
        assume(False)
        raise
    collision = decided(sought, rtol=1e-11)
    of = data.draw(st.sampled_from(RESULTS))
    target = getattr(collision, of)
    assume(target and collision.outcome != "stick")
    found = solve(scene, free=free, within=(low, high), **{of: target})
    within = any(a <= place <= b for a, b in found.throughout)
    assert within or min((abs(value / place - 1) for value in found), default=math.inf) < 1e-5, str(found)
    assert list(found) == sorted(set(found))
    for value in found[:3]:
        assert low <= value <= high
        again = collide(changed(scene, free, value), rtol=1e-11, ledger=False)
        assert getattr(again, of) == pytest.approx(target, rel=2e-6)
