"""The sample of collisions for numerical checks: impacts around the scene's, integrated by every engine."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from ..collision.collide import collide
from ..collision.result import Collision
from ..engines.settings import ENGINES
from ..errors import InputError, WetDoubletError
from ..scene.scene import Scene

RTOL = 1e-10
ANGLES = (0.0, math.radians(30), math.radians(60), math.radians(80))
FACTORS = (0.3, 1.0, 4.0)  # relative to the scene's Stokes number
REFERENCE = "rosenbrock"  # the most accurate of the engines that replay
Collide = Callable[..., Collision]


@dataclass(frozen=True)
class Extent:
    """Sizes of the samples of a scene; the defaults are those of `verify`.

    Arguments:
        angles: angles of the sample, rad; the scene's is added.
        factors: Stokes numbers of the sample, relative to the scene's.
        audited: impacts of the certificate audit.
        grid_angles: angles of the budget, degrees.
        grid_points: Stokes numbers of the budget.
    """

    angles: tuple[float, ...] = ANGLES
    factors: tuple[float, ...] = FACTORS
    audited: int = 240  # a quarter of this head-on
    grid_angles: tuple[float, ...] = tuple(range(5, 90, 5))
    grid_points: int = 27  # ten per decade


WHOLE = Extent()


@dataclass
class Sample:
    """Collisions by impact and engine, and failures."""

    scene: Scene
    impacts: list[dict[str, Collision]] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    @property
    def all(self) -> list[Collision]:
        return [collision for impact in self.impacts for collision in impact.values()]


def stokes_of(scene: Scene) -> float:
    """The Stokes number at the centre of the sample."""
    return scene.stokes or 1.0


def place(stokes: float, angle: float, engine: str = "", event: str = "") -> str:
    """Stokes number, angle and engine as text."""
    parts = [f"St {stokes:.4g}", f"{math.degrees(angle):.4g} deg", engine, event]
    return ", ".join(text for text in parts if text)


def where(collision: Collision) -> str:
    """The place of a collision as text."""
    return place(collision.stokes, collision.angle, collision.engine)


def collisions(
    scene: Scene, angles: Sequence[float] | None = None, extent: Extent = WHOLE, collide: Collide = collide
) -> Sample:
    """Compute the sample of a scene; failures are recorded and the others go on.

    Arguments:
        angles: impact angles, rad; None for the extent's and the scene's.
        collide: function that computes a collision.
    """
    centre = stokes_of(scene)
    sample = Sample(scene)
    for angle in dict.fromkeys((*extent.angles, scene.angle or 0.0) if angles is None else angles):
        for factor in extent.factors:
            by_engine: dict[str, Collision] = {}
            for engine in ENGINES:
                try:
                    by_engine[engine] = collide(scene, stokes=centre * factor, angle=angle, rtol=RTOL, engine=engine)
                except InputError as error:
                    if error.field != "engine":  # an engine may not support every scene
                        sample.failures.append(f"{place(centre * factor, angle, engine)}: {error}")
                except WetDoubletError as error:
                    sample.failures.append(f"{place(centre * factor, angle, engine)}: {error}")
            if by_engine:
                sample.impacts.append(by_engine)
    return sample
