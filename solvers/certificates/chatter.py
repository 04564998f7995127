"""Criterion for chatter without a proof: cycles whose maxima do not grow, confined by an attraction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import CYCLES, SAFETY
from ..model.model import Model
from ..model.phases import Phase
from .base import Certainty, Certificate, at_maximum
from .quadrature import panels

_GAPS = 49  # number of gaps ahead at which the margin is evaluated


def chatters(maxima: Sequence[np.ndarray], kept: slice, margin: float) -> bool:
    """True if none of many successive maxima is above the one before.

    Arguments:
        maxima: states at the last maxima of the gap.
        kept: indices of the states that must not grow.
        margin: relative error of the states.
    """
    last = np.abs([y[kept] for y in maxima[-1 - CYCLES :]])  # of a momentum, the size
    return len(last) > CYCLES and not bool(np.any(last[1:] > last[:-1] * (1 + margin)))


class ChatterCertificate:
    """For unequal spheres or a user's laws: a stick of a doublet that has rebounded many times and is confined by an
    attraction.

    At constant gap, the orbital momentum is that of rigid rotation plus two decaying modes. Where its size decreases
    and is above that of the rigid value, it never returns to its present one; with no larger orbital momentum, the
    inward force at a maximum of the gap allows no higher maximum. The gap is not exactly constant, so this is not a
    theorem.

    Arguments:
        beside: another certificate, tried first.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside
        self.end = dict(zip(model.groups, p, strict=True)).get("rupture_gap", 1.0)
        self.watches = beside.watches

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        certainty = self.beside.decided(y, phase, maxima)
        if certainty or not at_maximum(y, phase):
            return certainty
        held = chatters(maxima, slice(0, 3, 2), self.margin) and self._held(y)
        return Certainty.of(held, theorem=False)

    def _held(self, y: np.ndarray) -> bool:
        gaps = float(y[0]) + (self.end - float(y[0])) * np.linspace(0.0, 1.0, _GAPS) ** 3  # denser at small distances
        at_end = np.array([self.end, *y[1:]])
        if abs(y[2]) < abs(self.model.values("rigid_rotation", at_end, self.p)["orbital_momentum"]):
            return False
        pull = np.cumsum(panels(lambda x: self._inward(x, y), gaps))
        weight = np.cumsum(panels(lambda x: self._size(x, y), gaps))
        return bool(np.any(pull > self.margin * weight))

    def _inward(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        states = np.repeat(y[: len(self.model.state), None], gaps.size, axis=1)
        states[0] = gaps
        return np.asarray(self.model.function("inward_force")(states, self.p).full())

    def _size(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        still = np.array(y)
        still[2] = 0.0
        attraction = self._inward(gaps, still)
        size: np.ndarray = np.abs(attraction) + np.abs(attraction - self._inward(gaps, y))
        return size
