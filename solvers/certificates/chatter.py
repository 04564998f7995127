"""Criterion for chatter without a proof: cycles whose maxima do not grow, confined by an attraction."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import CYCLES, stays_below
from ..model.phases import Phase
from .base import Certificate, at_maximum, inward
from .quadrature import gaps_ahead, panels


def chatters(maxima: Sequence[np.ndarray], kept: slice, margin: float) -> bool:
    """True if none of many successive maxima is above the one before.

    Arguments:
        maxima: states at the last maxima of the gap.
        kept: indices of the states that must not grow.
        margin: relative error of the states.
    """
    last = np.abs([y[kept] for y in maxima[-1 - CYCLES :]])  # of a momentum, the size
    return len(last) > CYCLES and not bool(np.any(last[1:] > last[:-1] * (1 + margin)))


class ChatterCertificate(Certificate):
    """For unequal spheres or a user's laws: a stick of a doublet that has rebounded many times and is confined by an
    attraction.

    At constant gap, the orbital momentum is that of rigid rotation plus two decaying modes. Where its size decreases
    and is above that of the rigid value, it never returns to its present one; with no larger orbital momentum, the
    inward force at a maximum of the gap allows no higher maximum. The gap is not exactly constant, so this is not a
    theorem.
    """

    theorem = False

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if not (at_maximum(y, phase) and chatters(maxima, slice(0, 3, 2), self.margin)):
            return False
        gaps = gaps_ahead(float(y[0]), self.end)
        rigid = self.values("rigid_rotation", np.array([self.end, *y[1:]]))["orbital_momentum"]
        if abs(y[2]) < abs(rigid):
            return False
        pull = np.cumsum(panels(lambda x: inward(self.model, self.p, x, y), gaps))
        weight = np.cumsum(panels(lambda x: self._size(x, y), gaps))
        return bool(np.any(stays_below(-pull, self.margin, weight)))

    def _size(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        attraction = inward(self.model, self.p, gaps, y, 0.0)
        size: np.ndarray = np.abs(attraction) + np.abs(attraction - inward(self.model, self.p, gaps, y))
        return size
