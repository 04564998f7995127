"""What engines and peers are asked, and what comes back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...engines.casadi.locate import Path
from ...model.dimensionless import Numbers, numbers
from ...scene.scene import Scene
from .impacts import Impact


@dataclass(frozen=True)
class Answer:
    """What a collision came to."""

    outcome: str
    restitution: float


Collide = Callable[[int], Answer]


@dataclass(frozen=True)
class Bulk:
    """All collisions in one call.

    Arguments:
        run: the call that is timed.
        read: what it came to, collision by collision; text says why one has failed.
    """

    run: Callable[[], Any]
    read: Callable[[Any], list[Answer | str]]

    def __call__(self) -> list[Answer | str]:
        return self.read(self.run())


def dimensionless(scene: Scene, impact: Impact) -> Numbers:
    """The numbers of a scene's collision."""
    return numbers(scene, scene.speed_of(impact.stokes), impact.angle)


def answer(path: Path) -> Answer:
    """What a located flight came to."""
    outputs = path.model.values("outputs", path.y, path.p) if path.separated else {}
    return Answer(path.outcome, outputs.get("restitution", 0.0))
