"""Models of all structures, derived once a session."""

from __future__ import annotations

import pytest
from wetdoublet.derive.model import Model, derive
from wetdoublet.derive.structure import structures


@pytest.fixture(scope="session")
def models() -> dict[str, Model]:
    """The model of each structure by name."""
    return {structure.name: derive(structure) for structure in structures()}
