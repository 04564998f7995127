"""Which engine answers where none is asked for: one collision, a batch, boundaries, derivatives."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ..scene.scene import Scene
from ..settings import CASADI_ENGINES, ENGINES, FEW
from .taylor.build import is_compiled, supported
from .taylor.orders import order_for
from .taylor.tangent import differentiates, variant_of


def single_engine(asked: str | None) -> str:
    """The engine for one collision: CVODES, whose error control is independent of ours."""
    return asked or "cvodes"


def bulk_engine(asked: str | None, count: int, scene: Scene) -> str:
    """The engine for `count` collisions of a scene: the requested one, else the Taylor kernel for more than `FEW`.

    Rosenbrock replaces the kernel, even a requested one, where the kernel does not support the scene or there is no
    compiler.
    """
    if asked not in (None, "taylor") or (asked is None and count <= FEW):
        return asked or "rosenbrock"
    return _kernel_or_rosenbrock(supported(scene))


def boundary_engine(scene: Scene) -> str:
    """The engine for boundaries of a scene, which take many collisions: the Taylor kernel if it supports the scene."""
    return _kernel_or_rosenbrock(supported(scene))


def casadi_gradient_engine(asked: str | None = None) -> str:
    """The engine for derivatives by CasADi; Rosenbrock's are about a hundred times more accurate at one tolerance."""
    return asked or "rosenbrock"


def gradient_engine(
    scene: Scene, of: Sequence[str], known: Collection[str], oblique: Collection[bool], rtol: float, count: int = 1
) -> str:
    """The engine for first derivatives, forward, of `count` collisions of a scene (docs/engineering/kernel.md).

    It is the Taylor kernel if already compiled or if the collisions are many; else CasADi's Rosenbrock.

    Arguments:
        of: requested results.
        known: results that the kernel differentiates.
        oblique: contains True if some collisions are oblique, False if some are head-on; these are separate kernels.
    """
    if not set(of) <= set(known):
        return "rosenbrock"
    if count > FEW:
        return _kernel_or_rosenbrock(differentiates(scene, oblique))
    order, rotation = order_for(rtol), "rotation" in of
    return _kernel_or_rosenbrock(all(is_compiled(variant_of(scene, own, order, rotation)) for own in oblique))


def available_engines(scene: Scene) -> tuple[str, ...]:
    """The engines that can collide a scene here."""
    return ENGINES if supported(scene) else CASADI_ENGINES


def _kernel_or_rosenbrock(kernel: bool) -> str:
    return "taylor" if kernel else "rosenbrock"
