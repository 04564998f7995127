"""Straight lines over impact speed and angle, along which an outcome changes."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Lines:
    """Lines of impacts on the rows of an experiment; a point lies at a distance y along its line.

    Attributes:
        row: (lines,), the row of each.
        speed, angle: (lines, 2), value at y = 0 and its derivative by y; m/s and rad.
        low, high: (lines,), the ends of each.
        relative: `speed` is the magnitude of the relative velocity, not the normal speed.
    """

    row: np.ndarray
    speed: np.ndarray
    angle: np.ndarray
    low: np.ndarray
    high: np.ndarray
    relative: bool

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
