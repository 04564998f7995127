"""What an unequal partner changes: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit."""

from __future__ import annotations

from . import pair, wall
from .base import Rotation


def rotation(partner: str) -> Rotation:
    """What the equations of a structure take from its partner, "pair" or "wall"."""
    return pair.rotation() if partner == "pair" else wall.rotation()


__all__ = ["Rotation", "rotation"]
