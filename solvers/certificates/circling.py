"""Limit of a doublet that repeatedly enters and leaves its film, less deeply in each cycle.

Outside the film and the edge of the tangential force (at gap e) no energy is lost and the orbital momentum J is
constant. In each cycle the doublet enters the film less deeply, and the tangential force brings J closer to J_e, its
value for rigid rotation at e. Both converge algebraically with the number of cycles, so integration does not reach the
limit, but the limit is known: an orbit that touches e, with J_e. If the attraction confines that orbit before rupture,
the doublet sticks; if not, it separates after finitely many cycles. The remaining radial energy does not change this
result while it is a small and not growing part of the remaining decrease of the barrier; two states of the trajectory
test this.
"""

from dataclasses import dataclass

import numpy as np

from .base import inward
from .floating import works
from .orbital_momentum import OrbitalMomentumCertificate
from .quadrature import panels

_SHALLOW = 0.1  # largest depth in the film, relative to its thickness, of a shallow cycle
_SMALL = 0.9  # largest ratio of the radial energy to the remaining decrease of the barrier
_GROWTH = 1.05  # tolerated growth of that ratio between the two states
_GAPS = 201


def limit_of_circling(proof: OrbitalMomentumCertificate, earlier: np.ndarray, y: np.ndarray) -> bool | None:
    """True if a circling doublet sticks in the limit of many cycles, False if it separates, None if undecided.

    Arguments:
        earlier, y: the model's states after some cycles and after several times as many.
    """
    first, last = _turn(proof, earlier), _turn(proof, y)
    if first is None or last is None or not last.ahead < first.ahead:
        return None
    if abs(last.barrier) < proof.margin * last.ahead:
        return None
    small = last.radial < _SMALL * last.ahead and last.radial * first.ahead <= _GROWTH * first.radial * last.ahead
    return last.barrier > 0 if small else None


@dataclass(frozen=True)
class _Turn:
    """Energies at the edge: radial motion, barrier of the limit, remaining decrease of the barrier."""

    radial: float
    barrier: float
    ahead: float


def _turn(proof: OrbitalMomentumCertificate, y: np.ndarray) -> _Turn | None:
    """Energies of a cycle; None unless it is shallow and the net force at the edge is outward."""
    model, edge = proof.model, max(proof.edge, 1.0)
    if model.strings or not model.edged or not edge < proof.end:
        return None
    there = np.array([edge, 0.0, *y[2 : len(model.state)]])
    settled = np.array(list(model.values("rigid_rotation", there, proof.p).values()))
    outward = -inward(model, proof.p, np.array([edge]), settled)[0]
    radial = float(y[1]) ** 2 / 2 - _work(proof, y, float(y[0]), edge)
    if not outward > 0 or not 0 <= radial < _SHALLOW * outward * (edge - proof.contact):
        return None
    barrier = _barrier(proof, settled, edge)
    return _Turn(radial, barrier, _barrier(proof, y, edge) - barrier)


def _work(proof: OrbitalMomentumCertificate, y: np.ndarray, start: float, end: float) -> float:
    """Work against the inward force from gap `start` to `end`."""
    return float(np.sum(works(proof.model, proof.p, y, start, end)))


def _barrier(proof: OrbitalMomentumCertificate, y: np.ndarray, edge: float) -> float:
    """The largest work against the inward force from the edge to any larger gap."""
    gaps = np.geomspace(edge, proof.end, _GAPS)
    work = np.concatenate([[0.0], np.cumsum(panels(lambda at: inward(proof.model, proof.p, at, y), gaps))])
    top = 1 + int(np.argmax(work[1:]))
    if top == work.size - 1:
        return float(work[top])
    low, high = float(gaps[top - 1]), float(gaps[top + 1])
    parts = np.linspace(low, high, _GAPS)
    pull = inward(proof.model, proof.p, parts, y)
    turns = np.flatnonzero((pull[:-1] > 0) & (pull[1:] <= 0))
    summit = float(parts[turns[0]]) if turns.size else float(gaps[top])  # an error of second order
    return float(work[top - 1]) + _work(proof, y, low, summit)
