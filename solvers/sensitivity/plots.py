"""Figures of derivatives: elasticities as bars and over impacts, bands of uncertainty, and critical speeds."""

from __future__ import annotations

import math
import textwrap
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ..collision.text import name_of
from ..formatting import ticks
from ..formatting.style import LONGEST, NOTE, broken, picture, plain_text, title
from ..results import BY_DEFAULT, DEFINITIONS
from ..scene.held import AXIS_LABELS

if TYPE_CHECKING:
    import xarray

_UP, _DOWN, _INK = "#2a6f97", "#c1554a", "#222222"
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_MOST = 16  # most bars in a panel
_SEEN = 0.005  # shortest bar, relative to a panel's longest
_LONG = 6  # most columns of panels
_WIDE = 4  # largest speed over the smallest, from which the axis is logarithmic
_BAR: Any = {"linewidth": 3, "alpha": 0.4}  # of an interval
_LABEL = 30  # most characters of a material's name on the axis
_CURVES, _PANELS, _ACROSS = 4, 6, 3  # panels of results over impacts; of changes of outcome, and side by side
_NAMES = {
    "impact.speed": "normal speed, Stokes",
    "impact.angle": "impact angle",
    "bridge.volume": "bridge volume",
    "particles.youngs_modulus": "Young's modulus",
    "particles.poisson_ratio": "Poisson's ratio",
}
"""Labels of parameters whose entry names are not descriptive enough."""


