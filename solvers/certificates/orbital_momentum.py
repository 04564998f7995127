"""By the orbital angular momentum: what holds a doublet now holds it for good.

It decides where energy does not: fast spin that the orbit will never get back, resting contact, cycles on glassy liquid
that lose next to nothing, and the surface arm, for which angular momentum is not conserved.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import CLOSING, SAFETY
from ..model.model import Model
from ..model.phases import Phase
from .base import STILL, Certainty, Certificate, at_maximum
from .chatter import chatters
from .quadrature import panels

_LEVERS = ("midgap", "surface")
_GAPS = 49  # at which the doublet is asked whether it gets there


def covers(model: Model) -> bool:
    """Whether the proof is about this model: equal spheres that turn, the library's laws, something that attracts."""
    return model.has("orbital_margins") and model.choice.package is None and model.choice.law("arm") in (None, *_LEVERS)


class OrbitalMomentumCertificate:
    """Asks, after another proof, whether some gap ahead is out of reach for good.

    On strings no proof covers the slip that their torque makes; there it ends chatter, after some cycles whose maxima
    do not grow, and the stick is not called a theorem. Nor is it with the surface arm (docs/physics.md).

    Arguments:
        beside: another proof for the same model, tried first unless the arm lets angular momentum drift; it is what a
            trajectory watches for.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate) -> None:
        self.model, self.p, self.margin, self.beside = model, p, SAFETY * rtol, beside
        self.groups = groups = dict(zip(model.groups, p, strict=True))
        self.end = groups.get("rupture_gap", 1.0)
        self.aspect, self.obliquity = groups["aspect"], groups["obliquity"]
        self.lever = model.choice.law("arm") or "midgap"
        more = (groups[str(symbol)] for symbol in model.extra("shear", "edge"))
        self.edge = float(model.laws.shear.edge(self.aspect, *more))
        self.watches = None if self._drifts else beside.watches

    @property
    def _drifts(self) -> bool:
        return self.lever == "surface"

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        if not self._drifts and (certainty := self.beside.decided(y, phase, maxima)):
            return certainty
        if self.model.strings:
            worth = at_maximum(y, phase) and chatters(maxima, slice(1), self.margin)
        else:
            worth = self._drifts or phase.resting or (phase.motion == CLOSING and y[1] > -STILL)
        return Certainty.of(worth and self.holds(y), self.proves)

    @property
    def proves(self) -> bool:
        """Whether `holds` is a theorem for this model."""
        return not (self._drifts or self.model.strings)

    def settles(self, y: np.ndarray) -> bool:
        """Whether a doublet with the surface arm is held once it turns as one body at the edge of the shear.

        It is, as with the other arm, but for the angular momentum that the surface arm makes in the film meanwhile:
        no theorem, for chatter that nothing else ends.
        """
        return self._drifts and not self.model.strings and self.holds(y, settled=True)

    def holds(self, y: np.ndarray, settled: bool = False) -> bool:
        """Whether the margin is below zero at some gap ahead by more than its error.

        Arguments:
            settled: count on omega = xi at the edge of the shear with the surface arm as well.
        """
        gap, normal_velocity, orbital_momentum = map(float, y[:3])
        if not gap < self.end:
            return False
        turning = (
            orbital_momentum / (4 + self.aspect * gap) ** 2 - self.model.values("orbital_margins", y, self.p)["slip"]
        )
        if self._drifts and not self.model.strings and not 0 <= 16 * turning <= orbital_momentum:
            return False  # beyond what is proved of the surface arm's exchange: rho < 4 a
        edges = gap + (self.end - gap) * np.linspace(0.0, 1.0, _GAPS) ** 3  # close ones first
        inward, attraction = self._work(edges, y, orbital_momentum), self._work(edges, y, 0.0)
        found = np.asarray(
            self.model.function("orbital_margins")(self._states(edges[1:], y, orbital_momentum), self.p).full()
        )
        slips = found[self.model.names("orbital_margins").index("slip")]
        needed = normal_velocity**2 / 2 - inward + self._exchange(edges[1:], y, found, settled or not self._drifts)
        turned = (self.obliquity**2 / 16) * abs(orbital_momentum) * np.maximum(-slips, 0.0)
        error = normal_velocity**2 + abs(normal_velocity) + 2 * np.abs(attraction) + np.abs(inward) + turned
        return bool(np.any(needed < -self.margin * error))  # a comparison with NaN proves nothing

    def _exchange(self, gaps: np.ndarray, y: np.ndarray, found: np.ndarray, settled: bool) -> np.ndarray:
        """Energy that the tangential force can still transfer from spin to orbit before each of these gaps.

        Beyond the edge of the shear only what it does before omega = xi there.
        """
        names = self.model.names("orbital_margins")
        slips, energy = found[names.index("slip")], found[names.index(self.lever)]
        possible: np.ndarray = np.where(slips < 0, energy, 0.0)
        beyond = gaps > self.edge
        if not settled or self.model.strings or not beyond.any():
            return possible
        rigid = self.model.values("rigid_rotation", np.array([self.edge, *y[1:]]), self.p)
        if y[2] >= rigid["orbital_momentum"]:
            return np.where(beyond, 0.0, possible)
        at_edge = np.array([self.edge, 0.0, *list(rigid.values())[2:]])  # orbit, and spin where it is a state
        left = np.asarray(
            self.model.function("orbital_margins")(
                self._states(gaps, at_edge, rigid["orbital_momentum"]), self.p
            ).full()
        )
        return np.where(beyond, energy - left[names.index(self.lever)], possible)

    def _work(self, edges: np.ndarray, y: np.ndarray, orbital_momentum: float) -> np.ndarray:
        """Work against what pulls inward from the first gap to each of the others, the orbit's momentum as given."""
        force = self.model.function("inward_force")
        work: np.ndarray = np.cumsum(
            panels(lambda gaps: np.asarray(force(self._states(gaps, y, orbital_momentum), self.p).full()), edges)
        )
        return work

    def _states(self, gaps: np.ndarray, y: np.ndarray, orbital_momentum: float) -> np.ndarray:
        states = np.repeat(y[: len(self.model.state), None], gaps.size, axis=1)
        states[0], states[2] = gaps, orbital_momentum
        return states
