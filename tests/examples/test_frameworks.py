"""The examples with jax and torch: gradient descent through collisions comes to where it should."""

import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "frameworks"
pytestmark = pytest.mark.filterwarnings("ignore:.*torch.jit.script. is deprecated:DeprecationWarning")  # torch's own


def test_gradient_descent_finds_the_film() -> None:
    """Two entries from 40 restitutions whose noise is 0.001: the loss ends at the noise, the entries within 5 %."""
    pytest.importorskip("jax", reason="jax is not installed: pip install -e '.[jax]'")
    example = runpy.run_path(str(FOLDER / "film_by_gradient_descent.py"))
    found, losses = example["calibrate"](300)
    assert losses[-1] < 2e-6 < losses[0]
    assert found == pytest.approx(example["TRUTH"], rel=0.05)


def test_a_network_is_trained_through_a_collision() -> None:
    """The error of the restitution falls by a factor of ten."""
    pytest.importorskip("torch", reason="torch is not installed: pip install -e '.[torch]'")
    losses = runpy.run_path(str(FOLDER / "collision_in_training.py"))["train"](60)
    assert losses[-1] < 0.1 * losses[0]
