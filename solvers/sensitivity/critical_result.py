"""Critical speeds as data, texts and a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...generated.automaton import BOUNCE, STICK
from ..boundaries.changes import Change
from ..formatting.markdown import aligned
from ..scene.origin import origin
from ..scene.scene import Scene

if TYPE_CHECKING:
    import pandas as pd

_SPEEDS = ("relative_speed", "speed", "interval", "bounces_above", "sticks")
_UNITS = dict.fromkeys(_SPEEDS, "m/s") | {"angle": "rad", "stokes": "1"}


@dataclass(frozen=True)
class CriticalSpeed:
    """The speed up to which impacts of one material stick at one angle.

    Attributes:
        label: name of the material.
        angle: rad.
        window: range of Stokes numbers of the search.
        speed_per_stokes: normal speed at St 1, m/s.
        changes: all changes of outcome in the range, ascending.
        slowest: outcome at the lower end of the range; "" if it could not be computed.
        interval: 95 % interval of `relative_speed`, m/s; None for an end that is not in the range. None without
            uncertain entries.
        gradient, elasticity: derivatives of `relative_speed` by parameter, SI.
        remarks: sentences.
        reason: why there is no answer.
    """

    label: str
    angle: float
    window: tuple[float, float]
    speed_per_stokes: float
    changes: tuple[Change, ...] = ()
    slowest: str = ""
    interval: tuple[float | None, float | None] | None = None
    gradient: Mapping[str, Any] = field(default_factory=dict)
    elasticity: Mapping[str, Any] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    reason: str = ""

    @property
    def change(self) -> Change | None:
        """The change at which impacts cease to stick that stick from the slowest of the range on; None without one."""
        return self.changes[0] if self.changes and self.changes[0].before == STICK else None

    @property
    def stokes(self) -> float | None:
        """Stokes number up to which they stick; None if the slowest do not, or all do."""
        return None if self.change is None else self.change.stokes

    @property
    def speed(self) -> float | None:
        """Normal speed up to which they stick, m/s."""
        return None if self.stokes is None else self.stokes * self.speed_per_stokes

    @property
    def relative_speed(self) -> float | None:
        """Magnitude of the relative velocity up to which they stick, m/s."""
        return None if self.stokes is None else self._relative(self.stokes)

    @property
    def to(self) -> str | None:
        """Outcome just beyond."""
        return None if self.change is None else self.change.after

    @property
    def bounces_above(self) -> float | None:
        """Relative speed (m/s) from which on all of the range bounce; None if the fastest do not, or all do."""
        last = self.changes[-1] if self.changes else None
        return self._relative(last.stokes) if last is not None and last.after == BOUNCE else None

    @property
    def sticks(self) -> tuple[tuple[float, float], ...]:
        """Intervals of Stokes numbers that stick; the first and the last may end where the range does."""
        before = [self.slowest, *(one.after for one in self.changes)]
        ends = [self.window[0], *(one.stokes for one in self.changes), self.window[1]]
        return tuple((ends[k], ends[k + 1]) for k, outcome in enumerate(before) if outcome == STICK)

    def _relative(self, stokes: float) -> float:
        return stokes * self.speed_per_stokes / math.cos(self.angle)

    def sentences(self) -> list[str]:
        """What the numbers leave out, in words."""
        low, high = self.window
        speeds = " to ".join(f"{self._relative(each):.4g}" for each in self.window)
        searched = f"St {low:g} to {high:g} (relative speed {speeds} m/s)"
        if self.reason:
            return [self.reason, *self.remarks]
        found = []
        if not self.changes:
            found.append(f"no change in the range that was searched: {self.slowest} for all of {searched}")
        elif self.change is None:
            found.append(f"the slowest do not stick: {self.slowest} from the lower end of the range on, {searched}")
        for a, b in self.sticks[self.change is not None :] if self.changes else ():
            more = "again " if self.change is not None else ""
            found.append(f"sticks {more}from {self._relative(a):.4g} to {self._relative(b):.4g} m/s (relative speed)")
        if self.changes and self.bounces_above is None:
            found.append(f"no speed from which on all bounce, {searched}")
        if self.interval is not None and None in self.interval:
            which = "all stick" if self.interval[1] is None else "not even the slowest stick"
            found.append(f"in more than 2.5 % of the draws {which} in the range, {searched}")
        return [*found, *self.remarks]

    def to_dict(self) -> dict[str, Any]:
        """The row in JSON; SI."""
        return {
            "material": self.label, "angle": self.angle, "relative_speed": self.relative_speed, "speed": self.speed,
            "stokes": self.stokes, "to": self.to, "interval": None if self.interval is None else list(self.interval),
            "bounces_above": self.bounces_above, "slowest": self.slowest or None,
            "sticks": [[self._relative(each) for each in ends] for ends in self.sticks],
            "searched": list(self.window), "gradient": dict(self.gradient), "elasticity": dict(self.elasticity),
            "sentences": self.sentences(),
        }  # fmt: skip


@dataclass(frozen=True)
class Critical:
    """Critical speeds, a row for each material and angle.

    Attributes:
        scene: the scene, unless there are several materials.

    Example:
        >>> from wetdoublet.solvers import critical
        >>> critical("granulation", angle=[0.0, 0.5]).to_dict()["rows"][1]["to"]
        'bounce'
    """

    rows: tuple[CriticalSpeed, ...]
    scene: Scene | None
    rtol: float

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet critical --json`: the row itself if there is one, else `rows`."""
        rows = [each.to_dict() for each in self.rows]
        from_where = {} if self.scene is None else origin(self.scene)
        return (rows[0] if len(rows) == 1 else {"rows": rows}) | {"rtol": self.rtol, "units": _UNITS} | from_where

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Head and rows of the table; a column without any cell is left out."""
        head = ["material", "angle (deg)", "sticks up to relative speed (m/s)", "95 % interval", "normal speed (m/s)",
                "St", "then", "bounces above relative speed (m/s)"]  # fmt: skip
        rows = [
            [one.label, f"{math.degrees(one.angle):.6g}", _number(one.relative_speed), _interval(one.interval),
             _number(one.speed), _number(one.stokes), one.to or "-", _number(one.bounces_above)]
            for one in self.rows
        ]  # fmt: skip
        kept = [k for k in range(len(head)) if any(row[k] for row in rows)]
        return [head[k] for k in kept], [[row[k] for k in kept] for row in rows]

    def __str__(self) -> str:
        head, rows = self.table()
        where = [f"{one.label} {math.degrees(one.angle):.6g} deg".strip() for one in self.rows]
        lines = aligned([head, *rows])
        lines += [f"{at}: {text}" for at, one in zip(where, self.rows, strict=True) for text in one.sentences()]
        names = dict.fromkeys(name for one in self.rows for name in one.gradient)
        if names:
            lines += ["", "d ln(relative speed)/d ln p (* its derivative, SI, where p is zero)"]
            lines += aligned([["", *where], *([name, *(_slope(one, name) for one in self.rows)] for name in names)])
        return "\n".join(lines)

    def to_pandas(self) -> pd.DataFrame:
        """A row for each material and angle (rad); speeds in m/s."""
        from ..formatting.frames import frame

        names = ("material", "angle", "relative_speed", "low", "high", "speed", "stokes", "to", "bounces_above")
        records = [one.to_dict() | dict(zip(("low", "high"), one.interval or (None, None))) for one in self.rows]
        return frame({name: [each[name] for each in records] for name in names})

    def _repr_html_(self) -> str:
        from ..formatting.notebook import view

        head, rows = self.table()
        return view("critical speeds", rows, head, [text for one in self.rows for text in one.sentences()])

    def plot(self, path: str | Path | None = None) -> Any:
        """Draw the relative speed up to which they stick over the angle, or by material; returns the Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
        """
        from ..host.pictures import saved
        from .critical_plot import draw

        return saved(lambda: draw(self), path)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _interval(interval: tuple[float | None, float | None] | None) -> str:
    if interval is None:
        return ""
    low, high = interval
    if low is None or high is None:
        return "open" if low == high else f"below {high:.4g}" if low is None else f"above {low:.4g}"
    return f"{low:.4g} to {high:.4g}"


def _slope(one: CriticalSpeed, name: str) -> str:
    if name not in one.gradient:
        return "-"
    elasticity = one.elasticity[name]
    return f"{elasticity:.5g}" if elasticity is not None else f"* {one.gradient[name]:.4g}"
