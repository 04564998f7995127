"""Choice of the engine; the only module of the engines that depends on both."""

from __future__ import annotations

from ..scene.scene import Scene
from ..settings import FEW
from .taylor.build import supported


def bulk_engine(asked: str | None, count: int, scene: Scene) -> str:
    """The engine for `count` collisions of a scene: the requested one, else the Taylor kernel for more than `FEW`.

    Rosenbrock replaces the kernel, even a requested one, where the kernel does not support the scene or there is no
    compiler.
    """
    if asked not in (None, "taylor") or (asked is None and count <= FEW):
        return asked or "rosenbrock"
    return "taylor" if supported(scene) else "rosenbrock"
