"""FMU export: named, and refused until it is right.

CasADi 3.8.2 can write the sources of an FMU with event indicators, but calls that experimental, ships no
FMI headers to compile them with, and has no place for what is decided by rule here: criteria that are met already,
events that coincide, resting contact.
"""

from __future__ import annotations

from ..errors import InputError
from ..scene.scene import Scene


def texts(scene: Scene) -> dict[str, str]:
    """Refuse.

    Raises:
        InputError: always; says what is missing.
    """
    missing = "c or latex: for an FMU casadi lacks fmi3Functions.h, and the phases' rules have no place in its export"
    raise InputError("--to", "fmu", missing, f"is not available for {scene.name or 'this scene'}")
