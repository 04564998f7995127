"""Outcomes of many collisions as a figure: a map where they lie on a grid, else a point for each."""

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
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FixedLocator, MaxNLocator

from ...generated.automaton import OUTCOMES
from ..collision.text import against, name_of, plain, quantity
from ..formatting import ticks
from ..formatting.style import (
    EDGES,
    FILLS,
    HATCHES,
    INK,
    LETTERS,
    LONGEST,
    NOTE,
    NOTHING,
    halo,
    letters,
    patch,
    picture,
    plain_text,
)
from ..formatting.style import title as write_title
from ..model.validity import counted
from ..results import FAILED, VALIDITY
from ..scene.held import AXIS_LABELS, NAMES
from ..scene.scene import Scene
from .regime_map import IMPACTS, impact_axis, scene_of

if TYPE_CHECKING:
    import xarray

_MOST = 9  # most panels of a map that varies more than the impact
_PANEL, _ACROSS = 3.1, 3  # width of a panel in inches; panels in a row
_WIDTH, _HEIGHT = 9.0, 4.7  # size of a map of the impact alone, inches
_HANDLE = 2.1  # width of an entry of the legend, inches
_NOTES = 0.062  # width of a character of the notes, inches
_NOTE_HEIGHT, _NOTES_USUAL = 0.14, 4  # height of a line of notes, inches; lines for which there is room
HIGHEST = 2.0  # most e_n that the colours tell apart: near grazing incidence it grows without bound
_LEVELS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
_CROSS: Any = {"linestyle": "", "marker": "x", "color": "#B00020", "markersize": 5}
_OUTSIDE: Any = {"facecolor": "none", "edgecolor": "#303030", "hatch": "...", "linewidth": 0}

Curve = tuple[np.ndarray, np.ndarray]  # angles (rad), and Stokes numbers or speeds (m/s)
Curves = Mapping[int, Sequence[Curve]]  # of each panel: its flat index among what varies, 0 without


@picture
def draw(data: xarray.Dataset) -> Figure:
    """Draw what `regime_map` or `collide_many` has returned: a map, or a point for each collision."""
    return draw_map(data) if "Conventions" in data.attrs else _points(data)


@picture
def draw_map(data: xarray.Dataset, curves: Curves | None = None) -> Figure:
    """Draw a regime map as returned by `regime_map` or read from a file.

    Arguments:
        curves: exact boundaries to draw over the cells, as `boundaries.on_map.map_curves` finds them.
    """
    scene = scene_of(data)
    data, alone = _without_impact_axis(data)
    varied = [str(name) for name in data["outcome"].dims if name not in ("angle", _vertical(data))]
    if varied:
        figure, notes = _multiples(data, varied, curves or {})
        title = "outcomes"
    else:
        figure, notes = _pair(data, curves or {}), []
        title = f"outcome and normal restitution{alone}"
    across = figure.get_figwidth()
    write_title(figure, f"{plain_text(name_of(scene, LONGEST))}{against(scene)}: {title}")
    notes += _notes(data, scene)
    assumed = [line for line in scene.assumed if line.split(" ")[0] not in varied and not line.startswith("impact.")]
    lines = [textwrap.fill(line, int(across / _NOTES)) for line in notes]
    lines += [textwrap.shorten(line, int(across / _NOTES)) for line in assumed]
    text = "\n".join(plain_text(line) for line in lines)
    figure.set_figheight(figure.get_figheight() + _NOTE_HEIGHT * max(0, text.count("\n") - _NOTES_USUAL))
    figure.supxlabel(text, color=NOTE)
    return figure


def _without_impact_axis(data: xarray.Dataset) -> tuple[xarray.Dataset, str]:
    """The map without an impact axis of length 1, if just one entry varies, and that impact as text."""
    impact = impact_axis(data)
    varied = [name for name in data["outcome"].dims if name not in ("angle", impact)]
    if data.sizes[impact] > 1 or len(varied) != 1 or data.sizes[varied[0]] < 2:
        return data, ""
    unit = "" if impact == "stokes" else " m/s"
    return data.isel({impact: 0}), f" at {NAMES[impact]} {float(data[impact][0]):.4g}{unit}"


def _vertical(data: xarray.Dataset) -> str:
    """The dimension that is drawn upwards: the impact's, or the entry that varies in its place."""
    dims = [str(name) for name in data["outcome"].dims if name != "angle"]
    return next((name for name in dims if name in IMPACTS), dims[0])


