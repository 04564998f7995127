"""Fig. 4a: regime map of the free granules with lines of constant Ce and St; inset without capillary force."""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ..boundaries.result import Atlas
from ..formatting.document import Picture, Table
from ..formatting.style import INK, halo
from ..scene.scene import Scene
from .lines import (
    BRIDGE_VARIANTS,
    BRIDGED,
    DRY,
    PaperLines,
    centrifugal,
    described,
    outcomes,
    per_stokes_squared,
    printed_pressure,
    sticks_to,
    variants,
)  # fmt: skip
from .printed import PRINTED
from .report import Comparison, Part, degrees, number, shown
from .style import ANGLE, BLUE, COLUMN, GREY, ORANGE, STOKES, draw_map, sheet

_REACH = 0.26  # St at the right edge
_TAIL = 1.15  # end of the lines of constant Ce, relative to our St*
_OURS_AT = math.radians(45)  # angle at which our Ce* is read
_FIRST = math.radians(0.5)  # the lowest oblique line without a bridge


def make(lines: PaperLines, folder: Path) -> Part:
    """Compute the part: both maps, and Ce* and St* for the variants."""
    lines.say("fig. 4a: tracing the granules' boundaries")
    scene, dry = Scene.load(BRIDGED), Scene.load(DRY)
    whole, dry_oblique = lines.map(scene, _REACH), lines.map(dry, _REACH, _FIRST)
    [dry_head_on], [head_on] = lines.along(dry, (0.0,)), lines.along(scene, (0.0,))
    lines.say("fig. 4a: variants")
    moved = _moved(lines)
    criticals = [centrifugal(line) for line in lines.along(scene, lines.critical)]
    critical_centrifugal = centrifugal(lines.along(scene, (_OURS_AT,))[0])
    stokes = sticks_to(head_on)
    with sheet(folder / "fig4a.png", 7.6) as figure:
        axes = figure.add_subplot()
        draw_map(axes, whole)
        _lines_and_labels(axes, scene, critical_centrifugal, _TAIL * stokes)
        _dry(axes, dry_oblique, sticks_to(dry_head_on))
    sides = {dry_oblique.background}.union(*((curve.before, curve.after) for curve in dry_oblique.curves))
    only_head_on = "stick" not in sides and "stick" in outcomes(dry_head_on)
    caption = (
        f"Fig. 4a: regime map without strings. Black: traced boundaries. Blue: Ce = {number(critical_centrifugal)}, "
        f"the S/SRS boundary at {degrees(_OURS_AT)}; orange, dashed: the paper's Ce* = {PRINTED['centrifugal'].text} "
        f"and St* = {PRINTED['stokes_4'].text}. Inset: without capillary force, where only θ₀ = 0 sticks (arrow)."
    )
    return Part(
        "Fig. 4a: regime map of granules",
        comparisons=_compared(lines, scene, dry, stokes, critical_centrifugal, criticals, only_head_on),
        pictures=(Picture("fig4a.png", caption, COLUMN),),
        tables=(moved,),
        scenes=(BRIDGED, DRY),
    )


def _compared(
    lines: PaperLines,
    scene: Scene,
    dry: Scene,
    stokes: float,
    critical_centrifugal: float,
    criticals: Sequence[float],
    only_head_on: bool,
) -> tuple[Comparison, ...]:
    lines.say("fig. 4a: glass-transition pressure of the printed St*")
    pressure, fitted = printed_pressure(scene), lines.pressure_for(scene, PRINTED["stokes_4"].value)
    ours_over_angles = _spread(lines.critical, criticals)
    return (
        Comparison(
            "stokes_4",
            stokes,
            described(scene),
            f"St* follows from p_gt alone: the printed number is reached with {fitted} in place of the "
            f"printed {pressure / 1e6:.3g} MPa. Head-on, the lever arm, the "
            "tangential cut-off and the bridge law have next to no part in it",
        ),
        Comparison(
            "centrifugal",
            critical_centrifugal,
            described(scene),
            f"at {degrees(_OURS_AT)}; the paper has one number for all angles. Ours: {ours_over_angles}. With the "
            "leading-order lever arm of the tangential force, which the paper may have used (a law of one's own, "
            "docs/reference/models.md): 4.27, 4.20, 4.15, 4.08 at 30, 45, 60, 75 deg",
        ),
        Comparison(
            "dry",
            "θ₀ = 0 only" if only_head_on else "others, too",
            described(dry),
            "nothing holds a rotating doublet once lubrication has stopped it",
            agrees=only_head_on,
        ),
    )


