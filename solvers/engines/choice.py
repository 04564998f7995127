"""Which engine differentiates where none is requested: the Taylor kernel where it can, else Rosenbrock."""

from collections.abc import Collection, Sequence

from ..scene.scene import Scene
from .taylor.build import kernel_supports


def gradient_engine(scene: Scene, of: Sequence[str], known: Collection[str], oblique: Collection[bool]) -> str:
    """The engine for first derivatives, forward: the Taylor kernel, or CasADi's Rosenbrock for results it lacks.

    Rosenbrock is about a hundred times more accurate than CVODES at one tolerance.

    Arguments:
        of: requested results.
        known: results that the kernel differentiates.
        oblique: contains True if some collisions are oblique, False if some are head-on; these are separate kernels.
    """
    return "taylor" if set(of) <= set(known) and differentiates(scene, oblique) else "rosenbrock"


def differentiates(scene: Scene, oblique: Collection[bool] = (True, False)) -> bool:
    """True if the kernel differentiates a scene's collisions: oblique ones, head-on ones or both."""
    return kernel_supports(scene, oblique, gradients=True)
