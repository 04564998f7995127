"""Spin-down certificate: without angular momentum the rotation dies out, and a film alone keeps the doublet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..model.model import Model
from ..model.phases import Phase
from .base import Certificate


def covers(model: Model) -> bool:
    """True if the certificate applies: the film has an integral, shear falls with the gap, the lever arm keeps L."""
    laws = model.laws
    usable = model.has("spin_down_margins") and hasattr(laws.film, "stopping") and getattr(laws.shear, "FALLS", False)
    return usable and model.choice.law("arm") in (None, "midgap")


class SpinDownCertificate(Certificate):
    """Certificate for oblique collisions with a film alone and no angular momentum, or none that shear reaches."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if not y[0] >= self.contact * (1 - self.margin):
            return False  # the margins assume a gap above solid contact; initial contact may lie below it
        margins, error = self.values("spin_down_margins", y), self.margin * max(self.groups["stokes"], 1.0)
        dies_out = margins["momentum"] == 0 and margins["rate"] > 0 and margins["stays"] < -error
        return dies_out or bool(y[2] == 0 and margins["inside"] < 0 and margins["apart"] < -error)