def _spread(angles: Sequence[float], values: Sequence[float]) -> str:
    return ", ".join(f"{number(value)} at {degrees(angle)}" for angle, value in zip(angles, values))


def _moved(lines: PaperLines) -> Table:
    """St* and Ce* for the variants."""
    critical, rows = lines.critical, []
    for name, scene in variants(BRIDGED, BRIDGE_VARIANTS).items():
        [head_on], oblique = lines.along(scene, (0.0,)), lines.along(scene, critical, near=True)
        rows.append([name, shown(partial(sticks_to, head_on)), *(shown(partial(centrifugal, one)) for one in oblique)])
    rows.append(["paper", PRINTED["stokes_4"].text, *(PRINTED["centrifugal"].text for _ in critical)])
    head = ["variant", "St* at 0°", *(f"Ce* at {degrees(angle)}" for angle in critical)]
    return Table("Granules: St* and Ce* under the variants", head, rows)


def _lines_and_labels(axes: Axes, scene: Scene, critical_centrifugal: float, largest_stokes: float) -> None:
    """Draw our Ce* up to St = `largest_stokes`, the paper's Ce* and St*, the letters of the regions, and the axes."""
    angles = np.radians(np.linspace(1, 89.9, 600))
    per_square = np.array([per_stokes_squared(scene, angle) for angle in angles.tolist()])
    inside = np.sqrt(critical_centrifugal / per_square) < largest_stokes
    angles, per_square = angles[inside], per_square[inside]
    printed_ce, printed_st = PRINTED["centrifugal"], PRINTED["stokes_4"]
    up = np.degrees(angles)
    axes.plot(np.sqrt(critical_centrifugal / per_square), up, color=BLUE, linewidth=2.6, alpha=0.55, zorder=2.5)
    axes.plot(np.sqrt(printed_ce.value / per_square), up, color=ORANGE, linestyle=(0, (4, 2)), linewidth=1.1, zorder=4)
    axes.axvline(printed_st.value, color=ORANGE, linestyle=(0, (4, 2)), linewidth=1.1, zorder=4)
    style: Any = {"textcoords": "offset points", "color": ORANGE, "fontsize": 7.5, "ha": "right"}
    style |= {"path_effects": [halo()]}
    axes.annotate(f"paper:\n$St_n^*$ = {printed_st.text}", (printed_st.value, 4), (-3, 0), **style)
    stokes_at_label = math.sqrt(printed_ce.value / per_stokes_squared(scene, math.radians(33)))
    axes.annotate(f"paper:\n$Ce^*$ = {printed_ce.text}", (stokes_at_label, 33), (-14, 0), va="center", **style)
    for x, y, letters in ((0.03, 18, "S"), (0.075, 62, "SRS"), (0.17, 70, "B")):
        axes.text(x, y, letters, fontsize=13, ha="center", va="center", path_effects=[halo()])
    axes.set(xlim=(0, _REACH), ylim=(0, 90), yticks=range(0, 91, 15), xlabel=STOKES, ylabel=ANGLE)


def _dry(axes: Axes, whole: Atlas, stokes: float) -> None:
    """Draw the inset, without capillary force."""
    inset = axes.inset_axes((0.61, 0.135, 0.36, 0.5))
    inset.patch.set_zorder(5)
    inset.set_zorder(6)
    draw_map(inset, whole, linewidth=0.9)
    inset.plot([0, stokes], [0, 0], color=INK, linewidth=3, solid_capstyle="butt", clip_on=False, zorder=7)
    inset.annotate(
        "S", (0.6 * stokes, 1), (0.6 * stokes, 24), ha="center", fontsize=8, arrowprops={"arrowstyle": "->", "lw": 0.8}
    )
    inset.text(0.055, 55, "SRS", fontsize=8, ha="center", path_effects=[halo()])
    inset.text(0.185, 40, "B", fontsize=8, ha="center", path_effects=[halo()])
    inset.set(xlim=(0, _REACH), ylim=(0, 90), xticks=(0.1, 0.2), yticks=(0, 30, 60, 90))
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_title("without $F_c$", fontsize=7, pad=2)
    for spine in inset.spines.values():
        spine.set_color(GREY)
