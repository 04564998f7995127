"""Which engine answers: the one place that both engines are known at."""

from __future__ import annotations

from ..scene.scene import Scene
from ..settings import FEW
from .taylor.build import supported


def bulk_engine(asked: str | None, count: int, scene: Scene) -> str:
    """The engine for `count` collisions of a scene, if it is not asked for: the Taylor kernel where they are not few.

    What the kernel does not know, or a machine without a compiler, is Rosenbrock's, even where the kernel is asked for.
    """
    if asked not in (None, "taylor") or (asked is None and count <= FEW):
        return asked or "rosenbrock"
    return "taylor" if supported(scene) else "rosenbrock"
