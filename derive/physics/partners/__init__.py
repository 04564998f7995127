"""Unequal partners: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit; in space, `space`.

Equal spheres have equations of their own. As a pair of ratio 1, the ratios folded in and the spins equal, the emitted
rates take a tenth more operations (32 to 29, with a bridge 38 to 35) and a product of series more (8 to 7, 9 to 8);
the kernel with ledger executes 14 % more instructions.
"""

from ..references import GOLDMAN, JEFFREY, Reference
from ..structure import Structure
from . import pair, space, wall
from .base import Rotation

PUBLISHED: dict[str, tuple[Reference, ...]] = {"pair": (JEFFREY,), "wall": (GOLDMAN,)}
"""Publications of the friction of a partner, to its leading logarithm."""


def rotation(structure: Structure) -> Rotation:
    """The rotation of a structure with an unequal partner, for its equations."""
    if structure.partner == "space":
        return space.rotation(structure.reduced)
    return pair.rotation() if structure.partner == "pair" else wall.rotation(bool(structure.friction))


__all__ = ["PUBLISHED", "Rotation", "rotation"]
