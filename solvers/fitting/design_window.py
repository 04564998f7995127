"""The window of impacts that an experiment can make, and how they scatter and are measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..host.arguments import check_mapping, check_names
from ..many.arguments import checked_impact
from ..scene import units
from ..scene.fields import Field, Range
from ..scene.held import HOLDS
from ..scene.scene import Scene
from .measurements import ANGLE_SD, RESULT_SD, SPEED_SD, UNKNOWN, Measurements, rows_of

RESTITUTION = "restitution"
_ACCEPTED = '{"stokes": (0.02, 0.5), "angle": ("0 deg", "80 deg")}; also speed or relative_speed'
_FIELDS = {
    "speed": Field(
        "speed_sd", "a part of the speed", '"2 %" or 0.02', Range("from 0 to below 0.33", 0.0, 1 / 3, False)
    ),
    "angle": Field("angle_sd", "an angle", '"1 deg"', Range("from 0 to below 0.5 rad", 0.0, 0.5, False), unit="rad"),
    "restitution": Field("restitution_sd", "a standard deviation", "0.02", words=("none",)),
}
_ALONG, _ACROSS = 96, 32  # outcomes that are looked at for their changes: speeds, angles
_BESIDE = (-1.5, 0.0, 1.5)  # candidates beside a change of outcome, in standard deviations of the speed


def scatter_of(data: Measurements | None, **given: Any) -> dict[str, float | None]:
    """How planned impacts scatter and are measured: as given, else as measured ones (the median), else as `fit` has it.

    Returns:
        Standard deviations of speed (relative), angle (rad), and restitution; None where the outcome alone is recorded.

    Raises:
        InputError: no acceptable standard deviation, or none in speed and angle.
    """
    scatter: dict[str, float | None] = {"speed": SPEED_SD, "angle": ANGLE_SD, RESTITUTION: RESULT_SD[RESTITUTION]}
    if data is not None:
        values, sd = data.observed.get(RESTITUTION, (np.zeros(0), np.zeros(0)))
        medians = {"speed": data.speed_sd / data.speed, "angle": data.angle_sd, RESTITUTION: sd[np.isfinite(values)]}
        scatter = {name: float(np.median(column)) if column.size else None for name, column in medians.items()}
    if isinstance(text := given["speed"], str) and text.strip().endswith("%"):
        given["speed"] = units.number(text.strip()[:-1], "speed_sd", _FIELDS["speed"].accepts) / 100
    for name, value in given.items():
        if value is not None:
            read = _FIELDS[name].read(value)
            scatter[name] = read if isinstance(read, float) else None
    if scatter["speed"] == scatter["angle"] == 0:
        accepted = "speed_sd or angle_sd above 0: an outcome without scatter has no likelihood"
        raise InputError("speed_sd", 0, accepted)
    return scatter


@dataclass(frozen=True)
class Window:
    """Speeds (evenly in their logarithm) and angles; a point of the unit square stands for an impact.

    Attributes:
        scene: with the values for which impacts are planned.
        key: stokes, speed or relative_speed.
        speed: (2,), its ends, SI.
        angle: (2,), rad.
        scatter: of `scatter_of`.
    """

    scene: Scene
    key: str
    speed: np.ndarray
    angle: np.ndarray
    scatter: Mapping[str, Any]

    @classmethod
    def of(cls, scene: Scene, over: object, scatter: Mapping[str, Any]) -> Window:
        """The window of names and ends; what is not among them is the scene's.

        Raises:
            InputError: an unknown name, an end that is no such number, or ends in the wrong order.
        """
        given = check_mapping(over, "over", _ACCEPTED)
        check_names(list(given), (*HOLDS, "angle"), "over", "names nothing")
        (name, speed), (_, angle) = checked_impact(scene, given).items()
        for key, ends in ((name.partition(".")[2], speed), ("angle", angle)):
            if not (ends.size in (1, 2) and ends.flat[0] <= ends.flat[-1]):
                accepted = "two ends, (LO, HI) with LO at most HI, or one value"
                raise InputError(f"over {key}", given[key], accepted)
        return cls(scene, name.partition(".")[2], np.resize(speed, 2), np.resize(angle, 2), scatter)

    @property
    def extends(self) -> np.ndarray:
        """Mask (2,): which of speed and angle may be chosen."""
        return np.array([self.speed[1] > self.speed[0], self.angle[1] > self.angle[0]])

    def values(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values of the key, SI, and angles."""
        low, high = np.log(self.speed)
        speed = np.clip(np.exp(low + points[:, 0] * (high - low)), *self.speed)
        return speed, self.angle[0] + points[:, 1] * (self.angle[1] - self.angle[0])

    def plan(self, points: np.ndarray) -> Measurements:
        """The impacts as rows without observations."""
        value, angle = self.values(points)
        speed = value / self.scene.stokes_per_speed if self.key == "stokes" else value
        size, (speed_sd, angle_sd, noise) = len(points), self.scatter.values()
        observed = {} if noise is None else {RESTITUTION: (np.full(size, np.nan), np.full(size, noise))}
        return Measurements(
            speed, angle, speed_sd * speed, np.full(size, angle_sd), np.full(size, UNKNOWN), observed,
            relative=self.key == "relative_speed",
        )  # fmt: skip

    def grid(self, along: int, across: int) -> np.ndarray:
        """Points evenly over the square, its edges included, or in the middle; (points, 2), angle by angle."""
        sizes = np.where(self.extends, (along, across), 1).tolist()
        u, v = np.meshgrid(*(np.linspace(0, 1, n) if n > 1 else np.array([0.5]) for n in sizes))
        return np.column_stack([u.ravel(), v.ravel()])

    def outcomes(self, points: np.ndarray, rtol: float) -> np.ndarray:
        """Outcomes without scatter."""
        plan = self.plan(points)
        experiment = rows_of(self.scene, (), plan, rtol).unchecked(np.zeros(0))
        return experiment.outcomes(np.arange(plan.size), plan.normal_speed, plan.angle)

    def candidates(self, spacing: int, rtol: float) -> np.ndarray:
        """An even grid, and points beside the changes of outcome, which are narrower than its cells."""
        grid, fine = self.grid(spacing, spacing), self.grid(_ALONG, _ACROSS)
        if not self.extends[0]:
            return grid
        lines, places = self.outcomes(fine, rtol).reshape(-1, _ALONG), fine.reshape(-1, _ALONG, 2)
        line, k = np.nonzero(lines[:, 1:] != lines[:, :-1])
        middle = (places[line, k] + places[line, k + 1]) / 2
        sd = self.scatter["speed"] / math.log(self.speed[1] / self.speed[0])
        beside = [np.clip(middle + np.array([off * sd, 0.0]), 0, 1) for off in _BESIDE]
        return np.unique(np.vstack([grid, *beside]).round(9), axis=0)
