"""Style of the figures: width of one printed column, colour-blind safe colours, symbols of the paper."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from ..formatting.style import styled
from ..host.files import save

COLUMN = 8.8  # cm
DPI = 300
_INCH = 2.54

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
