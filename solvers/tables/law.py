"""A tabulated collision law as plain data: scene, ranges, errors and arrays."""

from dataclasses import dataclass

from ..scene.scene import Scene
from .attack import Attack
from .data import Data, Range

STOKES, ANGLE = "impact.stokes", "impact.angle"


@dataclass(frozen=True)
class Law:
    """A tabulated law.

    Attributes:
        scene: the scene.
        of: results.
        range: ranges of the variables.
        error: largest error that it states, over the magnitude of a result where that is above 1.
        found: what the attack found: number of `queries`, `largest` error and where.
        rtol: relative tolerance of the collisions.
        data: its arrays.
    """

    scene: Scene
    of: tuple[str, ...]
    range: Range
    error: float
    found: Attack
    rtol: float
    data: Data

    @property
    def variables(self) -> tuple[str, ...]:
        """Dotted names of the variables."""
        return (STOKES, ANGLE) + (() if self.range.third is None else (self.range.third,))
