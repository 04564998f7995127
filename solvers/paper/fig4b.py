"""Fig. 4b: restitution against St at six angles; inset against Ce for stick-rotate-separate."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ...generated.automaton import BOUNCE, ROTATE
from ..formatting.document import Picture, Table
from ..formatting.style import INK
from ..many.collide_many import collide_many
from ..scene.scene import Scene
from .lines import BRIDGED, Line, PaperLines, described, outcomes
from .printed import CURVES, PRINTED
from .report import Comparison, Part, degrees, number
from .style import BLUE, COLUMN, GREEN, ORANGE, PURPLE, SKY, STOKES, sheet

_REACH = 0.25  # St at the right edge
_BESIDE = 1e-6  # relative distance from a boundary at which a curve ends
_MOST_CE = 20.0  # range of the inset
_COLOURS = (INK, SKY, GREEN, BLUE, ORANGE, PURPLE)
_STYLES = ("-", (0, (4, 1.2)), "-", "-", "-", "-")


@dataclass(frozen=True)
class Curve:
    """Restitution between two boundaries at one angle."""

    angle: float
    outcome: str
    stokes: np.ndarray
    restitution: np.ndarray
    per_square: float  # Ce over St^2

    @property
    def highest(self) -> float:
        return float(self.restitution.max())


def make(lines: PaperLines, folder: Path) -> Part:
    """Compute the part: the curves between the boundaries, and their figure."""
    lines.say("fig. 4b: tracing boundaries")
    scene = Scene.load(BRIDGED)
    traced = lines.along(scene, CURVES)
    lines.say("fig. 4b: restitution along the curves")
    curves, counted = _curves(scene, traced, lines.curve)
    lines.collisions += counted
    with sheet(folder / "fig4b.png", 8.2) as figure:
        axes = figure.add_subplot()
        _against_stokes(axes, curves)
        _against_centrifugal(axes, curves)
    largest = max(curves, key=lambda curve: curve.highest)
    where = int(largest.restitution.argmax())
    rotating = max((curve for curve in curves if curve.outcome == ROTATE), key=lambda curve: curve.highest)
    at_15, apart = traced[1], _apart(curves)
    used = described(scene)
    rows = (
        Comparison(
            "two_at_15",
            ", ".join(outcomes(at_15)),
            used,
            f"one change, at St {number(at_15[0].stokes)}",
            agrees=outcomes(at_15) == ("stick", "bounce"),
        ),
        Comparison(
            "same_at_15",
            f"differs by {apart:.2g} at most",
            used,
            "in e_n, where both bounce",
            agrees=apart < 0.05,  # difference that is invisible in a printed figure
        ),
        Comparison(
            "above_one",
            f"{number(largest.highest)} at {degrees(largest.angle)}, St {largest.stokes[where]:.3g}",
            used,
            f"in St up to {_REACH:g}; of those that rotate first {number(rotating.highest)} at "
            f"{degrees(rotating.angle)}",
            agrees=largest.highest > 1,
        ),
    )
    caption = (
        "Fig. 4b: normal restitution against St, "
        + ", ".join(degrees(angle) for angle in CURVES)
        + " (bottom to top). Dotted: jumps at the traced boundaries. Inset: against Ce, where the spheres rotate "
        "before they separate (no rebound criterion met)."
    )
    return Part(
        "Fig. 4b: restitution",
        "The paper speaks of a discontinuity of the slope at St*; here e_n itself jumps, at every boundary (table): a "
        "doublet that has just passed its barrier takes up speed until rupture, and one that just meets a criterion is "
        "sent back with what speed it still had.",
        comparisons=rows,
        pictures=(Picture("fig4b.png", caption, COLUMN),),
        tables=(_jumps(traced, curves),),
        scenes=(BRIDGED,),
    )


def _curves(scene: Scene, lines: list[Line], points: int) -> tuple[list[Curve], int]:
    """All curves between boundaries, with points denser towards them, in one call."""
    pieces = []
    for angle, line in zip(CURVES, lines):
        edges = [change.stokes for change in line if change.stokes < _REACH]
        for outcome, (low, high) in zip(outcomes(line)[1:], pairwise([*edges, _REACH])):
            crowded = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, points))
            start, end = low * (1 + _BESIDE), high * (1 - _BESIDE)
            pieces.append((angle, outcome, start + (end - start) * crowded**1.5, line[0]))
    collided = collide_many(
        scene,
        stokes=np.concatenate([stokes for _, _, stokes, _ in pieces]),
        angle=np.repeat([angle for angle, *_ in pieces], points),
    )
    values = np.asarray(collided["restitution"])
    curves = []
    for k, (angle, outcome, stokes, first) in enumerate(pieces):
        per_square = (first.centrifugal or 0.0) / first.stokes**2
        curves.append(Curve(angle, outcome, stokes, values[k * points : (k + 1) * points], per_square))
    return curves, int(values.size)


def _apart(curves: list[Curve]) -> float:
    """Largest difference in restitution between the bounces at 15 deg and head-on."""
    head_on, at_15 = (next(c for c in curves if c.angle == angle and c.outcome == BOUNCE) for angle in CURVES[:2])
    start = max(head_on.stokes[0], at_15.stokes[0])
    stokes = np.linspace(start, _REACH, 400)[1:]
    values = [np.interp(stokes, curve.stokes, curve.restitution) for curve in (head_on, at_15)]
    return float(np.max(np.abs(values[1] - values[0])))


def _jumps(lines: list[Line], curves: list[Curve]) -> Table:
    """Table of e_n on both sides of each boundary."""
    rows = []
    for angle, line in zip(CURVES, lines):
        by_outcome = {curve.outcome: curve.restitution for curve in curves if curve.angle == angle}
        for change in line:
            if change.after in by_outcome:
                below = by_outcome[change.before][-1] if change.before in by_outcome else 0.0
                kind = f"{change.before} to {change.after}"
                ends = [f"{value:.3f}" for value in (below, by_outcome[change.after][0])]
                rows.append([degrees(angle), kind, number(change.stokes), number(change.centrifugal), *ends])
    return Table("Granules: e_n on either side of the boundaries", ["θ₀", "change", "St", "Ce", "below", "above"], rows)


def _against_stokes(axes: Axes, curves: list[Curve]) -> None:
    ends: dict[float, tuple[float, float]] = {}  # end of the last curve of an angle
    for curve in curves:
        place = CURVES.index(curve.angle)
        look: dict[str, Any] = {"color": _COLOURS[place], "linestyle": _STYLES[place], "zorder": 3 + place}
        last = ends.get(curve.angle, (0.0, 0.0))
        if curve.angle not in ends:
            axes.plot([0, curve.stokes[0]], [0, 0], **look, clip_on=False, label=degrees(curve.angle))
        jump = ([curve.stokes[0]] * 2, [last[1], curve.restitution[0]])
        axes.plot(*jump, color=look["color"], linestyle=":", linewidth=0.9, zorder=2)
        axes.plot(curve.stokes, curve.restitution, **look)
        ends[curve.angle] = (curve.stokes[-1], curve.restitution[-1])
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles[::-1], labels[::-1], title=r"$\theta_0$", loc="upper left", ncols=2, handlelength=1.8, columnspacing=1,
        title_fontsize=8,
    )  # fmt: skip
    top = max(curve.highest for curve in curves)
    axes.set(xlim=(0, _REACH), ylim=(0, 1.12 * top), xlabel=STOKES, ylabel="normal restitution $e_{w,n}$")
    axes.axhline(1, color=INK, linewidth=0.5, linestyle=(0, (1, 2)), zorder=1)


def _against_centrifugal(axes: Axes, curves: list[Curve]) -> None:
    inset = axes.inset_axes((0.63, 0.13, 0.345, 0.27))
    for curve in curves:
        if curve.outcome == ROTATE:
            ce = curve.per_square * curve.stokes**2
            colour = _COLOURS[CURVES.index(curve.angle)]
            inset.plot(ce, curve.restitution, color=colour, linewidth=1)
            inset.plot([0, ce[0], ce[0]], [0, 0, curve.restitution[0]], color=colour, linestyle=":", linewidth=0.9)
    inset.set(xlim=(0, _MOST_CE), ylim=(0, None))
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_xlabel("$Ce$", fontsize=7, labelpad=0.5)
    inset.set_ylabel("$e_{w,n}$", fontsize=7, labelpad=1)
    inset.axvline(PRINTED["centrifugal"].value, color=INK, linewidth=0.6, linestyle=(0, (4, 2)))
