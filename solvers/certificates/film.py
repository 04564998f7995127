"""Head-on with a film alone: its momentum integral decides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from casadi import SX, Function

from ...generated.automaton import CLOSING, FILM_DEPTHS, LEAST_DEPTH, SAFETY
from ..host.thread_caches import own_cache
from ..model.contact import contact_gap
from ..model.model import Model
from ..model.phases import Phase
from .base import Certainty
from .quadrature import panels

PARTS = 50  # panels of the quadrature between two depths


class FilmCertificate:
    """Head-on, film alone: du/dx = -(6 pi mu a^2/m) resistance, so the velocity at every gap is known in advance."""

    watches: str | None = None

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p = model, p
        groups = dict(zip(model.groups, p, strict=True))
        self.stokes = groups["stokes"]
        self.contact = contact_gap(groups)
        self.glass = groups["glass_number"]
        self.margin = SAFETY * rtol

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return Certainty.of(self._stops(y, phase))

    def _stops(self, y: np.ndarray, phase: Phase) -> bool:
        gap, normal_velocity = float(y[0]), float(y[1])
        if phase.resting:
            return True
        if phase.motion != CLOSING:
            return self.held(gap, normal_velocity)
        # closing: neither the solids nor the glass pressure are met before the film stops the motion
        grid = self.approach(gap, FILM_DEPTHS)
        speed = self.slowed(-normal_velocity, grid)
        if speed[-1] > -self.margin:
            return False
        # from one depth to the next the speed falls and the pressure per speed rises: their ends bound the pressure
        return self.clear(grid[PARTS::PARTS], np.maximum(speed[:-1:PARTS], 0.0))

    def approach(self, gap: float, depths: int) -> np.ndarray:
        """Gaps on the way to contact, in equal ratio: PARTS from one depth to the next."""
        deepest = max(self.contact, gap * LEAST_DEPTH)
        return np.geomspace(gap, deepest, depths * PARTS + 1)

    def held(self, gap: float, normal_velocity: float) -> bool:
        """Whether the film stops an opening doublet: u falls by its integral up to x = x0; not if it cavitates."""
        if normal_velocity == 0.0:
            return True  # at rest nothing moves it
        loss = 0.0 if self.model.cavitates else self._momentum_loss(np.linspace(gap, 1.0, 65))[-1]
        return bool(normal_velocity - loss < -self.margin)

    def slowed(self, speed: float, grid: np.ndarray) -> np.ndarray:
        """Closing speed along a falling gap; losses are negative there. Below zero: it has been stopped before."""
        found: np.ndarray = speed + self._momentum_loss(grid)
        return found

    def clear(self, gaps: np.ndarray, speeds: np.ndarray) -> bool:
        """Whether no glass pressure is met at these gaps and closing speeds."""
        beside = np.zeros((len(self.model.state) - 2, gaps.size))  # what moves across the line of centres
        clearance = np.asarray(_glass(self.model)(np.vstack([gaps, -speeds, beside]), self.p).full())
        return bool(np.min(clearance) > self.margin * self.glass)

    def _momentum_loss(self, grid: np.ndarray) -> np.ndarray:
        """Loss of u along a path of gaps, cumulative."""
        losses: np.ndarray = np.concatenate([[0.0], np.cumsum(panels(self._resistance_at, grid))]) / self.stokes
        return losses

    def _resistance_at(self, gaps: np.ndarray) -> np.ndarray:
        return np.asarray(_resistance(self.model)(gaps.reshape(1, -1), self.p).full())


@own_cache(64)
def _glass(model: Model) -> Function:
    return Function("glass", [model.column, model.parameters], [model("events")["glass"]])


@own_cache(64)
def _resistance(model: Model) -> Function:
    gap = SX.sym("gap")
    more = model.extra("film", "resistance")
    return Function("resistance", [gap, model.parameters], [model.laws.film.resistance(gap, *more)])
