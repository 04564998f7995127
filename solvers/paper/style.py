"""Style of the figures: width of one printed column, colour-blind safe colours, symbols of the paper, regime maps."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...generated.automaton import OUTCOMES
from ..boundaries.result import Atlas
from ..formatting.style import EDGES, FILLS, HATCHES, INK, styled
from ..host.files import save

COLUMN = 8.8  # cm
DPI = 300
_INCH = 2.54
_ROWS, _COLUMNS = 541, 781  # of the raster of outcomes; their edges are drawn over by the curves

BLUE, ORANGE, GREEN, PURPLE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9"  # Okabe-Ito
GREY = "#6E6E6E"
STOKES, ANGLE = "Stokes number $St_n$", r"impact angle $\theta_0$ (deg)"

_COLUMN: Any = {  # matplotlib's stubs type each key separately
    "font.size": 8,
    "axes.labelsize": 8.5,
    "axes.linewidth": 0.7,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "lines.linewidth": 1.2,
    "legend.fontsize": 7,
}


@contextmanager
def sheet(file: Path, height: float, width: float = COLUMN) -> Iterator[Figure]:
    """Context of a figure of the given size in cm, saved to `file` at the end."""
    with styled(_COLUMN):
        figure = Figure(figsize=(width / _INCH, height / _INCH), layout="constrained")
        yield figure
        save(figure, file, dpi=DPI)


def draw_map(axes: Axes, whole: Atlas, linewidth: float = 1.2) -> None:
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
