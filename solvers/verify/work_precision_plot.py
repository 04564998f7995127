"""Run time against achieved error of the engines as a figure."""

import math
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from ..collision.text import name_of
from ..formatting import ticks
from ..formatting.style import NOTE, picture, plain_text
from .work_precision import WorkPrecision

_STYLES = {"cvodes": ("#0072B2", "o"), "rosenbrock": ("#D55E00", "s"), "taylor": ("#E69F00", "*")}  # Okabe-Ito colours


@picture
def draw(bench: WorkPrecision) -> Figure:
    """One curve per engine; the recommended point is ringed. Large errors are on the left."""
    figure = Figure(figsize=(6.2, 4.4), layout="constrained")
    axes, best, uncertainty = figure.add_subplot(), bench.recommended, bench.uncertainty
    for engine in bench.engines:
        colour, marker = _STYLES[engine]
        rows = [row for row in bench.rows if row.engine == engine and row.error]
        style: dict[str, Any] = {"color": colour, "marker": marker, "markersize": 6}
        bad = style | {"linestyle": "", "markerfacecolor": "white"}
        ring = {"color": "black", "marker": "o", "markersize": 13, "linestyle": "", "markerfacecolor": "none"}
        for subset, look in (
            (rows, style | {"linewidth": 1.3, "label": engine}),
            ([row for row in rows if not row.keeps(math.inf)], bad),
            ([row for row in rows if (engine, row.rtol) == (best.engine, best.rtol)], ring),
        ):
            axes.loglog([row.error for row in subset], [1e3 * row.seconds for row in subset], **look)
    axes.set(xlabel="largest absolute error of $e_n$", ylabel="CPU time a collision (ms)")
    axes.grid(True, which="major", linewidth=0.4, color="#CCCCCC")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
    axes.xaxis.set_minor_locator(NullLocator())
    ticks.plain(axes.yaxis, (1,))
    errors = [*(row.error for row in bench.rows if row.error), bench.wanted]
    least = min(errors + [uncertainty] * bool(uncertainty)) / 4
    axes.set_xlim(4 * max(errors), least)
    if not bench.separate:
        words: Any = {"ha": "center", "transform": axes.transAxes, "bbox": {"color": "white"}}
        axes.text(0.5, 0.5, "all collisions stick:\nno error to draw", **words)
    axes.axvline(bench.wanted, color=NOTE, linestyle="--", linewidth=1, label="error wanted")
    if uncertainty:
        label = "below the references' difference"
        axes.axvspan(least, uncertainty, color="#DDDDDD", linewidth=0, zorder=0, label=label)
    figure.legend(loc="outside upper center", ncols=3)
    signs = "ringed: recommended for the error wanted; hollow: outcomes wrong or missing"
    figure.supxlabel(plain_text(f"{name_of(bench.scene)}: {bench.sample}\n{signs}"), color=NOTE)
    return figure
