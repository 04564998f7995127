"""Limit of a doublet that repeatedly enters and leaves its film, less deeply in each cycle.

Beyond the film and the edge of the shear (the gap e) nothing is lost and the orbit's momentum J stays. With every turn
the dip into the film gets shallower, and the shear brings J nearer to its value J_e where the doublet turns as one body
at e; both approach their limits by powers of the number of turns. So the limit is known though no number of turns
reaches it: an orbit that just touches e, with J_e. If attraction turns that orbit back before rupture the doublet stays
a stick; if not it separates, after however many turns. What is left of the radial energy does not change this as long
as it is a small and not a growing part of what the barrier has still to lose, which two states of the trajectory show.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.contact import contact_gap
from .orbital_momentum import OrbitalMomentumCertificate
from .quadrature import panels

_SHALLOW = 0.1  # a dip is shallow below this part of the film
_SMALL = 0.9  # radial energy over the remaining decrease of the barrier: below it none escapes before the limit
_GROWTH = 1.05  # of that ratio, between two states, which counts as none
_GAPS = 201


def comes_to(proof: OrbitalMomentumCertificate, earlier: np.ndarray, y: np.ndarray) -> bool | None:
    """Whether a doublet that circles is held in the limit of many turns; None where that is not clear.

    Arguments:
        earlier, y: the model's states after some turns, and after several times as many.
    """
    first, last = _turn(proof, earlier), _turn(proof, y)
    if first is None or last is None or abs(last.barrier) < proof.margin * last.ahead:
        return None
    small = last.radial < _SMALL * last.ahead and last.radial * first.ahead <= _GROWTH * first.radial * last.ahead
    return last.barrier > 0 if small else None


@dataclass(frozen=True)
class _Turn:
    """Energies at the edge: of the radial motion, the limit's barrier, and what the barrier has still to lose."""

    radial: float
    barrier: float
    ahead: float


def _turn(proof: OrbitalMomentumCertificate, y: np.ndarray) -> _Turn | None:
    """None for a doublet that does not dip shallowly into its film, pushed outwards at the edge.

    Nor with the surface arm, whose angular momentum drifts on while the dips get shallower.
    """
    model, edge = proof.model, max(proof.edge, 1.0)
    if model.strings or proof.lever == "surface" or not model.edged or not edge < proof.end:
        return None
    state = np.array([edge, 0.0, *y[2 : len(model.state)]])
    settled = np.array(list(model.values("rigid_rotation", state, proof.p).values()))
    outward = -_inward(proof, np.array([edge]), settled)[0]
    contact = contact_gap(proof.groups)
    radial = float(y[1]) ** 2 / 2 - _work(proof, y, float(y[0]), edge)
    if not outward > 0 or not 0 <= radial < _SHALLOW * outward * (edge - contact):
        return None
    barrier = _barrier(proof, settled, edge)
    return _Turn(radial, barrier, _barrier(proof, y, edge) - barrier)


def _inward(proof: OrbitalMomentumCertificate, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
    """What pulls inward at these gaps, with the momenta of a state."""
    states = np.repeat(y[: len(proof.model.state), None], gaps.size, axis=1)
    states[0] = gaps
    force: np.ndarray = np.asarray(proof.model.function("inward_force")(states, proof.p).full())[0]
    return force


def _work(proof: OrbitalMomentumCertificate, y: np.ndarray, start: float, end: float) -> float:
    """Work against what pulls inward."""
    edges = start + (end - start) * np.linspace(0.0, 1.0, 9)
    return float(np.sum(panels(lambda gaps: _inward(proof, gaps, y), edges)))


def _barrier(proof: OrbitalMomentumCertificate, y: np.ndarray, edge: float) -> float:
    """The most work that it takes from the edge to any gap further out."""
    gaps = np.geomspace(edge, proof.end, _GAPS)
    work = np.concatenate([[0.0], np.cumsum(panels(lambda at: _inward(proof, at, y), gaps))])
    top = 1 + int(np.argmax(work[1:]))
    if top == work.size - 1:
        return float(work[top])
    low, high = float(gaps[top - 1]), float(gaps[top + 1])
    parts = np.linspace(low, high, _GAPS)
    pull = _inward(proof, parts, y)
    turns = np.flatnonzero((pull[:-1] > 0) & (pull[1:] <= 0))
    summit = float(parts[turns[0]]) if turns.size else float(gaps[top])  # flat there: the rest is of second order
    return float(work[top - 1]) + _work(proof, y, low, summit)
