"""Lines through the scatter of single impacts, along which the likelihood is integrated.

In units of the standard deviations the scatter of an impact in speed and angle is the same in all directions. A line
goes the way in which the results change fastest; across it a few Gauss-Hermite nodes are enough.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import ndtr

from .measurements import Measurements

REACH = 5.0  # standard deviations to either side within which an integral is taken
_SLOWEST = 1e-3  # least speed of a scattered impact, over the nominal one
_STEEPEST = np.radians(89.4)


@lru_cache(maxsize=16)
def hermite(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the mean over a standard normal variable."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(count)
    return nodes, weights / weights.sum()


@dataclass(frozen=True)
class Lines:
    """Lines through the scatter of rows; a point lies on one at a distance y, in standard deviations.

    Attributes:
        row: (lines,), the row of each.
        weight: (lines,), of the mean over the lines of a row, over the probability of what is a possible impact.
        speed, angle: (lines, 2), value at y = 0 and slope; the speed as it was measured.
        low, high: (lines,), the ends of what is a possible impact.
    """

    row: np.ndarray
    weight: np.ndarray
    speed: np.ndarray
    angle: np.ndarray
    low: np.ndarray
    high: np.ndarray
    relative: bool

    @classmethod
    def of(cls, data: Measurements, direction: np.ndarray, counts: np.ndarray, reach: float = REACH) -> Lines:
        """The lines of all rows.

        Arguments:
            direction: (rows,), angle from the axis of speeds to that of angles, both in standard deviations.
            counts: (rows,), number of lines of each row, 0 to leave it out; one at most where a row scatters in speed
                or angle alone.
        """
        alone = (data.speed_sd == 0) | (data.angle_sd == 0)
        direction = np.where(data.speed_sd == 0, np.pi / 2, np.where(data.angle_sd == 0, 0.0, direction))
        counts = np.where(alone, np.minimum(counts, 1), counts)
        row = np.repeat(np.arange(data.size), counts)
        nodes, weights = (np.concatenate([hermite(int(n))[k] for n in counts if n] or [np.zeros(0)]) for k in (0, 1))
        c, s = np.cos(direction[row]), np.sin(direction[row])
        speed = np.column_stack([data.speed[row] - data.speed_sd[row] * s * nodes, data.speed_sd[row] * c])
        angle = np.column_stack([data.angle[row] + data.angle_sd[row] * c * nodes, data.angle_sd[row] * s])
        low, high = np.full(row.size, -reach), np.full(row.size, reach)
        for at, least, most in ((speed, _SLOWEST * data.speed[row], np.inf), (angle, -_STEEPEST, _STEEPEST)):
            with np.errstate(divide="ignore", invalid="ignore"):
                ends = [(limit - at[:, 0]) / at[:, 1] for limit in (least, most)]
            rises, falls = at[:, 1] > 0, at[:, 1] < 0
            low = np.where(rises, np.fmax(low, ends[0]), np.where(falls, np.fmax(low, ends[1]), low))
            high = np.where(rises, np.fmin(high, ends[1]), np.where(falls, np.fmin(high, ends[0]), high))
        low, high = np.minimum(low, 0.0), np.maximum(high, 0.0)
        return cls(row, weights / (ndtr(high) - ndtr(low)), speed, angle, low, high, data.relative)

    @classmethod
    def joined(cls, parts: Sequence[Lines], row: np.ndarray) -> Lines:
        """The lines of several sets together, with rows given anew."""

        def whole(name: str) -> np.ndarray:
            return np.concatenate([getattr(each, name) for each in parts])

        ends = whole("low"), whole("high")
        return cls(row, whole("weight"), whole("speed"), whole("angle"), *ends, parts[0].relative)

    @property
    def size(self) -> int:
        return int(self.row.size)

    def at(self, line: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normal speeds (m/s) and angles (rad) of points on lines."""
        angle = self.angle[line, 0] + self.angle[line, 1] * y
        speed = self.speed[line, 0] + self.speed[line, 1] * y
        return speed * np.cos(angle) if self.relative else speed, angle

    def slopes(self, line: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Their derivatives by y."""
        angle, by_angle = self.angle[line, 0] + self.angle[line, 1] * y, self.angle[line, 1]
        by_speed = self.speed[line, 1]
        if self.relative:
            speed = self.speed[line, 0] + self.speed[line, 1] * y
            by_speed = by_speed * np.cos(angle) - speed * np.sin(angle) * by_angle
        return by_speed, np.broadcast_to(by_angle, by_speed.shape)
