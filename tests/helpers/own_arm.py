"""The model file of docs/reference/models.md whose lever arm does not conserve the angular momentum."""

import re
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

from wetdoublet.solvers import Scene

PAGE = Path(__file__).resolve().parents[2] / "docs/reference/models.md"
[TEXT] = [
    text
    for text in re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    if 'law("arm"' in " ".join(text.split()).replace("( ", "(")
]


@cache
def model_file() -> str:
    """Its path; scenes that are loaded with it have `model.arm` "surface"."""
    file = Path(tempfile.mkdtemp(prefix="wetdoublet-tests-")) / "surface.py"
    file.write_text(TEXT)
    return str(file)


def surface(scene: str | Scene) -> Scene:
    """A scene, or a preset by name, with that arm."""
    return Scene.load(scene).with_model(model_file())


def described(tables: dict[str, Any]) -> Scene:
    """The scene of tables; with the model file where they have that arm."""
    if tables.get("model", {}).get("arm") != "surface":
        return Scene.from_dict(tables)
    plain = tables | {"model": tables["model"] | {"arm": "midgap"}}
    return Scene.from_dict(plain).with_model(model_file()).with_entries({"model.arm": "surface"})
