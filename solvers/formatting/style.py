"""One style for all figures: the style file, and the colours, hatches and letters of the outcomes."""

import functools
import textwrap
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, ParamSpec

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from ...generated.automaton import OUTCOMES

# Of rising lightness, so that they differ in grey as well; black and the contours' labels are legible on each.
FILLS = dict(zip(OUTCOMES, ("#75A9D8", "#F5BE6A", "#FCF6D5"), strict=True))
EDGES = dict(zip(OUTCOMES, ("#75A9D8", "#C9861B", "#FCF6D5"), strict=True))
"""Colours of the hatches."""
HATCHES: dict[str, str | None] = dict(zip(OUTCOMES, (None, "///", None), strict=True))
LETTERS = dict(zip(OUTCOMES, ("S", "SRS", "B"), strict=True))
INK, NOTE, NOTHING = "#202020", "#6E6E6E", "#DDDDDD"
LONGEST = 120
"""Most characters of a scene's name in a title."""
_ACROSS = 10.5  # characters of a title per inch

_LOCK = threading.RLock()  # matplotlib's settings belong to the process
Given = ParamSpec("Given")


@contextmanager
def styled(changes: Any = None) -> Iterator[None]:
    """Matplotlib's settings are the style file's, and `changes` (a mapping), until the end of the block."""
    with _LOCK, mpl.rc_context():
        mpl.rcParams.update(_settings())
        mpl.rcParams.update(changes or {})
        yield


@functools.cache
def _settings() -> Any:
    return mpl.rc_params_from_file(Path(__file__).with_name("wetdoublet.mplstyle"), use_default_template=False)


def picture(draw: Callable[Given, Figure]) -> Callable[Given, Figure]:
    """A function that draws a figure in this style; ticks, which matplotlib makes later, included."""

    @functools.wraps(draw)
    def drawn(*args: Given.args, **named: Given.kwargs) -> Figure:
        with styled():
            figure = draw(*args, **named)
            for axes in figure.axes:
                axes.tick_params(axis="x", labelsize=mpl.rcParams["xtick.labelsize"])
                axes.tick_params(axis="y", labelsize=mpl.rcParams["ytick.labelsize"])
        return figure

    return drawn


def patch(outcome: str, label: str = "") -> Patch:
    """What stands for an outcome in a legend: its colour and hatch."""
    text = label or f"{LETTERS[outcome]}: {outcome}"
    return Patch(facecolor=FILLS[outcome], edgecolor=EDGES[outcome], hatch=HATCHES[outcome], linewidth=0, label=text)


def halo(width: float = 2.4) -> withStroke:
    """White around a line or a label, so that it is legible on any colour; its width in points."""
    return withStroke(linewidth=width, foreground="white", alpha=0.85)


def fill(axes: Axes, outcome: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """Fill the region of each outcome, by index with a row for each y; lines drawn on the edges hide their steps."""
    looks: Any = {"colors": [*FILLS.values()], "hatches": [*HATCHES.values()]}
    regions = axes.contourf(x, y, outcome, levels=np.arange(len(OUTCOMES) + 1) - 0.5, zorder=1, **looks)
    regions.set_edgecolor([EDGES[name] for name in OUTCOMES])
    regions.set_linewidth(0)


def letters(axes: Axes, outcome: np.ndarray, x: np.ndarray, y: np.ndarray, least: int = 3, size: float = 12) -> None:
    """Write the letters of each outcome where its region is widest.

    Arguments:
        outcome: outcomes by index, a row for each y; -1 for none.
        least: distance of the letters from the region's edge, in places; a smaller region has none.
        size: of the letters, in points.
    """
    from scipy.ndimage import distance_transform_cdt  # slow import

    for k, name in enumerate(OUTCOMES):
        depth = distance_transform_cdt(np.pad(outcome == k, 1), "taxicab")[1:-1, 1:-1]
        if depth.max() >= least:
            row, column = np.unravel_index(np.argmax(depth), outcome.shape)
            style: Any = {"ha": "center", "va": "center", "color": INK, "fontsize": size, "zorder": 7}
            axes.annotate(LETTERS[name], (x[column], y[row]), path_effects=[halo(4)], **style)


def plain_text(text: str) -> str:
    """A text from outside, escaped for mathtext."""
    return text.replace("$", r"\$")


def title(figure: Figure, text: str) -> None:
    """Write a figure's title, on as many lines as its width takes."""
    across = int(_ACROSS * figure.get_figwidth())
    figure.suptitle("\n".join(textwrap.fill(line, across) for line in text.splitlines()))


def broken(outcome: np.ndarray, *columns: np.ndarray) -> list[np.ndarray]:
    """Columns with NaN between neighbours of different outcome, so that no line joins what jumps."""
    jumps = np.flatnonzero(outcome[1:] != outcome[:-1]) + 1
    return [np.insert(np.asarray(column, float), jumps, np.nan) for column in columns]
