"""Panels of gap, velocity and rotation of a collision over time.

The approach takes a small part of the time of a pair that rotates before it separates; it then has a column of its own.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator
from matplotlib.transforms import blended_transform_factory

from ....generated.automaton import CRITERIA
from ...formatting import ticks
from ...scene.groups import GAPS, scaled
from ..outcome import Outcome
from ..text import ends_early, prefix, quantity
from .frames import Frame
from .strip import INK

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#6E6E6E"  # Okabe-Ito
_ZOOM = 5.0  # the approach has its own column if the collision lasts longer than this many approaches
_NEXT = 2.6  # this column extends to the next event if that comes within this many approaches
_DECADE = 10.0  # gaps whose largest and smallest values differ by more are drawn on a logarithmic axis
_LETTER = 0.078  # width of a character of an event's label, inches
_MANY, _LABELS = 50, 6  # most lines and labels of events in a column
_RATES = ("rotation_rate", "spin", "spin_partner")


@dataclass(frozen=True)
class Column:
    """An interval of time and its panels: gap, normal velocity and, if oblique, rotation rates and angle."""

    start: float
    end: float
    title: str
    panels: Sequence[Axes]
    width: float  # approximate, inches
    shaded: float = 0.0  # until this time another column shows more detail

    @property
    def unit(self) -> tuple[float, str]:
        factor, name = prefix(self.end)
        return factor, micro(name + "s")

    def shows(self, time: float) -> bool:
        return (self.shaded < time or not self.shaded) and time <= self.end


def columns_of(
    figure: Figure, place: Any, collision: Outcome, rows: int, heights: Sequence[float] | None = None
) -> list[Column]:
    """Empty panels for a trajectory in a cell of the figure's grid; the whole of it is the last column."""
    assert collision.trajectory is not None
    duration = float(collision.trajectory["time"][-1])
    zoom = _zoom(collision, duration)
    widths = [1, 1.7] if zoom else [1]
    grid = place.subgridspec(rows, len(widths), width_ratios=widths, height_ratios=heights)
    panels = [[figure.add_subplot(grid[row, column]) for row in range(rows)] for column in range(grid.ncols)]
    whole = Column(0.0, duration, "whole trajectory" if zoom else "", panels[-1], 5.0 if zoom else 8.0, zoom or 0.0)
    return [Column(0.0, zoom, "approach", panels[0], 2.9), whole] if zoom else [whole]


def time_panels(figure: Figure, place: Any, collision: Outcome, rows: int, pictures: Sequence[Frame]) -> None:
    """Draw the trajectory into a cell of the figure's grid, `rows` panels high; mark the instants of `pictures`."""
    assert collision.trajectory is not None
    columns = columns_of(figure, place, collision, rows)
    whole = columns[-1]
    for column in columns:
        _fill(column, collision, rows, last=column is whole)
        finish(column, collision)
    _match(columns, np.asarray(collision.trajectory["time"]))
    for row, text in ((0, "a"), (2, "b")):
        if row < rows:
            letter(columns[0].panels[row], text)
    for column in columns:
        figure.align_ylabels(column.panels)
    if rows == 4 and not collision.scene.wall:
        dots = [(frame.time / whole.unit[0], math.degrees(frame.angle)) for frame in pictures if not frame.free]
        whole.panels[3].plot(*zip(*dots), "o", color=INK, markersize=4, fillstyle="none")


def _zoom(collision: Outcome, duration: float) -> float | None:
    """End of the approach's column, s; None if it would show the whole trajectory."""
    times = [event.time for event in collision.events if event.time > 0]
    if not times or duration < _ZOOM * times[0]:
        return None
    end = times[0]
    for later in times[1:]:
        if later <= _NEXT * times[0]:
            end = later
    return end if duration > _ZOOM / 2 * end else None


