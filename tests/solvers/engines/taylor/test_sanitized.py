"""The kernel and the engine of enclosures use no memory that is not theirs, and do nothing that C leaves undefined."""

from pathlib import Path
from typing import Any

import pytest

from ....helpers import sanitized

pytestmark = pytest.mark.slow

SAMPLE: list[list[Any]] = [
    ["reference", "granulation-dry-bridge"],
    ["random", "granulation-dry-bridge", "plain", True, 1000],
    ["random", "granulation-dry-bridge", "ledger and trajectory", True, 300],
    ["random", "granulation-dry-bridge", "steps not kept", True, 300],
    ["random", "granulation-dry-bridge", "forwards", False, 300],
    ["random", "granulation", "backwards", False, 300],
    ["enclosed", "granulation", 30],
]


@pytest.mark.skipif(not sanitized.libraries(), reason="the C compiler has no sanitizers")
def test_sanitizers_find_nothing(tmp_path: Path):
    """Reference collisions and two thousand random ones, some with numbers that no scene has, under both sanitizers."""
    done = sanitized.process(SAMPLE, tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "done\n"
