"""The probabilities of the outcomes over speed and angle as a picture."""

import numpy as np
import xarray
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from ..formatting.style import FILLS, INK, NOTE, halo, patch, picture
from ..formatting.ticks import plain
from ..scene.held import AXIS_LABELS

_LEVELS = 0.05, 0.5, 0.95


@picture
def draw(data: xarray.Dataset) -> Figure:
    """The colours of the outcomes, mixed by probability, and lines of the probability of sticking."""
    names, kind = data["outcome"].values.tolist(), str(data["probability"].dims[2])
    share, degrees, speed = data["probability"].values, np.degrees(data["angle"].values), data[kind].values
    figure = Figure(figsize=(6.4, 5.2), layout="constrained")
    axes = figure.add_subplot()
    colours = np.tensordot(share, np.array([to_rgb(FILLS[name]) for name in names]), axes=(0, 0))
    axes.pcolormesh(degrees, speed, np.clip(colours.swapaxes(0, 1), 0, 1), shading="nearest", rasterized=True)
    if share[0].min() < _LEVELS[-1] and share[0].max() > _LEVELS[0]:
        lines = axes.contour(degrees, speed, share[0].T, levels=_LEVELS, colors=INK, linestyles=["--", "-", "--"])
        for label in axes.clabel(lines, fmt=lambda level: f"{level:.0%}", fontsize=7):
            label.set_path_effects([halo()])
    if (speed > 0).all():
        axes.set_yscale("log")
    plain(axes.yaxis)
    axes.set(xlabel="impact angle (deg)", ylabel=AXIS_LABELS[kind])
    axes.set_title("probability of sticking, with the uncertainty of the fitted entries", fontsize=9)
    handles = [patch(name) for name, each in zip(names, share, strict=True) if each.max() > _LEVELS[0]]
    for each in handles:
        each.set(edgecolor=INK, hatch=None, linewidth=0.6)
    axes.legend(handles=handles, fontsize=7, loc="best", frameon=True, framealpha=0.9)
    effective = f"{data.attrs['effective_draws']:.0f}"
    figure.supxlabel(f"{data.attrs['draws']} weighted draws of the entries, worth {effective}", color=NOTE, fontsize=7)
    return figure
