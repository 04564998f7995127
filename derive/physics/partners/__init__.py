"""Unequal partners: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit."""

from __future__ import annotations

from . import pair, wall
from .base import Rotation


def rotation(partner: str) -> Rotation:
    """The rotation of a structure with partner "pair" or "wall", for its equations."""
    return pair.rotation() if partner == "pair" else wall.rotation()


__all__ = ["Rotation", "rotation"]
