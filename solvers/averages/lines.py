"""What happens along lines of constant relative speed: the impact angles at which it changes, enclosed by collisions.

Many lines are treated together: every round is one call of the kernel for the brackets of all lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .sizes import STEEPEST, UNDECIDED

_EVEN, _GRAZING = 30, 22  # angles at which a line is sampled: evenly, and evenly in ln cos(angle)
_FROM = 0.4  # the largest cosine of the latter
_HEAD_ON = (1e-5, 1e-4, 1e-3, 5e-3)  # rad; more of them
_HINTS = 4  # angles of a line that are kept to sample another one
_ROUNDS = 60
_MOST_BRACKETS = 64  # of a line; more changes are those of chatter, and are left to the quadrature
_ASIDE = (0.5, 0.41, 0.63)  # parts of a bracket tried in turn while collisions there are undecided

RIGHT_ANGLE = np.pi / 2
Labels = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(lines, angles) -> labels."""


@dataclass(frozen=True)
class Segments:
    """Parts of lines without a change, sorted by line and angle; what happens in each has one label.

    Attributes:
        line: index of the line.
        low, high: angles, rad.
        label: of its collisions.
        width: of the bracket of the change at `low`, rad; 0 at head-on.
    """

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    label: np.ndarray
    width: np.ndarray

    @property
    def begins(self) -> np.ndarray:
        """Mask of segments that begin head-on."""
        found: np.ndarray = self.low == 0
        return found

    @property
    def ends(self) -> np.ndarray:
        """Mask of segments that end at grazing incidence."""
        found: np.ndarray = self.high == RIGHT_ANGLE
        return found

    def sequences(self, lines: int) -> list[tuple[int, ...]]:
        """The labels along each line."""
        first = np.searchsorted(self.line, np.arange(lines + 1))
        return [tuple(self.label[a:b].tolist()) for a, b in pairwise(first.tolist())]

    def hints(self, lines: int) -> np.ndarray:
        """The middle of the narrowest segments of each line, rad, (lines, _HINTS); where another line is sampled."""
        order = np.lexsort((self.high - self.low, self.line))
        rank = np.arange(order.size) - np.searchsorted(self.line, self.line[order])
        few = order[rank < _HINTS]
        found = np.full((lines, _HINTS), RIGHT_ANGLE / 2)
        found[self.line[few], rank[rank < _HINTS]] = (self.low[few] + self.high[few]) / 2
        return found


def sampled_angles() -> np.ndarray:
    """Angles at which every line is sampled, ascending, rad."""
    grazing = np.arccos(np.geomspace(_FROM, math.cos(STEEPEST), _GRAZING))
    return np.concatenate([_HEAD_ON, (np.arange(_EVEN) + 0.5) * (grazing[0] / _EVEN), grazing])


def segments(labels: Labels, lines: int, width: float, hints: np.ndarray | None = None) -> Segments:
    """The segments of lines.

    Arguments:
        width: to which changes are enclosed, rad.
        hints: angles at which lines are sampled besides, (lines, any number).
    """
    angles = np.tile(sampled_angles(), (lines, 1))
    if hints is not None:
        angles = np.sort(np.hstack([angles, hints]), axis=1)
    seen = labels(np.repeat(np.arange(lines), angles.shape[1]), angles.ravel()).reshape(angles.shape)
    seen = _without_gaps(seen)
    line, k = np.nonzero(seen[:, 1:] != seen[:, :-1])
    open_ = _Brackets(line, angles[line, k], angles[line, k + 1], seen[line, k], seen[line, k + 1])
    found = _enclosed(labels, open_, lines, width)
    entry_line = np.concatenate([np.arange(lines), found.line])
    entry_low = np.concatenate([np.zeros(lines), (found.low + found.high) / 2])
    entry_label = np.concatenate([seen[:, 0], found.after])
    entry_width = np.concatenate([np.zeros(lines), found.high - found.low])
    order = np.lexsort((entry_low, entry_line))
    own, low = entry_line[order], entry_low[order]
    last = np.append(own[1:] != own[:-1], True)
    high = np.where(last, RIGHT_ANGLE, np.append(low[1:], RIGHT_ANGLE))
    return Segments(own, low, high, entry_label[order], entry_width[order])


def _without_gaps(seen: np.ndarray) -> np.ndarray:
    """Labels of lines with undecided ones replaced by the nearest decided one before, or after."""
    place = np.where(seen != UNDECIDED, np.arange(seen.shape[1]), -1)
    before = np.maximum.accumulate(place, axis=1)
    first = np.argmax(seen != UNDECIDED, axis=1)
    filled: np.ndarray = np.take_along_axis(seen, np.where(before < 0, first[:, None], before), axis=1)
    return filled


@dataclass(frozen=True)
class _Brackets:
    """Brackets of changes: the line, angles below and above, and the labels there."""

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    before: np.ndarray
    after: np.ndarray

    def where(self, which: np.ndarray) -> _Brackets:
        return _Brackets(self.line[which], self.low[which], self.high[which], self.before[which], self.after[which])

    @staticmethod
    def joined(*parts: _Brackets) -> _Brackets:
        columns = ("line", "low", "high", "before", "after")
        return _Brackets(*(np.concatenate([getattr(one, name) for one in parts]) for name in columns))


def _enclosed(labels: Labels, open_: _Brackets, lines: int, width: float) -> _Brackets:
    """Bisect brackets until each is narrower than `width`; a third label within one makes two of it."""
    closed = [open_.where(np.zeros(open_.line.size, bool))]
    tries = np.zeros(open_.line.size, int)
    for _ in range(_ROUNDS):
        done = (open_.high - open_.low <= width) | (tries >= len(_ASIDE))
        closed.append(open_.where(done))
        open_, tries = open_.where(~done), tries[~done]
        if not open_.line.size:
            break
        middle = open_.low + np.take(_ASIDE, tries) * (open_.high - open_.low)
        seen = labels(open_.line, middle)
        unknown, low, high = seen == UNDECIDED, seen == open_.before, seen == open_.after
        third = ~(unknown | low | high)
        crowded = np.bincount(open_.line, minlength=lines)[open_.line] >= _MOST_BRACKETS
        low |= third & crowded
        third &= ~crowded
        tries = np.where(unknown, tries + 1, 0)
        upper = _Brackets(open_.line, middle, open_.high, seen, open_.after).where(third)
        open_ = _Brackets(
            open_.line,
            np.where(low, middle, open_.low),
            np.where(high | third, middle, open_.high),
            open_.before,
            np.where(third, seen, open_.after),
        )
        open_, tries = _Brackets.joined(open_, upper), np.append(tries, np.zeros(upper.line.size, int))
    return _Brackets.joined(*closed, open_)
