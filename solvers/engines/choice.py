"""Which engine answers where none is requested: the Taylor kernel where it supports the scene, else Rosenbrock.

The request alone decides, and not what is compiled or how many collisions there are: a missing kernel is compiled.
"""

from collections.abc import Collection, Sequence

from ..scene.scene import Scene
from .settings import CASADI_ENGINES, ENGINES
from .taylor.build import kernel_supports


def collision_engine(scene: Scene, requested: str | None = None) -> str:
    """The engine for collisions of a scene: the requested one, else the Taylor kernel.

    Rosenbrock replaces the kernel, even a requested one, where the kernel does not support the scene or there is no
    compiler.
    """
    if requested not in (None, "taylor"):
        return requested
    return _kernel_or_rosenbrock(kernel_supports(scene))


def casadi_gradient_engine(requested: str | None = None) -> str:
    """The engine for derivatives by CasADi; Rosenbrock's are about a hundred times more accurate at one tolerance."""
    return requested or "rosenbrock"


def gradient_engine(scene: Scene, of: Sequence[str], known: Collection[str], oblique: Collection[bool]) -> str:
    """The engine for first derivatives, forward: the Taylor kernel, or CasADi's Rosenbrock for results it lacks.

    Arguments:
        of: requested results.
        known: results that the kernel differentiates.
        oblique: contains True if some collisions are oblique, False if some are head-on; these are separate kernels.
    """
    return _kernel_or_rosenbrock(set(of) <= set(known) and differentiates(scene, oblique))


def differentiates(scene: Scene, oblique: Collection[bool] = (True, False)) -> bool:
    """True if the kernel differentiates a scene's collisions: oblique ones, head-on ones or both."""
    return kernel_supports(scene, oblique, gradients=True)


def available_engines(scene: Scene) -> tuple[str, ...]:
    """The engines that can collide a scene here."""
    return ENGINES if kernel_supports(scene) else CASADI_ENGINES


def _kernel_or_rosenbrock(kernel: bool) -> str:
    return "taylor" if kernel else "rosenbrock"
