"""Fig. 4b: restitution against St at six angles; inset against Ce for stick-rotate-separate."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ...generated.automaton import BOUNCE, OUTCOMES, ROTATE
from ..boundaries.changes import Change
from ..formatting.document import Picture, Table
from ..formatting.style import INK, broken
from ..many.collide_many import collide_many
from ..scene.scene import Scene
from . import theory
from .printed import CURVES, PRINTED
from .report import STOKES, Comparison, Part, sheet
from .theory import degrees, number

_REACH = 0.25  # St at the right edge
_POINTS = 1500  # of a curve
_BESIDE = 1e-6  # relative distance from a boundary at which a curve ends
_MOST_CE = 20.0  # range of the inset
_COLOURS = (INK, "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7")  # Okabe-Ito
_LINES: Sequence[Any] = ("-", (0, (4, 1.2)), "-", "-", "-", "-")
_ROTATES, _BOUNCES = OUTCOMES.index(ROTATE), OUTCOMES.index(BOUNCE)


def fig4b(folder: Path) -> Part:
    """The curves between the boundaries, and their figure."""
    scene = Scene.load(theory.BRIDGED)
    lines = [theory.changes_at(scene, angle) for angle in CURVES]
    edges = np.array([change.stokes for line in lines for change in line if change.stokes < _REACH])
    even = np.linspace(0, _REACH, _POINTS + 1)[1:]
    stokes = np.unique(np.concatenate([even, edges * (1 - _BESIDE), edges * (1 + _BESIDE)]))
    found = collide_many(scene, stokes=xr.DataArray(stokes, dims="stokes"), angle=xr.DataArray([*CURVES], dims="angle"))
    outcome, restitution = (found[name].transpose("angle", "stokes").values for name in ("outcome", "restitution"))
    with sheet(folder / "fig4b.png", 8.2) as figure:
        axes = figure.add_subplot()
        _against_stokes(axes, stokes, outcome, restitution)
        _against_centrifugal(axes, stokes, outcome, restitution, lines)

    def highest(values: np.ndarray) -> tuple[float, float, float]:
        """The largest value, its angle and Stokes number."""
        angle, place = np.unravel_index(np.argmax(values), values.shape)
        return float(values[angle, place]), CURVES[angle], float(stokes[place])

    both_bounce = (outcome[:2] == _BOUNCES).all(axis=0)
    apart = float(np.abs(np.diff(restitution[:2], axis=0)[0, both_bounce]).max())
    largest, at, at_stokes = highest(restitution)
    rotating, rotating_at, _ = highest(np.where(outcome == _ROTATES, restitution, 0.0))
    used, at_15 = theory.described(scene), theory.outcomes(lines[1])
    why_largest = f"in St up to {_REACH:g}; of those that rotate first {number(rotating)} at {degrees(rotating_at)}"
    invisible = 0.05  # difference in a printed figure
    comparisons = [
        Comparison(
            "two_at_15", ", ".join(at_15), used, f"one change, at St {number(lines[1][0].stokes)}",
            at_15 == ("stick", "bounce"),
        ),
        Comparison(
            "same_at_15", f"differs by {apart:.2g} at most", used, "in e_n, where both bounce", apart < invisible
        ),
        Comparison(
            "above_one", f"{number(largest)} at {degrees(at)}, St {at_stokes:.3g}", used, why_largest, largest > 1
        ),
    ]  # fmt: skip
    caption = (
        f"Fig. 4b: normal restitution against St, {', '.join(map(degrees, CURVES))} (bottom to top). Dotted: jumps at "
        "the traced boundaries. Inset: against Ce, where the spheres rotate before they separate (no rebound criterion "
        "met)."
    )
    return Part(
        "Fig. 4b: restitution",
        "The paper speaks of a discontinuity of the slope at St*; here e_n itself jumps, at every boundary (table): a "
        "doublet that has just passed its barrier takes up speed until rupture, and one that just meets a criterion is "
        "sent back with what speed it still had.",
        comparisons=comparisons,
        pictures=[Picture("fig4b.png", caption)],
        tables=[_jumps(lines, stokes, restitution)],
        scenes=[theory.BRIDGED],
    )


def _jumps(lines: Sequence[Sequence[Change]], stokes: np.ndarray, restitution: np.ndarray) -> Table:
    """Table of e_n on both sides of each boundary."""
    rows = []
    for angle, line, values in zip(CURVES, lines, restitution):
        for change in line:
            above = int(np.searchsorted(stokes, change.stokes))
            ends = [f"{value:.3f}" for value in values[above - 1 : above + 1]]
            kind = f"{change.before} to {change.after}"
            rows.append([degrees(angle), kind, number(change.stokes), number(change.centrifugal), *ends])
    return Table("Granules: e_n on either side of the boundaries", ["θ₀", "change", "St", "Ce", "below", "above"], rows)


def _against_stokes(axes: Axes, stokes: np.ndarray, outcome: np.ndarray, restitution: np.ndarray) -> None:
    """Draw a curve for each angle; jumps are dotted."""
    for k, angle in enumerate(CURVES):
        axes.plot(stokes, restitution[k], color=_COLOURS[k], linestyle=":", linewidth=0.9, zorder=2)
        look: dict[str, Any] = {"color": _COLOURS[k], "linestyle": _LINES[k], "zorder": 3 + k}
        axes.plot(*broken(outcome[k], stokes, restitution[k]), **look, clip_on=False, label=degrees(angle))
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles[::-1], labels[::-1], title=r"$\theta_0$", loc="upper left", ncols=2, handlelength=1.8, columnspacing=1,
        title_fontsize=8,
    )  # fmt: skip
    axes.set(xlim=(0, _REACH), ylim=(0, 1.12 * restitution.max()), xlabel=STOKES)
    axes.set_ylabel("normal restitution $e_{w,n}$")
    axes.axhline(1, color=INK, linewidth=0.5, linestyle=(0, (1, 2)), zorder=1)


def _against_centrifugal(
    axes: Axes, stokes: np.ndarray, outcome: np.ndarray, restitution: np.ndarray, lines: Sequence[Sequence[Change]]
) -> None:
    """Draw the inset; at an angle Ce is proportional to St^2."""
    inset = axes.inset_axes((0.63, 0.13, 0.345, 0.27))
    for k, rotates in enumerate(outcome == _ROTATES):
        if rotates.any():
            centrifugal = (lines[k][0].centrifugal or 0.0) * (stokes[rotates] / lines[k][0].stokes) ** 2
            inset.plot(centrifugal, restitution[k, rotates], color=_COLOURS[k], linewidth=1)
            start, height = centrifugal[0], restitution[k, rotates][0]
            inset.plot([0, start, start], [0, 0, height], color=_COLOURS[k], linestyle=":", linewidth=0.9)
    inset.set(xlim=(0, _MOST_CE), ylim=(0, None))
    inset.tick_params(labelsize=6, pad=1.5)
    inset.set_xlabel("$Ce$", fontsize=7, labelpad=0.5)
    inset.set_ylabel("$e_{w,n}$", fontsize=7, labelpad=1)
    inset.axvline(PRINTED["centrifugal"].value, color=INK, linewidth=0.6, linestyle=(0, (4, 2)))
