"""Chatter that no proof ends: cycles whose maxima do not grow, held by what attracts."""

from __future__ import annotations

import numpy as np

from ...generated.automaton import CLOSING, SAFETY
from ..model.model import Model
from ..model.phases import Phase
from .base import Proof
from .quadrature import panels

CYCLES = 20  # maxima, none above the one before, that are taken for chatter
STILL = 1e-9  # of v0: slower is a turning point
_GAPS = 49  # at which the doublet is asked whether it gets there


class Cycles:
    """How many maxima there have been in a row none of which is above the one before, but for its error.

    Arguments:
        margin: relative error.
    """

    def __init__(self, margin: float) -> None:
        self.margin = margin
        self._last: np.ndarray | None = None
        self._count = 0

    def count(self, y: np.ndarray, phase: Phase, kept: slice) -> int:
        """The number, if this is a maximum of the gap, else 0.

        Arguments:
            kept: which states must not grow.
        """
        if phase.resting or phase.motion != CLOSING or abs(y[1]) > STILL:
            return 0
        here = np.array(y[kept])
        grows = self._last is not None and bool(np.any(here > self._last * (1 + self.margin)))
        self._count = 1 if grows else self._count + 1
        self._last = here
        return self._count


class ChatterProof:
    """Between unequal spheres, or with laws of one's own, an attraction that holds what has rebounded many times.

    At a gap that stays the same, the orbit's momentum is that of rigid rotation and two modes that decay. Where it
    falls and is above the rigid one it never comes back to what it was, and with no more of it what pulls inward at a
    maximum of the gap allows none that is higher. The gap does not quite stay the same, so this is no theorem.

    Arguments:
        beside: the proof that is tried first.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Proof) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside
        self.end = dict(zip(model.groups, p, strict=True)).get("rupture_gap", 1.0)
        self.theorem, self.watches = beside.theorem, beside.watches
        self._cycles = Cycles(self.margin)

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        self.theorem = self.beside.theorem
        if self.beside.decided(y, phase):
            return True
        self.theorem = False
        return self._cycles.count(y, phase, slice(0, 3, 2)) > CYCLES and self._held(y)

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
