"""FMU export: named, and refused until it is right."""

from __future__ import annotations

from .errors import InputError
from .scene import Scene


def texts(scene: Scene) -> dict[str, str]:
    """Refuse: an FMU of a collision needs its events in the FMU, which CasADi's export does not write.

    Raises:
        InputError: always.
    """
    missing = "c or latex: an FMU needs the model's events, and CasADi's FMU export writes none"
    raise InputError("--to", "fmu", missing, f"is not available for {scene.name or 'this scene'}")
