"""Floating: a doublet in a well of the potential beyond the edge of the tangential force.

There the orbital momentum is constant, so the gap moves in a fixed potential, whose slope is the inward force; film and
rebounds only take energy. If the energy is below the potential at the edge and at some larger gap, the doublet stays
between the two for ever. At a maximum of the gap the second condition holds.
"""

import numpy as np

from ...generated.automaton import stays_below
from ..model.model import Model
from .base import inward
from .quadrature import gaps_ahead, panels

_PANELS = 8


def floats(model: Model, p: np.ndarray, y: np.ndarray, margin: float) -> bool:
    """True if a doublet that does not rest stays beyond the edge of the tangential force, before rupture.

    Arguments:
        margin: relative error of the energies.
    """
    if not model.oblique or model.wall or model.strings or model.friction:
        return False  # nothing turns, or strings or impulses change the orbital momentum
    groups = dict(zip(model.groups, p, strict=True))
    more = (groups[str(symbol)] for symbol in model.extra("shear", "edge"))
    edge = float(model.laws.shear.edge(groups["aspect"], *more))
    gap, end, kinetic = float(y[0]), groups.get("rupture_gap", 1.0), float(y[1]) ** 2 / 2
    if not edge < gap < end:
        return False
    inside = works(model, p, y, edge, gap)
    if not stays_below(kinetic + inside.sum(), margin, kinetic + np.abs(inside).sum()):
        return False
    outside = panels(lambda gaps: inward(model, p, gaps, y), gaps_ahead(gap, end))
    return bool(np.any(stays_below(kinetic - np.cumsum(outside), margin, kinetic + np.cumsum(np.abs(outside)))))


def works(model: Model, p: np.ndarray, y: np.ndarray, start: float, end: float) -> np.ndarray:
    """Work against the inward force over each panel from gap `start` to `end`."""
    return panels(lambda gaps: inward(model, p, gaps, y), np.linspace(start, end, _PANELS + 1))
