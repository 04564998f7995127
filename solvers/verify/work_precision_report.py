"""Run time against achieved error as text, JSON and a figure."""

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from ..collision.text import name_of
from ..formatting import ticks
from ..formatting.markdown import table
from ..formatting.style import NOTE, picture, plain_text
from ..host.environment import environment
from ..host.files import save
from .work_precision import WorkPrecision, duration

_STYLES = {  # Okabe-Ito colours and a marker for each engine
    "cvodes": ("#0072B2", "o"),
    "rosenbrock": ("#D55E00", "s"),
    "taylor": ("#E69F00", "*"),
}


def to_dict(bench: WorkPrecision, error: float) -> dict[str, Any]:
    """Return the JSON object; s and rad, null where not measured."""
    rows = [
        {
            **{name: getattr(row, name) for name in ("engine", "rtol", "wrong", "failed", "handed_over")},
            "error": {"restitution": row.error, "contact_time": row.time_error},
            "cpu": {"single": row.single, "batch": row.batch},
        }
        for row in bench.rows
    ]
    return {
        "scene": name_of(bench.scene),
        "environment": environment(),
        **{name: getattr(bench, name) for name in ("sample", "batch", "separate", "left_out")},
        "impacts": [asdict(impact) for impact in bench.impacts],
        "references": [{"engine": engine, "rtol": rtol} for engine, rtol in bench.references],
        "uncertainty": {"restitution": bench.uncertainty, "contact_time": bench.time_uncertainty},
        "rows": rows,
        "error": error,
        "recommended": [asdict(advice) for advice in bench.recommend(error)],
    }


def text(bench: WorkPrecision, error: float) -> str:
    """Return a text of the sample, the table, the references and the recommendation."""
    head = ("engine", "rtol", "error in e_n", "in contact time", "CPU: one collision", f"one of {bench.batch}")
    rows = []
    for row in bench.rows:
        errors = ["-" if value is None else f"{value:.1e}" for value in (row.error, row.time_error)]
        costs = ["-" if cost is None else duration(cost) for cost in (row.single, row.batch)]
        rows.append([row.engine, f"{row.rtol:.0e}", *errors, *costs, str(row.wrong), str(row.failed)])
    counted = f"Errors of {len(bench.impacts)} of them, of which {bench.separate} separate."
    if bench.left_out:
        counted += f" {bench.left_out} are left out: the references disagree on the outcome."
    lines = [f"{name_of(bench.scene)}: {bench.sample}", counted, "", table((*head, "wrong", "failed"), rows)]
    against = ", ".join(f"{engine} at rtol {rtol:.0e}" for engine, rtol in bench.references)
    lines += [
        "",
        f"Errors are differences from the first of {against} that is another engine.",
        f"These two differ by at most {bench.uncertainty:.1e} in e_n and {bench.time_uncertainty:.1e} (relative) in",
        "contact time: the error estimate of the references.",
        "CPU time on one core, each by `collide` without ledger, and of one among those in a call of `collide_many`,",
        "which CasADi's engines compute one after another: theirs is the cost alone.",
    ]
    if any(row.batch is None for row in bench.rows):
        lines.append("-: no batch, as one at a looser tolerance took more than a second, or a collision in it failed.")
    if handed := sum(row.handed_over for row in bench.rows):
        lines.append(f"{handed} collisions were handed over to another engine, whose time and error they have.")
    lines += ["", f"Recommended for an error of {error:.1e} in e_n:"]
    for advice in bench.recommend(error):
        setting = f"{advice.engine}, rtol {advice.rtol:.0e}" if advice.engine else "none"
        lines += [f"* {advice.use}: {setting}", f"  {advice.reason}"]
    return "\n".join(lines)


@picture
def draw(bench: WorkPrecision, error: float, path: str | Path | None = None) -> Figure:
    """Draw CPU time against achieved error, alone and in a batch, one curve per engine; recommended points are ringed.

    Arguments:
        error: requested error of e_n.
        path: file to write (.png, .pdf or .svg); None only draws.
    """
    figure = Figure(figsize=(9.2, 4.4), layout="constrained")
    first, second = figure.subplots(1, 2, sharex=True, sharey=True)
    recommended = bench.recommend(error)
    for axes, title, best in zip(
        (first, second), ("one collision", f"one of a batch of {bench.batch}"), recommended, strict=True
    ):
        for engine in bench.engines:
            colour, marker = _STYLES[engine]
            costs = [(row, row.single if axes is first else row.batch) for row in bench.rows if row.engine == engine]
            points = [(row.error, 1e3 * cost, row) for row, cost in costs if row.error and cost is not None]
            bad = [point for point in points if not point[2].keeps(math.inf)]
            ringed = [point for point in points if (engine, point[2].rtol) == (best.engine, best.rtol)]
            style: dict[str, Any] = {"color": colour, "marker": marker, "markersize": 6}
            for subset, more in (
                (points, style | {"linewidth": 1.3, "label": engine}),
                (bad, style | {"linestyle": "", "markerfacecolor": "white"}),
                (
                    ringed,
                    {"color": "black", "marker": "o", "markersize": 13, "linestyle": "", "markerfacecolor": "none"},
                ),
            ):
                axes.loglog([point[0] for point in subset], [point[1] for point in subset], **more)
        axes.set_title(title)
        axes.set_xlabel("largest absolute error of $e_n$")
        axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
        axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
        axes.xaxis.set_minor_locator(NullLocator())
        ticks.plain(axes.yaxis, (1,))
        axes.tick_params(labelleft=True)
    _limits(first, second, bench, error)
    first.set_ylabel("CPU time a collision (ms)")
    handles, labels = first.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=5)
    signs = "ringed: recommended for the error wanted; hollow: outcomes wrong or missing"
    note = f"{name_of(bench.scene)}: {bench.sample}\n{signs}"
    figure.supxlabel(plain_text(note), color=NOTE)
    if path is not None:
        save(figure, path, dpi=150)
    return figure


def _limits(first: Axes, second: Axes, bench: WorkPrecision, error: float) -> None:
    """Set axis limits, large errors on the left; grey where an error is below the references' uncertainty."""
    errors = [row.error for row in bench.rows if row.error] + [error]
    uncertainty = bench.uncertainty
    least = min([*errors, *([uncertainty] if uncertainty else [])]) / 4
    first.set_xlim(4 * max(errors), least)
    for axes in (first, second):
        if not bench.separate:
            style: Any = {"ha": "center", "transform": axes.transAxes, "bbox": {"color": "white"}}
            axes.text(0.5, 0.5, "all collisions stick:\nno error to draw", **style)
        axes.axvline(error, color=NOTE, linestyle="--", linewidth=1, label="error wanted")
        if uncertainty:
            axes.axvspan(
                least, uncertainty, color="#DDDDDD", linewidth=0, zorder=0, label="below the references' difference"
            )
