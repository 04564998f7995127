"""Attraction certificate: an attraction that decreases with the gap and confines the doublet permanently."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import attraction_holds
from ..model.phases import Phase
from .base import Certificate


class AttractionCertificate(Certificate):
    """Certificate that the attraction is so strong that the maxima of the gap can only decrease."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        state = {"gap": y[0], "contact": self.contact, "margin": self.margin, "energy": max(float(y[1]) ** 2, 1.0)}
        return bool(attraction_holds(**state, **self.values("attraction_margins", y)))
