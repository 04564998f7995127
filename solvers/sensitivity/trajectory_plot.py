"""Trajectory sensitivities as a figure: what moves, and how the parameters that matter most change it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ..collision.text import prefix
from ..formatting.style import picture

if TYPE_CHECKING:
    import xarray

_SHOWN = {"gap": "m", "normal_velocity": "m/s", "rotation_rate": "rad/s", "spin": "rad/s"}  # and their units
_MOST = 5  # parameters in a panel
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
_EVENT: Any = {"color": "#999999", "linewidth": 0.7, "linestyle": ":"}


@picture
def draw(found: xarray.Dataset) -> Figure:
    """A row for each variable that is not zero: on the left its course, on the right p dy/dp of the parameters p.

    The strongest five parameters of a row are drawn; dotted lines are events.
    """
    names = [name for name in _SHOWN if np.any(found[name].values)]
    figure = Figure(figsize=(9.6, 1.0 + 1.9 * len(names)), layout="constrained")
    axes = figure.subplots(len(names), 2, sharex=True, squeeze=False)
    parameters = [str(name) for name in found["parameter"].values]
    factor, letter = prefix(float(found["time"].values[-1]))
    time = found["time"].values / factor
    strongest: dict[str, str] = {}
    for (left, right), name in zip(axes, names, strict=True):
        scale, own = prefix(float(np.abs(found[name].values).max())) if name == "gap" else (1.0, "")
        left.plot(time, found[name].values / scale, color="#202020", linewidth=1.4)
        left.set_ylabel(f"{name.replace('_', ' ')} ({own.replace('u', 'µ')}{_SHOWN[name]})")
        change = found[f"d_{name}"].values * found["reference"].values / scale
        largest = np.abs(change).max(axis=0)
        if "impact.speed" in parameters and "impact.stokes" in parameters:
            largest[parameters.index("impact.stokes")] = 0.0  # it moves everything as the speed does
        for k in np.argsort(-largest)[:_MOST]:
            parameter = parameters[k]
            if largest[k] > 0:
                colour = strongest.setdefault(parameter, _COLOURS[len(strongest) % len(_COLOURS)])
                style = "-" if list(strongest).index(parameter) < len(_COLOURS) else "--"
                right.plot(time, change[:, k], color=colour, linestyle=style, linewidth=1.2, label=parameter)
        right.legend(fontsize=6.5, frameon=False)
        for axis in (left, right):
            axis.spines[["top", "right"]].set_visible(False)
            for event in np.unique(found["event_time"].values):
                axis.axvline(event / factor, **_EVENT)
    axes[0][0].set_title("trajectory", fontsize=10)
    axes[0][1].set_title("p dy/dp at fixed time", fontsize=10)
    for axis in axes[-1]:
        axis.set_xlabel(f"time ({letter.replace('u', 'µ')}s)")
    figure.suptitle(f"Sensitivities of the trajectory, {found.attrs['outcome']}", fontsize=11)
    return figure
