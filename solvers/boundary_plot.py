"""Traced boundaries as a picture: Stokes number against impact angle, the outcomes named between the curves."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import ticks
from .draw_map import COLOURS
from .many import OUTCOMES

if TYPE_CHECKING:
    from .bounds import Boundaries
    from .scene import Scene

_PALE = 0.45  # the map's colours, for lines and words on them
_ROOM = 1.8  # factor of Stokes number shown beyond the outermost curves
_INSIDE = 0.13  # of the width: a region's name keeps this far from the sides
_EDGE = 0.05  # ... and one that is there alone stands beside the edge
_INK, _NOTE = "#202020", "#6E6E6E"
Run = tuple[np.ndarray, list[str], np.ndarray]


def draw(scene: Scene, found: Boundaries) -> Figure:
    """The changes of `found` as curves, points for a single angle, and what happens on either side.

    Arguments:
        found: as `boundary` returns it; where curves meet, `closed` leaves no gap.
    """
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axes = figure.add_subplot()
    name = (scene.name or "scene").replace("$", r"\$")
    axes.set_title(f"{name}: where the outcome changes", fontsize=11)
    axes.set_xlabel(r"impact angle $\theta_0$ (deg)")
    axes.set_ylabel("normal Stokes number St")
    axes.set_yscale("log")
    ticks.plain(axes.yaxis)
    stokes = [one.stokes for line in found.changes for one in line]
    low, high = (min(stokes) / _ROOM, max(stokes) * _ROOM) if stokes else (0.1, 10.0)
    degrees = np.degrees(found.angles)
    if len(degrees) > 1:
        axes.set_xlim(degrees.min(), degrees.max())
    axes.set_ylim(low, high)
    runs = list(_runs(found, low, high))
    for number, (angles, outcomes, edges) in enumerate(runs):
        # half-way to the neighbouring patterns, so that no sliver stays white
        first = (runs[number - 1][0][-1] + angles[0]) / 2 if number else angles[0]
        last = (angles[-1] + runs[number + 1][0][0]) / 2 if number + 1 < len(runs) else angles[-1]
        across, up = np.array([first, *angles, last]), np.vstack([edges[:1], edges, edges[-1:]])
        for k, outcome in enumerate(outcomes):
            colour = COLOURS[OUTCOMES.index(outcome)]
            axes.fill_between(across, up[:, k], up[:, k + 1], color=colour, alpha=_PALE, linewidth=0)
        marker = "o" if angles[0] == angles[-1] else ""
        for k in range(1, len(outcomes)):
            axes.plot(angles, edges[:, k], color=_INK, linewidth=1.6, marker=marker, solid_capstyle="round")
    _names(axes, runs)
    failed = [np.degrees(angle) for angle, _ in found.failed]
    if failed:
        axes.plot(failed, [0.02] * len(failed), "x", color=_INK, transform=axes.get_xaxis_transform(), clip_on=False)
        figure.supxlabel("crosses: angles that could not be traced", fontsize=7.5, color=_NOTE)
    return figure


def _runs(found: Boundaries, low: float, high: float) -> Iterator[Run]:
    """Neighbouring angles with one pattern: degrees, outcomes upwards, and the edges between (angle x edge)."""
    lines = sorted((angle, line) for angle, line in zip(np.degrees(found.angles), found.changes, strict=True) if line)
    patterns = groupby(lines, lambda pair: [pair[1][0].before, *(one.after for one in pair[1])])
    for outcomes, members in patterns:
        run = list(members)
        angles = np.array([angle for angle, _ in run])
        yield angles, outcomes, np.array([[low, *(one.stokes for one in line), high] for _, line in run])


def _names(axes: Axes, runs: list[Run]) -> None:
    """The name of each outcome where its region is highest, away from the sides."""
    left, right = axes.get_xlim()
    best: dict[str, tuple[float, float, float]] = {}
    for angles, outcomes, edges in runs:
        for k, outcome in enumerate(outcomes):
            heights = np.log(edges[:, k + 1] / edges[:, k])
            for angle, height, below in zip(angles, heights, edges[:, k], strict=True):
                place = (angle - left) / (right - left)
                inside = _INSIDE <= place <= 1 - _INSIDE
                middle = float(below * np.exp(height / 2))
                best[outcome] = max(best.get(outcome, (-1.0, 0.0, 0.0)), (inside * height, angle, middle))
    for outcome, (_, angle, middle) in best.items():
        alone = next(angles.size == 1 for angles, _, _ in runs if angle in angles) and len(runs) > 1
        text = outcome.replace("rotate-", "rotate-\n") + f" at {angle:.4g}°" * alone
        place = (angle - left) / (right - left)
        side = "left" if place < _EDGE else "right" if place > 1 - _EDGE else "center"
        axes.annotate(
            text, (angle, middle), ({"left": 8, "right": -8, "center": 0}[side], 0), textcoords="offset points",
            ha=side, va="center", fontsize=9, color=_INK, linespacing=1.1,
        )  # fmt: skip
