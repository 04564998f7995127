"""Measured impacts as checked arrays in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ...generated.automaton import BOUNCE, OUTCOMES, ROTATE, STICK

UNKNOWN = -1
"""Code of an outcome that was not recorded."""
OBSERVED = ("restitution", "tangential_restitution", "contact_time", "rotation")
"""Results of a collision that may be measured."""
_CODES = {word: OUTCOMES.index(word) for word in (STICK, ROTATE, BOUNCE)}


@dataclass(frozen=True)
class Measurements:
    """Impacts and what was seen of them; arrays of one length, SI and radians.

    Attributes:
        speed: normal speeds, or magnitudes of the relative velocity where `relative`.
        speed_sd, angle_sd: standard deviations of the scatter of single impacts about speed and angle.
        outcome: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 not recorded.
        observed: result -> values and standard deviations of its measurement; NaN where it was not measured.
        columns: other entries that differ from row to row, by dotted name.
        remarks: sentences on what the data left to defaults.
        labels: what names a row in messages.
    """

    speed: np.ndarray
    angle: np.ndarray
    speed_sd: np.ndarray
    angle_sd: np.ndarray
    outcome: np.ndarray
    observed: Mapping[str, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)
    columns: Mapping[str, np.ndarray] = field(default_factory=dict)
    relative: bool = False
    remarks: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()

    @property
    def speed_name(self) -> str:
        """Which speed `speed` is, as entries of an impact are named."""
        return "relative_speed" if self.relative else "speed"

    @property
    def size(self) -> int:
        return int(self.speed.size)

    @property
    def separated(self) -> np.ndarray:
        """Mask of the rows of which the likelihood holds a density of a measured result."""
        seen = np.zeros(self.size, bool)
        for values, _ in self.observed.values():
            seen |= np.isfinite(values)
        found: np.ndarray = seen & (self.outcome != _CODES[STICK])
        return found

    @property
    def allowed(self) -> np.ndarray:
        """Mask (rows, outcomes) of the outcomes that agree with a row."""
        found: np.ndarray = self.outcome[:, None] == np.arange(len(OUTCOMES))
        unknown = self.outcome == UNKNOWN
        found[unknown] = np.arange(len(OUTCOMES)) != _CODES[STICK]
        return found

    def part(self, which: np.ndarray) -> Measurements:
        """The rows of these indices."""
        return replace(
            self,
            speed=self.speed[which],
            angle=self.angle[which],
            speed_sd=self.speed_sd[which],
            angle_sd=self.angle_sd[which],
            outcome=self.outcome[which],
            observed={name: (values[which], sds[which]) for name, (values, sds) in self.observed.items()},
            columns={name: values[which] for name, values in self.columns.items()},
            labels=tuple(self.labels[k] for k in which.tolist()) if self.labels else (),
        )

    def label(self, row: int) -> str:
        """What names a row in messages."""
        return self.labels[row] if self.labels else f"row {row + 1}"
