"""The picture of a flow curve with its law."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..formatting.style import picture

if TYPE_CHECKING:
    from .flow_curve import FlowCurve


@picture
def draw(curve: FlowCurve) -> Figure:
    """Viscosities over shear rates, and the law, dashed beyond what is measured."""
    figure = Figure(layout="constrained")
    axes = figure.subplots()
    first, last = curve.rate[0], curve.rate[-1]
    for low, high, line in ((first / 10, first, "--"), (first, last, "-"), (last, last * 10, "--")):
        rates = np.geomspace(low, high, 100)
        axes.plot(rates, curve(rates), line, color="C0", label=curve.law if line == "-" else None)
    axes.plot(curve.rate, curve.viscosity, "o", color="C1", label="measured")
    axes.set(xscale="log", yscale="log", xlabel="shear rate (1/s)", ylabel="viscosity (Pa s)")
    axes.legend()
    return figure
