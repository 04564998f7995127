"""Spin-down certificate: without angular momentum the rotation dies out, and a film alone keeps the doublet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import spins_down
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
        margins, error = self.values("spin_down_margins", y), self.margin * max(self.groups["stokes"], 1.0)
        momentum, rate, stays, inside, apart = (
            margins[name] for name in ("momentum", "rate", "stays", "inside", "apart")
        )
        return spins_down(y[0], self.contact, self.margin, momentum, rate, stays, error, y[2], inside, apart)
