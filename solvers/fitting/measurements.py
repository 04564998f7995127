"""Measured impacts as arrays in SI, and the scenes of their rows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.experiment import Rows
from ..engines.taylor.tangent import check_derivatives
from ..results import DEFINITIONS
from ..scene.scene import Scene
from .flights import FLIGHT, FlightRows, Flights

UNKNOWN = -1
"""Code of an outcome that was not recorded."""
SCATTER = ("speed", "angle")
"""What single impacts scatter in."""
SPEED_SD, ANGLE_SD = 0.02, math.radians(1.0)
"""Scatter of single impacts where the data do not give it: of the speed, relative; of the angle."""
RESULT_SD = {"restitution": 0.02, "tangential_restitution": 0.02, "contact_time": 0.05, "rotation": math.radians(2.0)}
"""Standard deviation of measured results where the data do not give it; of the contact time relative."""
OBSERVED = tuple(RESULT_SD)
"""Results of a collision that may be measured."""

_STICK = OUTCOMES.index(STICK)
UNITS = {name: DEFINITIONS[name].unit.removeprefix("1") for name in OBSERVED} | FLIGHT
CORRELATION = "correlation"
"""Column of the correlations between errors of FLIGHT: those of a lower triangle, row by row, without the diagonal."""
RESULTS = tuple(dict.fromkeys((*OBSERVED, *FLIGHT)))
"""All results that a row may have."""


@dataclass(frozen=True)
class Measurements:
    """Impacts and what was seen of them; arrays of one length, SI and radians.

    Attributes:
        speed: normal speeds, or magnitudes of the relative velocity where `relative`.
        speed_sd, angle_sd: standard deviations of the scatter of single impacts about speed and angle.
        outcome: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 not recorded.
        observed: result -> values and standard deviations of its measurement; NaN where it was not measured.
        columns: other entries that differ from row to row, by dotted name.
        flights: of impacts that were measured in free flight; `observed` are then DEPARTING, and speed and angle those
            of the line of approach at a distance.
        kind_unsaid: the name of the column does not say which speed it is.
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
    kind_unsaid: bool = False
    remarks: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()
    flights: Flights | None = None

    @property
    def speed_name(self) -> str:
        """Which speed `speed` is, as entries of an impact are named."""
        return "relative_speed" if self.relative else "speed"

    @property
    def size(self) -> int:
        return int(self.speed.size)

    @property
    def normal_speed(self) -> np.ndarray:
        """m/s."""
        return self.speed * np.cos(self.angle) if self.relative else self.speed

    @property
    def measured(self) -> np.ndarray:
        """Mask of the rows with a measured result."""
        seen = np.zeros(self.size, bool)
        for values, _ in self.observed.values():
            seen |= np.isfinite(values)
        return seen

    @property
    def separated(self) -> np.ndarray:
        """Mask of the rows of which the likelihood holds a density of a measured result."""
        return np.asarray(self.measured & (self.outcome != _STICK))

    @property
    def allowed(self) -> np.ndarray:
        """Mask (rows, outcomes) of the outcomes that agree with a row."""
        codes, outcome = np.arange(len(OUTCOMES)), self.outcome[:, None]
        return np.asarray(np.where(outcome == UNKNOWN, codes != _STICK, outcome == codes))

    def subset(self, which: np.ndarray) -> Measurements:
        """The rows of these indices."""
        alone = ("speed", "angle", "speed_sd", "angle_sd", "outcome")
        return replace(
            self,
            **{name: getattr(self, name)[which] for name in alone},
            observed={name: (values[which], sds[which]) for name, (values, sds) in self.observed.items()},
            columns={name: values[which] for name, values in self.columns.items()},
            flights=self.flights and self.flights.subset(which),
            labels=tuple(self.labels[k] for k in which.tolist()) if self.labels else (),
        )

    @classmethod
    def joined(cls, parts: Sequence[Measurements], labels: Sequence[str]) -> Measurements:
        """Several sets as one, for tables and pictures: of mixed kinds of speed the normal one; without other entries.

        Arguments:
            labels: before the rows' own.
        """
        relative, tables = all(data.relative for data in parts), []
        for data in parts:
            share = 1.0 if relative else data.normal_speed / data.speed
            table = {"speed": share * data.speed, "angle": data.angle, "speed_sd": share * data.speed_sd}
            table |= {"angle_sd": data.angle_sd, "outcome": data.outcome}
            for name, (values, sd) in data.observed.items():
                table |= {f"observed {name}": values, f"sd {name}": sd}
            tables.append(table)
        whole: dict[str, Any] = stacked(tables, [data.size for data in parts])
        observed = {
            name: (whole.pop(f"observed {name}"), whole.pop(f"sd {name}")) for name in RESULTS if f"sd {name}" in whole
        }
        about = tuple(f"{label}: {text}" for label, data in zip(labels, parts) for text in data.remarks)
        rows = tuple(f"{label}, {data.label(k)}" for label, data in zip(labels, parts) for k in range(data.size))
        return cls(**whole, observed=observed, relative=relative, remarks=about, labels=rows)

    def noisier(self, factors: Mapping[str, float]) -> Measurements:
        """The same with standard deviations of results, and of speed and angle, multiplied by these factors."""
        own = {f"{name}_sd": factors[name] * getattr(self, f"{name}_sd") for name in SCATTER if name in factors}
        observed = {name: (values, factors.get(name, 1.0) * sd) for name, (values, sd) in self.observed.items()}
        return replace(self, observed=observed, **own)

    def label(self, row: int) -> str:
        """What names a row in messages."""
        return self.labels[row] if self.labels else f"row {row + 1}"


def stacked(tables: Sequence[Mapping[str, np.ndarray]], sizes: Sequence[int]) -> dict[str, np.ndarray]:
    """Columns of tables of these sizes, one after the other; NaN where a table has no such column."""
    names = dict.fromkeys(name for table in tables for name in table)
    return {
        name: np.concatenate([data.get(name, np.full(size, np.nan)) for data, size in zip(tables, sizes, strict=True)])
        for name in names
    }


def rows_of(scene: Scene, names: tuple[str, ...], data: Measurements, rtol: float) -> Rows:
    """The scenes of the rows, with free entries; ComputationError if the kernel has no derivatives of them."""
    check_derivatives(scene, True)
    if data.flights is not None:
        return FlightRows(data.flights, scene, names, data.columns, data.size, rtol)
    return Rows(scene, names, data.columns, data.size if data.columns else 1, rtol)
