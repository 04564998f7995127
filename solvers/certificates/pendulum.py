"""Pendulum certificate: the strings outweigh the centrifugal force permanently, and the film stops every rebound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from casadi import SX, Function

from ...generated.automaton import SAFETY
from ..host.thread_caches import own_cache
from ..model.model import Model
from ..model.phases import Phase, pendulum_margin
from .base import BEYOND, Certainty


class PendulumCertificate:
    """Certificate for an oblique pendulum with a film and no bridge: all forces but lubrication stay inward."""

    watches: str | None = "pendulum"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.rtol = model, p, rtol

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return (SAFETY + BEYOND) * self.rtol

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return Certainty.of(float(_pendulum(self.model)(y[: len(self.model.state)], self.p, SAFETY * self.rtol)) < 0)


@own_cache(64)
def _pendulum(model: Model) -> Function:
    margin = SX.sym("margin")
    return Function("pendulum_margins", [model.column, model.parameters, margin], [pendulum_margin(model, margin)])