@picture
def draw(result: Any) -> Figure:
    """A panel per quantity and a bar per parameter of `Sensitivities`; below it those without a visible elasticity."""
    names = [name for name in result.value if any(result.elasticity[name].values())]
    panels = names[:_LONG] or list(result.value)[:1]
    order = _ranked(result, panels)
    rows = max(len(order), 1)
    figure = Figure(figsize=(2.3 + 3.1 * len(panels), 1.5 + 0.3 * rows), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axis, name in zip(axes, panels):
        _panel(axis, result, name, order)
    weak = [p for p in result.parameters if p not in order and any(result.elasticity[y][p] for y in panels)]
    left_out = [p for p in result.parameters if p not in order and p not in weak]
    if not order:
        axes[0].axis("off")
        axes[0].text(
            0.5, 0.5, "nothing moves it: a stick has e_n = 0" if result.outcome == "stick" else "no elasticity here",
            ha="center", va="center", transform=axes[0].transAxes, fontsize=9, color=_INK,
        )  # fmt: skip
    restitution = result.value.get("restitution")
    notes = [result.outcome if restitution is None else f"{result.outcome}, $e_n$ = {restitution:.4g}"]
    notes += [f"too little to be seen: {', '.join(_short(weak))}"] if _short(weak) else []
    notes += [f"no influence or no elasticity: {', '.join(_short(left_out))}"] if left_out else []
    title(figure, f"{plain_text(name_of(result.scene, LONGEST))}: elasticities d ln y / d ln p")
    figure.supxlabel(textwrap.fill("; ".join(notes), 34 * len(panels) + 30), color="#555555")
    return figure


def _ranked(result: Any, names: Sequence[str]) -> list[str]:
    """Parameters with influence, the largest last (bars are drawn from below); speed and Stokes number appear once."""
    single = [p for p in result.parameters if not (p == "impact.stokes" and "impact.speed" in result.parameters)]
    sizes = np.array([[abs(result.elasticity[y][p] or 0.0) for y in names] for p in single]).reshape(-1, len(names))
    order = np.argsort(sizes.max(axis=1), kind="stable")
    visible = (sizes > _SEEN * sizes.max(axis=0, initial=0.0)).any(axis=1)
    return [single[k] for k in order if visible[k]][-_MOST:]


def _panel(axis: Any, result: Any, name: str, order: Sequence[str]) -> None:
    """Draw the bars of one quantity, each labelled with its elasticity."""
    values = [result.elasticity[name][p] or 0.0 for p in order]
    bars = _bars(axis, values, [_label(p) for p in order])
    reach = max((abs(v) for v in values), default=1.0) or 1.0
    axis.set_xlim(-1.45 * reach, 1.45 * reach)
    for bar, value in zip(bars, values):
        text = f"{value:.2g}" if abs(value) >= 0.01 else f"{value:.0e}"
        side = 1 if value >= 0 else -1
        axis.annotate(
            text, (value, bar.get_y() + bar.get_height() / 2), (3 * side, 0), textcoords="offset points",
            ha="left" if side > 0 else "right", va="center", fontsize=7.5, color=_INK,
        )  # fmt: skip
    unit = DEFINITIONS[name].unit
    axis.set_title(f"{name.replace('_', ' ')}\n{result.value[name]:.4g}{'' if unit == '1' else ' ' + unit}", color=_INK)
    axis.tick_params(axis="y", length=0)


def _bars(axis: Any, values: Sequence[float], labels: Sequence[str], **of_labels: Any) -> Any:
    bars = axis.barh(range(len(values)), values, color=[_UP if v >= 0 else _DOWN for v in values], height=0.7)
    axis.set_yticks(range(len(values)), labels, **of_labels)
    axis.axvline(0, color=_INK, linewidth=0.8)
    axis.spines[["top", "right", "left"]].set_visible(False)
    return bars


def _label(name: str) -> str:
    return _NAMES.get(name, name.partition(".")[2].replace("_", " "))


def _short(names: Sequence[str]) -> list[str]:
    return [_label(name) for name in names if name != "impact.stokes"]


def draw_boundaries(boundaries: Any) -> Figure:
    """A panel for each change (at most six), a bar for each parameter; of Ce* where there is one, else of the speed."""
    parameters, panels = boundaries.parameters, boundaries.pairs[:_PANELS]
    across = max(1, min(_ACROSS, len(panels)))
    down = max(1, -(-len(panels) // across))
    height = 1.1 + 0.22 * len(parameters)
    figure = Figure(figsize=(2.2 + 3.0 * across, 0.5 + height * down), layout="constrained")
    grid = figure.subplots(down, across, sharey=True, squeeze=False)
    for axis in grid.ravel()[len(panels) :]:
        axis.set_visible(False)
    for axis, (angle, shift) in zip(grid.ravel(), panels):
        of = shift.results[-1]
        values = [shift.elasticity[of][name] or 0.0 if shift.elasticity else 0.0 for name in parameters]
        _bars(axis, values, parameters, fontsize=7.5)
        symbol = {"centrifugal": "Ce*", "speed": "(normal speed)"}[of]
        axis.set_title(f"{math.degrees(angle):.4g}°, {shift.change.before} → {shift.change.after}", fontsize=8)
        axis.set_xlabel(f"d ln {symbol}/d ln p" if not shift.reason else shift.reason[:40], fontsize=8)
    figure.suptitle("how the boundaries move with the parameters" if panels else "no change of outcome", fontsize=11)
    return figure


@picture
def draw_gradients(data: xarray.Dataset) -> Figure:
    """Elasticities of each result over what of the impact varies; the strongest six parameters are drawn."""
    quantities = data["quantity"].values[:_CURVES]
    figure = Figure(figsize=(7.0, 1.2 + 2.3 * len(quantities)), layout="constrained")
    axes = figure.subplots(len(quantities), 1, sharex=True, squeeze=False)[:, 0]
    x, label = data["stokes"].values, "Stokes number St"
    if np.ptp(x) == 0 and np.ptp(data["angle"].values) > 0:
        x, label = np.degrees(data["angle"].values), "impact angle (deg)"
    order = np.argsort(x, kind="stable")
    outcome = data["outcome"].values[order]
    for axis, name in zip(axes, quantities, strict=True):
        values = data["elasticity"].sel(quantity=name).values
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a parameter without elasticity anywhere
            size = np.nan_to_num(np.nanmedian(np.abs(values), axis=0))
        parameters = [str(parameter) for parameter in data["parameter"].values]
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
    labels = list(dict.fromkeys(row.material for row in lines))
    by_material, several = len(labels) == len(lines) > 1, len(labels) > 1
    spread = [row.interval is not None and None not in row.interval for row in lines]
    above = [row.bounces_above if row.bounces_above != row.relative_speed else None for row in lines]
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes, speeds = figure.subplots(), []
    for label in [""] if by_material else labels:
        places = [k for k, row in enumerate(lines) if by_material or row.material == label]
        x = [float(k) if by_material else math.degrees(lines[k].angle) for k in places]
        y = [math.nan if lines[k].relative_speed is None else lines[k].relative_speed for k in places]
        named = plain_text(label) if several and not by_material else None
        (line,) = axes.plot(x, y, "o" if by_material else "o-", label=named)
        for at, k in zip(x, places, strict=True):
            if spread[k]:
                axes.plot([at, at], lines[k].interval, "-", color=line.get_color(), **_BAR)
            if (bounce := above[k]) is not None:
                axes.plot(at, bounce, "^", color=NOTE, markersize=4)
            speeds += [speed for speed in (above[k], *(lines[k].interval or ()), lines[k].relative_speed) if speed]
    axes.plot([], [], "o", color=NOTE, label="sticks up to")
    if any(spread):
        axes.plot([], [], "-", color=NOTE, label="95 % interval", **_BAR)
    if any(speed is not None for speed in above):
        axes.plot([], [], "^", color=NOTE, markersize=4, label="bounces above")
    axes.legend()
    if by_material:
        words = [plain_text(textwrap.shorten(label, _LABEL)) for label in labels]
        axes.set_xticks(range(len(labels)), words, rotation=30, ha="right")
        axes.margins(x=0.5 / len(labels))
    axes.set(xlabel="" if by_material else "impact angle (deg)", ylabel="relative speed (m/s)")
    if speeds and max(speeds) > _WIDE * min(speeds):
        axes.set_yscale("log")
        ticks.plain(axes.yaxis)
    return figure
