"""Spin-down certificate: without angular momentum the rotation dies out, and a film alone keeps the doublet."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import LEAST_MOMENTUM, spins_down
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
        return self._holds(y, 0.0)

    def rounded(self, y: np.ndarray) -> bool:
        """True if the doublet separates only by an angular momentum that rounding changes too much for its figures."""
        return self._holds(y, LEAST_MOMENTUM)

    def _holds(self, y: np.ndarray, negligible: float) -> bool:
        error = self.margin * max(self.groups["stokes"], 1.0)
        state = {"gap": y[0], "orbital_momentum": y[2], "contact": self.contact, "margin": self.margin, "error": error}
        return bool(spins_down(negligible=negligible, **state, **self.values("spin_down_margins", y)))
