"""Fig. 4a: regime map of the untethered granules, the lines of constant Ce and St, and without capillary force."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ..numbers import numbers
from ..scene import Scene
from . import regimes, tune
from .desk import Desk, Line, change_at, outcomes
from .parts import Comparison, Part, Picture, Table, degrees, number
from .printed import CURVES, PRINTED
from .style import ANGLE, BLUE, COLUMN, GREY, INK, ORANGE, STOKES, panel, sheet
from .variants import BRIDGE_VARIANTS, BRIDGED, DRY, described, variant

_REACH = 0.26  # St at the right edge
_AT = math.radians(45)  # where our Ce* is read
_FIRST = 0.5  # degrees: the lowest oblique line without a bridge
_ROTATING = CURVES[2:]  # angles of Fig. 4b that separate by rotation


def make(desk: Desk, folder: Path) -> Part:
    """Trace and draw both maps; Ce* and St* under the variants."""
    desk.say("fig. 4a: tracing the granules' boundaries")
    scene, dry = variant(BRIDGED, {}), variant(DRY, {})
    angles, lines = desk.map(scene)
    dry_angles, dry_lines = desk.map(dry, _FIRST)
    [dry_head_on], [head_on] = desk.many([(dry, (0.0,)), (scene, (0.0,))])
    criticals = [centrifugal(line) for line in desk.lines(scene, _ROTATING)]
    ours = centrifugal(desk.lines(scene, (_AT,))[0])
    stokes = change_at(head_on, "stick").stokes
    with sheet(folder / "fig4a.png", 7.6) as figure:
        axes = panel(figure)
        regimes.draw(axes, angles, lines, _REACH)
        _critical_lines(axes, scene, ours)
        _dry(axes, dry_angles, dry_lines, change_at(dry_head_on, "stick").stokes)
    sticking = [angle for angle, line in zip(dry_angles, dry_lines) if "stick" in outcomes(line)]
    only_head_on = not sticking and "stick" in outcomes(dry_head_on)
    caption = (
        f"Fig. 4a: regime map without strings. Black: traced boundaries. Blue: Ce = {number(ours)}, the S/SRS boundary "
        f"at {degrees(_AT)}; orange, dashed: the paper's Ce* = {PRINTED['centrifugal'].text} and St* = "
        f"{PRINTED['stokes_4'].text}. Inset: without capillary force, where only θ₀ = 0 sticks (arrow)."
    )
    return Part(
        "Fig. 4a: regime map of granules",
        comparisons=_compared(desk, scene, dry, stokes, ours, criticals, only_head_on),
        pictures=(Picture("fig4a.png", caption, COLUMN),),
        tables=(_moved(desk),),
        scenes=(BRIDGED, DRY),
    )


def centrifugal(line: Line) -> float:
    """Ce* of a line of constant angle: Ce at the end of sticking."""
    found = change_at(line, "stick").centrifugal
    if found is None:
        raise LookupError("without a bridge there is no centrifugal number")
    return found


def _compared(
    desk: Desk,
    scene: Scene,
    dry: Scene,
    stokes: float,
    ours: float,
    criticals: Sequence[float],
    only_head_on: bool,
) -> tuple[Comparison, ...]:
    desk.say("fig. 4a: glass-transition pressure of the printed St*")
    pressure, fitted = scene.liquid.glass_transition_pressure, tune.pressure_for(scene, PRINTED["stokes_4"].value)
    surface = variant(BRIDGED, BRIDGE_VARIANTS["arm surface"])
    leading = _spread([centrifugal(line) for line in desk.lines(surface, _ROTATING)])
    return (
        Comparison(
            "stokes_4",
            stokes,
            described(scene),
            f"St* follows from p_gt alone: the printed number is reached with {fitted / 1e6:.3g} MPa in place of the "
            f"printed {pressure / 1e6:.3g} MPa. Head-on, arm, log and bridge law have next to no part in it",
        ),
        Comparison(
            "centrifugal",
            ours,
            described(scene),
            f"at {degrees(_AT)}; the paper has one number for all angles. Ours: {_spread(criticals)}. With the "
            f"leading-order arm of the tangential force, which the paper may have used: {leading}",
        ),
        Comparison(
            "dry",
            "θ₀ = 0 only" if only_head_on else "others, too",
            described(dry),
            "nothing holds a rotating doublet once lubrication has stopped it",
            agrees=only_head_on,
        ),
    )


def _spread(values: Sequence[float]) -> str:
    return ", ".join(f"{number(value)} at {degrees(angle)}" for angle, value in zip(_ROTATING, values))


def _moved(desk: Desk) -> Table:
    desk.say("fig. 4a: variants")
    scenes = {name: variant(BRIDGED, changes) for name, changes in BRIDGE_VARIANTS.items()}
    traced = desk.many([(scene, (0.0, *_ROTATING)) for scene in scenes.values()])
    rows = [
        [name, number(change_at(head_on, "stick").stokes), *(number(centrifugal(line)) for line in oblique)]
        for name, (head_on, *oblique) in zip(scenes, traced)
    ]
    rows.append(["paper", PRINTED["stokes_4"].text, *(PRINTED["centrifugal"].text for _ in _ROTATING)])
    head = ["variant", "St* at 0°", *(f"Ce* at {degrees(angle)}" for angle in _ROTATING)]
    return Table("Granules: St* and Ce* under the variants", head, rows)


def _critical_lines(axes: Axes, scene: Scene, ours: float) -> None:
    angles = np.radians(np.linspace(1, 89.5, 300))
    per_square = np.array(
        [numbers(scene, scene.speed_of(1.0), angle).centrifugal for angle in angles.tolist()], dtype=float
    )
    paper, edge = PRINTED["centrifugal"], PRINTED["stokes_4"]
    up = np.degrees(angles)
    axes.plot(np.sqrt(ours / per_square), up, color=BLUE, linewidth=2.6, alpha=0.55, zorder=2.5)
    axes.plot(np.sqrt(paper.value / per_square), up, color=ORANGE, linestyle=(0, (4, 2)), linewidth=1.1, zorder=4)
    axes.axvline(edge.value, color=ORANGE, linestyle=(0, (4, 2)), linewidth=1.1, zorder=4)
    axes.annotate(
        f"$St_n^*$ = {edge.text}", (edge.value, 4), (-3, 0), textcoords="offset points", color=ORANGE, fontsize=7.5,
        ha="right",
    )  # fmt: skip
    place = np.radians(33)
    at = math.sqrt(paper.value / float(numbers(scene, scene.speed_of(1.0), place).centrifugal or 1.0))
    axes.annotate(
        f"$Ce^*$ = {paper.text}", (at, math.degrees(place)), (-8, 0), textcoords="offset points", color=ORANGE,
        fontsize=7.5, ha="right", va="center",
    )  # fmt: skip
    axes.text(0.03, 26, "S", fontsize=13, ha="center", va="center")
    axes.text(0.075, 62, "SRS", fontsize=13, ha="center", va="center")
    axes.text(0.17, 70, "B", fontsize=13, ha="center", va="center")
    axes.set(xlim=(0, _REACH), ylim=(0, 90), yticks=range(0, 91, 15), xlabel=STOKES, ylabel=ANGLE)


def _dry(axes: Axes, angles: list[float], lines: list[Line], stokes: float) -> None:
    """The inset: without capillary force."""
    inset = axes.inset_axes((0.61, 0.135, 0.36, 0.5))
    inset.patch.set_zorder(5)
    inset.set_zorder(6)
    regimes.draw(inset, angles, lines, _REACH, linewidth=0.9)
    inset.plot([0, stokes], [0, 0], color=INK, linewidth=3, solid_capstyle="butt", clip_on=False, zorder=7)
    inset.annotate(
        "S", (0.6 * stokes, 1), (0.6 * stokes, 24), ha="center", fontsize=8, arrowprops={"arrowstyle": "->", "lw": 0.8}
    )
    inset.text(0.055, 55, "SRS", fontsize=8, ha="center")
    inset.text(0.185, 40, "B", fontsize=8, ha="center")
    inset.set(xlim=(0, _REACH), ylim=(0, 90), xticks=(0, 0.1, 0.2), yticks=(0, 30, 60, 90))
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_title("without $F_c$", fontsize=7, pad=2)
    for spine in inset.spines.values():
        spine.set_color(GREY)
