"""Quantities of many collisions that need no integration: from scene, impacts and varied entries."""

from typing import Any

import numpy as np

from ...generated import scaling
from ..errors import WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..model.validity import flags
from ..results import FAILED, OF_IMPACT
from ..scene.groups import si_values
from ..scene.quantities import quantities
from ..scene.schema import MEETING
from .impacts import Impacts
from .results import Block


def varied_columns(request: Impacts) -> dict[str, np.ndarray]:
    """Quantities by vocabulary name, SI, one value for each collision; without speed and angle."""
    entries: dict[str, Any] = {name: value for name, value in request.scene.si if name not in MEETING}
    values = quantities(entries | dict(request.vary), request.scene.ways)
    return {name: np.broadcast_to(np.asarray(value, dtype=float), request.size) for name, value in values.items()}


def quantities_and_impacts(request: Impacts) -> dict[str, Any]:
    """Quantities by vocabulary name, SI. Speed, Stokes number and angle are arrays; others only if entries vary."""
    values: dict[str, Any] = varied_columns(request) if request.vary else dict(si_values(request.scene, None, None))
    with np.errstate(all="ignore"):
        stokes_per_speed = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
        speed = np.asarray(request.stokes) / stokes_per_speed if request.speed is None else request.speed
        stokes = speed * stokes_per_speed if request.stokes is None else request.stokes
    return values | {"speed": speed, "stokes": stokes, "angle": request.angle}


def impact_columns(request: Impacts) -> Block:
    """Columns of `OF_IMPACT`; NaN where a scene has no such number, or where its collision is impossible."""
    columns = {name: np.full(request.size, np.nan) for name in OF_IMPACT if name in request.of}
    for k in range(request.size if columns else 0):
        try:
            scene, speed, angle = request.impact(k)
            n = nondimensionalise(scene, speed, angle)
        except WetDoubletError:  # the collision is marked as failed
            continue
        for name, column in columns.items():
            value = getattr(n, name)
            column[k] = np.nan if value is None else value
    return columns


def validity(request: Impacts, results: Block) -> np.ndarray:
    """Bits for the limits of the model that each collision passes; 0 for one that failed."""
    passed = flags(request.scene, quantities_and_impacts(request) | results, request.size)
    return np.where(results["outcome"] == FAILED, np.int16(0), passed)
