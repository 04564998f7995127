"""The free granules: the regime map with lines of constant Ce and St (Fig. 4a), and the factors of Ce*."""

import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ...generated.automaton import STICK
from ..boundaries.boundary import atlas
from ..boundaries.result import Atlas
from ..formatting.document import Picture, Table
from ..formatting.style import INK, LETTERS, NOTE, halo
from ..scene.scene import Scene
from . import theory
from .printed import CURVES, DOUBLED, PRINTED
from .report import Comparison, Part, draw_map, sheet
from .theory import degrees, number

_REACH = 0.26  # St at the right edge
_STEEPEST, _FIRST = math.radians(89.0), math.radians(0.5)  # the lowest oblique line without a bridge
_OBLIQUE, _AT = CURVES[2:], math.radians(45)  # angles of the table of Ce*, and that at which ours is read
_OUT_OF_REACH = 1e9  # factor on the glass-transition pressure
_BLUE, _ORANGE = "#0072B2", "#D55E00"


def fig4a(folder: Path) -> Part:
    """Both maps, and Ce* and St* for the variants."""
    scene, dry = Scene.load(theory.BRIDGED), Scene.load(theory.DRY)
    whole, dry_oblique = (
        atlas(each, span=(first, _STEEPEST), stokes=(1e-3 * _REACH, _REACH))
        for each, first in ((scene, 0.0), (dry, _FIRST))
    )
    stokes, centrifugal = theory.critical_stokes(scene), theory.critical_centrifugal(scene, _AT)
    with sheet(folder / "fig4a.png", 7.6) as figure:
        axes = figure.add_subplot()
        draw_map(axes, whole)
        _draw_critical(axes, centrifugal, theory.end_of_sticking(scene, _AT).stokes * math.tan(_AT), 1.15 * stokes)
        _draw_dry(axes, dry_oblique, theory.critical_stokes(dry))
    sides = {dry_oblique.background}.union(*((curve.before, curve.after) for curve in dry_oblique.curves))
    only_head_on = STICK not in sides and STICK in theory.outcomes(theory.changes_at(dry, 0.0))
    pressure = theory.pressure_for(scene, PRINTED["stokes_4"].value)
    why_stokes = (
        f"St* follows from p_gt alone: the printed number is reached with {pressure}. Head-on, the lever arm, the "
        "tangential cut-off and the bridge law have next to no part in it"
    )
    used, dry_used = theory.described(scene), theory.described(dry)
    over_angles = ", ".join(f"{number(theory.critical_centrifugal(scene, at))} at {degrees(at)}" for at in _OBLIQUE)
    why_centrifugal = (
        f"at {degrees(_AT)}; the paper has one number for all angles. Ours: {over_angles}. With the "
        "leading-order lever arm of the tangential force, which the paper may have used (a law of one's own, "
        "docs/reference/models.md): 4.27, 4.20, 4.15, 4.08 at 30, 45, 60, 75 deg"
    )
    why_dry = "nothing holds a rotating doublet once lubrication has stopped it"
    caption = (
        f"Fig. 4a: regime map without strings. Black: traced boundaries. Blue: Ce = {number(centrifugal)}, "
        f"the S/SRS boundary at {degrees(_AT)}; orange, dashed: the paper's Ce* = {PRINTED['centrifugal'].text} "
        f"and St* = {PRINTED['stokes_4'].text}. Inset: without capillary force, where only θ₀ = 0 sticks (arrow)."
    )
    readings: dict[str, Any] = {"St* at 0°": theory.critical_stokes}
    readings |= {f"Ce* at {degrees(at)}": partial(theory.critical_centrifugal, angle=at) for at in _OBLIQUE}
    printed = [PRINTED["stokes_4"].text, *[PRINTED["centrifugal"].text] * len(_OBLIQUE)]
    moved = "Granules: St* and Ce* under the variants"
    return Part(
        "Fig. 4a: regime map of granules",
        comparisons=[
            Comparison("stokes_4", stokes, used, why_stokes),
            Comparison("centrifugal", centrifugal, used, why_centrifugal),
            Comparison("dry", "θ₀ = 0 only" if only_head_on else "others, too", dry_used, why_dry, only_head_on),
        ],
        pictures=[Picture("fig4a.png", caption)],
        tables=[theory.under_variants(moved, theory.BRIDGED, theory.BRIDGE_VARIANTS, readings, printed)],
        scenes=[theory.BRIDGED, theory.DRY],
    )


