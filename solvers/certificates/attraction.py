"""Attraction certificate: an attraction that decreases with the gap and confines the doublet permanently."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..model.phases import Phase
from .base import Certificate


class AttractionCertificate(Certificate):
    """Certificate that the attraction is so strong that the maxima of the gap can only decrease."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if not y[0] >= self.contact * (1 - self.margin):
            return False  # the margins assume a gap above solid contact; initial contact may lie below it
        margins = self.values("attraction_margins", y)
        hold = margins["hold"]
        # each inequality must hold by more than its error; with NaN the comparison is false
        energy = max(float(y[1]) ** 2, 1.0)
        return hold > 0 and margins["rebound"] < -self.margin * hold and margins["escape"] < -self.margin * energy
