"""Sobol indices as a figure: a pair of bars for each parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..formatting.style import picture

if TYPE_CHECKING:
    import xarray

_BARS = (("first", "first order", "#2a6f97", -0.2), ("total", "total", "#c1554a", 0.2))


@picture
def draw(found: xarray.Dataset) -> Figure:
    """First-order and total indices with their 95 % intervals, the largest on top."""
    order = np.argsort(found["total"].values)
    figure = Figure(figsize=(6.4, 1.4 + 0.5 * order.size), layout="constrained")
    axes = figure.add_subplot()
    for name, label, colour, shift in _BARS:
        values, within = found[name].values[order], found[f"{name}_within"].values[order]
        axes.barh(np.arange(order.size) - shift, values, 0.36, xerr=within, color=colour, label=label,
                  error_kw={"linewidth": 0.9})  # fmt: skip
    axes.set_yticks(range(order.size), found["parameter"].values[order])
    axes.set_xlabel("part of the variance")
    of = str(found.attrs["of"]).replace("_", " ")
    axes.set_title(f"Sobol indices of the {of}, {found.attrs['collisions']} collisions", fontsize=10)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8, loc="lower right")
    return figure
