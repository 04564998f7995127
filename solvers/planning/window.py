"""The window of impacts that an experiment can make, and how they scatter and are measured."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import InputError, did_you_mean
from ..fitting.measurements import ANGLE_SD, RESULT_SD, SPEED_SD, UNKNOWN, Measurements, rows_of
from ..scene.scene import Scene
from ..scene.schema import FIELDS

RESTITUTION = "restitution"
SPEEDS = ("stokes", "speed", "relative_speed")
_AXES = (*SPEEDS, "angle")
_WIDEST_SPEED, _WIDEST_ANGLE = 1 / 3, 0.5
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

    @staticmethod
    def checked(speed: object, angle: object, restitution: object, default: Scatter) -> Scatter:
        """From an argument each, None for the default; "none" for a restitution that is not measured.

        Raises:
            InputError: no acceptable standard deviation, or none in speed and angle.
        """
        scatter = default
        if speed is not None:
            accepted = f'a part of the speed, 0 to below {_WIDEST_SPEED:.2g}, such as "2 %" or 0.02'
            part = _number("speed_sd", speed, accepted, lambda value: 0 <= value < _WIDEST_SPEED, True)
            scatter = replace(scatter, speed=part)
        if angle is not None:
            scatter = replace(scatter, angle=FIELDS["impact.angle"].number(angle, label="angle_sd"))
            if scatter.angle >= _WIDEST_ANGLE:
                accepted = f'an angle from 0 to below {_WIDEST_ANGLE} rad, such as "1 deg"'
                raise InputError("angle_sd", angle, accepted, "is out of range")
        if isinstance(restitution, str) and restitution.strip() == "none":
            scatter = replace(scatter, restitution=None)
        elif restitution is not None:
            accepted = 'a number > 0, or "none" where only outcomes are recorded'
            noise = _number("restitution_sd", restitution, accepted, lambda value: 0 < value < math.inf)
            scatter = replace(scatter, restitution=noise)
        if scatter.speed == scatter.angle == 0:
            accepted = "speed_sd or angle_sd above 0: an outcome without scatter has no likelihood"
            raise InputError("speed_sd", 0, accepted)
        return scatter


def _number(label: str, value: Any, accepted: str, holds: Callable[[float], bool], percent: bool = False) -> float:
    """A number, or with `percent` also text in %; InputError for anything else."""
    text = value.strip() if isinstance(value, str) else value
    try:
        in_percent = percent and isinstance(text, str) and text.endswith("%")
        number = float(text[:-1]) / 100 if in_percent else float(text)
    except (TypeError, ValueError):
        raise InputError(label, value, accepted, "is not a number") from None
    if not holds(number):
        raise InputError(label, value, accepted, "is out of range")
    return number


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
        grid = self.grid(spacing, spacing)
        if not self.extends[0]:
            return grid
        fine = self.grid(_ALONG, _ACROSS)
        lines = self.outcomes(fine, rtol).reshape(-1, _ALONG)
        line, k = np.nonzero(lines[:, 1:] != lines[:, :-1])
        middle = (k + 0.5) / (_ALONG - 1)
        sd = self.scatter.speed / math.log(self.speed[1] / self.speed[0])
        across = fine.reshape(-1, _ALONG, 2)[line, 0, 1]
        beside = [np.column_stack([np.clip(middle + off * sd, 0, 1), across]) for off in _BESIDE]
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
