"""What single impacts tell, over speed and angle, and the planned ones."""

from typing import Any

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ..collision.text import against, name_of
from ..formatting import ticks
from ..formatting.style import INK, LONGEST, NOTE, picture, plain_text, title
from ..scene.held import AXIS_LABELS
from .design_result import Design
from .information import information

_ALONG, _ACROSS = 40, 28  # speeds and angles
_WORST, _BEST = 1.0, 1e-3  # standard errors from one impact that the colours tell apart, at most
_OPEN = 1e3  # a standard error that says nothing


@picture
def draw(design: Design) -> Figure:
    """A panel for each entry."""
    free, window, values = design.free, design.window, design.values
    figure = Figure(figsize=(1.4 + 3.3 * free.size, 3.8), layout="constrained")
    panels: Any = figure.subplots(1, free.size, sharey=True, squeeze=False)
    points = window.grid(_ALONG, _ACROSS)
    single, probability = information(window.scene, free.names, values, window.plan(points), design.rtol)
    speed, angle = (axis.reshape(np.unique(points[:, 1]).size, -1) for axis in window.values(points))
    x, y = np.degrees(angle[:, 0]), speed[0]
    told = np.einsum("cii->ic", single) * free.rates(values)[:, None] ** 2
    error = 1 / np.sqrt(told.reshape(free.size, *speed.shape).clip(_OPEN**-2))
    scale = LogNorm(float(np.clip(error.min(), _BEST, 0.3)), _WORST)
    x = x if window.extends[1] else x + np.array([-1.0, 1.0])
    y = y if window.extends[0] else y * np.array([0.97, 1.03])
    for axes, name, errors in zip(panels[0], free.names, error, strict=True):
        colours = np.broadcast_to(errors.T, (y.size, x.size))
        mesh = axes.pcolormesh(x, y, colours, norm=scale, cmap="viridis_r", shading="gouraud", rasterized=True)
        for k in (0, -1) if all(window.extends) else ():  # sticks, and bounces
            share = probability[:, k].reshape(speed.shape).T
            if share.min() < 0.5 < share.max():
                axes.contour(x, y, share, [0.5], colors="white", linewidths=0.9)
        axes.set_yscale("log")
        ticks.plain(axes.yaxis)
        axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), xlabel="impact angle (deg)")
        if not window.extends[1]:
            axes.set_xticks(np.degrees(window.angle[:1]))
        if not window.extends[0]:
            axes.set_yticks(window.speed[:1])
        axes.set_title(plain_text(name), fontsize="medium")
        for impact in design.impacts:
            at = np.degrees(impact.angle), getattr(impact, window.key)
            axes.plot(*at, "o", color="white", markeredgecolor=INK, markersize=11, zorder=4, clip_on=False)
            style: Any = {"ha": "center", "va": "center_baseline", "fontsize": 8, "color": INK}
            axes.text(*at, f"{impact.count}", zorder=5, clip_on=False, **style)
    panels[0, 0].set_ylabel(AXIS_LABELS[window.key])
    bar = figure.colorbar(mesh, ax=panels, extend="both", pad=0.02, aspect=30)
    relative = "relative" if free.logarithmic.all() else "on the scale of the fit"
    bar.set_label(f"standard error from one impact, {relative}")
    ticks.plain(bar.ax.yaxis)
    title(figure, f"{plain_text(name_of(window.scene, LONGEST))}{against(window.scene)}: what an impact tells")
    note = f"numbers: planned impacts ({design.size})"
    if window.extends.all():
        note += ("; " if free.size > 1 else "\n") + "lines: half of all impacts stick, or bounce"
    figure.supxlabel(note, color=NOTE)
    return figure
