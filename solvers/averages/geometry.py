"""Means over the impact geometry at a relative speed: outcomes, e_n and e_t; angles have the density sin(2 theta).

Along a line of constant relative speed the angles are enclosed at which what happens changes; between two of them the
results are smooth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..boundaries.brackets import Changes, locate
from ..boundaries.experiment import STEEPEST, UNDECIDED, Experiment
from .sizes import collide, labels, outcome_of

RIGHT_ANGLE = np.pi / 2
WIDTH = 1e-8  # rad, to which changes are enclosed
STICKS, ROTATES, BOUNCES, NORMAL, TANGENTIAL, ENERGY, TURNING, LOST = range(8)  # columns: shares of the outcomes, sums
# of e_n and e_t, of the normal energy that is left, of what rotations gain and of what is lost, over the energy
COLUMNS = 8
_FIRST, _DOUBLINGS = 8, 6  # parts of an interval whose ends are the first places, and numbers of them that are tried
_ASYMPTOTIC = 3  # the doubling from which on changes of an integral fall, but for noise
_MOST = 64  # changes of a line within one bracket; more are those of chatter, and are left to the quadrature
_HINTS = 4  # angles of a line that are kept to sample another one
_EVEN, _GRAZING = 30, 22  # angles at which a line is sampled: evenly, and evenly in ln cos(angle)
_FROM = 0.4  # the largest cosine of the latter
_HEAD_ON = (1e-5, 1e-4, 1e-3, 5e-3)  # rad; more of them
_GRAZING_ANGLES = np.arccos(np.geomspace(_FROM, np.cos(STEEPEST), _GRAZING))
_SAMPLED = np.concatenate([_HEAD_ON, (np.arange(_EVEN) + 0.5) * (_GRAZING_ANGLES[0] / _EVEN), _GRAZING_ANGLES])


def summed(owner: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums of the rows of `values` that have the same owner: (count, columns)."""
    return np.stack([np.bincount(owner, column, count) for column in values.T], axis=1)


def integrals(
    function: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]], owner: np.ndarray, ends: np.ndarray,
    sharp: np.ndarray | bool, tolerance: float, count: int,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Integrals of what is smooth in intervals, and their errors: sums over those of one owner, (count, columns) each.

    All intervals are integrated together, each with twice as many places until it or the sum changes by little enough.
    scipy's adaptive rules would divide all of them where one needs it.

    Arguments:
        function: indices of intervals and places in them -> values and their errors, (places, columns) each.
        owner, ends: (intervals,), (intervals, 2).
        sharp: (intervals, 2), the ends at which a function may begin as a square root; places are dense there.
        tolerance: of the sums.
    """
    (low, high), (below, above) = ends.T, np.broadcast_to(sharp, ends.shape).T
    allowed = tolerance / np.bincount(owner)[owner]
    every, even, sums = np.arange(low.size), np.zeros(0), np.zeros((3, 0, 0))
    for doubling in range(_DOUBLINGS):
        u, weight = _fejer(_FIRST << doubling)
        where = [mask[every, None] for mask in (below & above, below, above)]
        fraction = np.select(where, [u * u * (3 - 2 * u), u * u, u * (2 - u)], u)
        rate = np.select(where, [6 * u * (1 - u), 2 * u, 2 * (1 - u)], 1.0)
        length, new = (high - low)[every, None], slice(None, None, 2 if doubling else 1)
        place = low[every, None] + length * fraction[:, new]
        columns = np.stack(function(np.repeat(every, place.shape[1]), place.ravel()))
        columns = columns.reshape(2, *place.shape, columns.shape[-1])
        if doubling:
            columns, odd = np.empty((2, *fraction.shape, columns.shape[-1])), columns
            columns[:, :, ::2], columns[:, :, 1::2] = odd, even
        value, error = np.einsum("bknc,kn->bkc", columns, weight * rate * length)
        if not doubling:
            sums, even = np.stack([value, np.full(value.shape, np.inf), error]), columns
            continue
        latest = np.stack([value, np.abs(value - sums[0, every]), error])
        # what changes by more again is noise: results' errors, which grow towards a square root at an end
        noisy = (latest[1] > sums[1, every]) & (doubling >= _ASYMPTOTIC)
        sums[:, every] = np.where(noisy, sums[:, every], latest)
        total = summed(owner, sums[1], count).max(axis=1)[owner]
        coarse = (~noisy & (sums[1] > allowed[:, None])[every]).any(axis=1) & (total > tolerance)[every]  # not if NaN
        every, even = every[coarse], columns[:, coarse]
        if not every.size:
            break
    return summed(owner, sums[0], count), summed(owner, sums[1] + sums[2], count)


@cache
def _fejer(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights on (0, 1) of Fejer's second rule, whose places are among those of twice the count."""
    angle, odd = np.pi * np.arange(1, count) / count, np.arange(1, count, 2)
    return (1 - np.cos(angle)) / 2, np.sin(np.outer(angle, odd)) @ (2 / odd) * np.sin(angle) / count


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

    def subset(self, which: np.ndarray) -> Segments:
        return Segments(*(values[which] for values in vars(self).values()))

    def hints(self, lines: int) -> np.ndarray:
        """The middle of the narrowest segments of each line, rad, (lines, hints); where another line is sampled."""
        order = np.lexsort((self.high - self.low, self.line))
        rank = np.arange(order.size) - np.searchsorted(self.line, self.line[order])
        few = order[rank < _HINTS]
        hints = np.full((lines, _HINTS), RIGHT_ANGLE / 2)
        hints[self.line[few], rank[rank < _HINTS]] = (self.low[few] + self.high[few]) / 2
        return hints


