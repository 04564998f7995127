"""Default engine for derivatives, based on the measurement in docs/engineering/kernel.md."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from ..engines.taylor.build import is_compiled
from ..engines.taylor.call import order_for
from ..engines.taylor.tangent import variant_of
from ..scene.scene import Scene
from ..settings import FEW
from . import by_kernel as kernel


def chosen(scene: Scene, of: Sequence[str], oblique: Collection[bool], rtol: float, count: int = 1) -> str:
    """The engine for first derivatives, forward, of `count` collisions of a scene.

    It is the Taylor kernel if already compiled or if the collisions are many; else CasADi's Rosenbrock.

    Arguments:
        of: requested results.
        oblique: contains True if some collisions are oblique, False if some are head-on; these are separate kernels.
    """
    if not all(name in kernel.KNOWN for name in of):
        return "rosenbrock"
    if count > FEW:
        return "taylor" if kernel.offers(scene, of, oblique) else "rosenbrock"
    order, rotation = order_for(rtol), "rotation" in of
    there = all(is_compiled(variant_of(scene, own, order, rotation)) for own in oblique)
    return "taylor" if there else "rosenbrock"
