"""Collisions in the plane and in space beside a reference in Cartesian vectors, written from the documents."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import Scene, collide_pair

from ..helpers.flow import Unfinished
from ..helpers.in_space import ZERO, Arrival, Spatial, Vector, planar_arrival, plus
from ..helpers.phases import Chatter
from ..helpers.random_in_space import arrivals, differences, direction, quantities, request
from ..helpers.spinning import PARTNER, SPIN, TURNING, Planar, U, impact_of
from ..helpers.two_bodies import bodies_of
from .conditioning import Conditioned
from .scenes import PAIRS_IN_SPACE, scenes
from .settings import examples

TURNED = [each for each in PAIRS_IN_SPACE if not (each["head-on"] or (each["partner"] == "wall" and each["friction"]))]
OUTCOMES = ("stick", "stick-rotate-separate", "bounce")

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


@examples(14)
@given(scenes(PAIRS_IN_SPACE))
def test_equals_the_reference(scene: Scene) -> None:
    """Outcome, events, restitution, rates and spins of a collision in the plane."""
    computed = Conditioned(scene)
    collision = computed.collision
    course = Planar(bodies_of(scene), impact_of(scene))
    try:
        end = course.run()
    except (Chatter, Unfinished):
        assume(False)
    assert collision.outcome == end.outcome
    if end.outcome == "stick":
        return
    assert [event.kind for event in collision.events] == [kind for kind, _ in end.events]
    scale = computed.slopes["restitution"] + 1.0
    assert collision.restitution == pytest.approx(end.state[U] / course.speed, abs=1e-8 * scale)
    assert collision.contact_time == pytest.approx(end.time, rel=1e-8 * scale)
    sizes = course.sizes()
    for name, where in (("final_spin", SPIN), ("final_spin_partner", PARTNER), ("final_rotation_rate", TURNING)):
        found = getattr(collision, name)
        if found is not None and not (scene.wall and where != SPIN):
            assert found == pytest.approx(end.state[where], abs=1e-7 * scale * max(sizes[where], abs(end.state[SPIN])))


@examples(10)
@given(scenes(TURNED), st.integers(0, 2**32 - 1))
def test_a_plane_turned_in_space_is_the_plane(scene: Scene, seed: int) -> None:
    """Any plane, and any velocity of the centre of mass: outcome, restitution and time are those in the plane."""
    computed = Conditioned(scene)
    draw = np.random.default_rng(seed)
    normal = direction(draw)
    tangent = np.cross(normal, direction(draw))
    tangent /= np.linalg.norm(tangent)
    bodies, impact = bodies_of(scene), impact_of(scene)
    drift = tuple((impact.speed * draw.normal(size=3)).tolist())
    arrival = planar_arrival(bodies, impact, (tuple(normal.tolist()), tuple(tangent.tolist())), drift)
    found = collide_pair(scene, *request(bodies, [arrival]), rtol=1e-11)
    outcome = int(found["outcome"].values[0])
    assume(outcome >= 0)
    assert OUTCOMES[outcome] == computed.collision.outcome
    if outcome:
        scale = computed.slopes["restitution"] + 1.0
        assert found["restitution"].values[0] == pytest.approx(computed.collision.restitution, abs=3e-8 * scale)


@examples(8)
@given(scenes([each for each in PAIRS_IN_SPACE if not each["friction"]]), st.integers(0, 2**32 - 1))
def test_equals_the_reference_in_space(scene: Scene, seed: int) -> None:
    """Outcome and restitution of an arrival with any velocities and spins."""
    bodies, (speed, _) = bodies_of(scene), scene.need_impact()
    (arrival,) = arrivals(bodies, speed, 1, np.random.default_rng(seed))
    near = [arrival, *(_faster(arrival, factor) for factor in (1 - 1e-7, 1 + 1e-7))]
    found = collide_pair(scene, *request(bodies, near), rtol=1e-11)
    outcomes = set(found["outcome"].values.tolist())
    assume(len(outcomes) == 1 and outcomes != {-1})  # beside a boundary
    try:
        end = Spatial(bodies, arrival).run()
    except (Chatter, Unfinished):
        assume(False)
    outcome = int(found["outcome"].values[0])
    assert OUTCOMES[outcome] == end.outcome
    if outcome:
        e_n = found["restitution"].values
        scale = abs(e_n[1] - e_n[2]) / (2e-7 * max(1e-3, abs(e_n[0]))) + 1.0
        expected = quantities(bodies, arrival, end)
        apart = differences(bodies, arrival, {name: found[name].values[0] for name in expected}, expected)
        assert max(apart[name] for name in ("restitution", "velocities", "spins")) <= 1e-7 * scale, apart


def _faster(arrival: Arrival, factor: float) -> Arrival:
    """The same arrival with all its velocities and spins times a factor."""

    def times(vectors: tuple[Vector, Vector]) -> tuple[Vector, Vector]:
        return plus(ZERO, factor, vectors[0]), plus(ZERO, factor, vectors[1])

    return replace(arrival, velocities=times(arrival.velocities), spins=times(arrival.spins))
