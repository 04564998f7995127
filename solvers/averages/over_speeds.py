"""Means over relative speeds: panels between the speeds at which the sequence of outcomes along the angle changes."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from .geometry import COLUMNS, OverAngles, over_angles
from .lines import RIGHT_ANGLE, segments
from .rule import RULE, Panels, summed
from .sizes import Pairs
from .speeds import Speeds

_SCAN = 24  # speeds at which the sequence is looked at, for each distribution
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
    """

    pair: np.ndarray
    speed: np.ndarray
    kronrod: np.ndarray
    gauss: np.ndarray
    found: OverAngles


@dataclass(frozen=True)
class Means:
    """Means of pairs and their errors, (pairs, COLUMNS), with the lines that they were made of."""

    mean: np.ndarray
    error: np.ndarray
    collisions: int
    batches: list[Batch]


def means(pairs: Pairs, speeds: Speeds, tolerance: float, rtol: float, cut: float = CUT) -> Means:
    """The means of pairs over impact angles and relative speeds, to a tolerance."""
    inner = _INNER * tolerance / 4  # a line has some four panels
    if speeds.density is None:
        every, speed, one = np.arange(pairs.size), np.full(pairs.size, speeds.knots[0]), np.ones(pairs.size)
        found = over_angles(pairs, every, speed, None, inner, rtol)
        return Means(found.mean, found.error, found.collisions, [Batch(every, speed, one, one, found)])
    panels, own, hints, collisions = _panels(pairs, speeds, rtol, cut)
    mean, error = np.zeros((pairs.size, COLUMNS)), np.zeros((pairs.size, COLUMNS))
    batches = []
    for last in (k == _ROUNDS for k in range(_ROUNDS + 1)):
        if not panels.size:
            break
        speed, length = panels.nodes(RULE)
        of = own[panels.of]
        pair = np.repeat(of, RULE.size)
        found = over_angles(pairs, pair, speed.ravel(), np.repeat(hints[panels.of], RULE.size, axis=0), inner, rtol)
        collisions += found.collisions
        weight = (length * speeds.density(speed))[:, :, None]
        values, errors = (each.reshape(*speed.shape, COLUMNS) for each in (found.mean, found.error))
        rough = (values * weight * RULE.gauss[:, None]).sum(axis=1)
        fine = (values * weight * RULE.kronrod[:, None]).sum(axis=1)
        difference = np.abs(fine - rough)
        allowed = (1 - _INNER) * tolerance / np.bincount(of, minlength=pairs.size)[of]
        enough = (error + summed(of, difference, pairs.size)).max(axis=1) <= (1 - _INNER) * tolerance
        done = (difference.max(axis=1) <= allowed) | enough[of] | last
        within = (errors * weight * RULE.kronrod[:, None]).sum(axis=1)
        mean += summed(of[done], fine[done], pairs.size)
        error += summed(of[done], (difference + within)[done], pairs.size)
        kept = weight[:, :, 0] * done[:, None]
        batches.append(Batch(pair, speed.ravel(), (kept * RULE.kronrod).ravel(), (kept * RULE.gauss).ravel(), found))
        panels = panels.where(~done).halved()
    return Means(mean, error, collisions, batches)


