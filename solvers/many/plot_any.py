"""Outcomes of many collisions as a figure: a map where they lie on a grid, else a point for each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ...generated.automaton import OUTCOMES, ROTATE
from ..collision.text import name_of
from ..formatting.style import EDGES, FILLS, picture
from ..scene.held import AXIS_LABELS
from .plot_map import draw_map
from .regime_map import scene_of
from .results import FAILED

if TYPE_CHECKING:
    import xarray

_MARKS = ("o", "^", "s")
_FILL = FILLS | {ROTATE: EDGES[ROTATE]}  # of small marks, which have no hatch


@picture
def draw(data: xarray.Dataset) -> Figure:
    """Draw what `regime_map` or `collide_many` has returned."""
    return draw_map(data) if "Conventions" in data.attrs else _points(data)


def _points(data: xarray.Dataset) -> Figure:
    """A point for each collision, over impact angle and Stokes number or speed, marked by its outcome."""
    impact = "stokes" if "stokes" in data.coords else "speed"
    outcome = data["outcome"].values.ravel()
    x, y = (data[name].broadcast_like(data["outcome"]).transpose(*data["outcome"].dims).values.ravel()
            for name in ("angle", impact))  # fmt: skip
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.add_subplot()
    for code, (name, mark) in enumerate(zip(OUTCOMES, _MARKS, strict=True)):
        here = outcome == code
        if here.any():
            edge: Any = {"linewidths": 0.4, "edgecolors": "#404040", "label": f"{name} ({int(here.sum())})"}
            axes.scatter(np.degrees(x[here]), y[here], s=26, c=_FILL[name], marker=mark, **edge)
    failed = outcome == FAILED
    if failed.any():
        axes.scatter(np.degrees(x[failed]), y[failed], s=30, c="#C00000", marker="x", label=f"failed ({failed.sum()})")
    if y.size and y.min() > 0 and y.max() > 20 * y.min():
        axes.set_yscale("log")
    axes.set(xlabel="impact angle (deg)", ylabel=AXIS_LABELS[impact])
    name = name_of(scene_of(data)).replace("$", r"\$")
    axes.set_title(f"{name}: outcomes of {outcome.size} collisions", fontsize=11)
    axes.spines[["top", "right"]].set_visible(False)
    if outcome.size:
        figure.legend(loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    return figure
