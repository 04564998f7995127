"""Sensitivities of boundaries as a figure: the elasticities of every change of outcome as bars."""

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

_UP, _DOWN = "#2a6f97", "#c1554a"
_PANELS, _ACROSS = 6, 3


def draw(angles: Sequence[float], changes: Sequence[Sequence[Any]], parameters: Sequence[str]) -> Figure:
    """A panel for each change (at most six), a bar for each parameter; of Ce* where there is one, else of the speed."""
    panels = [(angle, one) for angle, line in zip(angles, changes, strict=True) for one in line][:_PANELS]
    across = max(1, min(_ACROSS, len(panels)))
    down = max(1, -(-len(panels) // across))
    height = 1.1 + 0.22 * len(parameters)
    figure = Figure(figsize=(2.2 + 3.0 * across, 0.5 + height * down), layout="constrained")
    grid = figure.subplots(down, across, sharey=True, squeeze=False)
    for axis in grid.ravel()[len(panels) :]:
        axis.set_visible(False)
    for axis, (angle, one) in zip(grid.ravel(), panels):
        of = one.shown[-1]
        values = [one.elasticity[of][name] or 0.0 if one.elasticity else 0.0 for name in parameters]
        axis.barh(range(len(parameters)), values, color=[_UP if value >= 0 else _DOWN for value in values], height=0.7)
        axis.set_yticks(range(len(parameters)), parameters, fontsize=7.5)
        axis.axvline(0, color="#222222", linewidth=0.8)
        symbol = {"centrifugal": "Ce*", "speed": "(normal speed)"}[of]
        axis.set_title(f"{math.degrees(angle):.4g}°, {one.change.before} → {one.change.after}", fontsize=8)
        axis.set_xlabel(f"d ln {symbol}/d ln p" if not one.reason else one.reason[:40], fontsize=8)
        axis.spines[["top", "right", "left"]].set_visible(False)
    figure.suptitle("how the boundaries move with the parameters" if panels else "no change of outcome", fontsize=11)
    return figure
