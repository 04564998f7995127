"""The window of impacts that an experiment can make, and how they scatter and are measured."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError, did_you_mean
from ..fitting.measurements import ANGLE_SD, RESULT_SD, SPEED_SD, UNKNOWN, Measurements, rows_of
from ..scene import units
from ..scene.fields import Field, Range
from ..scene.scene import Scene
from ..scene.schema import FIELDS

RESTITUTION = "restitution"
SPEEDS = ("stokes", "speed", "relative_speed")
_AXES = (*SPEEDS, "angle")
_THIRD, _HALF = (
    Range(f"from 0 to below {most}", 0.0, end, low_open=False) for most, end in (("0.33", 1 / 3), ("0.5 rad", 0.5))
)
_SPEED_SD = Field("speed_sd", "a part of the speed", '"2 %" or 0.02', _THIRD)
_ANGLE_SD = Field("angle_sd", "an angle", '"1 deg"', _HALF, unit="rad")
_NOISE = Field("restitution_sd", "a standard deviation", "0.02", words=("none",))
_ALONG, _ACROSS = 96, 32  # outcomes that are looked at for their changes: speeds, angles
_BESIDE = (-1.5, 0.0, 1.5)  # candidates beside a change of outcome, in standard deviations of the speed


@dataclass(frozen=True)
class Scatter:
    """How planned impacts scatter and how they are measured.

    Attributes:
        speed: standard deviation, relative.
        angle: rad.
        restitution: of the measured restitution; None where the outcome alone is recorded.
    """

    speed: float = SPEED_SD
    angle: float = ANGLE_SD
    restitution: float | None = RESULT_SD[RESTITUTION]

    @classmethod
    def typical(cls, data: Measurements) -> Scatter:
        """The median of measured impacts."""
        noise = None
        if RESTITUTION in data.observed:
            values, sd = data.observed[RESTITUTION]
            noise = float(np.median(sd[np.isfinite(values)])) if np.isfinite(values).any() else None
        return cls(float(np.median(data.speed_sd / data.speed)), float(np.median(data.angle_sd)), noise)

    @classmethod
    def checked(cls, speed: object, angle: object, restitution: object, default: Scatter) -> Scatter:
        """From an argument each, None for the default; "none" for a restitution that is not measured.

        Raises:
            InputError: no acceptable standard deviation, or none in speed and angle.
        """
        if isinstance(speed, str) and speed.strip().endswith("%"):
            speed = units.number(speed.strip()[:-1], "speed_sd", _SPEED_SD.accepts) / 100
        noise: Any = default.restitution if restitution is None else _NOISE.read(restitution)
        scatter = cls(
            default.speed if speed is None else _SPEED_SD.number(speed),
            default.angle if angle is None else _ANGLE_SD.number(angle),
            None if noise == "none" else noise,
        )
        if scatter.speed == scatter.angle == 0:
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
    """

    scene: Scene
    key: str
    speed: tuple[float, float]
    angle: tuple[float, float]
    scatter: Scatter

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
        size, scatter = len(points), self.scatter
        observed = {}
        if scatter.restitution is not None:
            observed[RESTITUTION] = np.full(size, np.nan), np.full(size, scatter.restitution)
        return Measurements(
            speed, angle, scatter.speed * speed, np.full(size, scatter.angle), np.full(size, UNKNOWN), observed,
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
        sd = self.scatter.speed / math.log(self.speed[1] / self.speed[0])
        beside = [np.clip(middle + np.array([off * sd, 0.0]), 0, 1) for off in _BESIDE]
        return np.unique(np.vstack([grid, *beside]).round(9), axis=0)


def check_over(over: object) -> tuple[str, tuple[float, float], tuple[float, float]]:
    """The window of `over`: key, its ends in SI, and the ends of the angle.

    Raises:
        InputError: an unknown name, an end that is no such number, or ends in the wrong order.
    """
    accepted = 'a mapping {"stokes": (0.02, 0.5), "angle": ("0 deg", "80 deg")}; also speed or relative_speed'
    if not isinstance(over, Mapping) or not over:
        raise InputError("over", over, accepted)
    for name in over:
        if name not in _AXES:
            raise InputError("over", name, ", ".join(_AXES), "is not known" + did_you_mean(name, _AXES))
    keys = [name for name in SPEEDS if name in over]
    if len(keys) != 1:
        raise InputError("over", ", ".join(over), f"one of {', '.join(SPEEDS)}, and angle")
    if "angle" not in over:
        raise InputError("over", ", ".join(over), "angle=LO:HI beside it, or angle=VALUE", "lacks the angle")
    return keys[0], _ends(over, keys[0]), _ends(over, "angle")


def _ends(over: Mapping[str, Any], name: str) -> tuple[float, float]:
    value = over[name]
    several = isinstance(value, Sequence | np.ndarray) and not isinstance(value, str)
    ends = list(value) if several else [value, value]
    if len(ends) != 2:
        raise InputError(f"over {name}", value, "two ends, (LO, HI), or one value")
    low, high = (FIELDS[f"impact.{name}"].number(end, label=f"over {name}") for end in ends)
    if low > high:
        raise InputError(f"over {name}", value, "LO at most HI", "is not a range")
    return low, high
