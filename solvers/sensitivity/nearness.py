"""How near a flight is to a boundary."""
from __future__ import annotations


def checked(scene, n, finder, path, rtol):
    return None
