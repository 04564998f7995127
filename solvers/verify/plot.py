"""Figure on e_n > 1: a map of e_n, and the terms of e_n^2 - 1 at two angles."""

import math

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from ..boundaries.on_map import map_curves
from ..collision.text import name_of
from ..engines.choice import collision_engine
from ..formatting import ticks
from ..formatting.style import INK, LONGEST, NOTHING, broken, picture, plain_text, title
from ..many.plot_map import HIGHEST, draw_contours, label_scale
from ..many.regime_map import regime_map
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
_FINE = 160  # rows and columns of the map of e_n, where the kernel computes it
_STEEP = math.radians(75)  # angle of the upper panel, degrees; the lower one is less oblique


@picture
def draw_budget(data: xarray.Dataset) -> Figure:
    """Draw a budget over angle and Stokes number, as returned by `restitution_budget`."""
    scene = Scene.from_toml(data.attrs["scene"])
    figure = Figure(figsize=(10.5, 5.4), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=[1, 1.15])
    shown = _rows(data, scene)
    _map(figure, figure.add_subplot(grid[:, 0]), data, shown)
    panels = [figure.add_subplot(grid[k, 1]) for k in range(len(shown))]
    for panel, row, letter in zip(panels, shown, "bc"):
        _terms(panel, data, row, letter)
    panels[0].tick_params(labelbottom=len(panels) == 1)
    panels[-1].set_xlabel("Stokes number St")
    _legend(figure, data)
    name = plain_text(name_of(scene, LONGEST))
    title(figure, f"{name}: energy of rotation released against losses, and the restitution that they leave")
    return figure


def _rows(data: xarray.Dataset, scene: Scene) -> list[int]:
    """Indices of the angles of the right panels: a steep one, and the scene's or a medium one."""
    angles = data["angle"].values
    steep = int(np.argmin(np.abs(angles - _STEEP)))
    angle = scene.angle if scene.angle and scene.angle < _STEEP - 0.1 else math.radians(45)
    other = int(np.argmin(np.abs(angles - angle)))
    return list(dict.fromkeys((steep, other)))


def _map(figure: Figure, axes: Axes, data: xarray.Dataset, shown: list[int]) -> None:
    """Draw the map of e_n, white where e_n = 1, and the exact boundaries between outcomes."""
    fine = _fine(data)
    e_n = np.ma.masked_where(fine["outcome"].values <= 0, fine["restitution"].values)
    angles, stokes = np.degrees(fine["angle"].values), fine["stokes"].values
    axes.set_facecolor(NOTHING)
    norm = TwoSlopeNorm(1.0, 0.0, HIGHEST)
    mesh = axes.pcolormesh(angles, stokes, e_n.T, cmap="RdBu_r", norm=norm, shading="nearest", rasterized=True)
    highest = float(e_n.max()) if e_n.count() else 0.0
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, extend="max" if highest > HIGHEST else "neither")
    label_scale(bar, HIGHEST, max(highest, HIGHEST))
    axes.set_yscale("log")
    axes.set_xlim(angles[0], angles[-1])
    axes.set_ylim(stokes[0], stokes[-1])
    for x, y in map_curves(fine).get(0, []):
        axes.plot(np.degrees(x), y, color=INK, linewidth=0.9, zorder=3)[0].set_gid("boundary")
    draw_contours(axes, fine, [1.0])
    if highest < 1:
        axes.text(0.03, 0.03, "$e_n < 1$ everywhere", transform=axes.transAxes, fontsize=9, ha="left")
    angles = np.degrees(data["angle"].values)
    for row, letter in zip(shown, "bc"):
        axes.axvline(angles[row], color=INK, linewidth=0.8, linestyle=":")
        axes.annotate(
            letter, (angles[row], 1), (0, 2), xycoords=axes.get_xaxis_transform(), textcoords="offset points",
            ha="center", fontsize=8,
        )  # fmt: skip
    ticks.plain(axes.yaxis, (1, 3))
    axes.xaxis.set_major_locator(MaxNLocator(9, steps=[1, 2, 3, 5, 10]))
    axes.set_xlabel("impact angle (deg)")
    axes.set_ylabel("Stokes number St")
    axes.set_title("(a)", loc="left", fontsize=10, fontweight="bold")


def _fine(data: xarray.Dataset) -> xarray.Dataset:
    """Restitution in the window of a budget, on a finer grid where the kernel computes it; else the budget's own."""
    scene = Scene.from_toml(data.attrs["scene"])
    angle, stokes = data["angle"].values, data["stokes"].values
    if collision_engine(scene) != "taylor" or min(angle.size, stokes.size) < 2:
        return data
    across, up = np.linspace(angle[0], angle[-1], _FINE), np.geomspace(stokes[0], stokes[-1], _FINE)
    return regime_map(scene, stokes=up, angle=across, of=("restitution",))


def _terms(axes: Axes, data: xarray.Dataset, row: int, letter: str) -> None:
    """Draw released energy above zero, losses below, and the sum as a line."""
    stokes = data["stokes"].values
    parted, outcome = np.isfinite(data["excess"].values[row]), data["outcome"].values[row]
    axes.set_xscale("log")
    gains, losses = np.where(parted, 0.0, np.nan), np.where(parted, 0.0, np.nan)
    for name in ("rotation_released", *LOSSES):
        taken = data[name].values[row] * (1 if name == "rotation_released" else -1)
        colour = RELEASED if name == "rotation_released" else COLOURS[name]
        # a bridge may release energy, so each sign is stacked on its side
        for side, stack in ((np.maximum(taken, 0), gains), (np.minimum(taken, 0), losses)):
            at, low, high = broken(outcome, stokes, stack, stack + side)
            axes.fill_between(at, low, high, color=colour, linewidth=0)
            stack += side
    excess = data["excess"].values[row]
    axes.plot(*broken(outcome, stokes, excess), color=INK, linewidth=1.8)
    axes.plot(stokes, np.where(excess > 0, excess, np.nan), "o", color=INK, markersize=3.5, markerfacecolor="white")
    axes.axhline(0, color=INK, linewidth=0.6)
    for first, last in _runs(~parted):
        axes.axvspan(_between(stokes, first - 1, first), _between(stokes, last, last + 1), color=NOTHING, linewidth=0)
    axes.set_xlim(stokes[0], stokes[-1])
    ticks.plain(axes.xaxis, (1, 3))
    angle = math.degrees(float(data["angle"][row]))
    axes.set_title(f"({letter})", loc="left", fontsize=10, fontweight="bold")
    axes.set_title(f"{angle:.0f}°: terms of $e_n^2 - 1$")
    axes.set_ylabel("energy / $\\frac{1}{2} m v_0^2$")
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
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
    handles += [Line2D([], [], color=INK, linewidth=1.8, marker="o", markersize=3.5, markerfacecolor="white",
                       label="$e_n^2 - 1$ (circles: > 0)"), Patch(color=NOTHING, label="stick")]  # fmt: skip
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
