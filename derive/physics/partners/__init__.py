"""Unequal partners: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit."""

from __future__ import annotations

from ..laws.references import GOLDMAN, JEFFREY, Reference
from . import pair, wall
from .base import Rotation

PUBLISHED: dict[str, tuple[Reference, ...]] = {"pair": (JEFFREY,), "wall": (GOLDMAN,)}
"""Publications of the friction of a partner, to its leading logarithm."""


def rotation(partner: str, friction: str = "") -> Rotation:
    """The rotation of a structure with partner "pair" or "wall", for its equations.

    Arguments:
        friction: of the dry contact, whose impulses start the modes beside a wall anew.
    """
    return pair.rotation() if partner == "pair" else wall.rotation(bool(friction))


__all__ = ["PUBLISHED", "Rotation", "rotation"]
