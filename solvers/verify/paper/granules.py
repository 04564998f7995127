"""The free granules: regime map (Fig. 4a), restitution (Fig. 4b), and the factors of Ce*."""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ....generated.automaton import BOUNCE, OUTCOMES, ROTATE, STICK
from ...boundaries.boundary import atlas
from ...boundaries.result import Atlas
from ...formatting.style import INK, NOTE, broken, halo
from ...many.collide_many import collide_many
from ...scene.scene import Scene
from . import report
from .printed import CURVES, DOUBLED, PRINTED
from .report import Comparison, Part, degrees, draw_map, number, sheet

_REACH = 0.26  # St at the right edge
_STEEPEST, _FIRST = math.radians(89.0), math.radians(0.5)  # the lowest oblique line without a bridge
_OBLIQUE, _AT = CURVES[2:], math.radians(45)  # angles of the table of Ce*, and that at which ours is read
_PRESSURE = "liquid.glass_transition_pressure"
_OUT_OF_REACH = 1e9  # factor on the glass-transition pressure
_INSET = (0.61, 0.135, 0.36, 0.5)  # of Fig. 4a: left, bottom, width and height, as parts of its axes
_BLUE, _ORANGE = "#0072B2", "#D55E00"
_SHOWN, _INVISIBLE = 0.25, 0.05  # St at the right edge of Fig. 4b; difference that is not seen in it
_POINTS, _BESIDE = 1500, 1e-6  # of a curve; relative distance from a boundary at which it ends
_COLOURS = (INK, "#56B4E9", "#009E73", _BLUE, _ORANGE, "#CC79A7")  # Okabe-Ito
_LINES: Sequence[Any] = ("-", (0, (4, 1.2)), "-", "-", "-", "-")
_ROTATES, _BOUNCES = OUTCOMES.index(ROTATE), OUTCOMES.index(BOUNCE)


def fig4a(folder: Path) -> Part:
    """Both maps, and Ce* and St*."""
    scene, dry = Scene.load(report.BRIDGED), Scene.load(report.DRY)
    whole, dry_oblique = (
        atlas(setup, span=(first, _STEEPEST), stokes=(1e-3 * _REACH, _REACH))
        for setup, first in ((scene, 0.0), (dry, _FIRST))
    )
    head_on, *ends = report.ends_of_sticking(scene, 0.0, *_OBLIQUE)
    [dry_line] = report.changes_at(dry, 0.0)
    stokes, at_45 = head_on.stokes, ends[_OBLIQUE.index(_AT)]
    centrifugal = at_45.centrifugal or math.nan
    with sheet(folder / "fig4a.png", 7.6) as figure:
        axes = figure.add_subplot()
        draw_map(axes, whole, covered=_INSET)
        _draw_critical(axes, centrifugal, at_45.stokes * math.tan(_AT), 1.15 * stokes)
        _draw_dry(axes, dry_oblique, dry_line[0].stokes)
    sides = {dry_oblique.background}.union(*((curve.before, curve.after) for curve in dry_oblique.curves))
    only_head_on = STICK not in sides and STICK in report.outcomes(dry_line)
    why_stokes = "St* follows from p_gt alone: lever arm, tangential cut-off and bridge law have next to no part in it"
    why_centrifugal = (
        f"at {degrees(_AT)}; the paper has one number for all angles. Ours: "
        f"{_over_angles(end.centrifugal for end in ends)}. The paper may have used the leading-order lever arm of the "
        "tangential force, with which they are larger (a law of one's own, docs/reference/models.md)"
    )
    only, why_dry = "θ₀ = 0 only", "nothing holds a rotating doublet once lubrication has stopped it"
    caption = (
        f"Fig. 4a: regime map without strings. Black: traced boundaries. Blue: Ce = {number(centrifugal)}, "
        f"the S/SRS boundary at {degrees(_AT)}; orange, dashed: the paper's Ce* = {PRINTED['centrifugal'].text} "
        f"and St* = {PRINTED['stokes_4'].text}. Inset: without capillary force, where only θ₀ = 0 sticks (arrow)."
    )
    comparisons = [
        Comparison("stokes_4", stokes, why_stokes),
        Comparison("centrifugal", centrifugal, why_centrifugal),
        Comparison("dry", only if only_head_on else "others, too", why_dry, only_head_on),
    ]
    return Part.drawn("Fig. 4a: regime map of granules", "fig4a.png", caption, comparisons, report.BRIDGED, report.DRY)


