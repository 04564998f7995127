"""Which engine differentiates where none is asked for; docs/kernel.md has the measurement that it goes by."""

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

    The Taylor kernel where it is compiled already, or where the collisions are not few; else CasADi's Rosenbrock.

    Arguments:
        of: results.
        oblique: whether collisions are oblique, and whether head-on: a kernel each.
    """
    if not all(name in kernel.KNOWN for name in of):
        return "rosenbrock"
    if count > FEW:
        return "taylor" if kernel.offers(scene, of, oblique) else "rosenbrock"
    order, rotation = order_for(rtol), "rotation" in of
    there = all(is_compiled(variant_of(scene, own, order, rotation)) for own in oblique)
    return "taylor" if there else "rosenbrock"
