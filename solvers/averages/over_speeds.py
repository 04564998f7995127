"""Means over relative speeds: panels between the speeds at which the sequence of outcomes along the angle changes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..changes.brackets import locate
from ..changes.experiment import Experiment
from .geometry import COLUMNS, ENERGY, OverAngles, over_angles, segments
from .rule import GAUSS, KRONROD, Panels, summed
from .sizes import collide
from .speeds import Speeds

_SCAN = 24  # speeds at which the sequence is sampled, for each distribution
CUT, SHARP_CUT = 1e-6, 1e-9  # width to which changes of sequence are enclosed, over the fastest speed; the derivative
# of a mean may grow as an inverse square root beside one
_COARSE = 1e-7  # rad, to which changes of outcome are enclosed for it
_LOOSE = 1e-7  # tolerance of its collisions
_ROUNDS = 10  # halvings of a panel
_INNER = 0.3  # part of the tolerance for the means over angles


@dataclass(frozen=True)
class Batch:
    """Lines, and their weights by either rule, 0 in panels that were halved.

    Attributes:
        pair: index of the pair of each line.
        speed: relative speed, m/s.
        over_angles: means along the lines.
    """

    pair: np.ndarray
    speed: np.ndarray
    kronrod: np.ndarray
    gauss: np.ndarray
    over_angles: OverAngles


def means(
    experiment: Experiment, pairs: int, speeds: Speeds, tolerance: float, cut: float = CUT
) -> tuple[np.ndarray, np.ndarray, list[Batch]]:
    """Means of pairs, the rows of an experiment, over impact angles and relative speeds, to a tolerance.

    Returns:
        Means and errors, (pairs, COLUMNS), and the lines that they are made of.
    """
    inner = _INNER * tolerance / 4  # a line has some four panels
    if speeds.density is None:
        every, speed, one = np.arange(pairs), np.full(pairs, speeds.knots[0]), np.ones(pairs)
        along = over_angles(experiment, every, speed, None, inner)
        return along.mean, along.error, [Batch(every, speed, one, one, along)]
    sequences = _Sequences(replace(experiment, rtol=max(experiment.rtol, _LOOSE)), float(speeds.knots[-1]))
    panels, pair_of, hints = _panels(sequences, pairs, speeds, cut)
    mean_square = speeds.moment(2)
    mean, error = np.zeros((pairs, COLUMNS)), np.zeros((pairs, COLUMNS))
    batches = []
    for last in (k == _ROUNDS for k in range(_ROUNDS + 1)):
        if not panels.size:
            break
        speed, length = panels.nodes()
        owner = pair_of[panels.owner]
        pair, near = np.repeat(owner, KRONROD.size), np.repeat(hints[panels.owner], KRONROD.size, axis=0)
        along = over_angles(experiment, pair, speed.ravel(), near, inner)
        weight = (length * speeds.density(speed))[:, :, None]
        values, errors = (each.reshape(*speed.shape, COLUMNS) for each in (along.mean, along.error))
        for each in (values, errors):  # energies, over the mean one
            each[:, :, ENERGY:] *= (speed**2 / mean_square)[:, :, None]
        fine, rough, within = (
            (each * weight * rule[:, None]).sum(axis=1)
            for each, rule in ((values, KRONROD), (values, GAUSS), (errors, KRONROD))
        )
        difference = np.abs(fine - rough)
        allowed = (1 - _INNER) * tolerance / np.bincount(owner, minlength=pairs)[owner]
        enough = (error + summed(owner, difference, pairs)).max(axis=1) <= (1 - _INNER) * tolerance
        done = (difference.max(axis=1) <= allowed) | enough[owner] | last
        mean += summed(owner[done], fine[done], pairs)
        error += summed(owner[done], (difference + within)[done], pairs)
        kept = weight[:, :, 0] * done[:, None]
        batches.append(Batch(pair, speed.ravel(), (kept * KRONROD).ravel(), (kept * GAUSS).ravel(), along))
        panels = panels.part(~done).halved()
    return mean, error, batches


def _panels(sequences: _Sequences, pairs: int, speeds: Speeds, cut: float) -> tuple[Panels, np.ndarray, np.ndarray]:
    """Intervals of speed between changes of the sequence and knots of the distribution.

    Returns:
        The panels, the pair of each, and the angles at which its lines are sampled.
    """
    low, high = float(speeds.knots[0]), float(speeds.knots[-1])
    scan = low + (high - low) * (np.arange(_SCAN) + 0.5) / _SCAN
    cuts = locate(sequences, np.tile(scan, (pairs, 1)), cut * high, most=_SCAN)
    pair = np.concatenate([np.repeat(np.arange(pairs), speeds.knots.size), cuts.line])
    at = np.concatenate([np.tile(speeds.knots, pairs), cuts.place])
    order = np.lexsort((at, pair))
    sharp, pair, at = order >= pairs * speeds.knots.size, pair[order], at[order]
    k = np.flatnonzero((pair[1:] == pair[:-1]) & (at[1:] > at[:-1]))
    panels = Panels.over(at[k], at[k + 1], sharp[k], sharp[k + 1])
    return panels, pair[k], sequences.hints(pair[k], at[k], at[k + 1])


class _Sequences:
    """Sequences of outcomes along lines as numbers: the same number for the same sequence.

    A line is also sampled at angles between the changes of lines of the same pair at similar speeds, where segments are
    narrow if the sequence is about to change.
    """

    def __init__(self, experiment: Experiment, fastest: float) -> None:
        self._experiment, self._far = experiment, 3 * fastest
        self._keys, self._hints = np.zeros(0), np.zeros((0, 0))  # of all lines so far, by pair and speed

    def __call__(self, pair: np.ndarray, speed: np.ndarray) -> np.ndarray:
        def labels(line: np.ndarray, angle: np.ndarray) -> np.ndarray:
            return collide(self._experiment, pair[line], speed[line], angle, locating=True).label

        hints = self.hints(pair, speed, speed) if self._keys.size else None
        parts = segments(labels, pair.size, _COARSE, hints)
        new = parts.hints(pair.size)
        keys = np.concatenate([self._keys, pair * self._far + speed])
        order = np.argsort(keys)
        self._keys, self._hints = keys[order], np.vstack([self._hints, new] if self._hints.size else [new])[order]
        first = np.searchsorted(parts.line, np.arange(pair.size + 1))
        return np.array([hash(tuple(parts.label[a:b].tolist())) for a, b in pairwise(first.tolist())])

    def hints(self, pair: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Angles of the lines next above `low` and next below `high`."""
        above = np.searchsorted(self._keys, pair * self._far + low)
        below = np.searchsorted(self._keys, pair * self._far + high, side="right") - 1
        last = self._keys.size - 1
        return np.hstack([self._hints[np.clip(each, 0, last)] for each in (above, below)])
