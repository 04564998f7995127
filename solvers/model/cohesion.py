"""The attraction at initial contact and the generalised centrifugal number."""

import numpy as np

from ...generated import scaling
from ..scene.scene import Scene
from .dimensionless import DimensionlessGroups
from .key import ModelKey
from .model import load, select_model


def generalised_centrifugal(scene: Scene, n: DimensionlessGroups) -> float | None:
    """Return Ce_F = m omega0^2 a/F(x0), F the sum of all attractions at initial contact; None without attraction.
    It is 0 head-on and with a wall, where no line of centres rotates.
    """
    if scene.bridge is None and scene.attraction is None:
        return None
    chosen = select_model(scene, oblique=False)
    free = chosen.structure.replace("_strings", "")  # strings pull inward but are not a cohesive force
    model = load(ModelKey(free, tuple(law for law in chosen.laws if law[0] != "strings"), chosen.package))
    p = model.group_values(n.groups)
    still = np.array([1.0, 0.0, *(model.start(p)[2:] if len(model.state) > 2 else ())])
    inward = model.values("inward_force", still, p)["inward_force"]
    force = inward * n.energy / n.length
    if not force > 0:
        return None
    rate = 0.0 if scene.wall else n.groups["initial_rate"]
    return float(scaling.generalised_centrifugal(scene.reduced_radius, scene.reduced_mass, rate, force))
