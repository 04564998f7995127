"""What single impacts tell, over speed and angle, and the planned ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ..collision.text import against, name_of
from ..formatting import ticks
from ..formatting.style import INK, LONGEST, NOTE, picture, plain_text, title
from ..scene.held import AXIS_LABELS
from .result import Design

if TYPE_CHECKING:
    import xarray

_WORST, _BEST = 1.0, 1e-3  # standard errors from one impact that the colours tell apart, at most
_FINE = 320, 200  # outcomes on speeds and angles, for the lines of their changes
_ROWS = {"information": "outcome and restitution", "by_outcome": "outcome alone"}


@picture
def draw(design: Design) -> Figure:
    """A panel for each entry: outcome and restitution above, the outcome alone below."""
    data = design.map()
    names = list(design.free.names)
    measured = design.window.scatter.restitution is not None
    rows = list(_ROWS) if measured else ["by_outcome"]
    figure = Figure(figsize=(1.4 + 3.3 * len(names), 0.9 + 2.9 * len(rows)), layout="constrained")
    panels: Any = figure.subplots(len(rows), len(names), sharex=True, sharey=True, squeeze=False)
    single = np.sqrt(np.maximum(data[rows].to_array().values, 1e-300))
    best = float(np.clip(1 / single.max(), _BEST, 0.3))
    scale = LogNorm(best, _WORST)
    outcomes = _outcomes(design)
    mesh = None
    for i, of in enumerate(rows):
        for j, name in enumerate(names):
            axes = panels[i, j]
            mesh = _panel(axes, design, data, of, name, scale, outcomes)
            if i == 0:
                axes.set_title(plain_text(name), fontsize="medium")
            if i == len(rows) - 1:
                axes.set_xlabel("impact angle (deg)" if design.window.extends[1] else "")
        panels[i, 0].set_ylabel(f"{AXIS_LABELS[design.window.key]}\n{_ROWS[of]}")
    assert mesh is not None
    bar = figure.colorbar(mesh, ax=panels, extend="both", pad=0.02, aspect=30)
    bar.set_label("standard error from one impact, relative" if all(each.log for each in design.free.entries)
                  else "standard error from one impact, on the scale of the fit")  # fmt: skip
    ticks.plain(bar.ax.yaxis)
    scene = design.window.scene
    title(figure, f"{plain_text(name_of(scene, LONGEST))}{against(scene)}: what an impact tells")
    of_what = "all entries" if design.target is None else design.target
    note = (f"numbers: planned impacts for {plain_text(of_what)} ({design.size})"
            f"{'; ' if len(names) > 1 else chr(10)}lines: changes of outcome without scatter")  # fmt: skip
    figure.supxlabel(note, color=NOTE)
    return figure


def _panel(axes: Axes, design: Design, data: xarray.Dataset, of: str, name: str, scale: LogNorm, outcomes: Any) -> Any:
    single = data[of].sel(entry=name).values
    with np.errstate(divide="ignore"):
        error = np.where(single > 0, 1 / np.sqrt(np.maximum(single, 1e-300)), np.inf)
    x, y = np.degrees(data["angle"].values), data[design.window.key].values
    x, y = (np.array([each[0] * 0.97, each[0] * 1.03 + 1e-3]) if each.size == 1 else each for each in (x, y))
    shape = y.size, x.size
    values = np.broadcast_to(np.minimum(error, 1e3).T, shape)
    mesh = axes.pcolormesh(x, y, values, norm=scale, cmap="viridis_r", shading="gouraud", rasterized=True)
    if all(design.window.extends):
        angle, along, outcome = outcomes
        for level in (0.5, 1.5):
            if outcome.min() < level < outcome.max():
                axes.contour(angle, along, outcome, [level], colors="white", linewidths=0.9)
    axes.set_yscale("log")
    ticks.plain(axes.yaxis)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    for each in design.impacts:
        at = np.degrees(each.angle), getattr(each, design.window.key)
        axes.plot(*at, "o", color="white", markeredgecolor=INK, markersize=11, zorder=4, clip_on=False)
        style: Any = {"ha": "center", "va": "center_baseline", "fontsize": 8, "color": INK}
        axes.text(*at, f"{each.count}", zorder=5, clip_on=False, **style)
    return mesh


def _outcomes(design: Design) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles (deg), values of the key, and outcomes without scatter on a grid of them."""
    window = design.window
    points = window.grid(*_FINE)
    key, angle = window.values(points)
    along = np.unique(points[:, 0]).size
    outcomes = window.outcomes(points, design.rtol).reshape(-1, along)
    return np.degrees(angle.reshape(-1, along)[:, 0]), key.reshape(-1, along)[0], outcomes.T