def _fill(column: Column, collision: Outcome, rows: int, last: bool) -> None:
    """Draw the curves of a column; only the last column has labels in the right margin."""
    data = collision.trajectory
    assert data is not None
    factor, _ = column.unit
    time = np.asarray(data["time"]) / factor
    _gap(column.panels[0], time, np.asarray(data["gap"]), collision, last)
    velocity, approach = column.panels[1], [-collision.speed]  # also where it ends at first touch
    size, name = prefix(float(np.max(np.abs([*approach, *data["normal_velocity"]]))))
    normal = np.concatenate([approach, data["normal_velocity"]]) / size
    velocity.plot(np.concatenate([time[:1], time]), normal, color=ORANGE)
    velocity.axhline(0, color=GREY, linewidth=0.6)
    velocity.set_ylabel(f"normal\nvelocity ({micro(name + 'm/s')})")
    if rows == 4:
        rates, angle = column.panels[2:]
        most = max(float(np.max(np.abs(data[rate]))) for rate in _RATES if rate in data)
        size, name = next((unit for unit in ((1e6, "M"), (1e3, "k")) if most > 10 * unit[0]), (1.0, ""))
        pair, wall = "spin_partner" in data, collision.scene.wall
        if not wall:
            rates.plot(time, np.asarray(data["rotation_rate"]) / size, color=GREEN, label="ω, line of centres")
        label = "ξ, sphere" if pair or wall else "ξ, each sphere"
        rates.plot(time, np.asarray(data["spin"]) / size, color=PURPLE, linestyle=(0, (5, 1.5)), label=label)
        if pair:
            partner = np.asarray(data["spin_partner"]) / size
            rates.plot(time, partner, color=ORANGE, linestyle=(0, (1, 1)), label="ξ, partner")
        rates.axhline(0, color=GREY, linewidth=0.6)
        rates.set_ylabel(f"rotation\nrate{'s' * (not wall)} ({name}rad/s)")
        if wall:  # a wall has no rotating line of centres; show the distance moved along it
            size, name = prefix(float(np.max(np.abs(data["sliding_velocity"]))))
            angle.plot(time, np.asarray(data["sliding_velocity"]) / size, color=INK)
            angle.set_ylabel(f"sliding\nvelocity ({micro(name + 'm/s')})")
        else:
            angle.plot(time, np.degrees(data["rotation"]), color=INK)
            angle.set_ylabel("angle β (deg)")


def finish(column: Column, collision: Outcome) -> None:
    """Limits, labels of the time, and the events of a column that is filled."""
    factor, unit = column.unit
    margin = 0.02 * (column.end - column.start) / factor
    for panel in column.panels:
        after = 0.2 * margin if column.title == "approach" else margin
        panel.set_xlim(column.start / factor - margin, column.end / factor + after)
        panel.tick_params(labelbottom=panel is column.panels[-1], labelsize=8)
        panel.yaxis.label.set_fontsize(8.5)
        panel.spines[["top", "right"]].set_visible(False)
        if panel.get_yscale() == "linear":
            panel.yaxis.set_major_locator(MaxNLocator(4))
        if column.shaded:
            panel.axvspan(0, column.shaded / factor, color="#DDDDDD", linewidth=0, zorder=0)
    column.panels[-1].set_xlabel(f"time{', ' * bool(column.title)}{column.title} ({unit})", fontsize=9)
    _events(column, collision)


def _gap(axes: Axes, time: np.ndarray, gap: np.ndarray, collision: Outcome, last: bool) -> None:
    """Draw the gap, and lines at the gaps where the equations change."""
    scene = collision.scene
    factor, name = prefix(float(np.max(gap)))
    film, rupture = scene.liquid.film_thickness, scene.rupture_gap
    lines = {"$x_0 = x_f$": film} if math.isclose(film, rupture) else {"$x_0$": film, "$x_f$": rupture}
    if collision.reversal in GAPS:
        symbol = CRITERIA[collision.reversal].symbol
        lines[f"${symbol}$"] = scaled(GAPS[collision.reversal], scene, collision.speed) * film
    far = rupture > 3 * np.max(gap)
    if far:
        del lines["$x_f$"]
    axes.plot(time, gap / factor, color=BLUE)
    everything = np.array([np.min(gap), np.max(gap), *lines.values()]) / factor
    low, high = float(np.min(everything)), float(np.max(everything))
    if low > 0 and high > _DECADE / 2 * low:
        axes.set_yscale("log")
        axes.set_ylim(low / 1.3, high * 1.35)
        ticks.plain(axes.yaxis, (1, 2, 5) if high < 200 * low else (1,))
        axes.yaxis.set_minor_locator(NullLocator())
    else:
        axes.set_ylim(0, 1.2 * high)
    for text, value in lines.items():
        axes.axhline(value / factor, color=BLUE, linewidth=0.8, linestyle=":")
        axes.annotate(
            text, (1, value / factor), (3, 0), xycoords=axes.get_yaxis_transform(), textcoords="offset points",
            color=BLUE, fontsize=8, va="center",
        )  # fmt: skip
    if far and last:  # in the margin, clear of the curves
        axes.annotate(
            f"$x_f$ ↑\n{written(rupture, 'm')}", (1, 1), (3, 2), xycoords="axes fraction",
            textcoords="offset points", color=BLUE, fontsize=8, va="bottom",
        )  # fmt: skip
    axes.set_ylabel(f"gap ({micro(name + 'm')})")