def _draw_critical(axes: Axes, centrifugal: float, tangential: float, largest: float) -> None:
    """Draw our Ce* up to a Stokes number, and the paper's; Ce is proportional to the square of St tan(theta0)."""
    printed_ce, printed_st = PRINTED["centrifugal"], PRINTED["stokes_4"]
    stokes = np.linspace(0, largest, 600)
    by_paper = tangential * math.sqrt(printed_ce.value / centrifugal)
    axes.plot(stokes, np.degrees(np.arctan2(tangential, stokes)), color=_BLUE, linewidth=2.6, alpha=0.55, zorder=2.5)
    dashed: Any = {"color": _ORANGE, "linestyle": (0, (4, 2)), "linewidth": 1.1, "zorder": 4}
    axes.plot(stokes, np.degrees(np.arctan2(by_paper, stokes)), **dashed)
    axes.axvline(printed_st.value, **dashed)
    style: Any = {"textcoords": "offset points", "color": _ORANGE, "fontsize": 7.5, "ha": "right"}
    style |= {"path_effects": [halo()]}
    axes.annotate(f"paper:\n$St_n^*$ = {printed_st.text}", (printed_st.value, 4), (-3, 0), **style)
    place = by_paper / math.tan(math.radians(33)), 33
    axes.annotate(f"paper:\n$Ce^*$ = {printed_ce.text}", place, (-14, 0), va="center", **style)


def _draw_dry(axes: Axes, whole: Atlas, stokes: float) -> None:
    """Draw the inset, without capillary force; head-on collisions stick up to `stokes`."""
    inset = axes.inset_axes(_INSET, zorder=6)
    inset.patch.set_zorder(5)
    draw_map(inset, whole, linewidth=0.9, size=8)
    inset.plot([0, stokes], [0, 0], color=INK, linewidth=3, solid_capstyle="butt", clip_on=False, zorder=7)
    arrow: Any = {"arrowprops": {"arrowstyle": "->", "lw": 0.8}}
    inset.annotate("S", (0.6 * stokes, 1), (0.6 * stokes, 24), ha="center", fontsize=8, **arrow)
    inset.set(xticks=(0.1, 0.2), yticks=(0, 30, 60, 90), xlabel="", ylabel="")
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_title("without $F_c$", fontsize=7, pad=2)
    for spine in inset.spines.values():
        spine.set_color(NOTE)


