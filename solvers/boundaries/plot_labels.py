"""Placement of region names in a figure: inside the region, clear of curves and marks."""

from collections.abc import Callable, Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy import ndimage

from ...generated.automaton import OUTCOMES
from ..formatting.style import INK, halo

_CELL = 3.0  # margin, pixels
_CLEAR = 2  # cells between a name and the edge of its region
# Possible names of a region, the preferred first
_NAMES = ((OUTCOMES[0], "S"), (OUTCOMES[1], "stick-rotate-\nseparate", "SRS"), (OUTCOMES[2], "B"))
_FONT = 9.0


def place_names(figure: Figure, axes: Axes, outcome: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> None:
    """Write each region's name in it, or its letters if there is no room, or nothing if these do not fit either.

    Arguments:
        outcome: function of arrays of places, in the coordinates of the axes.
    """
    canvas = FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    box = axes.get_window_extent()
    columns, rows = int(box.width / _CELL), int(box.height / _CELL)
    pixels = np.stack(
        np.meshgrid(box.x0 + (np.arange(columns) + 0.5) * _CELL, box.y0 + (np.arange(rows) + 0.5) * _CELL), axis=-1
    )
    places = axes.transData.inverted().transform(pixels.reshape(-1, 2))
    labels = outcome(places[:, 0], places[:, 1]).reshape(rows, columns)
    labels = _without_marks(axes, labels, pixels)
    renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]  # matplotlib's
    for label, region in _regions(labels):
        for name in _NAMES[label]:
            text = axes.text(
                0, 0, name, fontsize=_FONT, ha="center", va="center", color=INK, linespacing=1.1, zorder=7,
                path_effects=[halo()],
            )  # fmt: skip
            size = text.get_window_extent(renderer)
            at = _room(region, int(size.width / _CELL) + 2, int(size.height / _CELL) + 2)
            if at is None:
                text.remove()
                continue
            text.set_transform(axes.transAxes)
            text.set_position(((at[1] * _CELL) / box.width, (at[0] * _CELL) / box.height))
            break


def _without_marks(axes: Axes, labels: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Labels with -1 under the marks of points."""
    kept = labels.copy()
    for line in axes.get_lines():
        if line.get_marker() in ("None", "", None) or line.get_transform() != axes.transData:
            continue
        reach = 0.5 * line.get_markersize() * axes.figure.dpi / 72 + _CELL
        for x, y in axes.transData.transform(np.column_stack(line.get_data())):
            kept[np.hypot(pixels[..., 0] - x, pixels[..., 1] - y) < reach] = -1
    return kept


def _regions(labels: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """The connected parts of each label, as masks, in the order of their first places."""
    parts, kinds = np.zeros(labels.shape, int), np.unique(labels[labels >= 0]).tolist()
    for kind in kinds:
        connected = ndimage.label(labels == kind)[0]
        parts = np.where(connected > 0, connected + parts.max(), parts)
    numbers, first = np.unique(parts, return_index=True)
    for place in np.sort(first[numbers > 0]).tolist():
        yield int(labels.flat[place]), parts == parts.flat[place]


def _room(region: np.ndarray, width: int, height: int) -> tuple[float, float] | None:
    """Row and column of the middle of a box of this size inside the region, as far from its edges as possible."""
    best, low, high = None, 0, max(region.shape)
    while low <= high:
        margin = (low + high) // 2
        fits = _fitting(region, width + 2 * (margin + _CLEAR), height + 2 * (margin + _CLEAR))
        if fits is None:
            high = margin - 1
        else:
            best, low = fits, margin + 1
    return best


def _fitting(region: np.ndarray, width: int, height: int) -> tuple[float, float] | None:
    """The middle of a box inside the region, the nearest to the region's middle."""
    rows, columns = region.shape
    if width > columns or height > rows:
        return None
    sums = np.pad(np.cumsum(np.cumsum(region, axis=0), axis=1), ((1, 0), (1, 0)))
    inside = (
        sums[height:, width:] - sums[:-height, width:] - sums[height:, :-width] + sums[:-height, :-width]
    ) == width * height
    if not inside.any():
        return None
    middle = np.argwhere(region).mean(axis=0)
    at = np.argwhere(inside) + np.array([height / 2, width / 2])
    row, column = at[int(np.argmin(((at - middle) ** 2).sum(axis=1)))]
    return float(row), float(column)
