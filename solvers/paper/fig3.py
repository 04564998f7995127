"""Fig. 3: regime map of the pendulum with the theoretical boundaries."""

import math
from functools import partial
from pathlib import Path
from typing import Any

from ...generated.automaton import ROTATE
from ..boundaries.result import Atlas
from ..formatting.document import Picture, Table
from ..formatting.style import halo
from ..scene.scene import Scene
from .lines import (
    PENDULUM,
    STRING_VARIANTS,
    Line,
    PaperLines,
    criterion_met,
    described,
    printed_pressure,
    sticks_to,
    variants,
)  # fmt: skip
from .printed import PRINTED
from .report import Comparison, Part, number, shown
from .style import ANGLE, COLUMN, GREY, STOKES, draw_map, sheet

_REACH = 2.5  # St at the right edge
_BESIDE = 1 + 1e-6
_BELOW = 0.8  # start of the search for the criterion, relative to the boundary


def make(lines: PaperLines, folder: Path) -> Part:
    """Compute the part: the map, and St* at theta0 = 0 for the variants."""
    lines.say("fig. 3: tracing the pendulum's boundaries")
    scene = Scene.load(PENDULUM)
    whole = lines.map(scene, _REACH)
    _draw(whole, folder / "fig3.png")
    used = described(scene)
    at_printed = math.radians(PRINTED["angle_3"].value)
    head_on, [rotates, *_] = lines.along(scene, (0.0, at_printed))
    escapes, met = sticks_to(head_on), _met(scene, head_on)
    first = math.degrees(min(min(curve.x) for curve in whole.curves if curve.after == ROTATE))
    leaves = math.degrees(max(max(curve.x) for curve in whole.curves if curve.before == ROTATE))
    printed = PRINTED["stokes_3"]
    lines.say("fig. 3: glass-transition pressure of the printed St*")
    fitted = lines.pressure_for(scene, printed.value)
    rows = (
        Comparison(
            "stokes_3",
            escapes,
            used,
            f"a criterion is met from {number(met)} on; up to {number(escapes)} the doublet is reversed and still "
            f"sticks. The printed number lies between; it is reached with p_gt = {fitted} in place of "
            f"the printed {printed_pressure(scene) / 1e6:.3g} MPa, which was fitted to a measured St*",
            beside=f"(escapes), {number(met)} (a criterion is met)",
        ),
        Comparison(
            "angle_3",
            first,
            used,
            "printed as “about”; here the theory's SRS region begins, sooner for longer strings. Its S/SRS line is "
            f"at St {number(rotates.stokes)} at the printed angle",
        ),
    )
    caption = (
        "Fig. 3: regime map of the pendulum. Lines: theory; dashed: the paper's "
        f"St* = {printed.text}. St along and angle up, as the text has it (“at higher θ₀ for a given St”); the "
        f"measured points of the paper are in its picture alone. SRS/B leaves the map to the right above {leaves:.3g}°."
    )
    return Part(
        "Fig. 3: regime map of the pendulum",
        comparisons=rows,
        pictures=(Picture("fig3.png", caption, COLUMN),),
        tables=(_moved(lines),),
        scenes=(PENDULUM,),
    )


def _met(scene: Scene, head_on: Line) -> float:
    """Stokes number from which a criterion is met; just above the boundary at most, where the criterion decides it."""
    return criterion_met(scene, _BELOW * sticks_to(head_on), sticks_to(head_on) * _BESIDE)


def _moved(lines: PaperLines) -> Table:
    """Both readings of St* for the variants; lever arm and logarithm have no effect head-on."""
    lines.say("fig. 3: variants")
    rows = []
    for name, scene in variants(PENDULUM, STRING_VARIANTS).items():
        [head_on] = lines.along(scene, (0.0,))
        rows.append([name, shown(partial(_met, scene, head_on)), shown(partial(sticks_to, head_on))])
    rows.append(["paper", PRINTED["stokes_3"].text, ""])
    head = ["variant", "St*: a criterion is met", "St*: escapes"]
    caption = "Pendulum at θ₀ = 0: St* under the variants (head-on, lever arm and tangential cut-off have no part)"
    return Table(caption, head, rows)


def _draw(whole: Atlas, file: Path) -> None:
    printed = PRINTED["stokes_3"]
    with sheet(file, 7.6) as figure:
        axes = figure.add_subplot()
        draw_map(axes, whole)
        axes.axvline(printed.value, color=GREY, linestyle=(0, (4, 2)), linewidth=1, zorder=2)
        style: Any = {"textcoords": "offset points", "fontsize": 7.5, "ha": "right"}
        axes.annotate(f"paper: $St_n^*$ = {printed.text}", (printed.value, 4), (-4, 0), **style)
        axes.text(0.45, 22, "S", fontsize=13, ha="center")
        axes.text(1.02, 62, "SRS", fontsize=13, ha="center", path_effects=[halo()])
        axes.text(2.0, 40, "B", fontsize=13, ha="center")
        axes.set(xlim=(0, _REACH), ylim=(0, 90), yticks=range(0, 91, 15), xlabel=STOKES, ylabel=ANGLE)
