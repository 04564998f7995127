"""Regime map: regions of the outcomes between traced boundaries; x axis St, y axis impact angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from ..formatting.style import EDGES, FILLS, HATCHES, INK
from .desk import Line, outcomes

_RIGHT_ANGLE = 90.0
Strip = tuple[str, float, float]  # outcome, from St, to St
Cell = tuple[str, list[tuple[float, float]]]  # outcome, corners


def draw(axes: Axes, angles: Sequence[float], lines: Sequence[Line], reach: float, linewidth: float = 1.2) -> None:
    """Draw the regions up to St = `reach` and the boundaries; angles are given in rad and drawn in degrees."""
    degrees = [math.degrees(angle) for angle in angles]
    cells = _cells(degrees[-1], _RIGHT_ANGLE, lines[-1], lines[-1], reach)
    for (low, here), (high, there) in pairwise(zip(degrees, lines)):
        if outcomes(here) == outcomes(there):
            cells += _cells(low, high, here, there, reach)
            for one, other in zip(here, there):
                axes.plot([one.stokes, other.stokes], [low, high], color=INK, linewidth=linewidth, zorder=3)
        else:  # a region begins between two close lines
            middle = (low + high) / 2
            cells += _cells(low, middle, here, here, reach) + _cells(middle, high, there, there, reach)
            _join(axes, low, high, here, there, linewidth)
    for outcome in FILLS:
        _fill(axes, outcome, [corners for own, corners in cells if own == outcome])


def _cells(low: float, high: float, here: Line, there: Line, reach: float) -> list[Cell]:
    """The regions between two angles, degrees, whose boundaries are those of two lines with the same outcomes."""
    return [
        (outcome, [(left, low), (right, low), (far_right, high), (far_left, high)])
        for (outcome, left, right), (_, far_left, far_right) in zip(_strips(here, reach), _strips(there, reach))
    ]


def _fill(axes: Axes, outcome: str, cells: list[list[tuple[float, float]]]) -> None:
    """Fill the cells of an outcome; one collection of all is drawn much faster than one of each."""
    fill = FILLS[outcome]
    axes.add_collection(PolyCollection(cells, facecolor=fill, edgecolor=fill, linewidth=0.3, zorder=1))
    if HATCHES[outcome]:
        look: Any = {"facecolor": "none", "edgecolor": EDGES[outcome], "hatch": HATCHES[outcome], "linewidth": 0}
        axes.add_collection(PolyCollection(cells, zorder=1.5, **look))


def _strips(line: Line, reach: float) -> list[Strip]:
    edges = [0.0, *(change.stokes for change in line), max(reach, *(change.stokes for change in line), 0.0)]
    return [(outcome, *ends) for outcome, ends in zip(outcomes(line), pairwise(edges))]


def _join(axes: Axes, low: float, high: float, here: Line, there: Line, linewidth: float) -> None:
    """Connect the boundaries of the two lines between which a region begins, each to the nearest one."""
    fewer, more, at, to = (here, there, low, high) if len(here) <= len(there) else (there, here, high, low)
    for change in more:
        if fewer:
            near = min(fewer, key=lambda one: abs(one.stokes - change.stokes))
            axes.plot([near.stokes, change.stokes], [at, to], color=INK, linewidth=linewidth, zorder=3)
