"""Warnings about laws used outside their range of validity; never errors."""

from __future__ import annotations

import math
import warnings
from functools import lru_cache

from ..errors import ModelWarning
from ..scene.groups import law_module
from ..scene.scene import Scene


@lru_cache(maxsize=64)
def remarks(scene: Scene) -> tuple[str, ...]:
    """Return one sentence for each quantity of the scene outside the range of validity of a law.

    Ranges are emitted with the laws (`VALIDITY`) as far as their sources state them.
    """
    if scene.bridge is None:
        return ()
    bridge, law = scene.bridge, law_module(scene, "bridge", scene.bridge.law)
    ranges: dict[str, tuple[float | None, float | None]] = getattr(law, "VALIDITY", {})
    reach = scene.rupture_gap / (2 * scene.reduced_radius)
    values = {"volume": bridge.volume, "contact_angle": bridge.contact_angle, "separation": reach}
    said = []
    for name, (least, largest) in ranges.items():
        value = values[name]
        if least is not None and value < least * (1 - _ROUNDING):
            said.append(_outside(scene, name, value, "below", least, law.VALIDITY_SOURCE))
        elif largest is not None and value > largest * (1 + _ROUNDING):
            said.append(_outside(scene, name, value, "above", largest, law.VALIDITY_SOURCE))
    return tuple(said)


_ROUNDING = 1e-12  # rounding: 50 deg is within a limit of 50 deg
_ENTRIES = {"volume": "bridge.volume", "contact_angle": "bridge.contact_angle", "separation": "x_f/R"}


def _outside(scene: Scene, name: str, value: float, side: str, bound: float, source: str) -> str:
    law = scene.bridge.law if scene.bridge else ""
    shown = (f"{math.degrees(each):.4g} deg" if name == "contact_angle" else f"{each:.4g}" for each in (value, bound))
    given, limit = shown
    return f"{_ENTRIES[name]} = {given} is {side} {limit}, outside the range of the law {law} ({source})"


def warn(scene: Scene, stacklevel: int = 3) -> tuple[str, ...]:
    """Issue every remark as a ModelWarning, and return them."""
    said = remarks(scene)
    for sentence in said:
        warnings.warn(sentence, ModelWarning, stacklevel=stacklevel)
    return said
