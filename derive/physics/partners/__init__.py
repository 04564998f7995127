"""What an unequal partner changes: another sphere (`pair`, from `bodies` and `rolling`), or a wall as its limit."""

from __future__ import annotations

from ..laws.references import GOLDMAN, JEFFREY, Reference
from . import pair, wall
from .base import Rotation

PUBLISHED: dict[str, tuple[Reference, ...]] = {"pair": (JEFFREY,), "wall": (GOLDMAN,)}
"""Where the friction of a partner is published, to its leading logarithm."""


def rotation(partner: str) -> Rotation:
    """What the equations of a structure take from its partner, "pair" or "wall"."""
    return pair.rotation() if partner == "pair" else wall.rotation()


__all__ = ["PUBLISHED", "Rotation", "rotation"]
