"""Means over the impact geometry at a relative speed: outcomes, e_n and e_t; angles have the density sin(2 theta)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .lines import RIGHT_ANGLE, Segments, segments
from .rule import RULE, Panels, summed
from .sizes import STICK, UNDECIDED, Pairs, outcome_of

WIDTH = 1e-8  # rad, to which changes are enclosed
STICKS, ROTATES, BOUNCES, NORMAL, TANGENTIAL = range(5)  # columns: shares of the outcomes, sums of e_n and e_t
COLUMNS = 5
_ROUNDS = 12  # halvings of a panel


@dataclass(frozen=True)
class Nodes:
    """Collisions of the quadrature of lines: where they are, and their weights by either rule."""

    line: np.ndarray
    angle: np.ndarray
    kronrod: np.ndarray
    gauss: np.ndarray

    @staticmethod
    def joined(parts: list[Nodes]) -> Nodes:
        columns = ("line", "angle", "kronrod", "gauss")
        return Nodes(*(np.concatenate([getattr(one, name) for one in parts]) for name in columns))

    def where(self, which: np.ndarray) -> Nodes:
        return Nodes(self.line[which], self.angle[which], self.kronrod[which], self.gauss[which])


@dataclass(frozen=True)
class OverAngles:
    """Means along lines of constant relative speed, and their errors: (lines, COLUMNS); sticks count 0 in e_n and e_t.

    Attributes:
        nodes: the collisions that separate, whose weighted sums the means are.
        segments: the parts of the lines.
        collisions: number of collisions that were computed.
    """

    mean: np.ndarray
    error: np.ndarray
    nodes: Nodes
    segments: Segments
    collisions: int


def over_angles(
    pairs: Pairs, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None, tolerance: float, rtol: float
) -> OverAngles:
    """The means of lines, each a pair (by index) at a relative speed (m/s); `hints` as for `segments`."""
    count = [0]

    def labels(line: np.ndarray, angle: np.ndarray) -> np.ndarray:
        count[0] += line.size
        return pairs.collide(pair[line], speed[line], angle, rtol, locating=True).label

    found = segments(labels, pair.size, WIDTH, hints)
    outcome, share = outcome_of(found.label), np.sin(found.high) ** 2 - np.sin(found.low) ** 2
    mean, error = np.zeros((pair.size, COLUMNS)), np.zeros((pair.size, COLUMNS))
    for k in (STICKS, ROTATES, BOUNCES):
        mean[:, k] = np.bincount(found.line, share * (outcome == k), pair.size)
    error += np.bincount(found.line, np.sin(2 * found.low) * found.width, pair.size)[:, None]
    panels = Panels.whole(np.arange(found.line.size), found.low, found.high, ~found.begins, ~found.ends)
    panels = panels.where(found.high - found.low > WIDTH)
    grazing = panels.high == RIGHT_ANGLE  # e_n varies over decades of the cosine there
    panels = Panels.joined(panels.where(~grazing), panels.where(grazing).halved())
    kept: list[Nodes] = []
    for last in (k == _ROUNDS for k in range(_ROUNDS + 1)):
        if not panels.size:
            break
        angle, length = panels.nodes(RULE)
        line = found.line[panels.of]
        lines, flat = np.repeat(line, angle.shape[1]), angle.ravel()
        count[0] += flat.size
        struck = pairs.collide(pair[lines], speed[lines], flat, rtol)
        weight = length * np.sin(2 * angle)
        expected = outcome[panels.of][:, None]
        seen = np.where(struck.label == UNDECIDED, UNDECIDED, outcome_of(struck.label)).reshape(angle.shape)
        strange = ((seen != expected) * weight * RULE.kronrod).sum(axis=1)
        values = np.stack([struck.restitution, struck.tangential]).reshape(2, *angle.shape)
        rough = (values * weight * RULE.gauss).sum(axis=2)
        fine = (values * weight * RULE.kronrod).sum(axis=2)
        difference = np.abs(fine - rough)
        missing = np.isnan(difference).any(axis=0)  # collisions that no engine completes
        done = (difference.max(axis=0) <= tolerance) & (strange <= tolerance)
        done |= last | missing | (outcome[panels.of] == STICK)
        sums = np.column_stack([strange, strange, strange, difference.T + strange[:, None]])[done]
        error += summed(line[done], sums, pair.size)
        mean[:, NORMAL:] += summed(line[done], fine.T[done], pair.size)
        use = np.repeat(done & (outcome[panels.of] != STICK), angle.shape[1])
        kept.append(Nodes(lines, flat, (weight * RULE.kronrod).ravel(), (weight * RULE.gauss).ravel()).where(use))
        panels = panels.where(~done).halved()
    return OverAngles(mean, error, Nodes.joined(kept), found, count[0])
