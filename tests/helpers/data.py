"""The public reference collisions and boundaries, copied into the repository."""

import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parents[1] / "data"
COLLISIONS: list[dict[str, Any]] = json.loads((DATA / "collisions.json").read_text())
BOUNDARIES: dict[str, Any] = json.loads((DATA / "boundaries.json").read_text())
