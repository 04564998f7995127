"""Parts of lines through the scatter on which the outcome agrees with the observed one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from . import changes as boundaries
from .changes import Changes
from .law import BoundLaw
from .lines import Lines


@dataclass(frozen=True)
class Segments:
    """Parts of lines where the outcome agrees with the row's.

    Attributes:
        low, high: the ends, within the errors of the changes so that the outcome is sure.
        first, last: the changes at their ends; -1 at the end of a line.
    """

    line: np.ndarray
    row: np.ndarray
    weight: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @classmethod
    def of(cls, lines: Lines, changes: Changes, allowed: np.ndarray) -> tuple[Segments, Segments]:
        """The segments on which the outcome agrees, and those on which it is not decided.

        Arguments:
            allowed: (rows, outcomes), whether an outcome agrees with the row's.
        """
        every = np.arange(lines.size)
        line = np.concatenate([every, changes.line])
        order = np.argsort(line, kind="stable")  # the first segment of a line, then those after its changes
        first = np.concatenate([np.full(lines.size, -1), np.arange(changes.size)])[order]
        line = line[order]
        outcome = np.concatenate([changes.first, changes.after])[order]
        ends = np.append(line[1:] != line[:-1], True)
        last = np.where(ends, -1, np.append(first[1:], -1))
        upper, lower = np.append(changes.y + changes.error, 0.0), np.append(changes.y - changes.error, 0.0)
        low = np.where(first < 0, lines.low[line], upper[first])
        high = np.where(last < 0, lines.high[line], lower[last])
        row = lines.row[line]
        parts = (line, row, lines.weight[line], low, high, first, last)
        agrees = np.where(outcome >= 0, allowed[row, outcome], False)
        kept = [np.flatnonzero(mask & (high > low)) for mask in (agrees, outcome < 0)]
        return cls(*(each[kept[0]] for each in parts)), cls(*(each[kept[1]] for each in parts))

    @property
    def from_change(self) -> np.ndarray:
        return self.first >= 0

    @property
    def to_change(self) -> np.ndarray:
        return self.last >= 0

    def mass(self) -> np.ndarray:
        """Probability of the scatter within each."""
        flip = self.low > 0  # the difference of two small numbers, not of two near one
        found: np.ndarray = np.where(flip, ndtr(-self.low) - ndtr(-self.high), ndtr(self.high) - ndtr(self.low))
        return found

    def mass_slopes(self, ends: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Derivatives of the logarithm of `mass`."""
        mass = np.maximum(self.mass(), 1e-300)
        density = [np.exp(-(each**2) / 2) / np.sqrt(2 * np.pi) / mass for each in (self.low, self.high)]
        found: np.ndarray = density[1][:, None] * ends[1] - density[0][:, None] * ends[0]
        return found


def moving_ends(
    law: BoundLaw, lines: Lines, changes: Changes, segments: Segments, which: np.ndarray, quick: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives by the free entries of the ends of the segments that the mask `which` tells."""
    needed = np.zeros(changes.size + 1, bool)
    for end in (segments.first, segments.last):
        needed[end[which]] = True
    needed = np.flatnonzero(needed[:-1])
    slopes = np.zeros((changes.size + 1, len(law.values)))  # the last for ends that stay
    if needed.size:
        slopes[needed] = boundaries.slopes(law, lines, changes, needed, quick)
    return slopes[segments.first], slopes[segments.last]
