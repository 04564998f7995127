"""The differentiation of one collision: what happens in it, its parameters, and the tolerance that it needs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..collision.by_kernel import sequence_of
from ..engines.casadi.sequence import EventSequence
from ..model import dimensionless
from ..scene.scene import Scene
from .boundary_distance import Near
from .parameters import Kind, kind_of, references

RECORDED = 1e-9  # tolerance of the record; landings on its events correct the remaining error
NEAR = 1e-2  # at smaller distances to a boundary errors are amplified, so the tolerance is reduced with the distance
SHARPEST = 1e-13
_TILT = 1e-8  # rad: its square is rounding, and states are scaled by it, so that steps follow the tangential motion

Slopes = tuple[np.ndarray, np.ndarray]
"""Quantities and their derivatives by the parameters, SI: y (q,), dy/dp (q, n)."""


@dataclass(frozen=True)
class Problem:
    """A collision, and the parameters to differentiate in."""

    scene: Scene
    n: dimensionless.Problem
    wrt: tuple[str, ...]
    hold: str

    @classmethod
    def of(cls, scene: Scene, speed: float, angle: float, wrt: tuple[str, ...], hold: str) -> Problem:
        """The problem of a scene's collision at a normal speed (m/s) and angle (rad)."""
        return cls(scene, dimensionless.nondimensionalise(scene, speed, angle), wrt, hold)

    @cached_property
    def kind(self) -> Kind:
        return kind_of(self.scene, self.hold)

    @cached_property
    def path(self) -> EventSequence:
        """The phases and events of the collision; ComputationError if its outcome is not decided."""
        return sequence_of(self.n, RECORDED)

    def reference(self, names: tuple[str, ...]) -> np.ndarray:
        """The values of parameters, SI."""
        return references(self.scene, names, self.n.speed, self.n.angle)

    def tilted(self) -> Problem:
        """The collision at a tiny angle: it has the derivatives that a head-on one has by its sideways motion."""
        return Problem.of(self.scene, self.n.speed, _TILT, self.wrt, self.hold)

    def defined(self, name: str) -> bool:
        """True if a quantity is defined for the collision and can vary."""
        if name == "tangential_restitution" and not self.n.angle > 0:
            return False
        if name == "slip_restitution" and not math.isfinite(self.path.slip):
            return False
        if name == "final_spin_partner" and not (self.scene.pair or self.scene.wall):
            return False
        return self.path.separated or name == "energy.initial"


@dataclass(frozen=True)
class Query:
    """What is asked of a trajectory: results by name, the method and tolerance, and the nearest boundary."""

    of: tuple[str, ...]
    method: str
    rtol: float
    near: Near | None

    @property
    def amplified(self) -> bool:
        """True if a boundary is so near that the trajectory amplifies errors."""
        return self.near is not None and self.near.distance < NEAR

    def sharpened(self, parting: float) -> float:
        """The tolerance reduced for a trajectory that amplifies errors.

        Near a boundary they grow by one over the distance, where it separates slowly by one over the remaining speed.

        Arguments:
            parting: opening speed at separation over v0; 0 of a stick.
        """
        distance = self.near.distance if self.near is not None else NEAR
        least = min(NEAR, distance, parting if parting > 0 else NEAR)
        return min(self.rtol, max(self.rtol * least / NEAR, SHARPEST))
