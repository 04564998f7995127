"""Pendulum certificate: the film takes more than the rotation can give, and stops every rebound."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import SAFETY, STILL, is_stopped, points_inward
from ..model.model import Model
from ..model.phases import Phase
from .approach import Approach, starts
from .base import BEYOND, Certificate


class PendulumCertificate(Certificate):
    """Certificate for an oblique pendulum with a film and no bridge."""

    watches: str | None = "pendulum"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self._approach = Approach(model, p, self.margin)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return (SAFETY + BEYOND) * self.rtol

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        margins, stokes = self.values("pendulum_margins", y), self.groups["stokes"]
        outward, pull, error = margins["outward"], margins["pull"], self.margin * max(stokes, 1.0)
        inward = points_inward(outward, pull, self.margin)
        if not inward:  # what the rotation may still drive outward; NaN if a force is, which its bound may hide
            error += stokes * margins["impulse"] if outward + pull >= 0 else np.nan
        if not is_stopped(margins["film"], error):
            return False
        turns = abs(y[1]) <= STILL  # the engines allow for the impulse at the same states: at a turn
        if (inward or turns) and is_stopped(margins["recoil"], error):
            return True
        return self._approach.covers and starts(y, phase) and self._held_on_approach(y, error)

    def _held_on_approach(self, y: np.ndarray, error: float) -> bool:
        """True if the film stops every rebound on an approach from initial contact, or after it."""
        part = None
        for part in self._approach.parts(y):
            stopped = is_stopped(self._rebound("rebound", part.start, part.fastest, y), error)
            if not (stopped or self._approach.misses_glass(y, part)):
                return False
        return part is not None and bool(is_stopped(self._rebound("beneath", part.gap, part.slowed, y), error))

    def _rebound(self, margin: str, gap: float, speed: float, y: np.ndarray) -> float:
        """Margin of a rebound from a gap and a closing speed."""
        return self.values("pendulum_margins", np.array([gap, -speed, *y[2:]]))[margin]
