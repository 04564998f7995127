"""Spin-down certificate: without angular momentum the rotation dies out, and a film alone keeps the doublet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import LEAST_MOMENTUM, SAFETY
from ..model.model import Model
from ..model.phases import Phase
from ..scene.contact import contact_gap
from .base import Certainty


def covers(model: Model) -> bool:
    """True if the certificate applies: the film has an integral, shear falls with the gap, the lever arm keeps L."""
    laws = model.laws
    usable = model.has("spin_down_margins") and hasattr(laws.film, "stopping") and getattr(laws.shear, "FALLS", False)
    return usable and model.choice.law("arm") in (None, "midgap")


class SpinDownCertificate:
    """Certificate for oblique collisions with a film alone and no angular momentum, or none that shear reaches."""

    watches: str | None = None

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.margin = model, p, SAFETY * rtol
        groups = dict(zip(model.groups, p, strict=True))
        self._error = self.margin * max(groups["stokes"], 1.0)
        self._nearest = contact_gap(groups) * (1 - self.margin)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        if self._dies_out(y, 0.0):
            return Certainty.PROVED
        found = self._margins(y)
        still = y[0] >= self._nearest and y[2] == 0
        return Certainty.of(bool(still and found["inside"] < 0 and found["apart"] < -self._error))

    def rounded(self, y: np.ndarray) -> bool:
        """True if the doublet separates only by an angular momentum that rounding changes too much for its figures."""
        return self._dies_out(y, LEAST_MOMENTUM)

    def _dies_out(self, y: np.ndarray, most: float) -> bool:
        """True if the film keeps the doublet where an angular momentum up to `most` of its parts is none.

        The margins assume a gap above solid contact; initial contact may lie below it.
        """
        found = self._margins(y)
        none = y[0] >= self._nearest and found["momentum"] <= most
        return bool(none and found["rate"] > 0 and found["stays"] < -self._error)

    def _margins(self, y: np.ndarray) -> dict[str, float]:
        return self.model.values("spin_down_margins", y[: len(self.model.state)], self.p)
