"""Figures of derivatives over impacts, of bands, and of critical speeds."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ..formatting.style import NOTE, broken, picture, title
from ..results import BY_DEFAULT
from ..scene.held import AXIS_LABELS

if TYPE_CHECKING:
    import xarray

_PANELS = 4
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


@picture
def draw_gradients(data: xarray.Dataset) -> Figure:
    """Elasticities of each result over what of the impact varies; the strongest six parameters are drawn."""
    quantities = data["quantity"].values[:_PANELS]
    figure = Figure(figsize=(7.0, 1.2 + 2.3 * len(quantities)), layout="constrained")
    axes = figure.subplots(len(quantities), 1, sharex=True, squeeze=False)[:, 0]
    x, label = _across(data)
    order = np.argsort(x, kind="stable")
    outcome = data["outcome"].values[order]
    for axis, name in zip(axes, quantities, strict=True):
        values = data["elasticity"].sel(quantity=name).values
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a parameter without elasticity anywhere
            size = np.nan_to_num(np.nanmedian(np.abs(values), axis=0))
        parameters = [str(one) for one in data["parameter"].values]
        if {"impact.stokes", "impact.speed"} <= {*parameters}:  # one variable
            size[parameters.index("impact.stokes")] = 0.0
        strongest = [k for k in np.argsort(-size) if size[k] > 0]
        for k, colour in zip(strongest, _COLOURS):
            style: Any = {"color": colour, "linewidth": 1.0, "markersize": 4, "label": parameters[k]}
            axis.plot(*broken(outcome, x[order], values[order, k]), ".-", **style)
        axis.axhline(0, color="#202020", linewidth=0.6)
        axis.set_ylabel(str(name).replace("_", " "))
        axis.spines[["top", "right"]].set_visible(False)
        if axis.lines[:-1]:
            axis.legend(fontsize=7, frameon=False, ncols=2)
    axes[-1].set_xlabel(label)
    figure.suptitle("elasticities d ln y/d ln p", fontsize=11)
    return figure


def _across(data: xarray.Dataset) -> tuple[np.ndarray, str]:
    if np.ptp(data["stokes"].values) > 0 or np.ptp(data["angle"].values) == 0:
        return data["stokes"].values, "Stokes number St"
    return np.degrees(data["angle"].values), "impact angle (deg)"


@picture
def draw_band(data: xarray.Dataset) -> Figure:
    """A result with bands of two first-order standard deviations and of the samples' 2.5 to 97.5 %."""
    over = str(next(iter(data.dims)))
    of = next(name for name in BY_DEFAULT if name in data)
    x = np.degrees(data[over].values) if over == "impact.angle" else data[over].values
    y, spread, low, high = data[of].values, 2 * data.first_order.values, data.low.values, data.high.values
    x, y, spread, low, high = broken(data.outcome.values, x, y, spread, low, high)
    figure = Figure(figsize=(6.6, 4.2), layout="constrained")
    axis = figure.subplots()
    shade: Any = {"color": "#2a6f97", "alpha": 0.25, "linewidth": 0, "label": "±2σ, first order"}
    axis.fill_between(x, y - spread, y + spread, **shade)
    axis.plot(x, y, ".-", color="#2a6f97", linewidth=1.6, label="as given")
    dashes: Any = {"color": "#c1554a", "linewidth": 0.9, "linestyle": "--"}
    axis.plot(x, low, label=f"2.5 and 97.5 % of {data.attrs['samples']} samples", **dashes)
    axis.plot(x, high, **dashes)
    unit = data[of].attrs["units"]
    axis.set_ylabel(of.replace("_", " ") + ("" if unit == "1" else f" ({unit})"))
    name = over.partition(".")[2]
    axis.set_xlabel(AXIS_LABELS.get(name, "impact angle (deg)"))
    title(figure, f"{of.replace('_', ' ')} with {data.attrs['uncertainty']} uncertain")
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend()
    return figure


@picture
def draw_critical(critical: Any) -> Figure:
    """Relative speed up to which impacts stick, over the angle; by material where each has one angle."""
    lines = critical.rows
    labels = list(dict.fromkeys(one.material for one in lines))
    by_material = len(labels) == len(lines) > 1
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.subplots()
    for label in [""] if by_material else labels:
        rows = [one for one in lines if by_material or one.material == label]
        x = [float(k) if by_material else math.degrees(one.angle) for k, one in enumerate(rows)]
        y = [math.nan if one.relative_speed is None else one.relative_speed for one in rows]
        (line,) = axes.plot(x, y, "o" if by_material else "o-", label=label or None)
        for at, one in zip(x, rows, strict=True):
            ends = [each for each in one.interval or () if each is not None]
            if len(ends) == 2:
                axes.plot([at, at], ends, "-", color=line.get_color(), linewidth=3, alpha=0.4)
            if one.bounces_above not in (None, one.relative_speed):
                axes.plot(at, one.bounces_above, "^", color=NOTE, markersize=4)
    if by_material:
        axes.set_xticks(range(len(labels)), labels, rotation=30, ha="right")
    elif len(labels) > 1:
        axes.legend()
    axes.set(yscale="log", xlabel="" if by_material else "impact angle (deg)", ylabel="relative speed (m/s)")
    axes.set_title("sticks up to (circles, bars: 95 % interval); bounces above (triangles)", fontsize=9)
    return figure
