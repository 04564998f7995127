"""What `critical()` returns: a speed for each material and angle, as table, JSON, CSV and picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..formatting.tables import aligned
from ..host.pictures import Drawn
from ..scene.origin import origin
from ..scene.scene import Scene
from .parameters import cell

_SPEEDS = ("relative_speed", "speed", "interval", "bounces_above", "sticks")
_UNITS = dict.fromkeys(_SPEEDS, "m/s") | {"angle": "rad", "stokes": "1"}


@dataclass(frozen=True)
class CriticalSpeed:
    """The speed up to which impacts of one material stick at one angle; speeds in m/s.

    Attributes:
        material: its name.
        angle: rad.
        searched: range of Stokes numbers of the search.
        relative_speed, speed, stokes: up to which all impacts of the range stick: magnitude of the relative velocity,
            its normal component, and Stokes number. None if the slowest do not stick, or all do.
        to: outcome just beyond.
        bounces_above: relative speed from which on all of the range bounce; None if the fastest do not, or all do.
        slowest: outcome at the lower end of the range; "" if it could not be computed.
        sticks: intervals of relative speeds that stick; the first and the last may end where the range does.
        interval: 95 % interval of `relative_speed`; None for an end that is not in the range. None without uncertain
            entries.
        gradient, elasticity: derivatives of `relative_speed` by parameter, SI.
        sentences: what the numbers leave out.
        validity: where an impact just above that speed, or else the slowest, leaves the model's range.
        failed: whether there is no answer; the first sentence says why.
    """

    material: str
    angle: float
    searched: tuple[float, float]
    relative_speed: float | None = None
    speed: float | None = None
    stokes: float | None = None
    to: str | None = None
    bounces_above: float | None = None
    slowest: str = ""
    sticks: tuple[tuple[float, float], ...] = ()
    interval: tuple[float | None, float | None] | None = None
    gradient: Mapping[str, Any] = field(default_factory=dict)
    elasticity: Mapping[str, Any] = field(default_factory=dict)
    sentences: tuple[str, ...] = ()
    validity: tuple[str, ...] = ()
    failed: bool = False


@dataclass(frozen=True)
class Critical(Drawn):
    """Critical speeds, a row for each material and angle.

    `plot` draws the relative speed up to which they stick over the angle, or by material.

    Attributes:
        scene: the scene, unless there are several materials.

    Example:
        >>> from wetdoublet.solvers import critical
        >>> critical("granulation", angle=[0.0, 0.3]).to_dict()["rows"][1]["to"]
        'bounce'
    """

    _picture = "sensitivity.plots.draw_critical"

    rows: tuple[CriticalSpeed, ...]
    scene: Scene | None
    rtol: float

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet critical --json`: the row itself if there is one, else `rows`."""
        rows = [asdict(row) for row in self.rows]
        from_where = {} if self.scene is None else origin(self.scene)
        return (rows[0] if len(rows) == 1 else {"rows": rows}) | {"rtol": self.rtol, "units": _UNITS} | from_where

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Head and rows of the table; a column without any cell is left out."""
        head = ["material", "angle (deg)", "sticks up to relative speed (m/s)", "95 % interval", "normal speed (m/s)",
                "St", "then", "bounces above relative speed (m/s)"]  # fmt: skip
        rows = [
            [row.material, f"{math.degrees(row.angle):.6g}", _number(row.relative_speed), _interval(row.interval),
             _number(row.speed), _number(row.stokes), row.to or "-", _number(row.bounces_above)]
            for row in self.rows
        ]  # fmt: skip
        columns = [k for k in range(len(head)) if any(row[k] for row in rows)]
        return [head[k] for k in columns], [[row[k] for k in columns] for row in rows]

    def __str__(self) -> str:
        head, rows = self.table()
        where = [f"{row.material} {math.degrees(row.angle):.6g} deg".strip() for row in self.rows]
        lines = aligned([head, *rows])
        lines += [f"{at}: {text}" for at, row in zip(where, self.rows, strict=True) for text in row.sentences]
        for text in dict.fromkeys(text for row in self.rows for text in row.validity):
            outside = [at for at, row in zip(where, self.rows, strict=True) if text in row.validity]
            lines.append(f"{', '.join(outside) if len(outside) < len(where) else 'throughout'}: {text}")
        names = dict.fromkeys(name for row in self.rows for name in row.gradient)
        if names:
            lines += ["", "d ln(relative speed)/d ln p (* its derivative, SI, where p is zero)"]
            slopes = [
                [name, *(cell(row.elasticity.get(name), row.gradient.get(name), "0") for row in self.rows)]
                for name in names
            ]
            lines += aligned([["", *where], *slopes])
        return "\n".join(lines)

    __repr__ = __str__  # what a notebook shows

    def columns(self) -> dict[str, list[Any]]:
        """A value for each material and angle (rad) by name; speeds in m/s."""
        names = ("material", "angle", "relative_speed", "low", "high", "speed", "stokes", "to", "bounces_above")
        records = [vars(row) | dict(zip(("low", "high"), row.interval or (None, None))) for row in self.rows]
        return {name: [record[name] for record in records] for name in names}

    def to_csv(self) -> str:
        """A row for each material and angle: speeds in m/s, angles in rad; empty where there is none."""
        from pandas import DataFrame

        speeds = ("relative_speed", "low", "high", "speed", "bounces_above")
        units = {"angle": "angle [rad]"} | {name: f"{name} [m/s]" for name in speeds}
        return str(DataFrame(self.columns()).rename(columns=units).to_csv(index=False, lineterminator="\n"))


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _interval(interval: tuple[float | None, float | None] | None) -> str:
    if interval is None:
        return ""
    low, high = interval
    if low is None or high is None:
        return "open" if low == high else f"below {high:.4g}" if low is None else f"above {low:.4g}"
    return f"{low:.4g} to {high:.4g}"
