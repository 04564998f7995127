"""Chatter that no proof ends: cycles whose maxima do not grow, held by what attracts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import SAFETY
from ..model.model import Model
from ..model.phases import Phase
from .base import Certainty, Certificate, at_maximum
from .quadrature import panels

CYCLES = 20  # maxima that are taken for chatter, if none of the next is above the one before
_GAPS = 49  # at which the doublet is asked whether it gets there


def chatters(maxima: Sequence[np.ndarray], kept: slice, margin: float) -> bool:
    """Whether none of many maxima is above the one before.

    Arguments:
        maxima: states at the last maxima of the gap.
        kept: which states must not grow.
        margin: their relative error.
    """
    last = np.array([y[kept] for y in maxima[-1 - CYCLES :]])
    return len(last) > CYCLES and not bool(np.any(last[1:] > last[:-1] * (1 + margin)))


class ChatterCertificate:
    """Between unequal spheres, or with laws of one's own, an attraction that holds what has rebounded many times.

    At a gap that stays the same, the orbit's momentum is that of rigid rotation and two modes that decay. Where it
    falls and is above the rigid one it never comes back to what it was, and with no more of it what pulls inward at a
    maximum of the gap allows none that is higher. The gap does not quite stay the same, so this is no theorem.

    Arguments:
        beside: the proof that is tried first.
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
        gaps = float(y[0]) + (self.end - float(y[0])) * np.linspace(0.0, 1.0, _GAPS) ** 3  # close ones first
        at_end = np.array([self.end, *y[1:]])
        if y[2] < self.model.values("rigid_rotation", at_end, self.p)["orbital_momentum"]:
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
