"""The benchmark as pictures: time against achieved error and against number."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from wetdoublet.solvers.host.files import save

Record = dict[str, Any]

_STYLES = {  # Okabe-Ito colours, a marker each, peers dashed
    "cvodes": ("#0072B2", "o", "-"),
    "rosenbrock": ("#D55E00", "s", "-"),
    "taylor": ("#E69F00", "*", "-"),
    "taylor, kernel alone": ("#E69F00", "1", ":"),
    "heyoka, batch of 8": ("#56B4E9", "P", "--"),
    "heyoka, without callbacks": ("#56B4E9", "x", ":"),
    "scipy LSODA": ("#CC79A7", "^", "--"),
    "scipy Radau": ("#202020", "v", "--"),
}
_OTHER = ("#AA3377", ".", ":")
_RC: Any = {"font.size": 8.5, "axes.labelsize": 9, "legend.fontsize": 8, "hatch.linewidth": 0.6}


def draw(record: Record, folder: Path) -> list[Path]:
    """Draw the pictures; returns their files."""
    pictures = {"tasks": ("work", work_error), "growth": ("growth", growth_curves)}
    files = []
    with rc_context(_RC):
        for name, make in (drawn for part, drawn in pictures.items() if record[part]):
            files.append(folder / f"{name}.png")
            save(make(record), files[-1], dpi=200)
    return files


def work_error(record: Record) -> Figure:
    """Mean CPU time of a collision against the largest error in e_n; a point a tolerance.

    From large errors on the left to small on the right; grey where the reference cannot tell them from its own.
    """
    tasks = [task for task in record["tasks"] if task["points"]]
    figure = Figure(figsize=(9.2, 4.9), layout="constrained")
    panels = figure.subplots(1, len(tasks), sharex=True, sharey=True, squeeze=False)[0]
    for axes, task in zip(panels, tasks):
        _draw(axes, [point["summary"] | {"engine": point["engine"]} for point in task["points"]])
        _grid(axes)
        axes.set_title(f"{task['preset']}: {task['collisions']['counted']} collisions", fontsize=9.5)
        axes.set_xlabel("largest absolute error in $e_n$")
    known = [task["collisions"]["own_error"] for task in tasks]
    drawn = [float(x) for axes in panels for line in axes.get_lines() for x in np.atleast_1d(line.get_xdata())]
    least = min([*drawn, *filter(None, known)], default=1e-14) / 5
    for axes, own in zip(panels, known):
        if own:
            axes.axvspan(least, own, color="#DDDDDD", linewidth=0, zorder=0, label="below the reference's own error")
    panels[0].set_xlim(max(drawn, default=1.0) * 5, least)
    panels[0].set_ylabel("CPU time a collision (us)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, frameon=False)
    return figure


def growth_curves(record: Record) -> Figure:
    """Wall time of a call, and of a collision in it, against their number."""
    figure = Figure(figsize=(7.2, 3.4), layout="constrained")
    panels = figure.subplots(1, 2, sharex=True)
    for engine in dict.fromkeys(each["engine"] for each in record["growth"]):
        colour, marker, _ = _STYLES.get(engine, _OTHER)
        for cores, line in ((1, "-"), (2, "--")):
            here = [each for each in record["growth"] if (each["engine"], each["cores"]) == (engine, cores)]
            counts = [each["collisions"] for each in here]
            style: Any = {"color": colour, "marker": marker, "linestyle": line, "markersize": 5, "linewidth": 1.3}
            panels[0].loglog(
                counts, [each["wall"] for each in here], label=f"{engine}, {cores} core{'s' * (cores > 1)}", **style
            )
            panels[1].loglog(counts, [1e6 * each["wall"] / each["collisions"] for each in here], **style)
    for axes, label in zip(panels, ("wall time of the call (s)", "wall time a collision (us)")):
        axes.set(xlabel="collisions in one call", ylabel=label)
        _grid(axes)
    figure.legend(loc="outside upper center", ncols=2, frameon=False)
    return figure


def _draw(axes: Axes, rows: Sequence[Record]) -> None:
    """Draw the CPU time over the error, a line for each engine; hollow where some failed."""
    for name in dict.fromkeys(row["engine"] for row in rows):
        here = [row for row in rows if row["engine"] == name and row["error_largest"]]
        colour, marker, line = _STYLES.get(name, _OTHER)
        style: Any = {"color": colour, "marker": marker, "markersize": 5.5}
        xs, ys = [row["error_largest"] for row in here], [row["cpu_mean"] * 1e6 for row in here]
        axes.loglog(xs, ys, line, linewidth=1.3, label=name, **style)
        failed = [(at, y) for at, y, row in zip(xs, ys, here, strict=True) if row["wrong"] or row["failed"]]
        if failed:
            axes.loglog(*zip(*failed), linestyle="none", markerfacecolor="white", **style)


def _grid(axes: Axes) -> None:
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(base=10, subs=(1.0, 2.0, 5.0), numticks=20))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.tick_params(labelleft=True)
