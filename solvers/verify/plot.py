"""Figure on e_n > 1: a map of e_n, and the terms of e_n^2 - 1 at two angles."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ..collision.text import name_of
from ..formatting import ticks
from ..host.files import save
from ..scene.scene import Scene
from .budget import LOSSES

# Okabe-Ito; released energy and losses
RELEASED = "#009E73"
COLOURS = {
    "normal_lubrication": "#0072B2",
    "tangential_lubrication": "#56B4E9",
    "capillary": "#CC79A7",
    "dry_contact": "#E69F00",
    "strings": "#8C6D31",
}
_NOTHING, _INK, _NOTE = "#DDDDDD", "black", "#6E6E6E"
_BRIGHTEST = 2.0  # upper limit of e_n in the colour scale
_STEEP = math.radians(75)  # angle of the upper panel, degrees; the lower one is less oblique


def draw_budget(data: xarray.Dataset, path: str | Path | None = None) -> Figure:
    """Draw a budget over angle and Stokes number, as returned by `restitution_budget`.

    Arguments:
        path: file to write (.png, .pdf or .svg); None only draws.
    """
    scene = Scene.from_toml(data.attrs["scene"])
    figure = Figure(figsize=(10.5, 5.4), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=[1, 1.15])
    shown = _rows(data, scene)
    _map(figure, figure.add_subplot(grid[:, 0]), data, shown)
    panels = [figure.add_subplot(grid[k, 1]) for k in range(len(shown))]
    for panel, row, letter in zip(panels, shown, "bc"):
        _terms(panel, data, row, letter)
    panels[0].tick_params(labelbottom=len(panels) == 1)
    panels[-1].set_xlabel("Stokes number St", fontsize=9)
    _legend(figure, data)
    title = name_of(scene).replace("$", r"\$")
    figure.suptitle(
        f"{title}: energy of rotation released against losses, and the restitution that they leave", fontsize=11
    )
    if path is not None:
        save(figure, path, dpi=130)
    return figure


def _rows(data: xarray.Dataset, scene: Scene) -> list[int]:
    """Indices of the angles of the right panels: a steep one, and the scene's or a medium one."""
    angles = data["angle"].values
    steep = int(np.argmin(np.abs(angles - _STEEP)))
    own = scene.angle if scene.angle and scene.angle < _STEEP - 0.1 else math.radians(45)
    other = int(np.argmin(np.abs(angles - own)))
    return list(dict.fromkeys((steep, other)))


def _map(figure: Figure, axes: Axes, data: xarray.Dataset, shown: list[int]) -> None:
    """Draw the map of e_n, white where e_n = 1."""
    e_n = np.ma.masked_where(data["outcome"].values <= 0, data["restitution"].values)
    angles, stokes = np.degrees(data["angle"].values), data["stokes"].values
    norm = TwoSlopeNorm(1.0, 0.0, _BRIGHTEST)
    axes.set_facecolor(_NOTHING)
    above = bool(np.ma.count(e_n)) and float(e_n.max()) > _BRIGHTEST
    mesh = axes.pcolormesh(angles, stokes, e_n.T, cmap="RdBu_r", norm=norm, shading="nearest", rasterized=True)
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, extend="max" if above else "neither", ticks=np.arange(0, 2.1, 0.25))
    bar.set_label("normal restitution $e_n$ (grey: stick)", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    if np.ma.count(e_n) and float(e_n.max()) > 1 > float(e_n.min()):
        # a stick has e_n = 0, so the contour passes between it and its neighbours
        filled = np.where(np.isfinite(data["restitution"].values), data["restitution"].values, 0.0)
        contour = axes.contour(angles, stokes, filled.T, levels=[1.0], colors=_INK, linewidths=1.2)
        axes.clabel(contour, fmt={1.0: "$e_n = 1$"}, fontsize=8)
    else:
        axes.text(0.03, 0.03, "$e_n < 1$ everywhere", transform=axes.transAxes, fontsize=9, ha="left")
    for row, letter in zip(shown, "bc"):
        axes.axvline(angles[row], color=_INK, linewidth=0.8, linestyle=":")
        axes.annotate(
            letter, (angles[row], 1), (0, 2), xycoords=axes.get_xaxis_transform(), textcoords="offset points",
            ha="center", fontsize=8,
        )  # fmt: skip
    axes.set_yscale("log")
    ticks.plain(axes.yaxis, (1, 3))
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=[1, 2, 3, 5, 10]))
    axes.set_xlabel("impact angle (deg)", fontsize=9)
    axes.set_ylabel("Stokes number St", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.set_title("(a)", loc="left", fontsize=10, fontweight="bold")


def _terms(axes: Axes, data: xarray.Dataset, row: int, letter: str) -> None:
    """Draw released energy above zero, losses below, and the sum as a line."""
    stokes = data["stokes"].values
    parted = np.isfinite(data["excess"].values[row])
    axes.set_xscale("log")
    gains, losses = np.zeros(stokes.size), np.zeros(stokes.size)
    for name in ("rotation_released", *LOSSES):
        taken = data[name].values[row] * (1 if name == "rotation_released" else -1)
        taken = np.where(parted, taken, 0.0)
        colour = RELEASED if name == "rotation_released" else COLOURS[name]
        # a bridge may release energy, so each sign is stacked on its side
        for side, stack in ((np.maximum(taken, 0), gains), (np.minimum(taken, 0), losses)):
            axes.fill_between(stokes, stack, stack + side, where=parted, color=colour, linewidth=0)
            stack += side
    excess = data["excess"].values[row]
    axes.plot(stokes, excess, color=_INK, linewidth=1.8)
    axes.plot(stokes, np.where(excess > 0, excess, np.nan), "o", color=_INK, markersize=3.5, markerfacecolor="white")
    axes.axhline(0, color=_INK, linewidth=0.6)
    for first, last in _runs(~parted):
        axes.axvspan(_between(stokes, first - 1, first), _between(stokes, last, last + 1), color=_NOTHING, linewidth=0)
    axes.set_xlim(stokes[0], stokes[-1])
    ticks.plain(axes.xaxis, (1, 3))
    angle = math.degrees(float(data["angle"][row]))
    axes.set_title(f"({letter})", loc="left", fontsize=10, fontweight="bold")
    axes.set_title(f"{angle:.0f}°: terms of $e_n^2 - 1$", fontsize=9)
    axes.set_ylabel("energy / $\\frac{1}{2} m v_0^2$", fontsize=9)
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)


def _runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """First and last indices of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(first), int(after) - 1) for first, after in zip(edges[::2], edges[1::2])]


def _between(values: np.ndarray, low: int, high: int) -> float:
    """Midpoint of two neighbours on a logarithmic axis; the end point beyond the last one."""
    low, high = max(low, 0), min(high, values.size - 1)
    return float(math.sqrt(values[low] * values[high]))


def _legend(figure: Figure, data: xarray.Dataset) -> None:
    there = [name for name in LOSSES if np.nanmax(np.abs(data[name].values), initial=0.0) > 0]
    handles: list[Patch | Line2D] = [Patch(color=RELEASED, label="rotation released")]
    handles += [Patch(color=COLOURS[name], label=LOSSES[name]) for name in there]
    handles += [Line2D([], [], color=_INK, linewidth=1.8, marker="o", markersize=3.5, markerfacecolor="white",
                       label="$e_n^2 - 1$ (circles: > 0)"), Patch(color=_NOTHING, label="stick")]  # fmt: skip
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8, frameon=False)
