"""Figures of the stress test: error and cost over Stokes number and angle, and cost beside a boundary."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from ....generated.automaton import OUTCOMES
from ...boundaries.changes import GRAZE
from ...formatting.style import picture
from ...formatting.ticks import plain
from ...host.files import save
from .run import Stress
from .verdict import FAST

_COLOURS = {"taylor": "#E69F00", "rosenbrock": "#D55E00", "cvodes": "#0072B2", "LSODA": "#CC79A7"}
_MARKERS = dict(zip(OUTCOMES, ("o", "^", "s"), strict=True))


def draw(stress: Stress, folder: Path) -> list[Path]:
    """Draw stress-map.png and stress-near.png; returns their paths."""
    figures = {folder / "stress-map.png": over_impacts(stress), folder / "stress-near.png": near(stress)}
    for file, figure in figures.items():
        save(figure, file, dpi=160)
    return list(figures)


@picture
def over_impacts(stress: Stress) -> Figure:
    """Draw the difference of e_n between engines and the cost of the fast one, a point for each sampled scene."""
    figure = Figure(figsize=(10.4, 5.0), layout="constrained")
    left, right = figure.subplots(1, 2, sharex=True, sharey=True, gridspec_kw={"wspace": 0.06})
    left.set_title("(a) do the engines agree?", loc="left")
    right.set_title("(b) what does a collision cost?", loc="left")
    sampled = [one for one in stress.verdicts if one.case.kind == "sampled"]
    error = [max(one.error or 0.0, 1e-16) for one in sampled]
    cost = [1e3 * one.results[FAST].cpu if FAST in one.results else np.nan for one in sampled]
    for axes, values, label, ends in (
        (left, error, "largest difference in $e_n$ between engines", (1e-16, 1e-6)),
        (right, cost, f"CPU time by {FAST} (ms)", _ends(cost)),
    ):
        norm = LogNorm(*ends, clip=True)
        shown: Any = None
        for outcome, marker in _MARKERS.items():
            here = [k for k, one in enumerate(sampled) if any(each.outcome == outcome for each in one.results.values())]
            here.sort(key=lambda k: values[k])  # the worst on top
            style: Any = {"norm": norm, "cmap": "viridis_r", "linewidths": 0.3, "edgecolors": "#606060"}
            coloured = [values[k] for k in here]
            scenes: Any = [sampled[k].case.scene for k in here]
            places = [each.stokes for each in scenes], [math.degrees(each.angle) for each in scenes]
            size = float(np.clip(9000.0 / max(len(sampled), 1), 2.0, 20.0))  # smaller for many points
            drawn = axes.scatter(*places, c=coloured, marker=marker, s=size, **style)
            axes.scatter([], [], marker=marker, s=20, color="#808080", label=outcome)
            shown = drawn if here or shown is None else shown
        bar = figure.colorbar(shown, ax=axes, label=label, pad=0.01, extend="both")
        if ends[1] < 1e3 * ends[0]:  # powers of ten alone would be too few ticks
            plain(bar.ax.yaxis)
        _marked(axes, stress)
        axes.set(xscale="log", xlabel="Stokes number", xlim=(5e-7, 2e4), ylim=(-2, 92))
        axes.set_yticks(range(0, 91, 15))
    left.set_ylabel("impact angle (deg)")
    figure.suptitle(f"Engines against each other in {len(sampled)} random scenes")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5)
    return figure


def _ends(values: list[float]) -> tuple[float, float]:
    """Ends of the colour scale: the 1 and 99 % quantiles."""
    there = np.array([value for value in values if np.isfinite(value) and value > 0])
    if there.size < 2:
        return 0.1, 10.0
    low, high = np.quantile(there, [0.01, 0.99])
    return float(low), float(max(high, 1.01 * low))


def _marked(axes: Axes, stress: Stress) -> None:
    """Draw failures and unexplained disagreements as crosses on top."""
    failed = {id(one): one for one, issue in stress.issues("failure") if one.case.kind == "sampled"}
    strange = {id(one): one for one, _ in stress.unexplained if one.case.kind == "sampled"}
    for which, colour, marker, label in ((failed, "#D55E00", "x", "failure"), (strange, "#D00000", "+", "unexplained")):
        scenes = [one.case.scene for one in which.values()]
        if scenes:
            stokes = [float(each.stokes or 0.0) for each in scenes]
            angles = [math.degrees(each.angle or 0.0) for each in scenes]
            axes.scatter(stokes, angles, c=colour, marker=marker, s=34, linewidths=1.1, label=label)


@picture
def near(stress: Stress) -> Figure:
    """Draw CPU time of every engine against the relative distance from an escape: medians, and all points faintly."""
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.add_subplot()
    beside = [one for one in stress.verdicts if one.case.distance and one.case.change != GRAZE]
    for name in dict.fromkeys(name for one in beside for name in one.results):
        points = [(one.case.distance, 1e3 * one.results[name].cpu) for one in beside if name in one.results]
        at: Any = sorted({distance for distance, _ in points}, reverse=True)
        middle = [float(np.median([cpu for distance, cpu in points if distance == each])) for each in at]
        colour = _COLOURS.get(name, "#202020")
        axes.plot(*np.array(points).T, ".", color=colour, alpha=0.25, markersize=4, markeredgewidth=0)
        axes.plot(at, middle, "-o", color=colour, markersize=4, linewidth=1.5, label=f"{name}, median")
    axes.set(xscale="log", yscale="log", ylabel="CPU time (ms)")
    axes.set_xlabel("relative distance from where a doublet begins to escape, in St")
    figure.suptitle("Cost of a collision beside the boundary of escape")
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    if beside:
        axes.invert_xaxis()
        axes.legend(ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
    return figure
