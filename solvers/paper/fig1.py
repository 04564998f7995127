"""Fig. 1: top views of three collisions of the pendulum at the paper's intervals between frames."""

from dataclasses import replace
from pathlib import Path

from ..collision.collide import collide
from ..collision.plot.frames import sampled
from ..collision.plot.strip import draw_strip, strip_size
from ..collision.result import Collision
from ..formatting.document import Picture, Table
from ..formatting.style import LETTERS
from ..scene.scene import Scene
from .lines import PENDULUM, STRING_VARIANTS, Line, PaperLines, described, variants
from .printed import PRINTED, SHOT_ANGLE, SHOTS, Shot
from .report import Comparison, Part, degrees, number
from .style import COLUMN, sheet

_BEFORE, _AFTER = 1, 4  # frames before and after initial contact
_MS = 1e3


def make(lines: PaperLines, folder: Path) -> Part:
    """Compute the part: the three collisions and their figure."""
    lines.say("fig. 1: frames of the three collisions")
    scene = Scene.load(PENDULUM)
    shown = {"angle": SHOT_ANGLE, "ledger": False, "trajectory": True, "engine": "taylor"}
    collisions = [collide(scene, stokes=shot.stokes, **shown) for shot in SHOTS]  # type: ignore[arg-type]  # by keyword
    _draw(collisions, folder / "fig1.png")
    used = described(scene)
    comparisons = [
        Comparison(f"fig1{shot.panel}", one.outcome, used, _said(one), agrees=one.outcome == shot.outcome)
        for shot, one in zip(SHOTS, collisions)
    ]
    diameter = 4 * scene.particles.reduced_radius * _MS
    why = "a of Fig. 3's caption is rounded to 0.63 cm; four times that is used"
    comparisons.append(Comparison("diameter", diameter, "preset pendulum", why))
    caption = (
        f"Fig. 1: pendulum at {degrees(SHOT_ANGLE)}, "
        + ", ".join(f"({shot.panel}) St {shot.stokes:g}" for shot in SHOTS)
        + "; seen from above in the frame of the centre of mass, to scale, at the paper's intervals. Before first "
        "touch and after rupture the spheres move on straight lines, strings left out. Lines: marks that met at touch."
    )
    return Part(
        "Fig. 1: three collisions",
        comparisons=comparisons,
        pictures=(Picture("fig1.png", caption, COLUMN),),
        tables=(_moved(lines),),
        scenes=(PENDULUM,),
    )


def _said(one: Collision) -> str:
    if one.contact_time is not None and one.rotation is not None:
        return f"separates after {_MS * one.contact_time:.4g} ms, turned by {degrees(one.rotation)}"
    last = one.events[-1]
    return f"ends at the experiment's cut-off ({last.kind}) after {_MS * last.time:.4g} ms"


def _moved(lines: PaperLines) -> Table:
    """Table of outcomes and boundaries along the line of Fig. 1 for the variants."""
    lines.say("fig. 1: variants")
    rows = []
    for name, scene in variants(PENDULUM, STRING_VARIANTS).items():
        [line] = lines.along(scene, (SHOT_ANGLE,))
        changes = ", ".join(f"{LETTERS[c.before]}/{LETTERS[c.after]} {number(c.stokes)}" for c in line)
        rows.append([name, *(_outcome(shot, line) for shot in SHOTS), changes or "failed"])
    rows.append(["paper", *(LETTERS[PRINTED[f"fig1{shot.panel}"].text] for shot in SHOTS), "-"])
    head = ["variant", *(f"({shot.panel}) St {shot.stokes:g}" for shot in SHOTS), "boundaries in St"]
    return Table(f"Pendulum at {degrees(SHOT_ANGLE)}: outcomes of Fig. 1 under the variants", head, rows)


def _outcome(shot: Shot, line: Line) -> str:
    """The letter of the outcome at a Stokes number on a line of constant angle."""
    crossed = [change for change in line if shot.stokes > change.stokes]
    return LETTERS[crossed[-1].after if crossed else line[0].before] if line else "failed"


def _draw(collisions: list[Collision], file: Path) -> None:
    strips = []
    for shot, one in zip(SHOTS, collisions):
        instants = [k * shot.interval / _MS for k in range(-_BEFORE, _AFTER + 1)]
        strips.append([replace(frame, relative=None) for frame in sampled(one, instants)])  # as photographs: no arrows
    sizes = [strip_size(strip) for strip in strips]
    widest = max(across for across, _ in sizes)
    with sheet(file, 7.4) as figure:
        rows = figure.subplots(len(strips), 1, height_ratios=[high + 1.2 for _, high in sizes])
        for axes, shot, one, strip in zip(rows, SHOTS, collisions, strips):
            captions = [f"{_MS * frame.time:.0f} ms".replace("-", "−") if frame.time else "0" for frame in strip]
            draw_strip(axes, one, strip, captions)
            axes.set_xlim(-0.2, widest - 0.2)
            title = f"({shot.panel}) $St_n$ = {shot.stokes:.1f}: {LETTERS[one.outcome]}"
            axes.set_title(title, loc="left", fontsize=8.5, pad=2)
