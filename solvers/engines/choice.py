"""Which engine answers where none is asked for: one collision, a batch, boundaries, derivatives."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ..scene.scene import Scene
from ..settings import CASADI_ENGINES, ENGINES, FEW
from .taylor.build import at_hand, supported
from .taylor.call import variant_for_many
from .taylor.in_space import variant_in_space
from .taylor.orders import order_for
from .taylor.record import variant_to_record
from .taylor.tangent import differentiates, variant_of


def single_engine(asked: str | None, scene: Scene, oblique: bool, rtol: float, ledger: bool, trajectory: bool) -> str:
    """The engine for one collision: the requested one, else the Taylor kernel if it is compiled, else CVODES."""
    if asked is not None:
        return asked
    return "taylor" if at_hand((variant_to_record(scene, oblique, rtol, ledger, trajectory),)) else "cvodes"


def bulk_engine(
    asked: str | None,
    count: int,
    scene: Scene,
    rtol: float,
    oblique: Collection[bool],
    rotation: bool = False,
    ledger: bool = False,
    varied: bool = False,
) -> str:
    """The engine for `count` collisions of a scene.

    It is the requested one, else the Taylor kernel: compiled if need be for more than `FEW`, for fewer only where it
    is compiled. Rosenbrock replaces the kernel, even a requested one, where the kernel does not support the scene or
    there is no compiler.

    Arguments:
        oblique: contains True if some collisions are oblique, False if some are head-on; these are separate kernels.
        rotation, ledger: requested beside the outcome.
        varied: entries other than the impact's vary.
    """
    if asked not in (None, "taylor"):
        return asked
    if asked is None and count <= FEW:
        needed = tuple(
            variant_to_record(scene, own, rtol, ledger=True, fold=not varied)
            if ledger
            else variant_for_many(scene, own, rtol, rotation, fold=not varied)
            for own in sorted(oblique)
        )
        return _kernel_or_rosenbrock(bool(needed) and at_hand(needed))
    return _kernel_or_rosenbrock(supported(scene))


def space_engine(asked: str | None, count: int, scene: Scene, rtol: float, ledger: bool = False) -> str:
    """The engine for `count` collisions in space, by the rules of `bulk_engine`; beside a wall these are planar."""
    if scene.wall:
        return bulk_engine(asked, count, scene, rtol, (True,), ledger=ledger, varied=True)
    if asked not in (None, "taylor"):
        return asked
    if asked is None and count <= FEW:
        return _kernel_or_rosenbrock(at_hand((variant_in_space(scene, rtol, ledger),)))
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

    It is the Taylor kernel if it is compiled or if the collisions are many; else CasADi's Rosenbrock.

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
    return _kernel_or_rosenbrock(at_hand(tuple(variant_of(scene, own, order, rotation) for own in sorted(oblique))))


def available_engines(scene: Scene) -> tuple[str, ...]:
    """The engines that can collide a scene here."""
    return ENGINES if supported(scene) else CASADI_ENGINES


def _kernel_or_rosenbrock(kernel: bool) -> str:
    return "taylor" if kernel else "rosenbrock"