def _draw_critical(axes: Axes, centrifugal: float, tangential: float, largest: float) -> None:
    """Draw our Ce* up to a Stokes number, the paper's Ce* and St*, and the letters of the regions.

    Arguments:
        tangential: St tan(theta0) at our Ce*; Ce is proportional to its square.
    """
    printed_ce, printed_st = PRINTED["centrifugal"], PRINTED["stokes_4"]
    angle = np.arctan2(tangential, np.linspace(0, largest, 600))
    by_paper = tangential * math.sqrt(printed_ce.value / centrifugal)
    axes.plot(tangential / np.tan(angle), np.degrees(angle), color=_BLUE, linewidth=2.6, alpha=0.55, zorder=2.5)
    dashed: Any = {"color": _ORANGE, "linestyle": (0, (4, 2)), "linewidth": 1.1, "zorder": 4}
    axes.plot(by_paper / np.tan(angle), np.degrees(angle), **dashed)
    axes.axvline(printed_st.value, **dashed)
    style: Any = {"textcoords": "offset points", "color": _ORANGE, "fontsize": 7.5, "ha": "right"}
    style |= {"path_effects": [halo()]}
    axes.annotate(f"paper:\n$St_n^*$ = {printed_st.text}", (printed_st.value, 4), (-3, 0), **style)
    place = by_paper / math.tan(math.radians(33)), 33
    axes.annotate(f"paper:\n$Ce^*$ = {printed_ce.text}", place, (-14, 0), va="center", **style)
    for x, y, letters in ((0.03, 18, "S"), (0.075, 62, "SRS"), (0.17, 70, "B")):
        axes.text(x, y, letters, fontsize=13, ha="center", va="center", path_effects=[halo()])
    axes.set_yticks(range(0, 91, 15))


def _draw_dry(axes: Axes, whole: Atlas, stokes: float) -> None:
    """Draw the inset, without capillary force; head-on collisions stick up to `stokes`."""
    inset = axes.inset_axes((0.61, 0.135, 0.36, 0.5), zorder=6)
    inset.patch.set_zorder(5)
    draw_map(inset, whole, linewidth=0.9)
    inset.plot([0, stokes], [0, 0], color=INK, linewidth=3, solid_capstyle="butt", clip_on=False, zorder=7)
    arrow: Any = {"arrowprops": {"arrowstyle": "->", "lw": 0.8}}
    inset.annotate("S", (0.6 * stokes, 1), (0.6 * stokes, 24), ha="center", fontsize=8, **arrow)
    for x, y, letters in ((0.055, 55, "SRS"), (0.185, 40, "B")):
        inset.text(x, y, letters, fontsize=8, ha="center", path_effects=[halo()])
    inset.set(xticks=(0.1, 0.2), yticks=(0, 30, 60, 90), xlabel="", ylabel="")
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_title("without $F_c$", fontsize=7, pad=2)
    for spine in inset.spines.values():
        spine.set_color(NOTE)


def factors(_folder: Path) -> Part:
    """Factors of Ce* when one quantity is doubled and all others are fixed, with the glass criterion disabled."""
    preset = Scene.load(theory.BRIDGED)
    base = preset.with_entries({theory.PRESSURE: _OUT_OF_REACH * float(preset.entries[theory.PRESSURE])})

    def doubled(scene: Scene, entry: str) -> Scene:
        return scene.with_entries({entry: 2 * float(scene.entries[entry])})

    entries, printed = zip(*DOUBLED.values())
    scenes = [base, *(doubled(base, entry) for entry in entries)]
    critical = np.array([[theory.critical_centrifugal(scene, angle) for angle in _OBLIQUE] for scene in scenes])
    ratios, place = critical[1:] / critical[0], _OBLIQUE.index(_AT)  # by quantity and angle
    nearest = int(np.argmin(((ratios - np.array(printed, dtype=float)[:, None]) ** 2).sum(axis=0)))
    in_reach = theory.outcomes(theory.changes_at(doubled(preset, "particles.reduced_radius"), _AT))
    comparisons = [
        Comparison(
            entry, float(row[place]), theory.described(base) + ", p_gt out of reach",
            f"at {degrees(_AT)}. Over the angles below: {number(row.min())} to {number(row.max())}",
        )
        for entry, row in zip(entries, ratios)
    ]  # fmt: skip
    rows = [
        [PRINTED[entry].what, PRINTED[entry].text, *(f"{x:.3f}" for x in row)] for entry, row in zip(entries, ratios)
    ]
    return Part(
        "Ce* with one quantity doubled",
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach: with the preset's p_gt a doubled radius goes through {', '.join(LETTERS[each] for each in in_reach)} "
        f"at {degrees(_AT)}. Ce* itself: {number(critical[0, place])}. The paper does not say at which angle; nearest "
        f"to its six numbers is {degrees(_OBLIQUE[nearest])}.",
        comparisons=comparisons,
        tables=[Table("Factors of Ce*", ["", "paper", *(f"at {degrees(angle)}" for angle in _OBLIQUE)], rows)],
        scenes=[theory.BRIDGED],
    )
