"""Boundaries as a figure: filled regions of each outcome, the curves between them, and their meeting points."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...generated.automaton import OUTCOMES
from ..collision.text import against, degrees, name_of, prefix
from ..engines.settings import RTOL
from ..formatting import ticks
from ..formatting.style import INK, LONGEST, fill, letters, patch, picture, plain_text, title
from ..scene.scene import Scene
from .atlas_curves import curves_of
from .plane import ANGLE, check_plane
from .result import LINES, Atlas, Boundaries, Curve, Point

_ROOM = 1.8  # factor of the Stokes number shown beyond the outermost curves
_MARKS = {
    "triple point": "o", "fold": "^", "crossing": "X", "criterion change": "D", "graze meets escape": "s",
}  # fmt: skip
_MOST_DOTS = 60  # most lines whose changes are marked
_PLACES, _ROOM_OF_LETTERS = 600, 30  # along each axis; between letters and the edge of their region


@picture
def draw(lines: Boundaries) -> Figure:
    """A figure of the regions of each outcome, the curves between them, and their meeting points.

    Lines of constant angle are drawn on the atlas of their angles; a single line as a strip of its outcomes.

    Arguments:
        lines: result of `boundary` or `atlas`.
    """
    scene = lines.scene
    dots = not isinstance(lines, Atlas) and len(set(lines.angles)) > 1 and len(lines.angles) <= _MOST_DOTS
    whole = lines if isinstance(lines, Atlas) else _filled(scene, lines)
    single = whole.span[0] == whole.span[1]
    figure = Figure(figsize=(6.4, 4.9), layout="constrained")
    axes = figure.add_subplot()
    name = plain_text(name_of(scene, LONGEST))
    fixed = "" if whole.over == ANGLE else f" at {degrees(scene.angle)}"
    title(figure, f"{name}{against(scene)}: where the outcome changes{fixed}")
    low, high = _shown(whole)
    factor = _frame(axes, scene, whole, low, high, single)
    regions = whole if not single else replace(whole, span=(0.0, 1.0))
    across, up = np.linspace(*axes.get_xlim(), _PLACES), np.geomspace(low, high, _PLACES)
    outcome = regions.region(*np.meshgrid(np.clip(across * factor, *regions.span), up))
    fill(axes, outcome, across, up)
    letters(axes, outcome, across, up, least=_ROOM_OF_LETTERS)
    for curve in regions.curves:
        axes.plot(np.array(curve.x) / factor, curve.stokes, color=INK, linewidth=1.5, solid_capstyle="round", zorder=3)
    changes = zip(lines.angles, lines.changes, strict=True) if dots else ()
    if pairs := [(math.degrees(at), change.stokes) for at, line in changes for change in line]:
        axes.plot(*zip(*pairs), "o", color=INK, markersize=2.6, zorder=4, clip_on=False)
    handles: list[Any] = [patch(OUTCOMES[k]) for k in np.unique(outcome)]
    handles += _mark(axes, whole.points, factor, low, high)
    handles += _doubts(axes, lines, whole, factor)
    figure.legend(handles=handles, loc="outside lower center", ncols=min(3, len(handles)), handleheight=1.1)
    return figure


def _filled(scene: Scene, lines: Boundaries) -> Atlas:
    """The atlas over the angles of lines; for a single line, its changes across the figure."""
    low, high = min(lines.angles), max(lines.angles)
    if low < high:
        return _curves(scene, (low, high), lines.window, max(2, min(LINES, len(lines.angles))))
    changes = lines.changes[0]
    curves = [Curve(edge.before, edge.after, edge.kind, (0.0, 1.0), (edge.stokes, edge.stokes)) for edge in changes]
    background = OUTCOMES[0]
    if not changes:
        background = _curves(scene, (max(low - 1e-6, 0.0), low + 1e-6), lines.window, 2).background
    return Atlas(
        lines.angles, lines.changes, lines.collisions, lines.failures, lines.resolution, scene, lines.window,
        lines.rtol, span=(low, low), curves=tuple(curves), background=background,
    )  # fmt: skip


def _curves(scene: Scene, angles: tuple[float, float], window: tuple[float, float], lines: int) -> Atlas:
    return curves_of(check_plane(scene, ANGLE, angles, window, RTOL), lines, lambda *_: None)


def _shown(whole: Atlas) -> tuple[float, float]:
    """Range of Stokes numbers of the figure: the curves and a margin, within the window."""
    stokes = [value for curve in whole.curves for value in curve.stokes]
    if not stokes:
        return whole.window
    return max(min(stokes) / _ROOM, whole.window[0]), min(max(stokes) * _ROOM, whole.window[1])


def _frame(axes: Axes, scene: Scene, whole: Atlas, low: float, high: float, single: bool) -> float:
    """Set scales and labels; returns the divisor of x."""
    factor, text = _across(scene, whole.over, whole.span)
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    ticks.plain(axes.yaxis, (1, 1.5, 2, 3, 4, 5, 7) if high / low < 8 else (1, 2, 5) if high / low < 1e3 else (1,))
    axes.set_ylabel("normal Stokes number St")
    if single:
        axes.set_xlim(0, 1)
        axes.set_xticks([])
        axes.set_xlabel(f"at an {text.replace(' (deg)', '')} of {degrees(whole.span[0])}")
        return 1.0
    axes.set_xlim(whole.span[0] / factor, whole.span[1] / factor)
    axes.set_xlabel(text)
    return factor


def _across(scene: Scene, over: str, span: tuple[float, float]) -> tuple[float, str]:
    """Divisor of x, and its label with the unit that results."""
    unit = scene.fields[over].unit
    if over == ANGLE or unit == "rad":
        name = r"impact angle $\theta_0$" if over == ANGLE else over.rpartition(".")[2].replace("_", " ")
        return math.pi / 180, f"{name} (deg)"
    name = over.rpartition(".")[2].replace("_", " ")
    if unit is None:
        return 1.0, name
    factor, letter = prefix(span[1]) if unit not in ("kg",) else (1.0, "")
    if span[1] >= 1e6:
        factor, letter = (1e9, "G") if span[1] >= 1e9 else (1e6, "M")
    return factor, f"{name} ({letter.replace('u', 'µ')}{unit})"


def _mark(axes: Axes, points: Sequence[Point], factor: float, low: float, high: float) -> list[Any]:
    """Draw meeting points and their legend."""
    handles: dict[str, Any] = {}
    for point in points:
        if not low <= point.stokes <= high:
            continue
        style: Any = {
            "marker": _MARKS[point.kind], "color": "white", "markeredgecolor": INK, "markeredgewidth": 1.2,
            "markersize": 6,
        }  # fmt: skip
        axes.plot(point.x / factor, point.stokes, linestyle="", zorder=5, clip_on=False, **style)
        handles[point.kind] = Line2D([], [], linestyle="", label=point.kind, **style)
    return list(handles.values())


def _doubts(axes: Axes, lines: Boundaries, whole: Atlas, factor: float) -> list[Any]:
    """Note on lines and places that could not be traced or verified."""
    style: Any = {"linestyle": "", "marker": "x", "color": "#C00000", "markersize": 6}
    places = [(x / factor, stokes) for x, stokes, _ in whole.unsettled]
    if places:
        axes.plot(*zip(*places), zorder=6, clip_on=False, **style)
    failed = [] if isinstance(lines, Atlas) else [math.degrees(angle) for angle, _ in lines.failed]
    if failed:
        axes.plot(failed, [0.02] * len(failed), transform=axes.get_xaxis_transform(), clip_on=False, **style)
    return [Line2D([], [], label="not settled", **style)] if places or failed else []
