"""Run time against achieved error as text, JSON and a figure."""

from __future__ import annotations

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
from .work_precision import Row, WorkPrecision, shown

_STYLES = {  # Okabe-Ito colours and a marker for each engine
    "cvodes": ("#0072B2", "o"),
    "rosenbrock": ("#D55E00", "s"),
    "taylor": ("#E69F00", "*"),
}


def to_dict(found: WorkPrecision, error: float) -> dict[str, Any]:
    """Return the JSON object; s and rad, null where not measured."""
    return {
        "scene": name_of(found.scene),
        "environment": environment(),
        "sample": found.sample,
        "batch": found.batch,
        "impacts": [{"stokes": each.stokes, "angle": each.angle} for each in found.impacts],
        "separate": found.separate,
        "left_out": found.left_out,
        "references": [{"engine": engine, "rtol": rtol} for engine, rtol in found.references],
        "uncertainty": {"restitution": found.uncertainty, "contact_time": found.time_uncertainty},
        "rows": [
            {
                "engine": row.engine,
                "rtol": row.rtol,
                "error": {"restitution": row.error, "contact_time": row.time_error},
                "cpu": {"single": row.single, "batch": row.batch},
                "wrong": row.wrong,
                "failed": row.failed,
                "handed_over": row.handed_over,
            }
            for row in found.rows
        ],
        "error": error,
        "recommended": [
            {"use": each.use, "engine": each.engine, "rtol": each.rtol, "reason": each.reason}
            for each in found.recommend(error)
        ],
    }


def text(found: WorkPrecision, error: float) -> str:
    """Return a text of the sample, the table, the references and the recommendation."""
    lines = [
        f"{name_of(found.scene)}: {found.sample}",
        _counted(found),
        "",
        table(_head(found.batch), [_cells(r) for r in found.rows]),
    ]
    against = ", ".join(f"{engine} at rtol {rtol:.0e}" for engine, rtol in found.references)
    lines += [
        "",
        f"Errors are differences from the first of {against} that is another engine.",
        f"These two differ by at most {found.uncertainty:.1e} in e_n and {found.time_uncertainty:.1e} (relative) in",
        "contact time: the error estimate of the references.",
        "CPU time on one core, each by `collide` without ledger, and of one among those in a call of `collide_many`.",
    ]
    if any(row.batch is None for row in found.rows):
        lines.append("-: no batch, as one at a looser tolerance took more than a second, or a collision in it failed.")
    if handed := sum(row.handed_over for row in found.rows):
        lines.append(f"{handed} collisions were handed over to another engine, whose time and error they have.")
    lines += ["", f"Recommended for an error of {error:.1e} in e_n:"]
    for each in found.recommend(error):
        setting = f"{each.engine}, rtol {each.rtol:.0e}" if each.engine else "none"
        lines += [f"* {each.use}: {setting}", f"  {each.reason}"]
    return "\n".join(lines)


def _head(batch: int) -> list[str]:
    return [
        "engine",
        "rtol",
        "error in e_n",
        "in contact time",
        "CPU: one collision",
        f"one of {batch}",
        "wrong",
        "failed",
    ]


def _counted(found: WorkPrecision) -> str:
    said = f"Errors of {len(found.impacts)} of them, of which {found.separate} separate."
    return said + (f" {found.left_out} are left out: the references disagree on the outcome." if found.left_out else "")


def _cells(row: Row) -> list[str]:
    errors = ["-" if each is None else f"{each:.1e}" for each in (row.error, row.time_error)]
    costs = [shown(row.single), "-" if row.batch is None else shown(row.batch)]
    return [row.engine, f"{row.rtol:.0e}", *errors, *costs, str(row.wrong), str(row.failed)]


@picture
def draw(found: WorkPrecision, error: float, path: str | Path | None = None) -> Figure:
    """Draw CPU time against achieved error, alone and in a batch, one curve per engine; recommended points are ringed.

    Arguments:
        error: requested error of e_n.
        path: file to write (.png, .pdf or .svg); None only draws.
    """
    figure = Figure(figsize=(9.2, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    recommended = found.recommend(error)
    for axes, title, best in zip(
        (left, right), ("one collision", f"one of a batch of {found.batch}"), recommended, strict=True
    ):
        single = axes is left
        for engine in found.engines:
            colour, marker = _STYLES[engine]
            points = [
                (row.error, 1e3 * cost, row)
                for row in found.rows
                if row.engine == engine and row.error and (cost := row.single if single else row.batch) is not None
            ]
            axes.loglog(*_columns(points), color=colour, marker=marker, markersize=6, linewidth=1.3, label=engine)
            bad = [each for each in points if not each[2].keeps(float("inf"))]
            axes.loglog(
                *_columns(bad), color=colour, marker=marker, markersize=6, linestyle="", markerfacecolor="white"
            )
            ringed = [each for each in points if (engine, each[2].rtol) == (best.engine, best.rtol)]
            axes.loglog(
                *_columns(ringed), color="black", marker="o", markersize=13, linestyle="", markerfacecolor="none"
            )
        _frame(axes, title)
    _limits(left, right, found, error)
    left.set_ylabel("CPU time a collision (ms)")
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=5)
    signs = "ringed: recommended for the error wanted; hollow: outcomes wrong or missing"
    note = f"{name_of(found.scene)}: {found.sample}\n{signs}"
    figure.supxlabel(plain_text(note), color=NOTE)
    if path is not None:
        save(figure, path, dpi=150)
    return figure


def _columns(points: list[tuple[float, float, Row]]) -> tuple[list[float], list[float]]:
    return [each[0] for each in points], [each[1] for each in points]


def _frame(axes: Axes, title: str) -> None:
    axes.set_title(title)
    axes.set_xlabel("largest absolute error of $e_n$")
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    ticks.plain(axes.yaxis, (1,))
    axes.tick_params(labelleft=True)


def _limits(left: Axes, right: Axes, found: WorkPrecision, error: float) -> None:
    """Set axis limits, large errors on the left; grey where an error is below the references' uncertainty."""
    errors = [row.error for row in found.rows if row.error] + [error]
    own = found.uncertainty
    least = min([*errors, *([own] if own else [])]) / 4
    left.set_xlim(4 * max(errors), least)
    for axes in (left, right):
        if not found.separate:
            style: Any = {"ha": "center", "transform": axes.transAxes, "bbox": {"color": "white"}}
            axes.text(0.5, 0.5, "all collisions stick:\nno error to draw", **style)
        axes.axvline(error, color=NOTE, linestyle="--", linewidth=1, label="error wanted")
        if own:
            axes.axvspan(least, own, color="#DDDDDD", linewidth=0, zorder=0, label="below the references' difference")