def fig4b(folder: Path) -> Part:
    """The curves between the boundaries, and their figure."""
    scene = Scene.load(report.BRIDGED)
    lines = report.changes_at(scene, *CURVES)
    edges = np.array([change.stokes for line in lines for change in line if change.stokes < _SHOWN])
    even = np.linspace(0, _SHOWN, _POINTS + 1)[1:]
    stokes = np.unique(np.concatenate([even, edges * (1 - _BESIDE), edges * (1 + _BESIDE)]))
    data = collide_many(scene, stokes=xr.DataArray(stokes, dims="stokes"), angle=xr.DataArray([*CURVES], dims="angle"))
    outcome, restitution = (data[name].transpose("angle", "stokes").values for name in ("outcome", "restitution"))
    with sheet(folder / "fig4b.png", 8.2) as figure:
        axes = figure.add_subplot()
        for k, of_curve in enumerate(CURVES):
            axes.plot(stokes, restitution[k], color=_COLOURS[k], linestyle=":", linewidth=0.9, zorder=2)
            look: dict[str, Any] = {"color": _COLOURS[k], "linestyle": _LINES[k], "zorder": 3 + k}
            axes.plot(*broken(outcome[k], stokes, restitution[k]), **look, clip_on=False, label=degrees(of_curve))
        axes.legend(
            *(column[::-1] for column in axes.get_legend_handles_labels()), title=r"$\theta_0$", loc="upper left",
            ncols=2, handlelength=1.8, columnspacing=1, title_fontsize=8,
        )  # fmt: skip
        axes.set(xlim=(0, _SHOWN), ylim=(0, 1.12 * restitution.max()), xlabel=report.STOKES)
        axes.set_ylabel("normal restitution $e_{w,n}$")
        axes.axhline(1, color=INK, linewidth=0.5, linestyle=(0, (1, 2)), zorder=1)
    both_bounce = (outcome[:2] == _BOUNCES).all(axis=0)
    apart = float(np.abs(np.diff(restitution[:2], axis=0)[0, both_bounce]).max())
    angle, place = np.unravel_index(np.argmax(restitution), restitution.shape)
    rotating = np.where(outcome == _ROTATES, restitution, 0.0).max(axis=1)
    at_15, most = report.outcomes(lines[1]), float(restitution[angle, place])
    largest = f"{number(most)} at {degrees(CURVES[angle])}, St {stokes[place]:.3g}"
    rotates = f"of those that rotate first {number(rotating.max())} at {degrees(CURVES[int(np.argmax(rotating))])}"
    change = f"one change, at St {number(lines[1][0].stokes)}"
    comparisons = [
        Comparison("two_at_15", ", ".join(at_15), change, at_15 == ("stick", "bounce")),
        Comparison("same_at_15", f"differs by {apart:.2g} at most", "in e_n, where both bounce", apart < _INVISIBLE),
        Comparison("above_one", largest, f"in St up to {_SHOWN:g}; {rotates}", most > 1),
    ]
    caption = (
        f"Fig. 4b: normal restitution against St, {', '.join(map(degrees, CURVES))} (bottom to top). Dotted: jumps at "
        "the traced boundaries."
    )
    words = (
        "The paper speaks of a discontinuity of the slope at St*; here e_n itself jumps, at every boundary: a doublet "
        "that has just passed its barrier takes up speed until rupture, and one that just meets a criterion is sent "
        "back with what speed it still had."
    )
    return Part.drawn("Fig. 4b: restitution", "fig4b.png", caption, comparisons, report.BRIDGED, words=words)


def factors(_folder: Path) -> Part:
    """Factors of Ce* when one quantity is doubled and all others are fixed, with the glass criterion disabled."""
    base = Scene.load(report.BRIDGED)
    base = base.with_entries({_PRESSURE: _OUT_OF_REACH * float(base.entries[_PRESSURE])})
    entries = [entry for entry, _ in DOUBLED.values()]
    scenes = [base, *(base.with_entries({entry: 2 * float(base.entries[entry])}) for entry in entries)]
    ends = [report.ends_of_sticking(scene, *_OBLIQUE) for scene in scenes]
    critical = np.array([[end.centrifugal for end in line] for line in ends], float)
    place = _OBLIQUE.index(_AT)
    comparisons = [
        Comparison(entry, float(row[place]), f"p_gt out of reach, at {degrees(_AT)}. {_over_angles(row, '.3f')}")
        for entry, row in zip(entries, critical[1:] / critical[0])
    ]
    words = (
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach. Ce* itself: {number(critical[0, place])}. The paper does not say at which angle."
    )
    return Part("Ce* with one quantity doubled", words, comparisons, scenes=[report.BRIDGED])


def _over_angles(values: Iterable[float | None], form: str = "#.4g") -> str:
    return ", ".join(f"{value:{form}} at {degrees(at)}" for at, value in zip(_OBLIQUE, values))
