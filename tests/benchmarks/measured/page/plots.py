"""The benchmark as pictures: time against achieved error, against distance and against number."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator
from wetdoublet.solvers.host.files import save

Record = dict[str, Any]

_STYLES = {  # Okabe-Ito colours, a marker each, peers dashed
    "cvodes": ("#0072B2", "o", "-"),
    "rosenbrock": ("#D55E00", "s", "-"),
    "taylor": ("#E69F00", "*", "-"),
    "taylor, kernel alone": ("#E69F00", "1", ":"),
    "heyoka, batch of 8": ("#56B4E9", "P", "--"),
    "heyoka, without callbacks": ("#56B4E9", "x", ":"),
    "diffrax Tsit5": ("#7F7F7F", "<", "--"),
    "scipy LSODA": ("#CC79A7", "^", "--"),
    "scipy Radau": ("#202020", "v", "--"),
    "gradients_many": ("#E69F00", "*", "-"),
    "rosenbrock, forward": ("#D55E00", "s", "-"),
    "rosenbrock, adjoint": ("#0072B2", "o", "-"),
    "heyoka, variational equations": ("#56B4E9", "P", "--"),
    "heyoka's, without callbacks": ("#56B4E9", "x", ":"),
    "central differences of taylor": ("#CC79A7", "^", "--"),
}
_OTHER = ("#AA3377", ".", ":")
_RC: Any = {"font.size": 8.5, "axes.labelsize": 9, "legend.fontsize": 8, "hatch.linewidth": 0.6}


def draw(record: Record, folder: Path) -> list[Path]:
    """Draw the pictures; returns their files."""
    files = []
    with rc_context(_RC):
        pictures = [("work.png", work_error)]
        if record["growth"]:
            pictures.append(("growth.png", growth_curves))
        if record["near"]:
            pictures.append(("near.png", near_curves))
        if record["gradient_work"]:
            pictures.append(("gradients.png", gradient_curves))
        for name, make in pictures:
            files.append(folder / name)
            save(make(record), files[-1], dpi=200)
    return files


def work_error(record: Record) -> Figure:
    """Mean CPU time of a collision against the largest error in e_n; a point a tolerance."""
    tasks = [task for task in record["tasks"] if task["points"]]
    figure = Figure(figsize=(9.2, 4.9), layout="constrained")
    panels: Sequence[Axes] = figure.subplots(1, len(tasks), sharex=True, sharey=True, squeeze=False)[0]
    known: dict[str, float] = {}
    for axes, task in zip(panels, tasks):
        for name in dict.fromkeys(point["engine"] for point in task["points"]):
            good, bad = _curve(task, name)
            colour, marker, line = _STYLES.get(name, _OTHER)
            style: Any = {"color": colour, "marker": marker, "markersize": 5.5}
            axes.loglog(*good, linestyle=line, linewidth=1.3, label=name, **style)
            if bad[0]:
                axes.loglog(*bad, linestyle="", **(style | {"markerfacecolor": "white"}))
        known[task["preset"]] = task["collisions"]["own_error"]
        _frame(axes, task)
    _limits(panels, list(known.values()))
    _legend(figure, panels[0], "CPU time a collision (us)", 3)
    return figure


def _curve(task: Record, name: str) -> tuple[tuple[list[float], list[float]], tuple[list[float], list[float]]]:
    """Errors and us of an engine: all points, and those with a wrong or missing outcome."""
    every: tuple[list[float], list[float]] = ([], [])
    bad: tuple[list[float], list[float]] = ([], [])
    for point in task["points"]:
        s = point["summary"]
        if point["engine"] != name or not s["error_largest"]:
            continue
        for xs, ys in (every, bad) if s["wrong"] or s["failed"] else (every,):
            xs.append(s["error_largest"])
            ys.append(s["cpu_mean"] * 1e6)
    return every, bad


def _limits(panels: Sequence[Axes], known: Sequence[float]) -> None:
    """From large errors on the left to small on the right; grey where the reference cannot tell them from its own."""
    drawn = [float(x) for axes in panels for line in axes.get_lines() for x in np.atleast_1d(line.get_xdata())]
    least = min([*drawn, *(each for each in known if each)], default=1e-14) / 5
    for axes, own in zip(panels, known):
        if own:
            axes.axvspan(least, own, color="#DDDDDD", linewidth=0, zorder=0, label="below the reference's own error")
    panels[0].set_xlim(max(drawn, default=1.0) * 5, least)


def _frame(axes: Axes, task: Record) -> None:
    axes.set_title(f"{task['preset']}: {task['collisions']['counted']} collisions", fontsize=9.5)
    axes.set_xlabel("largest absolute error in $e_n$")
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.tick_params(labelleft=True)


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
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_major_locator(LogLocator(base=10, subs=(1.0, 2.0, 5.0), numticks=20))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    figure.legend(loc="outside upper center", ncols=2, frameon=False)
    return figure


def near_curves(record: Record) -> Figure:
    """CPU time of a collision against its distance from the separatrix, a panel a tolerance."""
    rows = record["near"]
    rtols = list(dict.fromkeys(row["rtol"] for row in rows))
    figure = Figure(figsize=(9.2, 3.9), layout="constrained")
    panels: Sequence[Axes] = figure.subplots(1, len(rtols), sharex=True, sharey=True, squeeze=False)[0]
    for axes, rtol in zip(panels, rtols, strict=True):
        _draw(axes, [row for row in rows if row["rtol"] == rtol], "engine", "distance", 1e3)
        _grid(axes)
        axes.set_title(f"rtol {rtol:.0e}", fontsize=9.5)
        axes.set_xlabel("relative distance in St from the separatrix")
    panels[0].invert_xaxis()
    _legend(figure, panels[0], "CPU time a collision (ms)", 4)
    figure.supxlabel("hollow: some collisions failed", fontsize=8, color="#555555")
    return figure


def gradient_curves(record: Record) -> Figure:
    """CPU time of a gradient against its largest error, a panel a task."""
    tasks = record["gradient_work"]
    figure = Figure(figsize=(9.2, 4.3), layout="constrained")
    panels: Sequence[Axes] = figure.subplots(1, len(tasks), sharex=True, sharey=True, squeeze=False)[0]
    for axes, task in zip(panels, tasks, strict=True):
        _draw(axes, task["rows"], "method", "error_largest", 1e6)
        _grid(axes)
        axes.set_title(
            f"{task['preset']}: {task['collisions']} gradients, {len(task['parameters'])} parameters", fontsize=9.5
        )
        axes.set_xlabel("largest error, over the largest derivative")
    panels[0].invert_xaxis()
    _legend(figure, panels[0], "CPU time a gradient (us)", 3)
    return figure


def _draw(axes: Axes, rows: Sequence[Record], key: str, x: str, unit: float) -> None:
    """Draw the CPU time over x, a line for each value of the key; hollow where some failed."""
    for name in dict.fromkeys(row[key] for row in rows):
        here = [row for row in rows if row[key] == name and row[x]]
        colour, marker, line = _STYLES.get(name, _OTHER)
        style: Any = {"color": colour, "marker": marker, "markersize": 5.5}
        xs, ys = [row[x] for row in here], [row["cpu"] * unit for row in here]
        axes.loglog(xs, ys, line, linewidth=1.3, label=name, **style)
        failed = [(at, y) for at, y, row in zip(xs, ys, here, strict=True) if row["failed"]]
        if failed:
            axes.loglog(*zip(*failed), linestyle="none", markerfacecolor="white", **style)


def _legend(figure: Figure, first: Axes, label: str, columns: int) -> None:
    first.set_ylabel(label)
    figure.legend(*first.get_legend_handles_labels(), loc="outside upper center", ncols=columns, frameon=False)


def _grid(axes: Axes) -> None:
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(base=10, subs=(1.0, 2.0, 5.0), numticks=20))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.tick_params(labelleft=True)
