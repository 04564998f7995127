"""What tests of several files emit once."""

from pathlib import Path

import pytest

from ..helpers.command import run
from ..helpers.yielding import LAW


@pytest.fixture(scope="session")
def mine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The emitted package, beside its model file."""
    folder = tmp_path_factory.mktemp("models")
    (folder / "mine.py").write_text(LAW)
    done = run("generate", str(folder / "mine.py"), "--out", str(folder / "mine"))
    assert done.exception is None, done.exception
    assert "New group: yield_stress_number = reduced_radius*yield_stress/surface_tension" in done.output
    assert "angular momentum" in done.output
    return folder / "mine"
