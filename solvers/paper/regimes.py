"""Regime map: regions of the outcomes and the boundaries between them; x axis St, y axis impact angle."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ...generated.automaton import OUTCOMES
from ..boundaries.boundary import Atlas
from ..formatting.style import EDGES, FILLS, HATCHES, INK

_ROWS, _COLUMNS = 541, 781  # of the raster of outcomes; their edges are drawn over by the curves


def draw(axes: Axes, whole: Atlas, linewidth: float = 1.2) -> None:
    """Draw the regions and boundaries of an atlas of the impact angle, in degrees, continued to St = 0 and 90 deg."""
    degrees, stokes = np.linspace(0.0, 90.0, _ROWS), np.linspace(0.0, whole.window[1], _COLUMNS)
    places = np.meshgrid(np.clip(np.radians(degrees), *whole.span), np.clip(stokes, *whole.window), indexing="ij")
    labels = whole.region(*places)
    for label, outcome in enumerate(OUTCOMES):
        if (labels == label).any():
            style: Any = {"colors": [FILLS[outcome]], "hatches": [HATCHES[outcome] or None]}
            fill = axes.contourf(stokes, degrees, labels == label, levels=[0.5, 1.5], zorder=1, **style)
            fill.set_edgecolor(EDGES[outcome])
            fill.set_linewidth(0)
    for one in whole.curves:
        axes.plot(one.stokes, np.degrees(one.x), color=INK, linewidth=linewidth, zorder=3)
