"""Kinks of boundaries: angles at which a panel is divided because a boundary has a corner there."""

from __future__ import annotations

import numpy as np

from .fit import Order, Unresolved, fit
from .layout import Layout, Panel
from .series import Forest

EDGE_ORDER = Order((16, 1), 5e-8, most=400, checks=8)
_NARROW, _END = 1 / 100, 2e-3  # width of a patch, as part of its panel, that a kink makes; distance from the ends
_ROUNDS = 4


def with_kinks(layout: Layout) -> Layout:
    """The layout with panels divided where a boundary has a corner."""
    for _ in range(_ROUNDS):
        panels: list[Panel] = []
        for which, panel in enumerate(layout.panels):
            cut = _kink(layout, which)
            if cut is None:
                panels.append(panel)
            else:
                panels += [
                    Panel(panel.low, cut, panel.arcs, panel.labels), Panel(cut, panel.high, panel.arcs, panel.labels)
                ]  # fmt: skip
        if len(panels) == len(layout.panels):
            break
        layout.panels = panels
    return layout


def _kink(layout: Layout, which: int) -> float | None:
    """The angle of the sharpest kink inside a panel."""
    panel, sharpest = layout.panels[which], (_NARROW, 0.0)
    for k in range(len(panel.arcs)):
        forest = Forest(1)

        def sample(points: np.ndarray, k: int = k) -> np.ndarray:
            angle = panel.low + points[:, 0] * (panel.high - panel.low)
            return layout.boundary(which, k, angle)[:, None, None]

        try:
            fit(forest, sample, EDGE_ORDER)
        except Unresolved:
            continue
        for low, _, per, _ in forest.box:
            middle = low + 0.5 / per
            if _END < middle < 1 - _END and 1 / per < sharpest[0]:
                sharpest = 1 / per, middle
    return None if not sharpest[1] else panel.low + sharpest[1] * (panel.high - panel.low)
