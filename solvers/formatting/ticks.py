"""Labels of a logarithmic axis as plain numbers."""

from typing import Any

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter


def plain(axis: Any, subs: tuple[float, ...] = (1, 2, 5)) -> None:
    """Label only 0.01, 0.02, 0.05, ... of a logarithmic axis.

    Arguments:
        axis: a matplotlib x or y axis, already logarithmic.
        subs: labelled multiples of each power of ten.
    """
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())
