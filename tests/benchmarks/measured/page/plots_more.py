"""Pictures of cost near the separatrix, and of gradients: time against achieved error."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

Record = dict[str, Any]

_NEAR = {  # Okabe-Ito colours, a marker each, peers dashed
    "taylor": ("#E69F00", "*", "-"),
    "rosenbrock, generated C": ("#D55E00", "s", "-"),
    "rosenbrock, compiled": ("#009E73", "D", "-"),
    "heyoka, batch of 8": ("#56B4E9", "P", "--"),
}
_GRADIENTS = {
    "gradients_many": ("#E69F00", "*", "-"),
    "taylor, kernel alone": ("#E69F00", "1", ":"),
    "rosenbrock, forward": ("#D55E00", "s", "-"),
    "rosenbrock, adjoint": ("#0072B2", "o", "-"),
    "heyoka, variational equations": ("#56B4E9", "P", "--"),
    "heyoka's, without callbacks": ("#56B4E9", "x", ":"),
    "diffrax, forward derivatives": ("#7F7F7F", "<", "--"),
    "central differences of taylor": ("#CC79A7", "^", "--"),
}
_OTHER = ("#202020", ".", ":")


def near_curves(record: Record) -> Figure:
    """CPU time of a collision against its distance from the separatrix, a panel a tolerance."""
    rows = record["near"]
    rtols = list(dict.fromkeys(row["rtol"] for row in rows))
    figure = Figure(figsize=(9.2, 3.9), layout="constrained")
    panels: Sequence[Axes] = figure.subplots(1, len(rtols), sharex=True, sharey=True, squeeze=False)[0]
    for axes, rtol in zip(panels, rtols, strict=True):
        for name in dict.fromkeys(row["engine"] for row in rows):
            here = [row for row in rows if (row["engine"], row["rtol"]) == (name, rtol)]
            colour, marker, line = _NEAR.get(name, _OTHER)
            xs, ys = [row["distance"] for row in here], [row["cpu"] * 1e3 for row in here]
            axes.loglog(xs, ys, line, color=colour, marker=marker, markersize=5.5, linewidth=1.3, label=name)
            failed = [(x, y) for x, y, row in zip(xs, ys, here, strict=True) if row["failed"]]
            if failed:
                style: Any = {"color": colour, "marker": marker, "markersize": 5.5, "markerfacecolor": "white"}
                axes.loglog(*zip(*failed), linestyle="none", **style)
        _grid(axes)
        axes.set_title(f"rtol {rtol:.0e}", fontsize=9.5)
        axes.set_xlabel("relative distance in St from the separatrix")
    panels[0].invert_xaxis()
    panels[0].set_ylabel("CPU time a collision (ms)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False)
    figure.supxlabel("hollow: some collisions failed", fontsize=8, color="#555555")
    return figure


def gradient_curves(record: Record) -> Figure:
    """CPU time of a gradient against its largest error, a panel a task."""
    tasks = record["gradient_work"]
    figure = Figure(figsize=(9.2, 4.3), layout="constrained")
    panels: Sequence[Axes] = figure.subplots(1, len(tasks), sharex=True, sharey=True, squeeze=False)[0]
    for axes, task in zip(panels, tasks, strict=True):
        for name in dict.fromkeys(row["method"] for row in task["rows"]):
            here = [row for row in task["rows"] if row["method"] == name and row["error_largest"]]
            colour, marker, line = _GRADIENTS.get(name, _OTHER)
            xs, ys = [row["error_largest"] for row in here], [row["cpu"] * 1e6 for row in here]
            axes.loglog(xs, ys, line, color=colour, marker=marker, markersize=5.5, linewidth=1.3, label=name)
        _grid(axes)
        axes.set_title(
            f"{task['preset']}: {task['collisions']} gradients, {len(task['parameters'])} parameters", fontsize=9.5
        )
        axes.set_xlabel("largest error, over the largest derivative")
    panels[0].invert_xaxis()
    panels[0].set_ylabel("CPU time a gradient (us)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return figure


def _grid(axes: Axes) -> None:
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(base=10, subs=(1.0, 2.0, 5.0), numticks=20))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.tick_params(labelleft=True)
