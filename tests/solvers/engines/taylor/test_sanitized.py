"""The kernel and the engine of enclosures use no memory that is not theirs, and do nothing that C leaves undefined."""

from pathlib import Path
from typing import Any

import pytest

from ....helpers import sanitized
from ....helpers.snapping import BRIDGE, TIMED, TORQUE

pytestmark = pytest.mark.slow

SAMPLE: list[list[Any]] = [
    ["random", "granulation-dry-bridge", "plain", True, 1000],
    ["random", "granulation-dry-bridge", "ledger and trajectory", True, 300],
    ["random", "granulation-dry-bridge", "steps not kept", True, 300],
    ["random", "granulation-dry-bridge", "forwards", False, 300],
    ["random", "granulation", "backwards", False, 300],
    ["enclosed", "granulation", 30],
]


@pytest.mark.skipif(not sanitized.libraries(), reason="the C compiler has no sanitizers")
def test_sanitizers_find_nothing(tmp_path: Path):
    """Two thousand random collisions, some with numbers that no scene has, under both sanitizers."""
    done = sanitized.process(SAMPLE, tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "done\n"


@pytest.mark.skipif(not sanitized.libraries(), reason="the C compiler has no sanitizers")
def test_sanitizers_find_nothing_in_declared_events(tmp_path: Path):
    """The same with events and a torque of a model file, many of which happen at rest."""
    path = tmp_path / "timed.py"
    defaults = {"1e9 s": "1e-4 s", "1e30 1/s": "1e4 1/s", "default=1e9": "default=1.0", "0 m/s": "0.1 m/s"}
    text = TIMED + BRIDGE
    for far, near in defaults.items():
        text = text.replace(far, near)
    path.write_text(text + TORQUE.replace("0 N m", "1e-11 N m"))
    done = sanitized.process([["random", str(path), "ledger and trajectory", True, 300]], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "done\n"
