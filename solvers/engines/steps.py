"""Recorded steps of trajectories: polynomials in the time since the start of each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Steps:
    """Steps of trajectories, a row each, in order of time within a collision.

    Attributes:
        rows: time and length (x0/v0), collision, phase (counted from 0), closing, resting, film, and the series: states
            by powers of the time since the step's start.
        turned: index of the state that is the angle turned; None if there is none.
    """

    rows: np.ndarray
    turned: int | None

    def of(self, collision: int) -> Steps:
        """The steps of one collision."""
        return Steps(self.rows[self.rows["collision"] == collision], self.turned)

    def within(self, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times at the same fractions of every step, and the states there (one row each)."""
        since = self.rows["length"][:, None] * parts
        powers = since[:, None, :] ** np.arange(self.rows["series"].shape[2])[:, None]
        states = np.moveaxis(self.rows["series"] @ powers, 1, 0)
        return (self.rows["time"][:, None] + since).ravel(), states.reshape(states.shape[0], since.size)

    def states(self, times: np.ndarray) -> np.ndarray:
        """States (one row each) of one collision at times (x0/v0) within its trajectory."""
        at = np.searchsorted(self.rows["time"], times, side="right") - 1
        at = np.clip(at, 0, self.rows.size - 1)
        series, since = self.rows["series"][at], times - self.rows["time"][at]
        sums: np.ndarray = series[:, :, -1]
        for k in range(series.shape[2] - 2, -1, -1):
            sums = sums * since[:, None] + series[:, :, k]
        return sums.T
