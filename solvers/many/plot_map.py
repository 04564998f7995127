"""A regime map as a figure: outcomes and restitution over impact angle and Stokes number."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ...generated.automaton import OUTCOMES
from ..collision.text import name_of, quantity
from ..formatting import ticks
from ..scene.scene import Scene
from .regime_map import IMPACTS, impact_axis, scene_of
from .results import FAILED

if TYPE_CHECKING:
    import xarray

COLOURS = ("#0072B2", "#E69F00", "#F0E442")  # Okabe-Ito, from light to dark so that they differ in greyscale
LETTERS = ("S", "SRS", "B")
_INK = ("white", "black", "black")
_NOTE = "#6E6E6E"
_MOST = 9  # most panels of a map that varies more than the impact
_PANEL, _ACROSS = 3.1, 3  # inches; panels in a row
_WIDTH, _HEIGHT = 9.0, 4.7  # inches; map of the impact alone
_CROSS: Any = {"linestyle": "", "marker": "X", "color": "white", "markeredgecolor": "black", "markersize": 7}
_NOTHING = "#DDDDDD"
_BRIGHTEST = 2.0  # upper limit of e_n in the colour scale: near grazing it grows without bound
_LEVELS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)


def draw_map(data: xarray.Dataset) -> Figure:
    """Draw a regime map as returned by `regime_map` or read from a file; a panel for each value of a further entry."""
    scene = scene_of(data)
    varied = [name for name in data["outcome"].dims if name not in ("angle", *IMPACTS)]
    if varied:
        figure, notes = _multiples(data, varied)
    else:
        figure, notes = _pair(data), []
    title = name_of(scene).replace("$", r"\$")
    variant = textwrap.fill(_variant(scene), int(11 * figure.get_figwidth()))
    figure.suptitle(f"{title}: outcomes\n{variant}", fontsize=10)
    across = figure.get_figwidth()
    notes += [_counts(data), *(line for line in scene.assumed if line.split(" ")[0] not in varied)]
    notes = [textwrap.shorten(line, int(14 * across)).replace("$", r"\$") for line in notes]
    figure.supxlabel("\n".join(notes), fontsize=7.5, color=_NOTE)
    return figure


def _variant(scene: Scene) -> str:
    """The names of the laws used, as a note for the figure."""
    model = scene.model
    parts = [f"{model.arm} lever arm", f"{model.tangential} tangential force"]
    parts += [f"{model.glass} glass criterion"] if scene.liquid.glass_transition_pressure is not None else []
    parts.append("no capillary force" if scene.bridge is None else f"capillary force by {scene.bridge.law}")
    if scene.pendulum is not None:
        parts.append(f"strings of {quantity(scene.pendulum.length, 'm')}, {scene.pendulum.law}")
    return ", ".join(parts)


def _counts(data: xarray.Dataset) -> str:
    outcome = data["outcome"].values
    found = [f"{np.count_nonzero(outcome == k)} {letter}" for k, letter in enumerate(LETTERS)]
    failed = np.count_nonzero(outcome == FAILED)
    if failed:
        found.append(f"{failed} failed")
    told = f"relative tolerance {data.attrs['rtol']:g}, engine {data.attrs['engine']}"
    return f"{outcome.size} collisions: {', '.join(found)}; {told}"


def _pair(data: xarray.Dataset) -> Figure:
    """Draw the outcomes, and the restitution beside them."""
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=[0.05, 1])
    left = figure.add_subplot(grid[1, 0])
    right = figure.add_subplot(grid[1, 1], sharey=left)
    _outcomes(left, data)
    _letters(left, data)
    values = np.ma.masked_invalid(_restitution(data))
    right.set_facecolor(_NOTHING)
    highest = float(values.max()) if values.count() else 1.0
    top = min(max(highest, 1.0), _BRIGHTEST)
    mesh = right.pcolormesh(*_edges(data), values, cmap="viridis", vmin=0, vmax=top, rasterized=True)
    bar = figure.colorbar(mesh, ax=right, pad=0.02, extend="max" if highest > top else "neither")
    bar.set_label("normal restitution $e_n$ (grey: stick)", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    _contours(right, data, [1.0], "white")
    _contours(right, data, [2.0, 3.0, 5.0])
    _failed(right, data)
    for axes in (left, right):
        _frame(axes, data, left_most=axes is left)
    right.tick_params(labelleft=False)
    _legend(figure.add_subplot(grid[0, :]), _handles(data))
    return figure


def _legend(axes: Axes, handles: list[Any]) -> None:
    axes.axis("off")
    axes.legend(handles=handles, loc="center", ncols=len(handles), fontsize=8.5, frameon=False)


def _multiples(data: xarray.Dataset, varied: list[str]) -> tuple[Figure, list[str]]:
    """Draw a panel for each value of the varied entry: outcomes with lines of equal restitution."""
    sizes = [data.sizes[name] for name in varied]
    total = math.prod(sizes)
    chosen = np.unique(np.linspace(0, total - 1, min(total, _MOST)).round().astype(int))
    across = 2 if chosen.size == 4 else min(_ACROSS, chosen.size)
    down = math.ceil(chosen.size / across)
    figure = Figure(figsize=(max(6.5, 0.6 + _PANEL * across), 1.7 + 2.6 * down), layout="constrained")
    grid = figure.add_gridspec(1 + down, across, height_ratios=[0.05] + [1] * down)
    for number, place in enumerate(chosen):
        axes = figure.add_subplot(grid[1 + number // across, number % across])
        index = dict(zip(varied, np.unravel_index(place, sizes), strict=True))
        part = data.isel({name: int(k) for name, k in index.items()})
        _outcomes(axes, part)
        _contours(axes, part, _LEVELS)
        axes.set_title(", ".join(_value(part, name) for name in varied), fontsize=9)
        left_most, lowest = number % across == 0, number + across >= chosen.size
        _frame(axes, part, left_most, lowest)
        axes.tick_params(labelleft=left_most, labelbottom=lowest)
    lines = Line2D([], [], color="black", linewidth=0.8, label="normal restitution $e_n$")
    _legend(figure.add_subplot(grid[0, :]), [*_handles(data), lines])
    return figure, [f"{chosen.size} of {total} panels are shown."] if total > chosen.size else []


def _value(part: xarray.Dataset, name: str) -> str:
    unit = part[name].attrs.get("units", "1")
    value = float(part[name])
    if unit == "rad":
        text = f"{math.degrees(value):.4g}°"
    else:
        text = f"{value:.4g}" if unit == "1" else quantity(value, unit)
    return f"{name.rpartition('.')[2].replace('_', ' ')} {text.replace(' u', ' µ')}"


def _upright(data: xarray.Dataset, name: str) -> np.ndarray:
    """A variable as a 2-D array, with a row for each Stokes number or speed."""
    return np.asarray(data[name].transpose(impact_axis(data), "angle").values)


def _restitution(data: xarray.Dataset) -> np.ndarray:
    """Restitution of the pairs that separate, NaN elsewhere."""
    return np.where(_upright(data, "outcome") > 0, _upright(data, "restitution"), np.nan)


def _outcomes(axes: Axes, data: xarray.Dataset) -> None:
    outcome = np.ma.masked_less(_upright(data, "outcome"), 0)
    axes.pcolormesh(*_edges(data), outcome, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=2.5, rasterized=True)
    _failed(axes, data)


def _failed(axes: Axes, data: xarray.Dataset) -> None:
    rows, columns = np.nonzero(_upright(data, "outcome") == FAILED)
    if rows.size:
        x, y = np.degrees(data["angle"].values)[columns], data[impact_axis(data)].values[rows]
        axes.plot(x, y, clip_on=False, zorder=5, **_CROSS)


def _letters(axes: Axes, data: xarray.Dataset) -> None:
    """Write the name of each region where it is widest."""
    outcome = _upright(data, "outcome")
    angles, values = np.degrees(data["angle"].values), data[impact_axis(data)].values
    for k, letter in enumerate(LETTERS):
        inside = np.pad(outcome == k, 1)
        depth = np.zeros(inside.shape)
        while inside.any():  # erode the region; the points that remain last are farthest from its edge
            depth += inside
            inside = (
                inside
                & np.roll(inside, 1, 0) & np.roll(inside, -1, 0) & np.roll(inside, 1, 1) & np.roll(inside, -1, 1)
            )  # fmt: skip
        if depth.max() < 3:  # no room for it
            continue
        row, column = np.unravel_index(np.argmax(depth[1:-1, 1:-1]), outcome.shape)
        axes.annotate(letter, (angles[column], values[row]), ha="center", va="center", color=_INK[k], fontsize=12)


def _contours(axes: Axes, data: xarray.Dataset, levels: Sequence[float], colour: str = "black") -> None:
    """Draw labelled lines of equal restitution, for each outcome separately because it jumps between them."""
    outcome, restitution = _upright(data, "outcome"), _upright(data, "restitution")
    x, y = np.degrees(data["angle"].values), data[impact_axis(data)].values
    for k in (1, 2):
        values = np.ma.masked_where(outcome != k, restitution)
        if min(values.shape) < 2 or values.count() < 4:
            continue
        wanted = [level for level in levels if values.min() < level < values.max()]
        if wanted:
            lines = axes.contour(x, y, values, wanted, colors=colour, linewidths=0.9)
            for label in axes.clabel(lines, fontsize=7.5, fmt=lambda level: f"{level:g}"):
                place = (label.get_position()[0] - x[0]) / (x[-1] - x[0])
                label.set_visible(0.03 < place < 0.97)  # a label on the edge would be cut off


def _frame(axes: Axes, data: xarray.Dataset, left_most: bool, lowest: bool = True) -> None:
    """Set scales, ticks and labels."""
    name = impact_axis(data)
    if _logarithmic(data[name].values):
        axes.set_yscale("log")
        ticks.plain(axes.yaxis)
    across, up = _edges(data)
    axes.set_xlim(across[0], across[-1])
    axes.set_ylim(up[0], up[-1])
    steps = (1, 1.5, 3, 10) if across[-1] - across[0] > 20 else (1, 2, 5, 10)
    axes.xaxis.set_major_locator(MaxNLocator(7, steps=steps))
    axes.tick_params(labelsize=8)
    if lowest:
        axes.set_xlabel("impact angle $\\theta_0$ (deg)", fontsize=9)
    if left_most:
        labels: Mapping[str, str] = {
            "stokes": "Stokes number $St_n$",
            "speed": "normal approach speed $v_0$ (m/s)",
            "relative_speed": r"relative speed $v_0/\cos\theta_0$ (m/s)",
        }
        axes.set_ylabel(labels[name], fontsize=9)


def _handles(data: xarray.Dataset) -> list[Any]:
    handles: list[Any] = [
        Patch(color=colour, label=f"{letter}: {outcome}")
        for colour, letter, outcome in zip(COLOURS, LETTERS, OUTCOMES, strict=True)
    ]
    if (data["outcome"].values == FAILED).any():
        handles.append(Line2D([], [], label="failed", **_CROSS))
    return handles


def _edges(data: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the cells in both directions: midway between points, and the first and last point."""
    values = data[impact_axis(data)].values
    up = np.exp(_between(np.log(values))) if _logarithmic(values) else _between(values)
    return _between(np.degrees(data["angle"].values)), up


def _between(points: np.ndarray) -> np.ndarray:
    if points.size == 1:
        half = 0.05 * abs(points[0]) or 0.5
        return np.array([points[0] - half, points[0] + half])
    return np.concatenate([points[:1], (points[1:] + points[:-1]) / 2, points[-1:]])


def _logarithmic(values: np.ndarray) -> bool:
    """True if points are spaced evenly in the logarithm."""
    if values.size < 3 or values[0] <= 0:
        return False
    ratios = np.diff(np.log(values))
    return bool(np.ptp(ratios) < np.ptp(np.diff(values)) / values[-1])
