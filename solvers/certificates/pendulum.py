"""Pendulum certificate: the film takes more than the rotation can give, and stops every rebound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from casadi import SX, Function

from ...generated.automaton import SAFETY, STILL
from ..host.thread_caches import own_cache
from ..model.model import Model
from ..model.phases import Phase, pendulum_impulse, pendulum_margin
from .approach import Approach, starts
from .base import BEYOND, Certificate


class PendulumCertificate(Certificate):
    """Certificate for an oblique pendulum with a film and no bridge."""

    watches: str | None = "pendulum"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self._stokes, self._approach = self.groups["stokes"], Approach(model, p, self.margin)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return (SAFETY + BEYOND) * self.rtol

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        turning = abs(y[1]) <= STILL  # the engines allow for the impulse at the same states: at a turn
        margin = _pendulum(self.model, turning)(y[: len(self.model.state)], self.p, self.margin)
        return float(margin) < 0 or self._held_on_approach(y, phase)

    def _held_on_approach(self, y: np.ndarray, phase: Phase) -> bool:
        """True if the film stops the doublet after an approach from initial contact, and every rebound on the way."""
        if not self._approach.covers or not starts(y, phase):
            return False
        states = y[: len(self.model.state)]
        margins = self.values("pendulum_margins", states)
        slack = self._stokes * float(pendulum_impulse(margins, self.margin)) + self.margin * max(self._stokes, 1.0)
        if not margins["film"] + slack < 0:
            return False
        part = None
        for part in self._approach.parts(y):
            stopped = self._rebound("rebound", part.start, part.fastest, states) + slack < 0
            if not (stopped or self._approach.misses_glass(y, part)):
                return False
        return part is not None and self._rebound("beneath", part.gap, part.slowed, states) + slack < 0

    def _rebound(self, margin: str, gap: float, speed: float, states: np.ndarray) -> float:
        """Margin of a rebound from a gap and a closing speed."""
        return self.values("pendulum_margins", np.array([gap, -speed, *states[2:]]))[margin]


@own_cache(64)
def _pendulum(model: Model, turning: bool) -> Function:
    margin = SX.sym("margin")
    return Function(
        "pendulum_margins", [model.column, model.parameters, margin], [pendulum_margin(model, margin, turning)]
    )
