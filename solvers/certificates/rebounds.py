"""Certificate for chatter in space: every rebound ends below the last maximum of the gap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import SAFETY
from ..model.model import Model
from ..model.phases import Phase
from ..scene.contact import contact_gap
from .base import Certainty, Certificate, at_maximum


class ReboundCertificate:
    """Two spheres in space, with attractions that fall with the gap: what a rebound takes outweighs the rotation.

    At a maximum x of the gap let P be the attraction, and C a bound of the centrifugal force at this gap and below. If
    C < (1 - e_dry^2) P, the gap stays at x or below: the net force is inward, so that only a rebound, at some gap y,
    ends the approach. The speed there is at most that by the attraction's work W from x. After the rebound e_dry^2 W is
    left of this energy, and it takes at least W - C (x - y) to come back to x; W is at least P (x - y).

    The kinetic energy of rotation grows by the attraction's work down to the contact at most, and what of it is beyond
    L^2/(2 I) bounds the orbital momentum (`derive.checks.space.least_energy_in_space`). At smaller gaps the bound is
    larger by the fourth power of the ratio of the centre distances at most (`outward_at_smaller_gaps` there).

    Arguments:
        beside: another certificate, tried first.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside
        self.watches = beside.watches
        groups = dict(zip(model.groups, p, strict=True))
        self.kept = groups["dry_restitution"] ** 2
        self.aspect, self.deepest = groups["aspect"], contact_gap(groups)
        ratio = groups["radius_ratio"]
        self.centres = (1 + ratio) ** 2 / ratio  # R_1 + R_2 over a

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        certainty = self.beside.decided(y, phase, maxima)
        return certainty or Certainty.of(at_maximum(y, phase) and self._comes_back(y))

    def _comes_back(self, y: np.ndarray) -> bool:
        if not 0.0 < self.deepest < y[0]:
            return False
        here = self.model.values("resting_bound", y, self.p)
        at_contact = self.model.values("resting_bound", np.array([self.deepest, *y[1:]]), self.p)
        work = max(0.0, at_contact["inward"]) * (float(y[0]) - self.deepest)
        far, near = (self.centres + self.aspect * gap for gap in (float(y[0]), self.deepest))
        outward = (np.sqrt(here["outward"]) + np.sqrt(2 * work * self.aspect / far)) ** 2 * (far / near) ** 4
        return bool(outward < (1 - self.kept) * here["inward"] * (1 - self.margin))
