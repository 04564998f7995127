"""Certificates for attractions: one that confines the doublet, and one that the film helps, head-on or with a wall."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import ATTRACTED_FILM_DEPTHS, CLOSING, attraction_holds, is_stopped
from ..model.model import Model
from ..model.phases import Phase
from .base import Certificate
from .energy_barrier import EnergyCertificate
from .film import PARTS, FilmCertificate
from .quadrature import panels

_WEAK = 1e-3  # in units of m v0^2; the error of a level is at most 3e-5, at the loosest tolerance


class AttractionCertificate(Certificate):
    """Certificate that the attraction is so strong that the maxima of the gap can only decrease."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        state = {"gap": y[0], "contact": self.contact, "margin": self.margin, "energy": max(float(y[1]) ** 2, 1.0)}
        return bool(attraction_holds(**state, **self.values("attraction_margins", y)))


class FilmAndAttractionCertificate(EnergyCertificate):
    """Certificate for film and attractions, head-on or with a wall: by energy, or by the film that stops the approach.

    An attraction too weak for the energy certificate still confines a pair that the film has stopped. At each gap, let
    v be the closing speed, w the one that the film alone would leave, and g^2/2 the work of the attraction from x0 to
    there. Then v <= w + g: where the two are equal, v >= g, and the attraction adds no more to v than to g. If w
    vanishes before solid contact and w + g does not reach the glass pressure, the solids meet at a speed of at most g,
    and with e_dry <= 1 the rebound does not reach x0.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self._film = FilmCertificate(model, p, rtol)

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        by_energy = super().sticks(y, phase, maxima)
        return by_energy or (not phase.resting and self._too_weak_for_energy(y) and self._stopped(y, phase))

    def _too_weak_for_energy(self, y: np.ndarray) -> bool:
        """True if the barriers beyond x0 are too low for the energy to decide; saves the quadrature otherwise."""
        touch = self.model.values("effective_potential", np.array([1.0, *y[1:]]), self.p)["energy"]
        return all(barrier.height - touch < _WEAK for barrier in self.barriers(y))

    def _stopped(self, y: np.ndarray, phase: Phase) -> bool:
        """True if the film stops the motion, and attraction adds too little speed to reach the glass pressure."""
        film, gap, normal_velocity = self._film, float(y[0]), float(y[1])
        if gap > 1:
            return False
        closing = phase.motion == CLOSING
        grid = film.approach(gap if closing else 1.0, ATTRACTED_FILM_DEPTHS)  # an opening pair may reach x0 and return
        if closing:
            speed = film.closing_speed(-normal_velocity, grid)
            if not is_stopped(speed[-1], film.margin):
                return False
        elif film.stops_opening(gap, normal_velocity):
            speed = np.zeros(grid.size)
        else:
            return False
        work_before = self._attraction_work(np.geomspace(1.0, gap, 65) if closing else np.ones(2))
        work_ahead = self._attraction_work(grid)
        if not self._pulls(work_before, work_ahead):
            return False
        gained = np.sqrt(2 * (work_before[-1] + work_ahead[PARTS::PARTS]))
        return film.stays_liquid(grid[PARTS::PARTS], np.maximum(speed[:-1:PARTS], 0.0) + gained)

    @staticmethod
    def _pulls(*works: np.ndarray) -> bool:
        """True if the works never decrease; a user's law may be repulsive."""
        return all(bool(np.all(np.diff(work) >= 0)) for work in works)

    def _attraction_work(self, grid: np.ndarray) -> np.ndarray:
        """Cumulative work of the attraction from the first gap on, from the potential at zero angular momentum."""
        still = np.zeros(len(self.model.state))
        works: np.ndarray = np.concatenate([[0.0], np.cumsum(-panels(lambda gaps: self._slope(gaps, still), grid))])
        return works
