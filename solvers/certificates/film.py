"""Film certificate, head-on with a film alone: by the film's momentum integral."""

from collections.abc import Sequence

import numpy as np
from casadi import SX, Function

from ...generated.automaton import CLOSING, FILM_DEPTHS, LEAST_DEPTH, is_stopped
from ..host.thread_caches import own_cache
from ..model.model import Model
from ..model.phases import Phase
from .base import Certificate
from .quadrature import panels

PARTS = 50  # panels of the quadrature between two depths


class FilmCertificate(Certificate):
    """Certificate for a head-on film alone: du/dx = -(6 pi mu a^2/m) resistance gives the velocity at every gap."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        gap, normal_velocity = float(y[0]), float(y[1])
        if phase.resting:
            return True
        if phase.motion != CLOSING:
            return self.stops_opening(gap, normal_velocity)
        # closing: the film must stop the motion before solid contact and before the glass pressure is reached
        grid = self.approach(gap, FILM_DEPTHS)
        speed = self.closing_speed(-normal_velocity, grid)
        if not is_stopped(speed[-1], self.margin):
            return False
        # between two depths the speed falls and the pressure per speed rises, so their end values bound the pressure
        return self.stays_liquid(grid[PARTS::PARTS], np.maximum(speed[:-1:PARTS], 0.0))

    def approach(self, gap: float, depths: int) -> np.ndarray:
        """Gaps from `gap` to contact in geometric progression, PARTS for each depth."""
        deepest = max(self.contact, gap * LEAST_DEPTH)
        return np.geomspace(gap, deepest, depths * PARTS + 1)

    def stops_opening(self, gap: float, normal_velocity: float) -> bool:
        """True if the film stops an opening doublet: up to x0, u falls by the film's integral; not if it cavitates."""
        if normal_velocity == 0.0:
            return True  # at rest it stays at rest
        loss = 0.0 if self.model.cavitates else self._momentum_loss(np.linspace(gap, 1.0, 65))[-1]
        return bool(is_stopped(normal_velocity - loss, self.margin))

    def closing_speed(self, speed: float, grid: np.ndarray) -> np.ndarray:
        """Closing speed along decreasing gaps (losses are negative there); negative beyond the stop."""
        speeds: np.ndarray = speed + self._momentum_loss(grid)
        return speeds

    def stays_liquid(self, gaps: np.ndarray, speeds: np.ndarray) -> bool:
        """True if the glass pressure is not reached at these gaps and closing speeds."""
        beside = np.zeros((len(self.model.state) - 2, gaps.size))  # the tangential states, zero
        clearance = np.asarray(_glass(self.model)(np.vstack([gaps, -speeds, beside]), self.p).full())
        return bool(np.min(clearance) > self.margin * self.groups["glass_number"])

    def _momentum_loss(self, grid: np.ndarray) -> np.ndarray:
        """Cumulative loss of u along a grid of gaps."""
        losses: np.ndarray = (
            np.concatenate([[0.0], np.cumsum(panels(self._resistance_at, grid))]) / self.groups["stokes"]
        )
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
