"""Pendulum certificate: the film takes more than the rotation can give, and stops every rebound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from casadi import SX, Function

from ...generated.automaton import SAFETY
from ..host.thread_caches import own_cache
from ..model.model import Model
from ..model.phases import Phase, pendulum_impulse, pendulum_margin
from .approach import Approach, starts
from .base import BEYOND, Certainty


class PendulumCertificate:
    """Certificate for an oblique pendulum with a film and no bridge."""

    watches: str | None = "pendulum"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.rtol = model, p, rtol
        self._stokes = dict(zip(model.groups, p, strict=True))["stokes"]
        self._approach = Approach(model, p, SAFETY * rtol)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return (SAFETY + BEYOND) * self.rtol

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        held = float(_pendulum(self.model)(y[: len(self.model.state)], self.p, SAFETY * self.rtol)) < 0
        return Certainty.of(held or self._held_on_approach(y, phase))

    def _held_on_approach(self, y: np.ndarray, phase: Phase) -> bool:
        """True if the film stops the doublet after an approach from initial contact, and every rebound on the way."""
        if not self._approach.covers or not starts(y, phase):
            return False
        margin, states = SAFETY * self.rtol, y[: len(self.model.state)]
        found = self.model.values("pendulum_margins", states, self.p)
        slack = self._stokes * float(pendulum_impulse(found, margin)) + margin * max(self._stokes, 1.0)
        if not found["film"] + slack < 0:
            return False
        part = None
        for part in self._approach.parts(y):
            stopped = self._rebound("rebound", part.start, part.fastest, states) + slack < 0
            if not (stopped or self._approach.misses_glass(y, part)):
                return False
        return part is not None and self._rebound("beneath", part.gap, part.slowed, states) + slack < 0

    def _rebound(self, margin: str, gap: float, speed: float, states: np.ndarray) -> float:
        """Margin of a rebound from a gap and a closing speed."""
        return self.model.values("pendulum_margins", np.array([gap, -speed, *states[2:]]), self.p)[margin]


@own_cache(64)
def _pendulum(model: Model) -> Function:
    margin = SX.sym("margin")
    return Function(
        "pendulum_margins", [model.column, model.parameters, margin], [pendulum_margin(model, margin, True)]
    )
