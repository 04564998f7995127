"""Brackets of changes of outcome along lines, divided until they are narrow.

The brackets of all lines are divided together: every round is one call of the sampler. Any two neighbouring samples
with different labels bracket a change, so a sample with a third label makes two brackets of one, and a strip between
two changes is found as soon as a sample lies in it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np

_ROUNDS = 60  # of division; bisection reaches the rounding of a double before
_PARTS = 16  # most parts into which a bracket is divided in a round
_OTHERS = 17  # parts where nothing is known: none of these places was tried before

Labels = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Indices of lines and places on them -> what happens there, as whole numbers; a change is where two differ."""


@dataclass(frozen=True)
class Brackets:
    """Intervals with a change: index of the line, places of the ends, and the labels there."""

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    before: np.ndarray
    after: np.ndarray

    @classmethod
    def between(cls, line: np.ndarray, place: np.ndarray, label: np.ndarray) -> Brackets:
        """The intervals between neighbouring samples of one line with different labels.

        Arguments:
            line, place, label: samples sorted by line, and by place on each.
        """
        k = np.flatnonzero((line[1:] == line[:-1]) & (label[1:] != label[:-1]))
        return cls(line[k], place[k], place[k + 1], label[k], label[k + 1])

    @classmethod
    def joined(cls, parts: Sequence[Brackets]) -> Brackets:
        """All brackets of several, sorted by line and place."""
        columns = zip(*(vars(group).values() for group in parts), strict=True)
        every = cls(*(np.concatenate(column) for column in columns))
        return every.subset(np.lexsort((every.low, every.line)))

    @property
    def size(self) -> int:
        return int(self.line.size)

    @property
    def place(self) -> np.ndarray:
        """Where the changes are: the middles."""
        middle: np.ndarray = (self.low + self.high) / 2
        return middle

    @property
    def error(self) -> np.ndarray:
        """Of `place`: half the widths."""
        half: np.ndarray = (self.high - self.low) / 2
        return half

    def subset(self, which: np.ndarray) -> Brackets:
        """The brackets of these indices, or of this mask."""
        return Brackets(*(getattr(self, field.name)[which] for field in fields(Brackets)))


def locate(
    labels: Labels,
    places: np.ndarray,
    width: float | Callable[[Brackets], np.ndarray],
    unknown: int | None = None,
    most: int | None = None,
    at_once: int = 0,
) -> Changes:
    """The changes along lines that are sampled at ascending `places` (lines, samples); other arguments as `enclose`."""
    line = np.repeat(np.arange(len(places)), places.shape[1])
    label = labels(line, places.ravel())
    indices = np.flatnonzero(np.ones(label.size, bool) if unknown is None else label != unknown)
    brackets = Brackets.between(line[indices], places.ravel()[indices], label[indices])
    closed = enclose(labels, brackets, width, at_once=at_once, unknown=unknown, most=most)
    first = label.reshape(places.shape)[:, 0].copy()
    rows, earliest = np.unique(line[indices], return_index=True)
    first[rows] = label[indices[earliest]]
    return Changes(closed.line, closed.low, closed.high, closed.before, closed.after, first)


def enclose(
    labels: Labels,
    brackets: Brackets,
    width: float | Callable[[Brackets], np.ndarray],
    *,
    at_once: int = 0,
    unknown: int | None = None,
    most: int | None = None,
    logarithmic: bool = False,
) -> Brackets:
    """Divide brackets until they are no wider than `width`; the result is sorted by line and place.

    Brackets are halved, or divided into so many parts that a round has `at_once` samples, if few are left. One in which
    no sample has a known label is divided into 17 parts; if all labels there are unknown too, it stays as it is, wider
    than asked.

    Arguments:
        width: of a bracket, as a number or a function of the brackets that returns one for each.
        unknown: label of a sample that says nothing; such samples are passed over. None if every label counts.
        most: number of brackets of a line from which on only the last of several changes within a bracket is followed.
        logarithmic: places are positive, and widths and divisions those of their logarithms.
    """
    closed: list[Brackets] = []
    undecided = np.zeros(brackets.size, int)  # rounds without a known label
    for _ in range(_ROUNDS):
        wide = np.log(brackets.high / brackets.low) if logarithmic else brackets.high - brackets.low
        done = (wide <= (width(brackets) if callable(width) else width)) | (undecided > 1)
        closed.append(brackets.subset(done))
        brackets, undecided = brackets.subset(~done), undecided[~done]
        if not brackets.size:
            break
        parts = min(_PARTS, max(2, 1 - (-at_once // brackets.size)))
        owner, place = _divisions(brackets, np.where(undecided > 0, _OTHERS, parts), logarithmic)
        label = labels(brackets.line[owner], place)
        mask = np.ones(label.size, bool) if unknown is None else label != unknown
        every = np.arange(brackets.size)
        owner = np.concatenate([every, owner[mask], every])
        place = np.concatenate([brackets.low, place[mask], brackets.high])
        label = np.concatenate([brackets.before, label[mask], brackets.after])
        decided = np.bincount(owner, minlength=brackets.size) > 2
        undecided = np.where(decided, np.minimum(undecided, 1), undecided + 1 + (parts == _PARTS))
        order = np.lexsort((place, owner))
        narrower = Brackets.between(owner[order], place[order], label[order])
        if most is not None:
            crowded = np.bincount(brackets.line)[brackets.line] >= most
            narrower = narrower.subset(~crowded[narrower.line] | np.append(np.diff(narrower.line) != 0, True))
        undecided = undecided[narrower.line]
        brackets = Brackets(brackets.line[narrower.line], narrower.low, narrower.high, narrower.before, narrower.after)
    return Brackets.joined([*closed, brackets])


@dataclass(frozen=True)
class Changes(Brackets):
    """Enclosed changes, sorted by line and place; `first` are the labels at the lower ends of the lines."""

    first: np.ndarray

    def pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The parts of the lines between changes, sorted like these.

        Returns:
            Of each part the line, the label, and the changes at its lower and upper end (-1 at an end of the line).
        """
        lines = self.first.size
        line = np.concatenate([np.arange(lines), self.line])
        order = np.argsort(line, kind="stable")  # the first part of a line, then those above its changes
        lower = np.concatenate([np.full(lines, -1), np.arange(self.size)])[order]
        line = line[order]
        last = np.append(line[1:] != line[:-1], True)
        upper = np.where(last, -1, np.append(lower[1:], -1))
        return line, np.concatenate([self.first, self.after])[order], lower, upper


def _divisions(brackets: Brackets, parts: np.ndarray, logarithmic: bool) -> tuple[np.ndarray, np.ndarray]:
    """The places that divide each bracket into equal parts, ends excluded, and the index of its bracket for each."""
    if not (logarithmic or np.any(parts - 2)):  # the usual case
        return np.arange(brackets.size), brackets.place
    owner = np.repeat(np.arange(brackets.size), parts - 1)
    number = 1 + np.arange(owner.size) - np.repeat(np.cumsum(parts - 1) - (parts - 1), parts - 1)
    fraction, low, high = number / parts[owner], brackets.low[owner], brackets.high[owner]
    place: np.ndarray = low * (high / low) ** fraction if logarithmic else low + (high - low) * fraction
    return owner, place
