"""The picture of a flow curve with its law."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..formatting.style import picture

if TYPE_CHECKING:
    from .flow_curve import FlowCurve


@picture
def draw(found: FlowCurve) -> Figure:
    """Viscosities over shear rates, and the law, dashed beyond what is measured."""
    figure = Figure(layout="constrained")
    axes = figure.subplots()
    first, last = found.rate[0], found.rate[-1]
    for low, high, line in ((first / 10, first, "--"), (first, last, "-"), (last, last * 10, "--")):
        rates = np.geomspace(low, high, 100)
        axes.plot(rates, found(rates), line, color="C0", label=found.law if line == "-" else None)
    axes.plot(found.rate, found.viscosity, "o", color="C1", label="measured")
    axes.set(xscale="log", yscale="log", xlabel="shear rate (1/s)", ylabel="viscosity (Pa s)")
    axes.legend()
    return figure
