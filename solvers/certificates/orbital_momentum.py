"""Orbital-momentum certificate: bounds the energy that spin can still transfer to the orbit.

It decides cases that the energy certificate does not: fast spin that the orbit cannot regain, resting contact, and
cycles on glassy liquid with small losses.
"""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import CLOSING, STILL, stays_below
from ..model.model import Model
from ..model.phases import Phase
from .base import Certificate, at_maximum, inward, states_at
from .chatter import chatters
from .quadrature import gaps_ahead, panels


def covers(model: Model) -> bool:
    """True if the certificate applies: oblique, equal spheres, the library's laws, an attraction."""
    return model.has("orbital_margins") and model.choice.package is None


class OrbitalMomentumCertificate(Certificate):
    """Certificate, tried after another one, that some larger gap can never be reached.

    With strings no proof covers the slip caused by their torque. There it ends chatter after some cycles whose maxima
    do not grow, and the stick is not a theorem.

    Arguments:
        beside: another certificate for the same model, tried first; its level is the watched event.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate) -> None:
        super().__init__(model, p, rtol, beside)
        groups = self.groups
        self.aspect, self.obliquity = groups["aspect"], groups["obliquity"]
        more = (groups[str(symbol)] for symbol in model.extra("shear", "edge"))
        self.edge = float(model.laws.shear.edge(self.aspect, *more))
        self.theorem = not model.strings

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if self.model.strings:
            worth = at_maximum(y, phase) and chatters(maxima, slice(1), self.margin)
        else:
            worth = phase.resting or (phase.motion == CLOSING and y[1] > -STILL)
        return worth and self.holds(y)

    def holds(self, y: np.ndarray) -> bool:
        """True if the margin is negative at some larger gap by more than its error."""
        gap, normal_velocity, orbital_momentum = map(float, y[:3])
        if not gap < self.end:
            return False
        edges = gaps_ahead(gap, self.end)
        inward, attraction = self._work(edges, y, orbital_momentum), self._work(edges, y, 0.0)
        slips, energy = self.margins(edges[1:], y, orbital_momentum)
        exchanged = self.exchange(edges[1:], y, energy)
        needed = normal_velocity**2 / 2 - inward + exchanged
        size = abs(orbital_momentum) + np.abs(slips) * (4 + self.aspect * edges[1:]) ** 2
        turned = (self.obliquity**2 / 16) * size * np.where(exchanged > 0, np.abs(slips), 0.0)
        error = normal_velocity**2 + abs(normal_velocity) + 2 * np.abs(attraction) + np.abs(inward) + turned
        return bool(np.any(stays_below(needed, self.margin, error)))

    def margins(self, gaps: np.ndarray, y: np.ndarray, orbital_momentum: float) -> tuple[np.ndarray, np.ndarray]:
        """Slips at these gaps, and the energies that shear can transfer there."""
        states = states_at(self.model, gaps, y, orbital_momentum)
        margins = dict(
            zip(self.model.names("orbital_margins"), self.model.function("orbital_margins")(states, self.p).full())
        )
        return margins["slip"], margins["slip_energy"]

    def exchange(self, gaps: np.ndarray, y: np.ndarray, energy: np.ndarray) -> np.ndarray:
        """Energy that the tangential force can still transfer from spin to orbit before each of these gaps.

        Beyond the edge of that force, only the transfer until omega = xi at the edge.
        """
        beyond = gaps > self.edge
        if self.model.strings or not beyond.any():
            return energy
        rigid = self.values("rigid_rotation", np.array([self.edge, *y[1:]]))
        if y[2] * np.sign(rigid["orbital_momentum"]) >= abs(rigid["orbital_momentum"]):
            return np.where(beyond, 0.0, energy)
        at_edge = np.array([self.edge, 0.0, *list(rigid.values())[2:]])  # orbital momentum, and spin if it is a state
        _, left = self.margins(gaps, at_edge, rigid["orbital_momentum"])
        return np.where(beyond, energy - left, energy)  # of J at most, or of J = 0

    def _work(self, edges: np.ndarray, y: np.ndarray, orbital_momentum: float) -> np.ndarray:
        """Work against the inward force from the first gap to each of the others, at the given orbital momentum."""
        return np.cumsum(panels(lambda gaps: inward(self.model, self.p, gaps, y, orbital_momentum), edges))