def _notes(data: xarray.Dataset, scene: Scene) -> list[str]:
    """Counts of the outcomes, the model's variants under their names in a scene, and the limits that are passed."""
    outcome, model = data["outcome"].values, scene.model
    counts = [f"{np.count_nonzero(outcome == k)} {LETTERS[name]}" for k, name in enumerate(OUTCOMES)]
    failed = np.count_nonzero(outcome == FAILED)
    counts += [f"{failed} failed"] if failed else []
    run = f"relative tolerance {data.attrs['rtol']:g}, engine {data.attrs['engine']}"
    parts = [f"arm {model.arm}", f"tangential {model.tangential}", f"film {model.film}"]
    parts += [f"glass {model.glass}"] if scene.liquid.glass_transition_pressure is not None else []
    parts.append("no bridge" if scene.bridge is None else f"bridge {scene.bridge.law}")
    if scene.pendulum is not None:
        parts.append(f"strings {quantity(scene.pendulum.length, 'm')} long, {scene.pendulum.law}")
    notes = [f"{outcome.size} collisions: {', '.join(counts)}; {run}", f"model: {', '.join(parts)}"]
    if VALIDITY in data and data[VALIDITY].values.any():
        limits = ", ".join(f"{words} in {count} cells" for words, count in counted(data[VALIDITY].values))
        notes.append(f"outside the model's range: {limits}")
    return notes


def _pair(data: xarray.Dataset, curves: Curves) -> Figure:
    """Outcomes, and restitution to their right."""
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=[0.05, 1])
    left = figure.add_subplot(grid[1, 0])
    right = figure.add_subplot(grid[1, 1], sharey=left)
    _outcomes(left, data)
    angles, values = np.degrees(data["angle"].values), data[_vertical(data)].values
    letters(left, _upright(data, "outcome"), angles, values)
    separated = _upright(data, "outcome") > 0
    values = np.ma.masked_invalid(np.where(separated, _upright(data, "restitution"), np.nan))
    right.set_facecolor(NOTHING)
    highest = float(values.max()) if values.count() else 1.0
    top = min(max(highest, 1.0), HIGHEST)
    mesh = right.pcolormesh(*_edges(data), values, cmap="viridis", vmin=0, vmax=top, rasterized=True)
    label_scale(figure.colorbar(mesh, ax=right, pad=0.02, extend="max" if highest > top else "neither"), top, highest)
    for axes in (left, right):
        _frame(axes, data, left_most=axes is left)
        _exact(axes, curves.get(0, ()))
        _failed(axes, data)
    _contours(right, data, [level for level in _LEVELS if level == 1 or level > top])
    right.tick_params(labelleft=False)
    _legend(figure.add_subplot(grid[0, :]), _handles(data, curves), _WIDTH)
    return figure


def label_scale(bar: Any, top: float, highest: float) -> None:
    """Label the colours of e_n, with the limit from which on they are the same."""
    bar.set_label("normal restitution $e_n$ (grey: stick)")
    if highest > top:
        places = np.linspace(0, top, 5)
        bar.set_ticks(places, labels=[*(f"{place:g}" for place in places[:-1]), f"≥ {top:g}"])
        bar.ax.set_title(f"up to {highest:.3g}", fontsize=8)


def _legend(axes: Axes, handles: list[Any], width: float) -> None:
    axes.axis("off")
    columns = max(2, min(len(handles), int(width / _HANDLE)))
    axes.legend(handles=handles, loc="center", ncols=columns, handlelength=2.4, handleheight=1.1)


