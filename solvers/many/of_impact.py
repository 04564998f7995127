"""Numbers of many collisions that their impacts alone decide: groups, without any integration."""

from __future__ import annotations

import numpy as np

from ..errors import WetDoubletError
from ..model.cohesion import generalised_centrifugal
from ..model.dimensionless import nondimensionalise
from .batch import Batch
from .results import OF_IMPACT


def of_impact(request: Batch) -> dict[str, np.ndarray]:
    """Columns of those that are asked for; NaN where a scene has no such number, or its collision cannot be."""
    asked = [name for name in OF_IMPACT if name in request.of]
    columns = {name: np.full(request.size, np.nan) for name in asked}
    for k in range(request.size if asked else 0):
        try:
            scene, speed, angle = request.impact(k)
            n = nondimensionalise(scene, speed, angle)
        except WetDoubletError:  # the collision is marked as failed
            continue
        for name in asked:
            value = generalised_centrifugal(scene, n) if name == "generalised_centrifugal" else getattr(n, name)
            columns[name][k] = np.nan if value is None else value
    return columns
