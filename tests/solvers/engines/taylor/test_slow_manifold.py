"""The slow-manifold jump: the same results as whole trajectories, wherever it is taken."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many

SLOW = {"stokes": (0.005, 0.3), "angle": (0.2, 1.5)}  # where films contract most


def impacts(count: int, seed: int) -> dict[str, np.ndarray]:
    """Impacts of slow, oblique collisions."""
    draw = np.random.default_rng(seed)
    stokes = np.exp(draw.uniform(*np.log(SLOW["stokes"]), count))
    return {"stokes": stokes, "angle": draw.uniform(*SLOW["angle"], count)}


def both(scene: Any, rtol: float, seed: int, count: int = 400) -> tuple[Any, Any]:
    """Collisions with jumps allowed, and whole ones: who asks for the contact time gets the trajectory."""
    given = impacts(count, seed)
    jumped = collide_many(scene, **given, rtol=rtol, engine="taylor", of=("steps",))
    whole = collide_many(scene, **given, rtol=rtol, engine="taylor", of=("steps", "contact_time"))
    return jumped, whole


LAWS: list[tuple[dict[str, Any], float]] = [
    ({}, 1e-7),
    ({}, 1e-9),
    ({}, 1e-11),
    ({"bridge.law": "willett-simple", "model.tangential": "film"}, 1e-9),
    ({"bridge.law": "constant", "model.film": "constant-volume"}, 1e-9),
]


@pytest.mark.parametrize(("laws", "rtol"), LAWS)
def test_results_are_those_of_whole_trajectories(laws: dict[str, Any], rtol: float) -> None:
    """No outcome differs, and e_n by less than the tolerance: a jump may take a tenth of it, and contracts it."""
    jumped, whole = both(Scene.load("granulation").with_entries(laws), rtol, seed=3)
    assert (jumped.outcome.values == whole.outcome.values).all()
    assert (jumped.reason.values == "").all()
    shorter = jumped.steps.values < whole.steps.values
    assert shorter.sum() > 10, "no trajectory was shortened"
    found, expected = jumped.restitution.values[shorter], whole.restitution.values[shorter]
    # both integrate the rest with the tolerance, amplified alike
    assert np.abs(found - expected).max() <= 10 * rtol * np.maximum(1, np.abs(expected)).max()


def test_what_is_left_out_may_pass_the_edge_of_the_tangential_force() -> None:
    """In a film thicker than a particle that force begins on the way in; a trajectory that jumps over it has it too."""
    scene = Scene.load("granulation-dry-bridge").with_entries({"liquid.film_thickness": "150 um"})
    given = impacts(400, seed=3) | {"angle": np.linspace(0.02, 0.3, 400)}
    jumped, whole = (
        collide_many(scene, **given, engine="taylor", of=("steps", *more)) for more in ((), ("contact_time",))
    )
    assert (jumped.steps.values < whole.steps.values).sum() > 20
    np.testing.assert_allclose(jumped.restitution.values, whole.restitution.values, rtol=1e-8)


def test_who_asks_for_times_gets_them() -> None:
    """Contact time, rotation and smallest gap are those of the trajectory, whatever else is asked for."""
    given = impacts(300, seed=8)
    every = ("contact_time", "rotation", "smallest_gap")
    together = collide_many("granulation", **given, engine="taylor", of=every)
    for name in every:
        alone = collide_many("granulation", **given, engine="taylor", of=(name,))
        np.testing.assert_allclose(alone[name].values, together[name].values, rtol=1e-8)
        assert np.isfinite(alone[name].values[alone.outcome.values > 0]).all()


def test_a_jump_does_not_depend_on_neighbours() -> None:
    """The digits of a collision are the same alone and among others."""
    given = impacts(64, seed=5)
    together = collide_many("granulation", **given, engine="taylor").restitution.values
    for k in range(0, 64, 7):
        alone = collide_many(
            "granulation", stokes=given["stokes"][k], angle=given["angle"][k], engine="taylor"
        ).restitution.values
        assert alone == together[k]
