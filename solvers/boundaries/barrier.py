"""The barrier of the potential that confines a doublet, from the emitted forces: the outcome of many turns.

A doublet may enter and leave its film again and again, less deeply in each cycle. Outside the film and the edge of
the tangential force (at gap e) no energy is lost and the orbital momentum J is constant, and the tangential force
brings J closer to J_e, its value for rigid rotation at e. Both converge algebraically with the number of cycles, so
integration does not reach the limit, but the limit is known: an orbit that touches e, with J_e. If the attraction
confines that orbit before rupture, the doublet sticks; if not, it separates after finitely many cycles. The remaining
radial energy does not change this while it is a small and not growing part of the remaining decrease of the barrier;
two states of the trajectory test this.
"""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...generated.automaton import SAFETY
from ..engines.casadi.sequence import tangential_edge
from ..model.model import Model
from ..scene.groups import contact_gap

_GAPS = 201
_SHALLOW = 0.1  # largest depth in the film, relative to its thickness, of a shallow cycle
_SMALL = 0.9  # largest ratio of the radial energy to the remaining decrease of the barrier
_GROWTH = 1.05  # tolerated growth of that ratio between the two states
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class _Turn(NamedTuple):
    """Energies at the edge: radial motion, barrier of the limit, remaining decrease of the barrier."""

    radial: float
    barrier: float
    ahead: float


class Potential:
    """The potential of a model, with the momenta of a state; `p` are the values of its groups."""

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.margin = model, p, SAFETY * rtol
        self.groups = dict(zip(model.groups, p, strict=True))
        self.contact, self.rim = contact_gap(self.groups), self.groups.get("rupture_gap", 1.0)

    @cached_property
    def edge(self) -> float:
        """Gap beyond which neither film nor tangential force acts."""
        return max(tangential_edge(self.model, self.groups), 1.0)

    def limit_of_circling(self, earlier: np.ndarray, y: np.ndarray) -> bool | None:
        """True if a circling doublet sticks in the limit of many cycles, False if it separates, None if undecided.

        Arguments:
            earlier, y: the model's states after some cycles and after several times as many.
        """
        first, last = self._turn(earlier), self._turn(y)
        if first is None or last is None or not last.ahead < first.ahead:
            return None
        if abs(last.barrier) < self.margin * last.ahead:
            return None
        small = last.radial < _SMALL * last.ahead and last.radial * first.ahead <= _GROWTH * first.radial * last.ahead
        return last.barrier > 0 if small else None

    def _turn(self, y: np.ndarray) -> _Turn | None:
        """Energies of a cycle; None unless it is shallow and the net force at the edge is outward."""
        if not self.edge < self.rim:
            return None
        on_edge = np.array([self.edge, 0.0, *y[2 : len(self.model.state)]])
        settled = np.array(list(self.model.values("rigid_rotation", on_edge, self.p).values()))
        outward = -self._inward(np.array([self.edge]), settled)[0]
        radial = float(y[1]) ** 2 / 2 - self._work(y, float(y[0]), self.edge)
        if not outward > 0 or not 0 <= radial < _SHALLOW * outward * (self.edge - self.contact):
            return None
        barrier = self._barrier(settled)
        return _Turn(radial, barrier, self._barrier(y) - barrier)

    def _barrier(self, y: np.ndarray) -> float:
        """The largest work against the inward force from the edge to any larger gap."""
        gaps = np.geomspace(self.edge, self.rim, _GAPS)
        work = np.cumsum(_panels(lambda at: self._inward(at, y), gaps))
        top = int(np.argmax(work))
        if top == work.size - 1:
            return float(work[top])
        low, high = float(gaps[top]), float(gaps[top + 2])
        parts = np.linspace(low, high, _GAPS)
        pull = self._inward(parts, y)
        turns = np.flatnonzero((pull[:-1] > 0) & (pull[1:] <= 0))
        summit = float(parts[turns[0]]) if turns.size else float(gaps[top + 1])  # an error of second order
        return float(work[top - 1] if top else 0.0) + self._work(y, low, summit)

    def _work(self, y: np.ndarray, start: float, end: float) -> float:
        """Work against the inward force from gap `start` to `end`."""
        return float(np.sum(_panels(lambda at: self._inward(at, y), np.linspace(start, end, 9))))

    def _inward(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        """The emitted force at these gaps, with the momenta of a state."""
        states = np.repeat(y[: len(self.model.state), None], gaps.size, axis=1)
        states[0] = gaps
        values: np.ndarray = np.asarray(self.model.function("inward_force")(states, self.p).full())[0]
        return values


def _panels(integrand: Callable[[np.ndarray], np.ndarray], edges: np.ndarray) -> np.ndarray:
    """The integrals between neighbouring edges, by a Gauss-Legendre rule."""
    low, width = edges[:-1], np.diff(edges)
    nodes = low + np.outer(_NODES + 1, width) / 2
    integrals: np.ndarray = (_WEIGHTS @ integrand(nodes.ravel()).reshape(nodes.shape)) * width / 2
    return integrals
