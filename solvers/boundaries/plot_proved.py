"""A proved map as a figure: cells by outcome, and in black what is undecided."""

from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ...generated.automaton import OUTCOMES
from ..formatting import ticks
from ..formatting.style import FILLS, INK, LETTERS, picture, plain_text, title
from ..scene.held import AXIS_LABELS
from .proved_map import UNDECIDED, ProvedMap


@picture
def draw(proved: ProvedMap) -> Figure:
    """Draw the cells over impact angle and Stokes number or speed."""
    cells, shares = proved.cells, proved.shares
    figure = Figure(figsize=(6.4, 5.2), layout="constrained")
    axes = figure.add_subplot()
    handles = []
    for number, word in (*enumerate(OUTCOMES), (UNDECIDED, "undecided")):
        colour = FILLS.get(word, INK)
        corners = [_corners(cell.angle, cell.speed) for cell in cells if cell.outcome == number]
        thin = number == UNDECIDED  # a sliver is narrower than a dot: its edge shows it
        style: Any = {"edgecolors": "face" if thin else "#00000030", "linewidths": 0.4 if thin else 0.15}
        patches = PolyCollection(corners, facecolors=colour, rasterized=True, zorder=2 if thin else 1, **style)
        axes.add_collection(patches)
        if corners:
            letter = f"{LETTERS[word]}, proved" if word in LETTERS else word
            handles.append(Patch(facecolor=colour, label=f"{letter}: {100 * shares[word]:.3g} % of the area"))
    axes.set_yscale("log")
    ticks.plain(axes.yaxis)
    axes.set_xlim(*(np.degrees(end(c.angle[k] for c in cells)) for k, end in enumerate((min, max))))
    axes.set_ylim(*(end(c.speed[k] for c in cells) for k, end in enumerate((min, max))))
    axes.set_xlabel("impact angle $\\theta_0$ (deg)")
    axes.set_ylabel(AXIS_LABELS[cells[0].by])
    title(figure, f"{plain_text(proved.scene.name)}: outcomes proved, cell by cell")
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _corners(angle: tuple[float, float], speed: tuple[float, float]) -> list[tuple[float, float]]:
    (left, right), (low, high) = np.degrees(angle), speed
    return [(left, low), (right, low), (right, high), (left, high)]
