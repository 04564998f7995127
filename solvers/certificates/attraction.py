"""Attraction certificate: an attraction that decreases with the gap and confines the doublet permanently."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import SAFETY
from ..model.model import Model
from ..model.phases import Phase
from ..scene.contact import contact_gap
from .base import Certainty, Certificate, NoCertificate


class AttractionCertificate:
    """Certificate that the attraction is so strong that the maxima of the gap can only decrease.

    Arguments:
        beside: another certificate for the same model, tried first; its level is the watched event.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate | None = None) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside or NoCertificate()
        self.watches: str | None = self.beside.watches
        groups = dict(zip(model.groups, p, strict=True))
        self._nearest = contact_gap(groups) * (1 - self.margin)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return self.beside.decided(y, phase, maxima) or Certainty.of(self._held(y))

    def _held(self, y: np.ndarray) -> bool:
        if not y[0] >= self._nearest:
            return False  # the margins assume a gap above solid contact; initial contact may lie below it
        found = self.model.values("attraction_margins", y, self.p)
        hold = found["hold"]
        # each inequality must hold by more than its error; with NaN the comparison is false
        energy = max(float(y[1]) ** 2, 1.0)
        return hold > 0 and found["rebound"] < -self.margin * hold and found["escape"] < -self.margin * energy
