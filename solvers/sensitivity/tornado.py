"""Elasticities as bars: of a collision a tornado chart, the largest on top; of boundaries a panel for each change."""

import math
import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from ..collision.text import name_of
from ..formatting.style import LONGEST, picture, plain_text, title
from ..results import DEFINITIONS

_UP, _DOWN, _INK = "#2a6f97", "#c1554a", "#222222"
_MOST = 16  # most bars in a panel
_SEEN = 0.005  # shortest bar, relative to a panel's longest
_LONG = 6  # most columns of panels
_PANELS, _ACROSS = 6, 3  # of changes of outcome, and side by side
_NAMES = {
    "impact.speed": "normal speed, Stokes",
    "impact.angle": "impact angle",
    "bridge.volume": "bridge volume",
    "particles.youngs_modulus": "Young's modulus",
    "particles.poisson_ratio": "Poisson's ratio",
}
"""Labels of parameters whose entry names are not descriptive enough."""


@picture
def draw(result: Any) -> Figure:
    """A panel per quantity and a bar per parameter of `Sensitivities`; below it those without a visible elasticity."""
    names = [name for name in result.value if any(result.elasticity[name].values())]
    panels = names[:_LONG] or list(result.value)[:1]
    order = _ranked(result, panels)
    rows = max(len(order), 1)
    figure = Figure(figsize=(2.3 + 3.1 * len(panels), 1.5 + 0.3 * rows), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axis, name in zip(axes, panels):
        _panel(axis, result, name, order)
    weak = [p for p in result.parameters if p not in order and any(result.elasticity[y][p] for y in panels)]
    left_out = [p for p in result.parameters if p not in order and p not in weak]
    if not order:
        axes[0].axis("off")
        axes[0].text(
            0.5, 0.5, "nothing moves it: a stick has e_n = 0" if result.outcome == "stick" else "no elasticity here",
            ha="center", va="center", transform=axes[0].transAxes, fontsize=9, color=_INK,
        )  # fmt: skip
    restitution = result.value.get("restitution")
    notes = [result.outcome if restitution is None else f"{result.outcome}, $e_n$ = {restitution:.4g}"]
    notes += [f"too little to be seen: {', '.join(_short(weak))}"] if _short(weak) else []
    notes += [f"no influence or no elasticity: {', '.join(_short(left_out))}"] if left_out else []
    title(figure, f"{plain_text(name_of(result.scene, LONGEST))}: elasticities d ln y / d ln p")
    figure.supxlabel(textwrap.fill("; ".join(notes), 34 * len(panels) + 30), color="#555555")
    return figure


def _ranked(result: Any, names: Sequence[str]) -> list[str]:
    """Parameters with influence, the largest last (bars are drawn from below); speed and Stokes number appear once."""
    single = [p for p in result.parameters if not (p == "impact.stokes" and "impact.speed" in result.parameters)]
    rows = {p: [abs(result.elasticity[y][p] or 0.0) for y in names] for p in single}
    longest = [max((row[k] for row in rows.values()), default=0.0) for k in range(len(names))]
    seen = [p for p, row in rows.items() if any(v > _SEEN * most for v, most in zip(row, longest))]
    return sorted(seen, key=lambda p: max(rows[p]))[-_MOST:]


def _panel(axis: Any, result: Any, name: str, order: Sequence[str]) -> None:
    """Draw the bars of one quantity, each labelled with its elasticity."""
    values = [result.elasticity[name][p] or 0.0 for p in order]
    bars = _bars(axis, values, [_label(p) for p in order])
    reach = max((abs(v) for v in values), default=1.0) or 1.0
    axis.set_xlim(-1.45 * reach, 1.45 * reach)
    for bar, value in zip(bars, values):
        text = f"{value:.2g}" if abs(value) >= 0.01 else f"{value:.0e}"
        side = 1 if value >= 0 else -1
        axis.annotate(
            text, (value, bar.get_y() + bar.get_height() / 2), (3 * side, 0), textcoords="offset points",
            ha="left" if side > 0 else "right", va="center", fontsize=7.5, color=_INK,
        )  # fmt: skip
    unit = DEFINITIONS[name].unit
    axis.set_title(f"{name.replace('_', ' ')}\n{result.value[name]:.4g}{'' if unit == '1' else ' ' + unit}", color=_INK)
    axis.tick_params(axis="y", length=0)


def _bars(axis: Any, values: Sequence[float], labels: Sequence[str], **of_labels: Any) -> Any:
    bars = axis.barh(range(len(values)), values, color=[_UP if v >= 0 else _DOWN for v in values], height=0.7)
    axis.set_yticks(range(len(values)), labels, **of_labels)
    axis.axvline(0, color=_INK, linewidth=0.8)
    axis.spines[["top", "right", "left"]].set_visible(False)
    return bars


def _label(name: str) -> str:
    return _NAMES.get(name, name.partition(".")[2].replace("_", " "))


def _short(names: Sequence[str]) -> list[str]:
    return [_label(name) for name in names if name != "impact.stokes"]


def draw_boundaries(boundaries: Any) -> Figure:
    """A panel for each change (at most six), a bar for each parameter; of Ce* where there is one, else of the speed."""
    parameters = boundaries.parameters
    panels = [(angle, one) for angle, line in zip(boundaries.angles, boundaries.changes, strict=True) for one in line][
        :_PANELS
    ]
    across = max(1, min(_ACROSS, len(panels)))
    down = max(1, -(-len(panels) // across))
    height = 1.1 + 0.22 * len(parameters)
    figure = Figure(figsize=(2.2 + 3.0 * across, 0.5 + height * down), layout="constrained")
    grid = figure.subplots(down, across, sharey=True, squeeze=False)
    for axis in grid.ravel()[len(panels) :]:
        axis.set_visible(False)
    for axis, (angle, one) in zip(grid.ravel(), panels):
        of = one.results[-1]
        values = [one.elasticity[of][name] or 0.0 if one.elasticity else 0.0 for name in parameters]
        _bars(axis, values, parameters, fontsize=7.5)
        symbol = {"centrifugal": "Ce*", "speed": "(normal speed)"}[of]
        axis.set_title(f"{math.degrees(angle):.4g}°, {one.change.before} → {one.change.after}", fontsize=8)
        axis.set_xlabel(f"d ln {symbol}/d ln p" if not one.reason else one.reason[:40], fontsize=8)
    figure.suptitle("how the boundaries move with the parameters" if panels else "no change of outcome", fontsize=11)
    return figure
