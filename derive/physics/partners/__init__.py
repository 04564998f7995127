"""Unequal partners: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit; in space, `space`."""

from __future__ import annotations

from ..laws.references import GOLDMAN, JEFFREY, Reference
from . import pair, space, wall
from .base import Rotation

PUBLISHED: dict[str, tuple[Reference, ...]] = {"pair": (JEFFREY,), "wall": (GOLDMAN,)}
"""Publications of the friction of a partner, to its leading logarithm."""


def rotation(partner: str, friction: str = "", reduced: bool = False) -> Rotation:
    """The rotation of a structure with partner "pair", "wall" or "space", for its equations.

    Arguments:
        friction: of the dry contact, whose impulses start the modes beside a wall anew.
        reduced: in space, without the partner's spin.
    """
    if partner == "space":
        return space.rotation(reduced)
    return pair.rotation() if partner == "pair" else wall.rotation(bool(friction))


__all__ = ["PUBLISHED", "Rotation", "rotation"]
