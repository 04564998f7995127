"""The equations of a scene's model as LaTeX, from the derivation (imports sympy)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..collision.text import name_of
from ..model.model import select_model
from ..scene.scene import Scene
from ..scene.user_model import Package

if TYPE_CHECKING:
    from ...derive.user.structures import UserModel


def texts(scene: Scene) -> dict[str, str]:
    """Text of NAME.tex, of a scene's model."""
    from ...derive.emit.document.document import document

    laws = dict(select_model(scene, oblique=True, full=True).laws)
    parts = (("bridge", scene.bridge), ("strings", scene.pendulum), ("glass", scene.liquid.glass_transition_pressure))
    lacking = [slot for slot, table in parts if table is None]
    title = f"Oblique collisions of wet particles: {name_of(scene)}"
    rendered = document(title, laws, user_model(scene.package), lacking, scene.particles.friction is not None)
    return {f"{file_name(scene)}.tex": rendered.tex()}


def user_model(package: Package | None) -> UserModel | None:
    """A user's model as an object of the derivation, read from the model file in its folder."""
    if package is None:
        return None
    from ...derive.laws.modelfile import read

    return read(Path(f"{package.name}.py"), package.source, package.name)


def file_name(scene: Scene) -> str:
    """A file name and C identifier made from the scene's name."""
    plain = re.sub(r"\W+", "_", scene.name, flags=re.ASCII).strip("_").lower() or "scene"
    return plain if plain[0].isalpha() else f"scene_{plain}"
