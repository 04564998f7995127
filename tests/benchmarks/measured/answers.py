"""Input and output of the engines that are compared."""

from dataclasses import dataclass

from wetdoublet.solvers.model.dimensionless import Problem, nondimensionalise
from wetdoublet.solvers.scene.scene import Scene


@dataclass(frozen=True)
class Impact:
    """Stokes number and angle (rad)."""

    stokes: float
    angle: float


@dataclass(frozen=True)
class Answer:
    """Result of a collision."""

    outcome: str
    restitution: float


def dimensionless(scene: Scene, impact: Impact) -> Problem:
    """Dimensionless groups of a scene's collision."""
    return nondimensionalise(scene, scene.speed_of(impact.stokes), impact.angle)
