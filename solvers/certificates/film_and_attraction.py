"""Attractions beside a film, where nothing turns: energy, or the film that stops the approach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import ATTRACTED_FILM_DEPTHS, CLOSING
from ..model.model import Model
from ..model.phases import Phase
from .base import Certainty
from .energy_barrier import EnergyCertificate
from .film import PARTS, FilmCertificate
from .quadrature import panels

_WEAK = 1e-3  # of m v0^2; the error of a level is 3e-5 at most, that of the loosest tolerance


class FilmAndAttractionCertificate(EnergyCertificate):
    """Head-on or beside a wall, a film and what attracts: energy, or the film that stops the approach.

    An attraction too weak to show in the energy still holds what the film has stopped. What would close at w under
    the film alone closes at most at w + g with the attraction, g^2/2 being its work from x = x0 on: where v = w + g,
    v >= g, so v grows no faster than w + g does. If w vanishes before the solids are met and w + g meets no glass
    pressure, the solids are met at no more than g, and e_dry <= 1 gives back less than it takes to get to x0.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self._film = FilmCertificate(model, p, rtol)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return super().decided(y, phase, maxima) or Certainty.of(
            not phase.resting and self._weak(y) and self._stopped(y, phase)
        )

    def _weak(self, y: np.ndarray) -> bool:
        """Whether what rises beyond x0 is too low for the energy to decide soon; else the film's quadrature is dear."""
        touch = self.model.values("effective_potential", np.array([1.0, *y[1:]]), self.p)["energy"]
        return all(barrier.height - touch < _WEAK for barrier in self.barriers(y))

    def _stopped(self, y: np.ndarray, phase: Phase) -> bool:
        film, gap, normal_velocity = self._film, float(y[0]), float(y[1])
        if gap > 1:
            return False
        closing = phase.motion == CLOSING
        grid = film.approach(gap if closing else 1.0, ATTRACTED_FILM_DEPTHS)  # what opens may rise up to x0 and fall
        if closing:
            speed = film.slowed(-normal_velocity, grid)
            if speed[-1] > -film.margin:
                return False
        elif film.held(gap, normal_velocity):
            speed = np.zeros(grid.size)
        else:
            return False
        above, below = self._fallen(np.geomspace(1.0, gap, 65) if closing else np.ones(2)), self._fallen(grid)
        if not self._pulls(above, below):
            return False
        fallen = np.sqrt(2 * (above[-1] + below[PARTS::PARTS]))
        return film.clear(grid[PARTS::PARTS], np.maximum(speed[:-1:PARTS], 0.0) + fallen)

    @staticmethod
    def _pulls(*works: np.ndarray) -> bool:
        """Whether none of the works ever falls: a law of one's own may push."""
        return all(bool(np.all(np.diff(work) >= 0)) for work in works)

    def _fallen(self, grid: np.ndarray) -> np.ndarray:
        """Work of the attraction from the first gap on, cumulative; the slope of the potential is nothing else here."""
        still = np.zeros(len(self.model.state))
        works: np.ndarray = np.concatenate([[0.0], np.cumsum(-panels(lambda gaps: self._slope(gaps, still), grid))])
        return works
