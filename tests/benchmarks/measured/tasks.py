"""The collisions that everything is measured on: drawn once, by a fixed seed."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from wetdoublet.solvers.model.dimensionless import Problem, nondimensionalise
from wetdoublet.solvers.scene.scene import Scene

SEED = 2012  # of numpy's default_rng, one generator a task: all Stokes numbers are drawn first, then all angles


@dataclass(frozen=True)
class Impact:
    """Stokes number and angle (rad)."""

    stokes: float
    angle: float

    def __str__(self) -> str:
        return f"St {self.stokes:.4g} at {math.degrees(self.angle):.4g} deg"


@dataclass(frozen=True)
class Answer:
    """Result of a collision."""

    outcome: str
    restitution: float


def columns(impacts: Sequence[Impact], copies: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Stokes numbers and angles, repeated."""
    stokes, angle = np.array([(each.stokes, each.angle) for each in impacts]).T
    return np.tile(stokes, copies), np.tile(angle, copies)


def dimensionless(scene: Scene, impact: Impact) -> Problem:
    """Dimensionless groups of a scene's collision."""
    return nondimensionalise(scene, scene.speed_of(impact.stokes), impact.angle)


@dataclass(frozen=True)
class Task:
    """A preset, and how its impacts are drawn: St log-uniform, angle uniform.

    Arguments:
        stokes: lowest and highest Stokes number.
        degrees: largest angle; the smallest is 0.
    """

    preset: str
    count: int
    stokes: tuple[float, float]
    degrees: float

    @property
    def scene(self) -> Scene:
        return Scene.load(self.preset)

    def impacts(self) -> list[Impact]:
        """The impacts, the same in every run."""
        return next(self.drawn())

    def drawn(self) -> Iterator[list[Impact]]:
        """The impacts, then as many again, without end."""
        draw = np.random.default_rng(SEED)
        low, high = self.stokes
        while True:
            stokes = np.exp(draw.uniform(math.log(low), math.log(high), self.count))
            angles = np.radians(draw.uniform(0.0, self.degrees, self.count))
            yield [Impact(float(st), float(theta)) for st, theta in zip(stokes, angles)]

    def __str__(self) -> str:
        low, high = self.stokes
        return f"{self.preset}: {self.count} collisions, St {low:g}..{high:g}, angle 0..{self.degrees:g} deg"


TASKS = (Task("granulation", 60, (0.005, 0.5), 85.0), Task("pendulum", 20, (0.3, 3.0), 80.0))
