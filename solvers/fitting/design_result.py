"""The result of `design`: planned impacts, what will be known with them, and how that is shown and written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..formatting.tables import aligned
from ..host.pictures import Drawn
from ..scene.held import NAMES
from ..scene.items import csv, item
from ..scene.origin import Record, Result
from ..scene.scene import Scene
from .design_window import Window
from .free_entries import FreeEntries, in_unit, interval
from .measurements import Measurements

_QUANTILE = 1.959963984540054  # of a normal distribution, 97.5 %
_FROM_RANGE = 1.2  # growth of a standard deviation with the range of the search, from which it says nothing


class Impact(Record):
    """A planned impact."""

    count: int = item("how often it is repeated")
    stokes: float
    speed: float
    relative_speed: float
    angle: float
    probability: Mapping[str, float] = item("by outcome")


class Expected(Record):
    """What will be known of an entry: standard deviation on the scale of the fit, 95 % interval (None: open), SI."""

    sd: float
    low: float | None
    high: float | None


class Design(Result, Drawn):
    """The result of `design`: planned impacts, what they will tell, and how that is shown and written.

    `plot` draws what single impacts tell over the window, and the planned ones.

    Example:
        >>> from wetdoublet.solvers import design
        >>> planned = design("granulation", "liquid.viscosity", {"stokes": (0.05, 0.3), "angle": 0.0}, 3)
        >>> sum(each.count for each in planned.impacts)
        3
    """

    _picture = "fitting.plot_design.draw"
    _keys = "impacts expected before combinations scatter"

    window: Window
    free: FreeEntries
    values: np.ndarray
    impacts: tuple[Impact, ...] = item("by angle and speed")
    expected: Mapping[str, Expected] = item("of each free entry with these impacts and what was known before")
    before: Mapping[str, Expected] = item("the same without the impacts")
    combinations: tuple[str, ...] = item(
        "sentences on products of powers that the impacts tell better than their entries"
    )
    points: np.ndarray = item("(distinct impacts, 2), in the window: logarithm of the speed, and angle, 0 to 1")
    rtol: float
    given: Scene = item("the scene as it was given, whose units are shown")

    @property
    def scene(self) -> Scene:
        """With the values for which impacts are planned."""
        return self.window.scene

    @property
    def scatter(self) -> dict[str, Any]:
        """Standard deviations of single impacts and of the measured restitution, SI; of the speed relative."""
        return {self._speed if name == "speed" else name: sd for name, sd in self.window.scatter.items()}

    @property
    def size(self) -> int:
        return sum(impact.count for impact in self.impacts)

    def plan(self) -> Measurements:
        """The impacts as rows of measurements; outcomes unknown, restitutions NaN with their standard deviation."""
        return self.window.plan(np.repeat(self.points, [impact.count for impact in self.impacts], axis=0))

    def to_csv(self) -> str:
        """A row for each impact in the form that `fit` reads, its observations empty."""
        plan, name, noise = self.plan(), self._speed, self.scatter["restitution"]
        columns = {
            name: plan.speed, f"{name}_sd": plan.speed_sd, "angle": np.degrees(plan.angle),
            "angle_sd": np.degrees(plan.angle_sd), "outcome": "",
        }  # fmt: skip
        if noise is not None:
            columns |= {"restitution": "", "restitution_sd": noise}
        units = {name: "m/s", f"{name}_sd": "m/s", "angle": "deg", "angle_sd": "deg"}
        return csv(columns, units, float_format="%.6g")

    def __str__(self) -> str:
        scene, (sd, angle_sd, noise), speed = self.given, self.scatter.values(), NAMES[self._speed]
        rows = [("times", "St", speed, "angle", "S / SRS / B (%)")]
        rows += [
            (str(impact.count), f"{impact.stokes:.4g}", f"{getattr(impact, self._speed):.4g} m/s",
             f"{math.degrees(impact.angle):.1f} deg",
             " / ".join(f"{100 * share:.0f}" for share in impact.probability.values()))
            for impact in self.impacts
        ]  # fmt: skip
        entries: list[tuple[str, ...]] = [("entry", "expected 95 % interval", "before")]
        entries += [
            (name, *(interval(scene, name, told[name].low, told[name].high) for told in (self.expected, self.before)))
            for name in self.free.names
        ]
        values = zip(self.free.names, self.values.tolist(), strict=True)
        at = ", ".join(f"{name} = {in_unit(scene, name, value)}" for name, value in values)
        measured = "outcomes only" if noise is None else f"restitution to {noise:.3g}"
        scatter = f"scatter {100 * sd:.3g} % of the {speed}, {math.degrees(angle_sd):.3g} deg; {measured}"
        title = f"{self.size} impact{'s' * (self.size > 1)} for {', '.join(self.free.names)}"
        blocks = [title, "", *aligned(rows), "", *aligned(entries), "", f"Planned for {at}; {scatter}."]
        return "\n".join([*blocks, *self.combinations])

    __repr__ = __str__  # at the prompt

    @property
    def _speed(self) -> str:
        """Which speed is shown."""
        return self.window.key if self.window.key != "stokes" else "speed"


def expected(free: FreeEntries, values: np.ndarray, total: np.ndarray) -> dict[str, Expected]:
    """Intervals to first order; open where they would end beyond the range of a search, or follow from it alone.

    Arguments:
        total: information, without that of the range of the search.
    """
    ranges = free.vague, free.vague / 4  # the latter of a range twice as wide
    sd, wider = (np.sqrt(np.diag(np.linalg.inv(total + vague))) for vague in ranges)
    half, centre = _QUANTILE * sd, free.inner(values)
    told = (2 * half < free.high - free.low) & (wider < _FROM_RANGE * sd)
    below, above = told & (centre - half > free.low), told & (centre + half < free.high)
    low, high = (
        [value if is_end else None for value, is_end in zip(free.values(ends).tolist(), closed, strict=True)]
        for ends, closed in ((centre - half, below), (centre + half, above))
    )
    return {name: Expected(*row) for name, *row in zip(free.names, sd.tolist(), low, high, strict=True)}
