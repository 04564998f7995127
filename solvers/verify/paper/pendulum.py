"""The spheres on strings: top views of three collisions (Fig. 1) and the regime map (Fig. 3)."""

import math
from dataclasses import replace
from pathlib import Path

from scipy.optimize import bisect

from ....generated.automaton import ROTATE
from ...boundaries.boundary import atlas
from ...collision.collide import collide
from ...collision.plot.frames import sampled
from ...collision.plot.strip import draw_strip, strip_size
from ...collision.result import Collision
from ...formatting.style import LETTERS, NOTE
from ...scene.scene import Scene
from . import report
from .printed import PRINTED, SHOT_ANGLE, SHOTS
from .report import Comparison, Part, degrees, draw_map, number, sheet

_BEFORE, _AFTER = 1, 4  # frames of a shot before and after initial contact
_REACH, _STEEPEST = 2.5, math.radians(89.0)  # St at the right edge of the map, and its largest angle
_MS = 1e3


def fig1(folder: Path) -> Part:
    """The three collisions and their figure."""
    scene = Scene.load(report.PENDULUM)
    collisions = [collide(scene, stokes=shot.stokes, angle=SHOT_ANGLE, ledger=False, trajectory=True) for shot in SHOTS]
    _draw_shots(collisions, folder / "fig1.png")
    comparisons = [
        Comparison(f"fig1{shot.panel}", seen.outcome, _end(seen), seen.outcome == shot.outcome)
        for shot, seen in zip(SHOTS, collisions)
    ]
    why = "a of Fig. 3's caption is rounded to 0.63 cm; four times that is used"
    comparisons.append(Comparison("diameter", 4 * scene.particles.reduced_radius * _MS, why))
    names = [f"({shot.panel}) St {shot.stokes:g}" for shot in SHOTS]
    caption = (
        f"Fig. 1: pendulum at {degrees(SHOT_ANGLE)}, {', '.join(names)}; seen from above in the frame of the centre of "
        "mass, to scale, at the paper's intervals. Before first touch and after rupture the spheres move on straight "
        "lines, strings left out. Lines: marks that met at touch."
    )
    return Part.drawn("Fig. 1: three collisions", "fig1.png", caption, comparisons, report.PENDULUM)


def _end(seen: Collision) -> str:
    if seen.contact_time is not None and seen.rotation is not None:
        return f"separates after {_MS * seen.contact_time:.4g} ms, turned by {degrees(seen.rotation)}"
    last = seen.events[-1]
    return f"ends at the experiment's cut-off ({last.kind}) after {_MS * last.time:.4g} ms"


def _draw_shots(collisions: list[Collision], file: Path) -> None:
    strips = []
    for shot, seen in zip(SHOTS, collisions):
        instants = [k * shot.interval / _MS for k in range(-_BEFORE, _AFTER + 1)]
        strips.append([replace(frame, relative=None) for frame in sampled(seen, instants)])  # as photographs: no arrows
    sizes = [strip_size(strip) for strip in strips]
    widest = max(across for across, _ in sizes)
    with sheet(file, 7.4) as figure:
        rows = figure.subplots(len(strips), 1, height_ratios=[high + 1.2 for _, high in sizes])
        for axes, shot, seen, strip in zip(rows, SHOTS, collisions, strips):
            captions = [f"{_MS * frame.time:.0f} ms".replace("-", "−") if frame.time else "0" for frame in strip]
            draw_strip(axes, seen, strip, captions)
            axes.set_xlim(-0.2, widest - 0.2)
            title = f"({shot.panel}) $St_n$ = {shot.stokes:.1f}: {LETTERS[seen.outcome]}"
            axes.set_title(title, loc="left", fontsize=8.5, pad=2)


def fig3(folder: Path) -> Part:
    """The map, and St* at theta0 = 0."""
    scene, printed = Scene.load(report.PENDULUM), PRINTED["stokes_3"]
    whole = atlas(scene, span=(0.0, _STEEPEST), stokes=(1e-3 * _REACH, _REACH))
    with sheet(folder / "fig3.png", 7.6) as figure:
        axes = figure.add_subplot()
        draw_map(axes, whole)
        axes.axvline(printed.value, color=NOTE, linestyle=(0, (4, 2)), linewidth=1, zorder=2)
        label = f"paper: $St_n^*$ = {printed.text}"
        axes.annotate(label, (printed.value, 4), (-4, 0), textcoords="offset points", fontsize=7.5, ha="right")
    at_printed = math.radians(PRINTED["angle_3"].value)
    head_on, oblique = report.ends_of_sticking(scene, 0.0, at_printed)
    escapes, rotates = head_on.stokes, oblique.stokes

    def reversal(stokes: float) -> float:
        """Positive where a rebound criterion is met head-on: at most just above St*, where the doublet escapes."""
        return 1.0 if collide(scene, stokes=stokes, angle=0.0, ledger=False).reversal else -1.0

    met = float(bisect(reversal, 0.8 * escapes, (1 + 1e-6) * escapes, xtol=1e-6 * escapes))
    first = math.degrees(min(min(curve.x) for curve in whole.curves if curve.after == ROTATE))
    leaves = math.degrees(max(max(curve.x) for curve in whole.curves if curve.before == ROTATE))
    between = (
        f"a criterion is met from {number(met)} on; up to {number(escapes)} the doublet is reversed and still sticks. "
        "The printed number lies between; p_gt, on which it depends, was fitted to a measured St*"
    )
    begins = (
        "printed as “about”; here the theory's SRS region begins, sooner for longer strings. Its S/SRS line is at St "
        f"{number(rotates)} at the printed angle"
    )
    caption = (
        f"Fig. 3: regime map of the pendulum. Lines: theory; dashed: the paper's St* = {printed.text}. St along and "
        "angle up, as the text has it (“at higher θ₀ for a given St”); the measured points of the paper are in its "
        f"picture alone. SRS/B leaves the map to the right above {leaves:.3g}°."
    )
    comparisons = [Comparison("stokes_3", escapes, between), Comparison("angle_3", first, begins)]
    return Part.drawn("Fig. 3: regime map of the pendulum", "fig3.png", caption, comparisons, report.PENDULUM)