def segments(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None, width: float = WIDTH
) -> Segments:
    """The segments of lines, each a pair (by index) at a relative speed (m/s).

    Arguments:
        hints: angles at which lines are sampled besides, (lines, any number).
        width: to which changes are enclosed, rad.
    """
    angles = np.tile(_SAMPLED, (pair.size, 1))
    if hints is not None:
        angles = np.sort(np.hstack([angles, hints]), axis=1)
    changes = locate(
        lambda line, angle: labels(experiment, pair[line], speed[line], angle), angles, width, UNDECIDED, _MOST
    )
    return Segments.between(changes)


def over_angles(
    experiment: Experiment, mean_square: float, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None,
    tolerance: float,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Means along lines and their errors, (lines, COLUMNS) each; sticks count 0 in e_n and e_t.

    Arguments:
        mean_square: of all relative speeds, to which energies relate.
        pair, speed, hints: as for `segments`.
    """
    parts = segments(experiment, pair, speed, hints)
    share = np.sin(parts.high) ** 2 - np.sin(parts.low) ** 2
    mean, error = np.zeros((2, pair.size, COLUMNS))
    for k in (STICKS, ROTATES, BOUNCES):
        mean[:, k] = np.bincount(parts.line, share * (outcome_of(parts.label) == k), pair.size)
    error += np.bincount(parts.line, np.sin(2 * parts.low) * parts.width, pair.size)[:, None]
    wide = parts.subset(parts.high - parts.low > WIDTH)

    def columns(which: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        line, weight = wide.line[which], np.sin(2 * angle)
        outcome, results = collide(experiment, pair[line], speed[line], angle)
        results[ENERGY - NORMAL :] *= speed[line] ** 2 / mean_square
        strange = outcome != outcome_of(wide.label[which])
        return (results * weight).T, np.tile(strange * weight, (COLUMNS - NORMAL, 1)).T

    ends = np.column_stack([wide.low, wide.high])
    value, errors = integrals(columns, wide.line, ends, True, tolerance, pair.size)
    mean[:, NORMAL:] = value
    error[:, NORMAL:] += errors
    return mean, error
