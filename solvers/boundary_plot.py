"""Traced boundaries as a picture: Stokes number against impact angle, a line a kind of change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from .bounds import Boundaries
    from .scene import Scene

# Okabe-Ito, and dashes that differ without colour
_STYLES = {
    ("stick", "stick-rotate-separate"): ("#0072B2", "-", "stick | stick-rotate-separate"),
    ("stick-rotate-separate", "bounce"): ("#D55E00", "--", "stick-rotate-separate | bounce"),
    ("stick", "bounce"): ("#000000", "-.", "stick | bounce"),
}
_OTHER = ("#CC79A7", ":", "other")


def draw(scene: Scene, found: Boundaries) -> Figure:
    """The changes of `found` as curves; points where a curve has only one."""
    figure = Figure(figsize=(6.0, 4.2), layout="constrained")
    axes = figure.add_subplot()
    degrees = np.degrees(found.angles)
    kinds = dict.fromkeys((one.before, one.after) for line in found.changes for one in line)
    for kind in kinds:
        colour, dashes, label = _STYLES.get(kind, _OTHER)
        stokes = np.full(degrees.size, np.nan)
        for k, line in enumerate(found.changes):
            for one in line:
                if (one.before, one.after) == kind:
                    stokes[k] = one.stokes
        marker = "o" if np.count_nonzero(np.isfinite(stokes)) == 1 else ""
        axes.plot(degrees, stokes, dashes, color=colour, label=label, marker=marker, linewidth=1.8)
    axes.set_yscale("log")
    axes.set_xlabel(r"impact angle $\theta_0$ (deg)")
    axes.set_ylabel("normal Stokes number St")
    axes.set_title(f"{scene.name or 'scene'}: where the outcome changes")
    axes.grid(visible=True, which="both", linewidth=0.3, alpha=0.6)
    if kinds:
        axes.legend(frameon=False)
    return figure
