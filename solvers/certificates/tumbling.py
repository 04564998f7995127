"""Criterion for a doublet that tumbles in space: held, whatever its angular momentum does, but without a proof."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import SAFETY, TUMBLES
from ..model.model import Model
from ..model.phases import Phase
from .base import Certainty
from .energy_barrier import EnergyCertificate


class TumblingCertificate:
    """A stick of two spheres in space that move as one body.

    Twist about the line of centres has no friction to leading logarithm. Where the film lets little slip, a doublet
    with twist precesses like a top, and loses energy slowly while the line of centres turns across the angular momentum
    L. Its energy stays above the barrier meanwhile, although twist cannot separate the spheres. The criterion leaves
    twist out and takes all of L across the line of centres, where it turns to: the doublet is held if this energy is
    below the barrier. It is taken only where little else is left than the motion of one body. As slip takes some energy
    out of twist, this is no theorem.

    Arguments:
        beside: the energy certificate, tried first.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: EnergyCertificate) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside
        self.watches: str | None = beside.watches

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return self.beside.decided(y, phase, maxima) or Certainty.of(self._held(y), theorem=False)

    def _held(self, y: np.ndarray) -> bool:
        rest = self.model.values("wobble", y, self.p)["wobble"]
        rigid = self.model.values("effective_potential", y, self.p)["energy"]
        ahead = [barrier for barrier in self.beside.barriers(y) if barrier.gap > y[0]]
        if not (ahead and rest < TUMBLES * rigid):
            return False
        work = self.beside.energy(y) - float(sum(self.model.values(self.model.escape, y, self.p).values()))
        height = ahead[0].height
        return bool(rest + rigid + work < height - self.margin * (self.beside.largest + abs(height)))
