"""Collisions in the plane and in space beside a reference in Cartesian vectors, written from the documents."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, collide_pair

from ..helpers.mechanics import ZERO, Arrival, Vector, X, planar_arrival, plus
from ..helpers.random_in_space import arrivals, differences, direction, quantities, request
from ..helpers.scanned import Outcome, Scan, UndecidedError, scan_of
from ..helpers.two_bodies import bodies_of
from .conditioning import Conditioned
from .scenes import parts, scenes
from .settings import examples, few
from .structures import STRUCTURES, Structure

PAIRS = [each for each in STRUCTURES if not (each["strings"] or (each["partner"] == "wall" and each["friction"]))]

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


def followed(scan: Scan, finer: float = 1.0) -> Outcome:
    """The reference's end, with steps so many times as accurate; what it does not decide soon is no example."""
    scan.most, scan.accuracy = 1500, scan.accuracy / finer
    try:
        return scan.run()
    except UndecidedError:
        assume(False)
        raise


@parts
@examples(20)
@given(st.data())
def test_equals_the_reference(structures: list[Structure], data: st.DataObject) -> None:
    """Outcome, events, restitution, times, rates and spins of a collision in the plane, on strings too."""
    scene = data.draw(scenes(structures))
    computed = Conditioned(scene)
    collision, bodies = computed.collision, bodies_of(scene)
    end = followed(scan_of(scene, rtol=1e-11))
    assert collision.outcome == end.outcome
    if end.outcome == "stick":
        return
    again = followed(scan_of(scene, rtol=1e-11), 10.0)
    assume(math.isclose(end.time, again.time, rel_tol=1e-7))  # pairs that roll at rest for long are not resolved by it
    assert [event.kind for event in collision.events] == [kind for kind, _ in end.events]
    scale = computed.slopes["restitution"] + 1.0
    assert collision.restitution == pytest.approx(end.restitution, abs=3e-8 * scale)
    assert collision.contact_time == pytest.approx(end.time, rel=3e-8 * scale)
    fast = scene.need_impact()[0] / bodies.radii[0]
    shown = [("final_spin", end.spins[0])]
    if not scene.wall:
        shown += [("final_spin_partner", end.spins[1])]
        shown += [("final_rotation_rate", end.across / (bodies.contact + end.state[X]))]
    for name, value in shown:
        if (found := getattr(collision, name)) is not None:
            assert found == pytest.approx(value, abs=3e-7 * scale * max(fast, *map(abs, end.spins)))


@examples(10)
@given(scenes(few([each for each in PAIRS if not each["head-on"]], 3)), st.integers(0, 2**32 - 1))
def test_a_plane_turned_in_space_is_the_plane(scene: Scene, seed: int) -> None:
    """Any plane, and any velocity of the centre of mass: outcome, restitution and time are those in the plane."""
    computed = Conditioned(scene)
    draw = np.random.default_rng(seed)
    normal = direction(draw)
    tangent = np.cross(normal, direction(draw))
    tangent /= np.linalg.norm(tangent)
    bodies, (speed, _) = bodies_of(scene), scene.need_impact()
    axes = tuple(normal.tolist()), tuple(tangent.tolist())
    arrival = planar_arrival(scene, axes=axes, drift=tuple((speed * draw.normal(size=3)).tolist()))
    found = collide_pair(scene, *request(bodies, [arrival]), rtol=1e-11)
    outcome = int(found["outcome"].values[0])
    assume(outcome >= 0)
    assert OUTCOMES[outcome] == computed.collision.outcome
    if outcome:
        scale = computed.slopes["restitution"] + 1.0
        assert found["restitution"].values[0] == pytest.approx(computed.collision.restitution, abs=3e-8 * scale)


@pytest.mark.slow
@examples(8)
@given(scenes(few(PAIRS, 8)), st.integers(0, 2**32 - 1))
def test_equals_the_reference_in_space(scene: Scene, seed: int) -> None:
    """Outcome and restitution of an arrival with any velocities and spins."""
    bodies, (speed, _) = bodies_of(scene), scene.need_impact()
    (arrival,) = arrivals(bodies, speed, 1, np.random.default_rng(seed))
    near = [arrival, *(_faster(arrival, factor) for factor in (1 - 1e-7, 1 + 1e-7))]
    found = collide_pair(scene, *request(bodies, near), rtol=1e-11)
    outcomes = set(found["outcome"].values.tolist())
    assume(len(outcomes) == 1 and outcomes != {-1})  # beside a boundary
    end = followed(Scan(bodies, arrival, rtol=1e-11))
    outcome = int(found["outcome"].values[0])
    assert OUTCOMES[outcome] == end.outcome
    if outcome:
        e_n = found["restitution"].values
        scale = abs(e_n[1] - e_n[2]) / (2e-7 * max(1e-3, abs(e_n[0]))) + 1.0
        expected = quantities(bodies, arrival, end)
        apart = differences(bodies, arrival, {name: found[name].values[0] for name in expected}, expected)
        assert max(apart.values()) <= 1e-7 * scale, apart


def _faster(arrival: Arrival, factor: float) -> Arrival:
    """The same arrival with all its velocities and spins times a factor."""

    def times(vectors: tuple[Vector, Vector]) -> tuple[Vector, Vector]:
        return plus(ZERO, factor, vectors[0]), plus(ZERO, factor, vectors[1])

    return replace(arrival, velocities=times(arrival.velocities), spins=times(arrival.spins))