def _events(column: Column, collision: Outcome) -> None:
    """Draw lines of events through all panels and their labels above, raised where they would overlap."""
    factor, _ = column.unit
    span = (column.end - column.start) * 1.04
    marks = [(event.time, event.kind) for event in collision.events]
    if collision.decided is not None and collision.certified and not ends_early(collision):
        marks.append((collision.decided, "proved to stick"))
        marks.sort(key=lambda mark: mark[0])  # a stick that is followed on has events after its proof
    lines = [time for time, _ in marks if time <= column.end * (1 + 1e-9)]
    if len(lines) > _MANY:  # repeated rebounds: one line where they coincide in the figure
        lines = list({round(200 * time / span): time for time in lines}.values())
    for time in lines:
        for panel in column.panels:
            panel.axvline(time / factor, color=GREY, linewidth=0.8, linestyle="--", zorder=1)
    taken: list[float] = []  # right end of the last label on each level, inches
    labels, near = [mark for mark in marks if column.shows(mark[0])], 0.02 * span
    while len(_grouped(labels, near)) > _LABELS:
        near *= 2
    for time, text in _grouped(labels, near):
        at = (time - column.start + 0.02 * span) / span * column.width
        size = _LETTER * len(text)
        side = "left" if at < 0.5 * column.width else "right"
        start = at if side == "left" else at - size
        level = next((k for k, end in enumerate(taken) if end < start), len(taken))
        taken[level:] = [start + size + 0.08, *taken[level + 1 :]]
        column.panels[0].annotate(
            text, (time / factor, 1), (0, 3 + 10 * level), xycoords=column.panels[0].get_xaxis_transform(),
            textcoords="offset points", ha=side, va="bottom", fontsize=8, color=INK,
        )  # fmt: skip


def _grouped(marks: Sequence[tuple[float, str]], near: float) -> list[tuple[float, str]]:
    """Labels of events; those closer than `near` share one, with kinds and counts."""
    groups: list[tuple[float, list[str]]] = []
    for time, kind in marks:
        if groups and time - groups[-1][0] < near:
            groups[-1][1].append(kind)
        else:
            groups.append((time, [kind]))
    labels = []
    for time, kinds in groups:
        counts = {kind: kinds.count(kind) for kind in kinds}
        labels.append((time, ", ".join(kind + (f" (x{count})" if count > 1 else "") for kind, count in counts.items())))
    return labels


def _match(columns: Sequence[Column], time: np.ndarray) -> None:
    """Give both columns the same scales, except of the angle, which is small in the approach."""
    if len(columns[0].panels) > 2:
        columns[-1].panels[2].legend(fontsize=7.5, frameon=False, loc="best")
    if len(columns) == 1:
        return
    zoomed, whole = columns
    for row, panel in enumerate(zoomed.panels):
        if row == 3:
            turned = np.asarray(panel.lines[0].get_ydata())[time <= zoomed.end * (1 + 1e-9)]
            panel.set_ylim(-0.08 * turned.max(), 1.12 * turned.max())
        else:
            whole.panels[row].sharey(panel)
            whole.panels[row].tick_params(labelleft=False)
        whole.panels[row].set_ylabel("")


def letter(axes: Axes, text: str) -> None:
    """Draw a panel's letter at the left edge of the figure, above the panel: all letters are in one column."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    place = blended_transform_factory(figure.transFigure, axes.transAxes)
    drawn = axes.annotate(
        f"({text})" if text else "", (0.006, 1), (0, 2), xycoords=place, textcoords="offset points",
        fontweight="bold", fontsize=10, ha="left", va="bottom", annotation_clip=False,
    )  # fmt: skip
    drawn.set_in_layout(False)


def micro(unit: str) -> str:
    """The unit with µ for a leading u."""
    return "µ" + unit[1:] if unit.startswith("u") else unit


def written(value: float, unit: str) -> str:
    """A quantity with four digits and its prefixed unit, as text for a figure."""
    number, _, name = quantity(value, unit).partition(" ")
    return f"{number} {micro(name)}"