def _panels(pairs: Pairs, speeds: Speeds, rtol: float, cut: float) -> tuple[Panels, np.ndarray, np.ndarray, int]:
    """Intervals of speed between changes of the sequence and knots of the distribution.

    Returns:
        The panels, which belong to intervals; the pair of each interval; angles at which its lines are sampled, from
        those at its ends, as segments that end there are narrow beside the ends; and the number of collisions.
    """
    low, high = float(speeds.knots[0]), float(speeds.knots[-1])
    scan = low + (high - low) * (np.arange(_SCAN) + 0.5) / _SCAN
    every = np.arange(pairs.size)
    look = _Look(pairs, max(rtol, _LOOSE))
    seen, hints = look(np.repeat(every, _SCAN), np.tile(scan, pairs.size))
    seen, hints = seen.reshape(pairs.size, _SCAN), hints.reshape(pairs.size, _SCAN, -1)
    of, k = np.nonzero(seen[:, 1:] != seen[:, :-1])
    brackets = _Cuts(of, scan[k], scan[k + 1], seen[of, k], seen[of, k + 1], hints[of, k], hints[of, k + 1])
    cuts = _enclosed(look, brackets, cut * high)
    count = speeds.knots.size
    plain = np.full((pairs.size * count, hints.shape[2]), RIGHT_ANGLE / 2)
    all_of = np.concatenate([np.repeat(every, count), cuts.of])
    at = np.concatenate([np.tile(speeds.knots, pairs.size), (cuts.low + cuts.high) / 2])
    below, above = np.vstack([plain, cuts.hints_low]), np.vstack([plain, cuts.hints_high])
    sharp = np.arange(at.size) >= plain.shape[0]
    order = np.lexsort((at, all_of))
    all_of, at, sharp, below, above = (each[order] for each in (all_of, at, sharp, below, above))
    made = np.flatnonzero((all_of[1:] == all_of[:-1]) & (at[1:] > at[:-1]))
    whole = Panels.whole(np.arange(made.size), at[made], at[made + 1], sharp[made], sharp[made + 1])
    return whole, all_of[made], np.hstack([above[made], below[made + 1]]), look.collisions


@dataclass(frozen=True)
class _Cuts:
    """Brackets of speeds between which the sequence changes: the pair, both ends, and the sequences and hints there."""

    of: np.ndarray
    low: np.ndarray
    high: np.ndarray
    before: np.ndarray
    after: np.ndarray
    hints_low: np.ndarray
    hints_high: np.ndarray

    def where(self, which: np.ndarray) -> _Cuts:
        return _Cuts(*(getattr(self, one.name)[which] for one in fields(self)))

    @staticmethod
    def joined(parts: list[_Cuts]) -> _Cuts:
        return _Cuts(*(np.concatenate([getattr(one, each.name) for one in parts]) for each in fields(_Cuts)))


def _enclosed(look: _Look, open_: _Cuts, width: float) -> _Cuts:
    """Bisect brackets until each is narrower than `width`; a third sequence within one makes two of it."""
    closed = [open_.where(np.zeros(open_.of.size, bool))]
    while open_.of.size:
        done = open_.high - open_.low <= width
        closed.append(open_.where(done))
        open_ = open_.where(~done)
        if not open_.of.size:
            break
        middle = (open_.low + open_.high) / 2
        seen, hints = look(open_.of, middle, np.hstack([open_.hints_low, open_.hints_high]))
        below, above = seen == open_.before, seen == open_.after
        third = ~(below | above) & (np.bincount(open_.of)[open_.of] < _SCAN)
        below |= ~(above | third)
        aside = below[:, None]
        upper = replace(open_, low=middle, before=seen, hints_low=hints).where(third)
        lower = _Cuts(
            open_.of,
            np.where(below, middle, open_.low),
            np.where(below, open_.high, middle),
            open_.before,
            np.where(third, seen, open_.after),
            np.where(aside, hints, open_.hints_low),
            np.where(aside, open_.hints_high, hints),
        )
        open_ = _Cuts.joined([lower, upper])
    return _Cuts.joined(closed)


@dataclass
class _Look:
    """What happens along lines, as a number that is the same where the same happens in the same order, and hints."""

    pairs: Pairs
    rtol: float
    collisions: int = 0

    def __call__(
        self, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        def labels(line: np.ndarray, angle: np.ndarray) -> np.ndarray:
            self.collisions += line.size
            return self.pairs.collide(pair[line], speed[line], angle, self.rtol, locating=True).label

        found = segments(labels, pair.size, _COARSE, hints)
        return np.array([hash(one) for one in found.sequences(pair.size)]), found.hints(pair.size)
