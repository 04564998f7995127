"""Derivatives of many collisions as a figure: elasticities over the impact."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ..formatting.style import picture

if TYPE_CHECKING:
    import xarray

_PANELS = 4
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


@picture
def draw(found: xarray.Dataset) -> Figure:
    """Elasticities of each result over what of the impact varies; the strongest six parameters are drawn."""
    quantities = found["quantity"].values[:_PANELS]
    figure = Figure(figsize=(7.0, 1.2 + 2.3 * len(quantities)), layout="constrained")
    axes = figure.subplots(len(quantities), 1, sharex=True, squeeze=False)[:, 0]
    x, label = _across(found)
    order = np.argsort(x, kind="stable")
    jumps = np.flatnonzero(np.diff(found["outcome"].values[order])) + 1  # lines are not joined across them
    for axis, name in zip(axes, quantities, strict=True):
        values = found["elasticity"].sel(quantity=name).values
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a parameter without elasticity anywhere
            size = np.nan_to_num(np.nanmedian(np.abs(values), axis=0))
        parameters = [str(one) for one in found["parameter"].values]
        strongest = [k for k in np.argsort(-size) if size[k] > 0 and not _twice(parameters, k)]
        for k, colour in zip(strongest, _COLOURS):
            y = np.insert(values[order, k], jumps, np.nan)
            axis.plot(np.insert(x[order], jumps, np.nan), y, ".-", color=colour, linewidth=1.0, markersize=4,
                      label=parameters[k])  # fmt: skip
        axis.axhline(0, color="#202020", linewidth=0.6)
        axis.set_ylabel(str(name).replace("_", " "))
        axis.spines[["top", "right"]].set_visible(False)
        if axis.lines[:-1]:
            axis.legend(fontsize=7, frameon=False, ncols=2)
    axes[-1].set_xlabel(label)
    figure.suptitle("elasticities d ln y/d ln p", fontsize=11)
    return figure


def _twice(parameters: list[str], k: int) -> bool:
    """Whether it is the Stokes number beside the speed, which moves everything alike."""
    return parameters[k] == "impact.stokes" and "impact.speed" in parameters


def _across(found: xarray.Dataset) -> tuple[np.ndarray, str]:
    if np.ptp(found["stokes"].values) > 0 or np.ptp(found["angle"].values) == 0:
        return found["stokes"].values, "Stokes number St"
    return np.degrees(found["angle"].values), "impact angle (deg)"
