"""Planned impacts, and what will be known of the entries with them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ..fitting.free_entries import COMBINED, IDENTIFIED, FreeEntries, combinations
from ..fitting.measurements import Measurements
from ..scene.scene import Scene
from .information import Information, information, reliable_information
from .search import Choice
from .window import Window

if TYPE_CHECKING:
    import xarray

_QUANTILE = 1.959963984540054
_FROM_RANGE = 1.2  # growth of a standard deviation with the range of the search, from which it says nothing
_ALONG, _ACROSS = 56, 40  # impacts of a map


@dataclass(frozen=True)
class Impact:
    """A planned impact.

    Attributes:
        count: how often it is repeated.
        stokes, speed: normal Stokes number and speed (m/s).
        relative_speed: magnitude of the relative velocity, m/s.
        angle: rad.
        probability: of stick, stick-rotate-separate and bounce.
    """

    count: int
    stokes: float
    speed: float
    relative_speed: float
    angle: float
    probability: tuple[float, float, float]


@dataclass(frozen=True)
class Expected:
    """What will be known of an entry: standard deviation on the scale of the fit, 95 % interval (None: open), SI."""

    sd: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Planned:
    """Planned impacts, and what they will tell.

    Attributes:
        impacts: by angle and speed.
        expected: of each free entry with these impacts and what was known before.
        before: the same without the impacts.
        against_grid: expected interval (in the logarithm for entries that vary so) over that of as many impacts evenly
            over the window.
        grid: number of speeds and of angles of these, their square root each where both may be chosen.
        combinations: sentences on products of powers that the impacts tell better than their entries.
        efficiency: least ratio of the criterion to that of any other choice among the candidates: of the volume's
            root for all entries, of the interval for one (with the part of the others). None where it is not known.
        target: the entry that matters; None for all.
        draws: values of the entries for which the impacts are the best on average.
        candidates: impacts among which they were chosen.
        given: the scene as it was given, whose units are shown.
        points: (distinct impacts, 2), in the window: logarithm of the speed, and angle, 0 to 1.
    """

    window: Window
    free: FreeEntries
    values: np.ndarray
    impacts: tuple[Impact, ...]
    expected: Mapping[str, Expected]
    before: Mapping[str, Expected]
    against_grid: Mapping[str, float]
    grid: tuple[int, int]
    combinations: tuple[str, ...]
    efficiency: float | None
    target: str | None
    draws: int
    candidates: int
    points: np.ndarray
    rtol: float
    given: Scene

    @classmethod
    def of(
        cls, window: Window, free: FreeEntries, values: np.ndarray, before: np.ndarray, choice: Choice,
        target: str | None, size: int, rtol: float, draws: int, given: Scene,
    ) -> Self:  # fmt: skip
        """The result for chosen impacts, by their information at these values."""
        order = np.lexsort((choice.points[:, 0], choice.points[:, 1]))
        points, counts = choice.points[order], choice.counts[order]
        rates = np.outer(free.rates(values), free.rates(values))
        single = reliable_information(window.scene, free.names, values, window.plan(points), rtol)
        side = max(1, round(math.sqrt(size))) if window.extends.all() else size
        grid = tuple(np.where(window.extends, side, 1).tolist())
        even = window.plan(window.grid(*grid))
        by_grid = reliable_information(window.scene, free.names, values, even, rtol).total.sum(axis=0)
        total = before + rates * np.einsum("c,cij->ij", counts, single.total)
        expected = _expected(free, values, total)
        spread = _spread(total + free.vague) / _spread(before + free.vague + rates * by_grid * size / even.size)
        verdicts = [COMBINED if each.low is None and each.high is None else IDENTIFIED for each in expected.values()]
        grows = free.size if target is None else 2
        efficiency = None if choice.bound is None else math.exp((choice.value - choice.bound) / grows)
        return cls(
            window, free, values, _impacts(window, points, counts, single), expected, _expected(free, values, before),
            dict(zip(free.names, spread.tolist(), strict=True)), grid,
            combinations(free, total, verdicts, "These impacts"), efficiency, target, draws, choice.candidates,
            points, rtol, given,
        )  # fmt: skip

    @property
    def size(self) -> int:
        """Number of impacts."""
        return sum(each.count for each in self.impacts)

    def plan(self) -> Measurements:
        """The impacts as rows of measurements; outcomes unknown, restitutions NaN with their standard deviation."""
        return self.window.plan(np.repeat(self.points, [each.count for each in self.impacts], axis=0))

    def map(self, along: int = _ALONG, across: int = _ACROSS) -> xarray.Dataset:
        """What a single impact tells of each entry over the window, in the variables of the fit (logarithms).

        Arguments:
            along, across: number of speeds and angles.

        Returns:
            Dataset over entry, angle and speed (by the window's name): `information`, and `by_outcome`, what the
            outcome alone tells.
        """
        import xarray as xr

        points = self.window.grid(along, across)
        single = information(self.window.scene, self.free.names, self.values, self.window.plan(points), self.rtol)
        key, angle = self.window.values(points)
        shape = np.unique(points[:, 1]).size, np.unique(points[:, 0]).size
        squares = self.free.rates(self.values) ** 2
        dims = ("entry", "angle", self.window.key)

        def of(each: np.ndarray) -> Any:
            diagonal = np.einsum("cii->ic", each) * squares[:, None]
            return dims, diagonal.reshape(-1, *shape), {"units": "1"}

        return xr.Dataset(
            {"information": of(single.total), "by_outcome": of(single.outcome)},
            coords={"entry": list(self.free.names), "angle": angle.reshape(shape)[:, 0],
                    self.window.key: key.reshape(shape)[0]},
            attrs={"name": self.window.scene.name},
        )  # fmt: skip


def _spread(total: np.ndarray) -> np.ndarray:
    spread: np.ndarray = np.sqrt(np.diag(np.linalg.inv(total)))
    return spread


def _expected(free: FreeEntries, values: np.ndarray, total: np.ndarray) -> dict[str, Expected]:
    """Intervals to first order; open where they would end beyond the range of a search, or follow from it alone.

    Arguments:
        total: information, without that of the range of the search.
    """
    expected = {}
    spread, wider = _spread(total + free.vague), _spread(total + free.vague / 4)  # of a range twice as wide
    centre, ranges = free.inner(values), free.high - free.low
    low, high = centre - _QUANTILE * spread, centre + _QUANTILE * spread
    known = (2 * _QUANTILE * spread < ranges) & (wider < _FROM_RANGE * spread)
    for k, each in enumerate(free.entries):
        below = each.outer(float(low[k])) if known[k] and low[k] > free.low[k] else None
        above = each.outer(float(high[k])) if known[k] and high[k] < free.high[k] else None
        expected[each.name] = Expected(float(spread[k]), below, above)
    return expected


def _impacts(window: Window, points: np.ndarray, counts: np.ndarray, single: Information) -> tuple[Impact, ...]:
    plan = window.plan(points)
    return tuple(
        Impact(int(count), window.scene.stokes_of(speed), speed, speed / math.cos(angle), angle, tuple(share))
        for count, speed, angle, share in zip(
            counts, plan.normal_speed.tolist(), plan.angle.tolist(), single.probability.tolist()
        )
    )
