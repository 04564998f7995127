"""Means over relative speeds, in intervals between changes of the sequence of outcomes along the angle."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ..boundaries.brackets import locate
from ..boundaries.experiment import Experiment
from .geometry import integrals, over_angles, segments
from .speeds import Speeds

_SCAN = 24  # speeds at which the sequence is sampled, for each distribution
_COARSE = 1e-7  # rad, to which changes of outcome are enclosed for it
_LOOSE = 1e-7  # tolerance of its collisions
_CUT = 1e-6  # width to which changes of the sequence are enclosed, over the fastest speed
_INNER = 0.3  # part of the tolerance for the means over angles


def means(experiment: Experiment, pairs: int, speeds: Speeds, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Means of the rows of an experiment over impact angles and relative speeds, and errors: (pairs, columns) each."""
    along, inner = partial(over_angles, experiment, speeds.moment(2)), _INNER * tolerance
    if speeds.density is None:
        return along(np.arange(pairs), np.full(pairs, speeds.knots[0]), None, inner)
    density = speeds.density
    sequences = _Sequences(replace(experiment, rtol=max(experiment.rtol, _LOOSE)), float(speeds.knots[-1]))
    pair, ends, sharp = _intervals(sequences, pairs, speeds)
    hints = sequences.hints(pair, *ends.T)

    def columns(which: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        mean, error = along(pair[which], speed, hints[which], inner)
        weight = density(speed)[:, None]
        return weight * mean, weight * error

    return integrals(columns, pair, ends, sharp, (1 - _INNER) * tolerance, pairs)


def _intervals(sequences: _Sequences, pairs: int, speeds: Speeds) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals of speed between changes of the sequence and knots of the distribution.

    Returns:
        The pair of each, its ends, and which of them are changes: (intervals,), (intervals, 2) twice.
    """
    low, high = float(speeds.knots[0]), float(speeds.knots[-1])
    scan = low + (high - low) * (np.arange(_SCAN) + 0.5) / _SCAN
    cuts = locate(sequences, np.tile(scan, (pairs, 1)), _CUT * high, most=_SCAN)
    pair = np.concatenate([np.repeat(np.arange(pairs), speeds.knots.size), cuts.line])
    at = np.concatenate([np.tile(speeds.knots, pairs), cuts.place])
    order = np.lexsort((at, pair))
    pair, at, sharp = pair[order], at[order], order >= pairs * speeds.knots.size
    k = np.flatnonzero((pair[1:] == pair[:-1]) & (at[1:] > at[:-1]))
    return pair[k], at[np.stack([k, k + 1], axis=1)], sharp[np.stack([k, k + 1], axis=1)]


class _Sequences:
    """Sequences of outcomes along lines as numbers: the same number for the same sequence.

    A line is also sampled at angles between the changes of lines of the same pair at similar speeds, where segments are
    narrow if the sequence is about to change.
    """

    def __init__(self, experiment: Experiment, fastest: float) -> None:
        self._experiment, self._far = experiment, 3 * fastest
        self._keys, self._hints = np.zeros(0), np.zeros((0, 0))  # of all lines so far, by pair and speed

    def __call__(self, pair: np.ndarray, speed: np.ndarray) -> np.ndarray:
        hints = self.hints(pair, speed, speed) if self._keys.size else None
        parts = segments(self._experiment, pair, speed, hints, _COARSE)
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
        return np.hstack([self._hints[np.clip(index, 0, last)] for index in (above, below)])