def _multiples(data: xarray.Dataset, varied: list[str], curves: Curves) -> tuple[Figure, list[str]]:
    """One panel for each value of the varied entries: outcomes with contours of restitution."""
    sizes = [data.sizes[name] for name in varied]
    chosen = panels(data)
    across = 2 if len(chosen) == 4 else min(_ACROSS, len(chosen))
    down = math.ceil(len(chosen) / across)
    figure = Figure(figsize=(max(6.5, 0.6 + _PANEL * across), 1.9 + 2.6 * down), layout="constrained")
    grid = figure.add_gridspec(1 + down, across, height_ratios=[0.05] + [1] * down)
    for number, place in enumerate(chosen):
        axes = figure.add_subplot(grid[1 + number // across, number % across])
        index = dict(zip(varied, np.unravel_index(place, sizes), strict=True))
        panel = data.isel({name: int(k) for name, k in index.items()})
        _outcomes(axes, panel)
        axes.set_title(", ".join(_value(panel, name) for name in varied))
        left_most, lowest = number % across == 0, number + across >= len(chosen)
        _frame(axes, panel, left_most, lowest)
        _exact(axes, curves.get(place, ()))
        _failed(axes, panel)
        _contours(axes, panel, _LEVELS)
        axes.tick_params(labelleft=left_most, labelbottom=lowest)
    lines = Line2D([], [], color=INK, linewidth=0.9, label="normal restitution $e_n$")
    _legend(figure.add_subplot(grid[0, :]), [*_handles(data, curves), lines], figure.get_figwidth())
    total = math.prod(sizes)
    return figure, [f"{len(chosen)} of {total} panels are shown"] if total > len(chosen) else []


def panels(data: xarray.Dataset) -> list[int]:
    """Flat indices among the varied entries of the panels that are drawn; [0] where nothing but the impact varies."""
    total = math.prod(data.sizes[name] for name in data["outcome"].dims if name not in ("angle", *IMPACTS))
    return [int(k) for k in np.unique(np.linspace(0, total - 1, min(total, _MOST)).round())]


def _value(panel: xarray.Dataset, name: str) -> str:
    unit = panel[name].attrs.get("units", "1")
    value = float(panel[name])
    if unit == "rad":
        text = f"{math.degrees(value):.4g}°"
    else:
        text = f"{value:.4g}" if unit == "1" else (plain if abs(value) >= 1 else quantity)(value, unit)
    return f"{name.rpartition('.')[2].replace('_', ' ')} {text.replace(' u', ' µ')}"


def _upright(data: xarray.Dataset, name: str) -> np.ndarray:
    """A variable as a 2-D array, with a row for each Stokes number or speed."""
    return np.asarray(data[name].transpose(_vertical(data), "angle").values)


def _outcomes(axes: Axes, data: xarray.Dataset) -> None:
    """Colour the cells by outcome, with the hatch of the outcome, and hatch those outside the model's range."""
    outcome = _upright(data, "outcome")
    colours = ListedColormap(list(FILLS.values()))
    edges = _edges(data)
    cells = np.ma.masked_less(outcome, 0)
    axes.pcolormesh(*edges, cells, cmap=colours, vmin=-0.5, vmax=2.5, rasterized=True)
    for k, name in enumerate(OUTCOMES):
        if HATCHES[name]:
            style = {"facecolor": "none", "edgecolor": EDGES[name], "hatch": HATCHES[name], "linewidth": 0}
            _hatch(axes, edges, outcome == k, f"cells of {name}", style)
    if VALIDITY in data:
        _hatch(axes, edges, _upright(data, VALIDITY) != 0, "cells outside the range", _OUTSIDE)


def _hatch(axes: Axes, edges: tuple[np.ndarray, np.ndarray], cells: np.ndarray, name: str, style: Any) -> None:
    """Hatch cells, as one patch: a rectangle for each run of a column."""
    across, up = edges
    rectangles = []
    for column in range(cells.shape[1]):
        ends = np.flatnonzero(np.diff(np.concatenate([[False], cells[:, column], [False]]).astype(int)))
        for low, high in zip(ends[::2], ends[1::2]):
            x, y = across[column : column + 2], (up[low], up[high])
            rectangles.append(Path([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])], closed=True))
    if rectangles:
        hatched = PathPatch(Path.make_compound_path(*rectangles), zorder=1.5, **style)
        hatched.set_gid(name)
        axes.add_patch(hatched)


def _exact(axes: Axes, curves: Sequence[Curve]) -> None:
    for x, y in curves:
        (line,) = axes.plot(np.degrees(x), y, color=INK, linewidth=1.6, zorder=3)
        line.set_gid("boundary")


def _failed(axes: Axes, data: xarray.Dataset) -> None:
    outcome = _upright(data, "outcome")
    rows, columns = np.nonzero(outcome == FAILED)
    if rows.size:
        x, y = np.degrees(data["angle"].values)[columns], data[_vertical(data)].values[rows]
        axes.plot(x, y, clip_on=False, zorder=5, **_CROSS | {"markersize": max(2.0, min(6.0, 90 / max(outcome.shape)))})


