"""Labels of a logarithmic axis as plain numbers."""

from __future__ import annotations

from typing import Any

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter


def plain(axis: Any, subs: tuple[float, ...] = (1, 2, 5)) -> None:
    """Label 0.01, 0.02, 0.05, ... and nothing between.

    Arguments:
        axis: of matplotlib, either one, logarithmic already.
        subs: which multiples of a power of ten.
    """
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())
