"""Picture of a table: restitution between its boundaries, and its patches."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from ...generated.automaton import OUTCOMES
from ..collision.text import against, name_of
from ..formatting import ticks
from ..formatting.style import FILLS, INK, NOTE, patch, picture, plain_text
from .attack import heights
from .data import Law
from .read import Read, read

_ACROSS, _UP = 480, 400


@picture
def draw(table: Law) -> Figure:
    """A figure of a table; one over three variables is drawn at the middle of the third."""
    data = table.data
    angle = np.linspace(data.low[1], data.high[1], _ACROSS)
    height = np.linspace(data.low[2], data.high[2], _UP)
    third = 0.5 * (data.low[0] + data.high[0])
    grid = [one.ravel() for one in np.meshgrid(angle, height)]
    answers = read(data, np.full(grid[0].size, third), grid[0], grid[1])
    outcome = answers.outcome.reshape(_UP, _ACROSS)
    figure = Figure(figsize=(9.2, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    x, y = np.degrees(angle), np.exp(height)
    name = table.of[0]
    shown = np.ma.masked_where(outcome == 0, answers.values[:, 0].reshape(_UP, _ACROSS))
    left.set_facecolor(FILLS[OUTCOMES[0]])
    colours = left.pcolormesh(x, y, shown, cmap="viridis", shading="nearest", rasterized=True)
    figure.colorbar(colours, ax=left, label=name.replace("_", " "))
    fills = ListedColormap([FILLS[one] for one in OUTCOMES])
    right.pcolormesh(x, y, outcome, cmap=fills, vmin=-0.5, vmax=2.5, shading="nearest", rasterized=True)
    _patches(right, answers, x, y)
    for axes in (left, right):
        _boundaries(axes, table, third, angle)
        axes.set_xlabel(r"impact angle $\theta_0$ (deg)")
        axes.set_yscale("log")
    left.set_ylim(y[0], y[-1])
    ticks.plain(left.yaxis, (1, 2, 5) if y[-1] / y[0] < 1e3 else (1,))
    left.set_ylabel("normal Stokes number St")
    title = f"{plain_text(name_of(table.scene, 40))}{against(table.scene)}"
    left.set_title(title if table.range.third is None else f"{title}, {_at(table, third)}")
    right.set_title(f"{len(data.results.size)} patches, {data.bytes / 1000:.0f} kB, error at most {table.error:g}")
    seen = sorted({int(one) for one in np.unique(outcome)})
    figure.legend(handles=[patch(OUTCOMES[one]) for one in seen], loc="outside lower center", ncols=len(seen))
    return figure


def _at(table: Law, third: float) -> str:
    name = table.range.third or ""
    value = math.exp(third) if table.range.logarithmic else third
    unit = table.scene.fields[name].unit or ""
    return f"{name.rpartition('.')[2].replace('_', ' ')} {value:.4g} {unit}".rstrip()


def _boundaries(axes: Axes, table: Law, third: float, angle: np.ndarray) -> None:
    """Draw the boundaries, panel by panel."""
    data = table.data
    places, count = heights(data, np.full(angle.size, third), angle)
    panel = read(data, np.full(angle.size, third), angle, np.full(angle.size, data.low[2])).panel
    for one in np.unique(panel):
        inside = np.flatnonzero(panel == one)
        for k in range(2, int(count[inside[0]])):
            axes.plot(np.degrees(angle[inside]), np.exp(places[k, inside]), color=INK, linewidth=1.2)


def _patches(axes: Axes, answers: Read, x: np.ndarray, y: np.ndarray) -> None:
    """Draw where one patch of results ends and another begins."""
    number = answers.patch.reshape(y.size, x.size)
    edge = np.zeros(number.shape, dtype=bool)
    edge[:, 1:] |= number[:, 1:] != number[:, :-1]
    edge[1:] |= number[1:] != number[:-1]
    axes.pcolormesh(
        x, y, np.ma.masked_where(~edge, edge.astype(float)), cmap=ListedColormap([NOTE]), shading="nearest",
        rasterized=True,
    )  # fmt: skip
