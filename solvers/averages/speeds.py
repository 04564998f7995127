"""Distributions of the relative speeds of collisions: one speed, a Maxwellian gas, or a table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import fixed_quad

from ..errors import InputError
from ..scene import units
from ..scene.columns import columns_of
from ..scene.fields import Field, Range
from ..scene.schema import FIELDS
from ..scene.values import array

_SPEED = FIELDS["impact.relative_speed"]
_LABEL = "speeds"
_LEAST, _MOST = 1e-30, 1e30  # m/s; products of speeds and densities stay within a double's range
_GAS = Field(
    _LABEL, "the standard deviation of a particle's velocity components", '"0.3 m/s"',
    Range(f"from {_LEAST:g} to {_MOST:g}", _LEAST, _MOST, False, False), unit="m/s",
)  # fmt: skip
_PREFIX = "maxwell:"
_ACCEPTED = (
    'a relative speed as "1 m/s", "maxwell:0.3 m/s" with the standard deviation of a particle\'s velocity components, '
    "or a table of relative speeds (m/s) and their density among collisions: two arrays, or a CSV file with a header"
)
_MAXWELL = (0.0, 2.0, 4.0, 10.0)  # panels of a Maxwellian, in standard deviations; 4e-10 of the collisions are faster
_NODES = 40  # of Gauss's rule between two knots
_HEADER = ("relative_speed", "density")


@dataclass(frozen=True)
class Speeds:
    """A distribution of relative speeds among collisions.

    Attributes:
        text: what it is, in words.
        knots: where the density or its slope jumps, ascending, m/s; the first and last bound it. A single speed alone.
        density: per m/s, integral 1; None for a single speed.
    """

    text: str
    knots: np.ndarray
    density: Callable[[np.ndarray], np.ndarray] | None

    def moment(self, power: int) -> float:
        """The mean of a power of the speed over the collisions, SI; inf where it does not exist."""
        if self.density is None:
            return float(self.knots[0] ** power)
        if power < 0 and self.knots[0] == 0 and self.density(self.knots[:1])[0] > 0:
            return np.inf
        density, total = self.density, 0.0
        for low, high in pairwise(self.knots.tolist()):
            if low > 0:  # by the logarithm of the speed
                ends = np.log(low), np.log(high)
                total += fixed_quad(lambda s: density(np.exp(s)) * np.exp((power + 1) * s), *ends, n=_NODES)[0]
            else:
                total += fixed_quad(lambda speed: density(speed) * speed**power, low, high, n=_NODES)[0]
        return float(total)

    @cached_property
    def mean(self) -> float:
        """The mean relative speed of all pairs, m/s, which collide in proportion to it; NaN where they would rest."""
        inverse = self.moment(-1)
        return np.nan if np.isinf(inverse) else 1 / inverse

    @classmethod
    def of(cls, value: Any) -> Speeds:
        """The distribution that a value describes; InputError for anything else.

        Arguments:
            value: a Speeds; a number in m/s, or text with its unit; text `maxwell:` with a speed; a pair of arrays
                (speeds, densities); or a CSV file of two columns.
        """
        if isinstance(value, Speeds):
            return value
        text = value.strip().lower() if isinstance(value, str) else ""
        if text.startswith(_PREFIX):
            return maxwellian(_GAS.number(value.strip()[len(_PREFIX) :]))
        if isinstance(value, Path) or text.endswith(".csv"):
            return _table(*_columns(Path(value)))
        if value is None:
            raise InputError(_LABEL, value, _ACCEPTED, "missing")
        if isinstance(value, (tuple, list)):
            if len(value) != 2 or np.ndim(value[0]) != 1:
                raise InputError(_LABEL, value, _ACCEPTED, "is no such pair of arrays")
            return _table(array(value[0], _SPEED, _LABEL), np.asarray(value[1], dtype=float))
        speed = _SPEED.number(value, label=_LABEL)
        return cls(f"relative speed {speed:.6g} m/s", np.array([speed]), None)


def maxwellian(deviation: float) -> Speeds:
    """Relative speeds of the collisions of a gas, V^3 exp(-V^2/(4 s^2))/(8 s^4).

    Each component of the velocities of the particles, of all sizes, has the standard deviation s (m/s), the square root
    of the granular temperature; a collision is the more frequent the faster it is.
    """

    def density(speed: np.ndarray) -> np.ndarray:
        u = (speed / (2 * deviation)) ** 2
        per_speed: np.ndarray = u * speed / (2 * deviation**2) * np.exp(-u)
        return per_speed

    text = f"Maxwellian gas, velocity components of standard deviation {deviation:.6g} m/s"
    return Speeds(text, np.array(_MAXWELL) * deviation, density)


def _table(speed: np.ndarray, density: np.ndarray) -> Speeds:
    """A density that is linear between the speeds of a table, and zero elsewhere."""
    if speed.shape != density.shape or speed.ndim != 1 or speed.size < 2:
        raise InputError(_LABEL, None, _ACCEPTED, f"has {speed.size} speeds and {density.size} densities")
    if not (np.all(np.diff(speed) > 0) and speed[0] >= 0 and speed[-1] <= _MOST):
        raise InputError(_LABEL, speed, f"speeds that ascend, from 0 to {_MOST:g} m/s", "has others")
    wrong = density[~(np.isfinite(density) & (density >= 0))]
    if wrong.size or not density.any():
        first = float(wrong[0]) if wrong.size else 0.0
        problem = "is no density" if wrong.size else "is every density"
        raise InputError(_LABEL, first, "densities of 0 or more, not all of them 0", problem)
    density = density / density.max()  # so that no product overflows or vanishes
    total = float(np.trapezoid(density, speed))
    return Speeds(
        f"table of {speed.size} relative speeds from {speed[0]:.6g} to {speed[-1]:.6g} m/s",
        speed,
        lambda at: np.interp(at, speed, density / total, left=0.0, right=0.0),
    )


def _columns(path: Path) -> tuple[np.ndarray, np.ndarray]:
    accepted = f"a CSV file with the header {','.join(_HEADER)} and a speed in m/s and its density in each row"
    columns = columns_of(path, _LABEL, accepted)[0]
    if [column.name for column in columns] != list(_HEADER):
        raise InputError(_LABEL, str(path), accepted, f"has the header {','.join(column.name for column in columns)}")
    try:
        speed, density = (np.array(column.cells, dtype=float) for column in columns)
    except ValueError as error:
        raise InputError(_LABEL, str(path), accepted, f"is no such table ({error})") from None
    unit = columns[0].unit or "m/s"
    return speed * units.factor(unit, "m/s", _LABEL, "relative_speed in m/s", f"relative_speed [{unit}]"), density
