"""Means over the impact geometry at a relative speed: outcomes, e_n and e_t; angles have the density sin(2 theta).

Along a line of constant relative speed the angles are enclosed at which what happens changes; between two of them the
results are smooth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..changes.brackets import Changes, Labels, locate
from ..changes.experiment import STEEPEST, UNDECIDED, Experiment
from .rule import GAUSS, KRONROD, Panels, summed
from .sizes import collide, outcome_of

RIGHT_ANGLE = np.pi / 2
WIDTH = 1e-8  # rad, to which changes are enclosed
STICKS, ROTATES, BOUNCES, NORMAL, TANGENTIAL, ENERGY, TURNING, LOST = range(8)  # columns: shares of the outcomes, sums
# of e_n and e_t, of the normal energy that is left, of what rotations gain and of what is lost, over the energy
COLUMNS = 8
SLOPES = 5  # columns that have derivatives
_ROUNDS = 12  # halvings of a panel
_MOST = 64  # changes of a line within one bracket; more are those of chatter, and are left to the quadrature
_HINTS = 4  # angles of a line that are kept to sample another one
_EVEN, _GRAZING = 30, 22  # angles at which a line is sampled: evenly, and evenly in ln cos(angle)
_FROM = 0.4  # the largest cosine of the latter
_HEAD_ON = (1e-5, 1e-4, 1e-3, 5e-3)  # rad; more of them
_GRAZING_ANGLES = np.arccos(np.geomspace(_FROM, np.cos(STEEPEST), _GRAZING))
_SAMPLED = np.concatenate([_HEAD_ON, (np.arange(_EVEN) + 0.5) * (_GRAZING_ANGLES[0] / _EVEN), _GRAZING_ANGLES])


@dataclass(frozen=True)
class Segments:
    """Parts of lines without a change, sorted by line and angle; what happens in each has one label.

    Attributes:
        low, high: angles, rad.
        width: of the bracket of the change at `low`, rad; 0 at head-on.
    """

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    label: np.ndarray
    width: np.ndarray

    @classmethod
    def between(cls, changes: Changes) -> Segments:
        line, label, first, last = changes.pieces()
        place, width = np.append(changes.place, 0.0), np.append(2 * changes.error, 0.0)
        return cls(
            line, np.where(first < 0, 0.0, place[first]), np.where(last < 0, RIGHT_ANGLE, place[last]), label,
            np.where(first < 0, 0.0, width[first]),
        )  # fmt: skip

    def hints(self, lines: int) -> np.ndarray:
        """The middle of the narrowest segments of each line, rad, (lines, hints); where another line is sampled."""
        order = np.lexsort((self.high - self.low, self.line))
        rank = np.arange(order.size) - np.searchsorted(self.line, self.line[order])
        few = order[rank < _HINTS]
        hints = np.full((lines, _HINTS), RIGHT_ANGLE / 2)
        hints[self.line[few], rank[rank < _HINTS]] = (self.low[few] + self.high[few]) / 2
        return hints


def segments(labels: Labels, lines: int, width: float, hints: np.ndarray | None = None) -> Segments:
    """The segments of lines.

    Arguments:
        labels: of lines and angles.
        width: to which changes are enclosed, rad.
        hints: angles at which lines are sampled besides, (lines, any number).
    """
    angles = np.tile(_SAMPLED, (lines, 1))
    if hints is not None:
        angles = np.sort(np.hstack([angles, hints]), axis=1)
    return Segments.between(locate(labels, angles, width, UNDECIDED, _MOST))


@dataclass(frozen=True)
class OverAngles:
    """Means along lines of constant relative speed, and their errors: (lines, COLUMNS); sticks count 0 in e_n and e_t.

    Attributes:
        segments: the parts of the lines.
        line, angle: of the collisions that separate, whose weighted sums the means are.
        kronrod, gauss: their weights by either rule.
    """

    mean: np.ndarray
    error: np.ndarray
    segments: Segments
    line: np.ndarray
    angle: np.ndarray
    kronrod: np.ndarray
    gauss: np.ndarray


def over_angles(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None, tolerance: float
) -> OverAngles:
    """The means of lines, each a pair (by index) at a relative speed (m/s); `hints` as for `segments`."""

    def labels(line: np.ndarray, angle: np.ndarray) -> np.ndarray:
        return collide(experiment, pair[line], speed[line], angle, locating=True).label

    parts = segments(labels, pair.size, WIDTH, hints)
    outcome, share = outcome_of(parts.label), np.sin(parts.high) ** 2 - np.sin(parts.low) ** 2
    mean, error = np.zeros((pair.size, COLUMNS)), np.zeros((pair.size, COLUMNS))
    for k in (STICKS, ROTATES, BOUNCES):
        mean[:, k] = np.bincount(parts.line, share * (outcome == k), pair.size)
    error += np.bincount(parts.line, np.sin(2 * parts.low) * parts.width, pair.size)[:, None]
    panels = Panels.over(parts.low, parts.high, parts.low > 0, parts.high < RIGHT_ANGLE)
    panels = panels.part(parts.high - parts.low > WIDTH)
    grazing = panels.high == RIGHT_ANGLE  # e_n varies over decades of the cosine there
    panels = panels.part(~grazing).joined(panels.part(grazing).halved())
    kept: list[tuple[np.ndarray, ...]] = []
    for last in (k == _ROUNDS for k in range(_ROUNDS + 1)):
        angle, length = panels.nodes()
        line = parts.line[panels.owner]
        lines, flat = np.repeat(line, angle.shape[1]), angle.ravel()
        collided = collide(experiment, pair[lines], speed[lines], flat)
        weight = length * np.sin(2 * angle)
        expected = outcome[panels.owner]
        strange = ((collided.outcome.reshape(angle.shape) != expected[:, None]) * weight * KRONROD).sum(axis=1)
        values = collided.results.reshape(-1, *angle.shape)
        fine, rough = ((values * weight * rule).sum(axis=2) for rule in (KRONROD, GAUSS))
        difference = np.abs(fine - rough)
        missing = np.isnan(difference).any(axis=0)  # collisions that no engine completes
        done = (difference.max(axis=0) <= tolerance) & (strange <= tolerance)
        done |= last | missing | (expected == STICKS)
        sums = np.column_stack([strange, strange, strange, difference.T + strange[:, None]])[done]
        error += summed(line[done], sums, pair.size)
        mean[:, NORMAL:] += summed(line[done], fine.T[done], pair.size)
        use = np.repeat(done & (expected != STICKS), angle.shape[1])
        kept.append(tuple(each[use] for each in (lines, flat, (weight * KRONROD).ravel(), (weight * GAUSS).ravel())))
        panels = panels.part(~done).halved()
        if not panels.size:
            break
    return OverAngles(mean, error, parts, *(np.concatenate(each) for each in zip(*kept, strict=True)))
