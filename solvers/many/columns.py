"""Quantities of many collisions as columns of one length, without any integration: from scene, impacts and entries."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...generated import scaling
from ..errors import WetDoubletError
from ..model.cohesion import generalised_centrifugal
from ..model.dimensionless import nondimensionalise
from ..scene.groups import si_values
from ..scene.quantities import quantities
from ..scene.schema import MEETING
from .batch import Batch
from .results import OF_IMPACT


def varied_columns(request: Batch) -> dict[str, np.ndarray]:
    """Quantities under the vocabulary's names, SI, of every collision where entries vary; without speed and angle."""
    scene = request.scene
    entries: dict[str, Any] = {name: value for name, value in scene.si if name not in MEETING}
    found = quantities(entries | dict(request.vary), scene.ways)
    return {name: np.broadcast_to(np.asarray(value, dtype=float), request.size) for name, value in found.items()}


def with_impacts(request: Batch) -> dict[str, Any]:
    """Quantities and impacts, SI: arrays, and numbers where all collisions share them."""
    values: dict[str, Any] = varied_columns(request) if request.vary else dict(si_values(request.scene, None, None))
    with np.errstate(all="ignore"):
        speed = request.speed
        if speed is None:
            unit = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
            speed = np.asarray(request.stokes) / unit
    return values | {"speed": speed, "angle": request.angle}


def of_impact(request: Batch) -> dict[str, np.ndarray]:
    """Columns of those that are names for; NaN where a scene has no such number, or its collision cannot be."""
    names = [name for name in OF_IMPACT if name in request.of]
    columns = {name: np.full(request.size, np.nan) for name in names}
    for k in range(request.size if names else 0):
        try:
            scene, speed, angle = request.impact(k)
            n = nondimensionalise(scene, speed, angle)
        except WetDoubletError:  # the collision is marked as failed
            continue
        for name in names:
            value = generalised_centrifugal(scene, n) if name == "generalised_centrifugal" else getattr(n, name)
            columns[name][k] = np.nan if value is None else value
    return columns
