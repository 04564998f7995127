"""The slow-manifold jump: the same results as whole trajectories, wherever it is taken."""

from pathlib import Path
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
    ({}, 1e-7), ({}, 1e-11),
    ({"bridge.law": "constant", "model.film": "constant-volume"}, 1e-9),
]  # fmt: skip


@pytest.mark.slow
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


def test_shear_acts_at_last_in_a_film_that_reaches_beyond_it() -> None:
    """Where shear ends within the film it does not act at initial contact, but does when the doublet opens."""
    draw, count = np.random.default_rng(4), 500
    given = {"stokes": np.exp(draw.uniform(-4, -1, count)), "angle": draw.uniform(0.02, 0.2, count)}
    vary = {"liquid.film_thickness": draw.uniform(101e-6, 110e-6, count)}  # shear ends at 100 um
    jumped, whole = (
        collide_many("granulation-dry-bridge", **given, vary=vary, engine="taylor", of=of)
        for of in (("steps",), ("contact_time",))
    )
    np.testing.assert_allclose(jumped.restitution.values, whole.restitution.values, atol=1e-8)


PEAKED = """\"\"\"A glass criterion that rises and falls with the gap.\"\"\"
from wetdoublet.derive.user import *
law("glass", "peaked", meaning="a peak inside the film", source="none",
    pressure=-3 * mu * a * u / x0**2 / (1 + (1000 * (x / x0 - Rational(3, 4))) ** 2))
"""


@pytest.mark.slow
def test_no_approach_is_left_out_under_a_glass_law_of_a_user(tmp_path: Path) -> None:
    """A user's pressure need not fall with the gap: values at some gaps do not exclude the criterion between them."""
    file = tmp_path / "peaked.py"
    file.write_text(PEAKED)
    scene = Scene.load("granulation", model=file).with_entries({"liquid.glass_transition_pressure": "0.3 MPa"})
    jumped, whole = both(scene, 1e-9, seed=1)
    assert (whole.outcome.values == 2).any()
    assert (jumped.outcome.values == whole.outcome.values).all()