def _contours(axes: Axes, data: xarray.Dataset, levels: Sequence[float]) -> None:
    """Draw labelled contours of restitution, separately for each outcome because it jumps between them."""
    outcome, restitution = _upright(data, "outcome"), _upright(data, "restitution")
    x, y = np.degrees(data["angle"].values), data[_vertical(data)].values
    for k in (1, 2):
        values = np.ma.masked_where(outcome != k, restitution)
        if min(values.shape) < 2 or values.count() < 4:
            continue
        if wanted := [level for level in levels if values.min() < level < values.max()]:
            widths = [1.4 if level == 1 else 0.9 for level in wanted]
            lines = axes.contour(x, y, values, wanted, colors=INK, linewidths=widths, path_effects=[halo()], zorder=4)
            for label in axes.clabel(lines, fmt="%g", fontsize=8):
                label.set_path_effects([halo(3)])


def _frame(axes: Axes, data: xarray.Dataset, left_most: bool, lowest: bool = True) -> None:
    """Set scales, ticks and labels."""
    name = _vertical(data)
    if _logarithmic(data[name].values):
        axes.set_yscale("log")
        ticks.plain(axes.yaxis)
    across, up = _edges(data)
    axes.set_xlim(across[0], across[-1])
    axes.set_ylim(up[0], up[-1])
    steps = (1, 1.5, 3, 10) if across[-1] - across[0] > 20 else (1, 2, 5, 10)
    axes.xaxis.set_major_locator(MaxNLocator(7, steps=steps))
    for axis, values in ((axes.xaxis, np.degrees(data["angle"].values)), (axes.yaxis, data[name].values)):
        if values.size == 1:  # a strip: what it shows is computed there only
            axis.set_major_locator(FixedLocator(values))
            axis.set_major_formatter(f"{values[0]:g}")
    if lowest:
        axes.set_xlabel("impact angle $\\theta_0$ (deg)")
    if left_most:
        unit = data[name].attrs.get("units", "1")
        entry = f"{name.rpartition('.')[2].replace('_', ' ')}{'' if unit == '1' else f' ({unit})'}"
        axes.set_ylabel(AXIS_LABELS.get(name, entry))


def _handles(data: xarray.Dataset, curves: Curves) -> list[Any]:
    present = np.unique(data["outcome"].values)
    handles: list[Any] = [patch(outcome) for k, outcome in enumerate(OUTCOMES) if k in present]
    if any(curves.values()):
        handles.append(Line2D([], [], color=INK, linewidth=1.6, label="exact boundary"))
    if VALIDITY in data and data[VALIDITY].values.any():
        handles.append(Patch(label="outside the model's range", **_OUTSIDE))
    if (data["outcome"].values == FAILED).any():
        handles.append(Line2D([], [], label="failed", **_CROSS))
    return handles


def _edges(data: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the cells in both directions: midway between points, and the first and last point."""
    values = data[_vertical(data)].values
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


def _points(data: xarray.Dataset) -> Figure:
    """A point for each collision, over impact angle and Stokes number or speed, marked by its outcome."""
    impact = "stokes" if "stokes" in data.coords else "speed"
    outcome = data["outcome"].values.ravel()
    x, y = (data[name].broadcast_like(data["outcome"]).transpose(*data["outcome"].dims).values.ravel()
            for name in ("angle", impact))  # fmt: skip
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.add_subplot()
    for code, (name, mark) in enumerate(zip(OUTCOMES, "o^s", strict=True)):
        here = outcome == code
        if here.any():
            edge: Any = {"linewidths": 0.4, "edgecolors": "#404040", "label": f"{name} ({int(here.sum())})"}
            axes.scatter(np.degrees(x[here]), y[here], s=26, c=EDGES[name], marker=mark, **edge)
    failed = outcome == FAILED
    if failed.any():
        axes.scatter(np.degrees(x[failed]), y[failed], s=30, c="#C00000", marker="x", label=f"failed ({failed.sum()})")
    if y.size and y.min() > 0 and y.max() > 20 * y.min():
        axes.set_yscale("log")
    axes.set(xlabel="impact angle (deg)", ylabel=AXIS_LABELS[impact])
    write_title(figure, f"{plain_text(name_of(scene_of(data), LONGEST))}: outcomes of {outcome.size} collisions")
    axes.spines[["top", "right"]].set_visible(False)
    if outcome.size:
        figure.legend(loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    return figure
