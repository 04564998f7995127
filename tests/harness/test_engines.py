"""What does not depend on how a collision is computed: engine, neighbours, order, tolerance."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import Scene, collide_many

from .conditioning import Conditioned, decided
from .scenes import scenes
from .settings import examples, few
from .structures import STRUCTURES

FEW = few(STRUCTURES, 8)  # one of which always parts
OF = ("outcome", "restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap")

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


def around(scene: Scene, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Impacts from a thousandth to a thousand times the scene's Stokes number, at angles up to 85 degrees."""
    draw = np.random.default_rng(seed)
    speed, angle = scene.need_impact()
    stokes = 10 ** draw.uniform(-3, 3, count) * speed / scene.speed_of(1.0)
    return stokes, np.radians(draw.uniform(0, 85, count)) * (angle > 0)


@examples(6)
@given(scenes(FEW), st.integers(0, 2**32 - 1))
def test_neighbours_and_order_change_no_bit(scene: Scene, seed: int) -> None:
    """A collision alone, in a lane among others, and in any order has the same bits."""
    stokes, angle = around(scene, 21, seed)
    order = np.random.default_rng(seed).permutation(stokes.size)
    whole = collide_many(scene, stokes=stokes, angle=angle, of=OF)
    mixed = collide_many(scene, stokes=stokes[order], angle=angle[order], of=OF)
    alone = collide_many(scene, stokes=stokes[order[:1]], angle=angle[order[:1]], of=OF)
    for name in (*OF, "certified"):
        assert np.array_equal(whole[name].values[order], mixed[name].values, equal_nan=whole[name].dtype.kind == "f")
        assert np.array_equal(mixed[name].values[:1], alone[name].values, equal_nan=whole[name].dtype.kind == "f")


@examples(6)
@given(scenes(FEW), st.integers(0, 2**32 - 1))
def test_rtol_is_the_error(scene: Scene, seed: int) -> None:
    """The error in e_n is of the order of the tolerance times the conditioning; no outcome depends on it."""
    stokes, angle = around(scene, 21, seed)
    exact, *beside = (
        collide_many(scene, stokes=stokes * factor, angle=angle, rtol=1e-12) for factor in (1.0, 1 - 1e-6, 1 + 1e-6)
    )
    low, high = (each["restitution"].values for each in beside)
    scale = 1 + np.abs(exact["restitution"].values) + np.abs(high - low) / 2e-6
    sound = (beside[0]["outcome"] == exact["outcome"]) & (beside[1]["outcome"] == exact["outcome"])
    sound &= exact["outcome"] >= 0
    for rtol in (1e-5, 1e-7, 1e-9):
        loose = collide_many(scene, stokes=stokes, angle=angle, rtol=rtol)
        error = np.abs(loose["restitution"].values - exact["restitution"].values) / scale
        assert np.all(error[sound & (loose["outcome"] == exact["outcome"])] <= 30 * rtol)
        if rtol == 1e-9:
            assert np.array_equal(loose["outcome"].values[sound], exact["outcome"].values[sound])


@examples(6)
@given(scenes(FEW), st.sampled_from(["cvodes", "rosenbrock"]))
def test_a_replay_is_the_kernel(scene: Scene, engine: str) -> None:
    """CasADi's integrators go through the same events to the same results and the same ledger."""
    computed = Conditioned(scene, rtol=1e-10)
    other = decided(scene, rtol=1e-10, engine=engine)
    computed.agree(other, 3e-8)
    if other.outcome == "stick":
        return
    assert [event.kind for event in other.events] == [event.kind for event in computed.collision.events]
    first, second = (one.to_dict()["energy"] for one in (computed.collision, other))
    size = max(map(abs, first.values()))
    assert set(first) == set(second)
    scale = 1 + computed.slopes["restitution"]
    assert all(abs(first[name] - second[name]) <= 1e-6 * scale * size for name in first)


@examples(8)
@given(scenes(FEW))
def test_a_batch_is_its_collisions(scene: Scene) -> None:
    """`collide_many` of one impact has the outcome and the restitution of `collide`."""
    collision = decided(scene, rtol=1e-10)
    speed, angle = scene.need_impact()
    found = collide_many(scene, stokes=[speed / scene.speed_of(1.0)], angle=[angle], rtol=1e-10)
    assume(found["outcome"].values[0] >= 0)
    assert ("stick", "stick-rotate-separate", "bounce")[int(found["outcome"].values[0])] == collision.outcome
    Conditioned(scene, rtol=1e-10).agree(collision, 1e-8)
    assert found["restitution"].values[0] == pytest.approx(collision.restitution, rel=1e-6, abs=1e-9)
