"""What single impacts tell, over speed and angle, and the planned ones."""

from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ..collision.text import against, name_of
from ..formatting import ticks
from ..formatting.style import INK, LONGEST, NOTE, picture, plain_text, title
from ..scene.held import AXIS_LABELS
from .result import Design

_WORST, _BEST = 1.0, 1e-3  # standard errors from one impact that the colours tell apart, at most
_OPEN = 1e3  # a standard error that says nothing
_ROWS = {"information": "outcome and restitution", "by_outcome": "outcome alone"}


@picture
def draw(design: Design) -> Figure:
    """A panel for each entry: outcome and restitution above, the outcome alone below."""
    data, names, window = design.map(), design.free.names, design.window
    rows = list(_ROWS)[window.scatter.restitution is None :]
    figure = Figure(figsize=(1.4 + 3.3 * len(names), 0.9 + 2.9 * len(rows)), layout="constrained")
    panels: Any = figure.subplots(len(rows), len(names), sharex=True, sharey=True, squeeze=False)
    error = 1 / np.sqrt(data[rows].to_array().clip(_OPEN**-2))
    scale = LogNorm(float(np.clip(error.min(), _BEST, 0.3)), _WORST)
    x, y = np.degrees(data["angle"].values), data[window.key].values
    x, y = (np.array([axis[0] * 0.97, axis[0] * 1.03 + 1e-3]) if axis.size == 1 else axis for axis in (x, y))
    for (i, of), (j, name) in product(enumerate(rows), enumerate(names)):
        axes = panels[i, j]
        values = np.broadcast_to(error.sel(variable=of, entry=name).values.T, (y.size, x.size))
        mesh = axes.pcolormesh(x, y, values, norm=scale, cmap="viridis_r", shading="gouraud", rasterized=True)
        for k in (0, -1) if all(window.extends) else ():  # sticks, and bounces
            share = data["probability"].isel(outcome=k).values.T
            if share.min() < 0.5 < share.max():
                axes.contour(x, y, share, [0.5], colors="white", linewidths=0.9)
        axes.set_yscale("log")
        ticks.plain(axes.yaxis)
        axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
        _mark(axes, design)
        if i == 0:
            axes.set_title(plain_text(name), fontsize="medium")
        if i == len(rows) - 1:
            axes.set_xlabel("impact angle (deg)" if window.extends[1] else "")
        panels[i, 0].set_ylabel(f"{AXIS_LABELS[window.key]}\n{_ROWS[of]}")
    bar = figure.colorbar(mesh, ax=panels, extend="both", pad=0.02, aspect=30)
    relative = "relative" if design.free.logarithmic.all() else "on the scale of the fit"
    bar.set_label(f"standard error from one impact, {relative}")
    ticks.plain(bar.ax.yaxis)
    title(figure, f"{plain_text(name_of(window.scene, LONGEST))}{against(window.scene)}: what an impact tells")
    of_what = "all entries" if design.target is None else plain_text(design.target)
    separator = "; " if len(names) > 1 else "\n"
    note = (
        f"numbers: planned impacts for {of_what} ({design.size}){separator}lines: half of all impacts stick, or bounce"
    )
    figure.supxlabel(note, color=NOTE)
    return figure


def _mark(axes: Axes, design: Design) -> None:
    """Draw the planned impacts and how often each is repeated."""
    for impact in design.impacts:
        at = np.degrees(impact.angle), getattr(impact, design.window.key)
        axes.plot(*at, "o", color="white", markeredgecolor=INK, markersize=11, zorder=4, clip_on=False)
        style: Any = {"ha": "center", "va": "center_baseline", "fontsize": 8, "color": INK}
        axes.text(*at, f"{impact.count}", zorder=5, clip_on=False, **style)
