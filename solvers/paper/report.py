"""The report: printed numbers beside ours, each part with figures, equations and variants; what all parts read."""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.optimize import bisect, root_scalar

from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.boundary import boundary
from ..boundaries.changes import Change
from ..boundaries.result import Atlas
from ..collision.collide import collide
from ..engines.settings import RTOL
from ..engines.taylor.build import compile_all
from ..engines.taylor.record import variant_to_record
from ..errors import ComputationError
from ..formatting.style import EDGES, FILLS, HATCHES, INK, styled
from ..host.files import save
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .printed import CITATION, NOT_COMPARED, PRINTED

TITLE = "Wet particles, oblique collisions: the paper and this model"
COLUMN = 8.8  # cm, width of a printed column
STOKES, ANGLE = "Stokes number $St_n$", r"impact angle $\theta_0$ (deg)"
_HEAD = ("quantity", "paper", "ours", "difference", "with (lever arm at mid-gap)", "why, and what goes with it")
_ROWS, _COLUMNS = 541, 781  # of the raster of outcomes; their edges are drawn over by the curves
_STYLE: Any = {  # matplotlib's stubs type each key separately
    "font.size": 8, "axes.labelsize": 8.5, "axes.linewidth": 0.7, "xtick.labelsize": 7.5, "ytick.labelsize": 7.5,
    "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True, "lines.linewidth": 1.2,
    "legend.fontsize": 7,
}  # fmt: skip
BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"
PRESSURE = "liquid.glass_transition_pressure"
_SHARED: dict[str, dict[str, Any]] = {
    "preset": {}, "log film": {"model.tangential": "film"}, "glass film-corrected": {"model.glass": "film-corrected"},
}  # fmt: skip
_OTHER_FIT = {"bridge.law": "mikami-log10"}
BRIDGE_VARIANTS = _SHARED | {_OTHER_FIT["bridge.law"]: _OTHER_FIT}
STRING_VARIANTS = _SHARED | {
    **{f"l = {length} m": {"pendulum.length": f"{length} m"} for length in ("0.4", "0.7", "1")},
    "small-angle strings": {"pendulum.law": "small-angle"},
}


@dataclass(frozen=True)
class Comparison:
    """A printed number or finding with ours.

    Arguments:
        key: key of the printed entry.
        ours: computed number, or the finding in words.
        used: the variants used.
        why: reason for a difference, or a comment.
        agrees: for a finding in words, True if it agrees with the paper.
    """

    key: str
    ours: float | str
    used: str
    why: str = ""
    agrees: bool | None = None

    @property
    def verdict(self) -> str:
        """Text of the relative difference and rounding to the printed digits; for words, agreement."""
        printed = PRINTED[self.key]
        if isinstance(self.ours, str):
            return "agrees" if self.agrees else "differs"
        rounded = f"{self.ours:.{printed.digits}f}" == printed.text
        difference = round(100 * (self.ours / printed.value - 1), 1) + 0.0
        return f"{difference:+.1f} %" + (" (rounds to it)" if rounded else "")


@dataclass(frozen=True)
class Table:
    """A table: a caption, a head, rows of text."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def __str__(self) -> str:
        """The caption and the table in Markdown; bars are escaped."""
        lines = [self.head, ["---"] * len(self.head), *self.rows]
        cells = [" | ".join(cell.replace("|", r"\|") for cell in line) for line in lines]
        return "\n".join([f"**{self.caption}**", "", *(f"| {line} |" for line in cells)])


@dataclass(frozen=True)
class Picture:
    """A picture: file name in the report's folder, and caption."""

    file: str
    caption: str

    def __str__(self) -> str:
        """In Markdown; the caption's first sentence is for readers who do not see the picture."""
        alternative = re.sub(r"[\[\]*_]", "", self.caption.split(".", maxsplit=1)[0])
        return f"![{alternative}]({self.file})\n\n*{self.caption}*"


@dataclass(frozen=True)
class Part:
    """A part of the report: a title, then text, pictures, formulas and tables, in this order."""

    title: str
    words: str = ""
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[Picture] = ()
    formulas: Sequence[tuple[str, str, str]] = ()  # heading, LaTeX, note
    tables: Sequence[Table] = ()
    scenes: Sequence[str] = ()  # presets used


def markdown(parts: Sequence[Part], how: str) -> str:
    """The report; `how` describes the computation."""
    return "\n\n".join([f"# {TITLE}", *map(str, _blocks(parts, how))]) + "\n"


def _blocks(parts: Sequence[Part], how: str) -> Iterator[str | Table | Picture]:
    comparisons = {each.key: each for part in parts for each in part.comparisons}
    compared = [(printed, comparisons[key]) for key, printed in PRINTED.items() if key in comparisons]
    if compared:
        yield f"The paper: {CITATION}."
    yield how
    if compared:
        yield (
            "“With” has the variants used where the paper leaves a choice open; how the numbers move under the others "
            "is in the tables further down. “Rounds to it”: ours, rounded to the printed digits, is the printed number."
        )
        yield "## The numbers"
        rows = [
            (printed.what, printed.text, ours.ours if isinstance(ours.ours, str) else number(ours.ours), ours.verdict,
             ours.used, ours.why)
            for printed, ours in compared
        ]  # fmt: skip
        yield Table("Every number the paper prints, beside ours", _HEAD, rows)
        yield Table("Printed, but not compared", ("what", "why"), NOT_COMPARED)
    for part in parts:
        yield f"## {part.title}"
        if part.words:
            yield part.words
        yield from part.pictures
        for heading, lines in groupby(part.formulas, key=lambda line: line[0]):
            yield f"### {heading}"
            yield from (text for _, latex, note in lines for text in (f"$$ {latex} $$", note) if text)
        yield from part.tables
    yield "## Inputs"
    yield _inputs([*dict.fromkeys(name for part in parts for name in part.scenes)])
    if compared:
        yield "## Sources"
        sources = [(printed.what, printed.place, f"“{printed.quote}”") for printed, _ in compared]
        yield Table("Where the paper prints it", ("quantity", "place", "words"), sources)


def _inputs(presets: Sequence[str]) -> Table:
    """Table of the entries of the presets, with assumed values marked."""
    columns = []
    for scene in map(Scene.load, presets):
        assumed = dict(scene.guesses)
        columns.append({name: f"{value}{' (assumed)' * (name in assumed)}" for name, value in scene.given})
    names = dict.fromkeys(name for column in columns for name in column if name not in MEETING)
    rows = [(name, *(column.get(name, "-") for column in columns)) for name in names]
    return Table("Presets, from the paper's captions; “assumed” is printed nowhere", ("entry", *presets), rows)


@contextmanager
def sheet(file: Path, height: float, width: float = COLUMN) -> Iterator[Figure]:
    """Context of a figure of the given size in cm, saved to `file` at the end."""
    with styled(_STYLE):
        figure = Figure(figsize=(width / 2.54, height / 2.54), layout="constrained")
        yield figure
        save(figure, file, dpi=300)


def draw_map(axes: Axes, whole: Atlas, linewidth: float = 1.2) -> None:
    """Draw the regions and boundaries of an atlas of the impact angle, in degrees, continued to St = 0 and 90 deg."""
    degrees, stokes = np.linspace(0.0, 90.0, _ROWS), np.linspace(0.0, whole.window[1], _COLUMNS)
    places = np.meshgrid(np.clip(np.radians(degrees), *whole.span), np.clip(stokes, *whole.window), indexing="ij")
    style: Any = {"colors": [*FILLS.values()], "hatches": [*HATCHES.values()]}
    fills = axes.contourf(stokes, degrees, whole.region(*places), levels=np.arange(4) - 0.5, zorder=1, **style)
    fills.set_edgecolor([EDGES[outcome] for outcome in OUTCOMES])
    fills.set_linewidth(0)
    for curve in whole.curves:
        axes.plot(curve.stokes, np.degrees(curve.x), color=INK, linewidth=linewidth, zorder=3)
    axes.set(xlim=(0, whole.window[1]), ylim=(0, 90), xlabel=STOKES, ylabel=ANGLE)


def described(scene: Scene) -> str:
    """The choices that the paper leaves open, by the names of a scene file."""
    text = f"tangential {scene.model.tangential}, glass {scene.model.glass}"
    text += "" if scene.bridge is None else f"; bridge {scene.bridge.law}"
    return text if scene.pendulum is None else f"{text}; {scene.pendulum.law} strings, l = {scene.pendulum.length:g} m"


def changes_at(scene: Scene, angle: float) -> tuple[Change, ...]:
    """The changes of outcome at an angle (rad), by the Stokes number; ComputationError where they are not traced."""
    traced = boundary(scene, angle=angle)
    for at, reason in traced.failed:
        raise ComputationError(f"{scene.name} at {degrees(at)}: {reason}")
    return traced.changes[0]


def outcomes(changes: Sequence[Change]) -> tuple[str, ...]:
    """The outcomes between changes, in order of St."""
    return (changes[0].before, *(change.after for change in changes)) if changes else ()


def end_of_sticking(scene: Scene, angle: float = 0.0) -> Change:
    """The change at which sticking ends: its Stokes number is St*, its centrifugal number Ce*."""
    for change in changes_at(scene, angle):
        if change.before == STICK:
            return change
    raise ComputationError("no boundary at which stick ends was found where the paper has one")


def critical_stokes(scene: Scene) -> float:
    """St* of head-on collisions."""
    return end_of_sticking(scene).stokes


def critical_centrifugal(scene: Scene, angle: float) -> float:
    """Ce* of a scene with a bridge."""
    return float(end_of_sticking(scene, angle).centrifugal or math.nan)


def criterion_met(scene: Scene) -> float:
    """The Stokes number from which a rebound criterion is met head-on; at most just above St*, which it decides."""
    escapes = critical_stokes(scene)

    def met(stokes: float) -> float:
        return 1.0 if collide(scene, stokes=stokes, angle=0.0, ledger=False).reversal else -1.0

    return float(bisect(met, 0.8 * escapes, (1 + 1e-6) * escapes, xtol=1e-6 * escapes))


def pressure_for(scene: Scene, stokes: float) -> str:
    """The glass-transition pressure with which St* is `stokes`, in place of the printed one."""

    def apart(log_pressure: float) -> float:
        return math.log(critical_stokes(scene.with_entries({PRESSURE: math.exp(log_pressure)})) / stokes)

    printed = float(scene.entries[PRESSURE])
    start = math.log(printed)
    pressure = math.exp(root_scalar(apart, x0=start, x1=start + 0.05, method="secant", xtol=1e-6).root)
    return f"p_gt = {pressure / 1e6:.3g} MPa in place of the printed {printed / 1e6:.3g} MPa"


def number(value: float | None) -> str:
    """A number with four or more significant digits; a dash for None or NaN."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in rad as degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"


def under_variants(
    caption: str, preset: str, variants: Mapping[str, dict[str, Any]],
    readings: Mapping[str, Callable[[Scene], str | float]], printed: Sequence[str],
) -> Table:  # fmt: skip
    """What is read of a preset with each choice changed alone, and as the paper prints it; `failed` where it cannot."""

    def cell(read: Callable[[Scene], str | float], scene: Scene) -> str:
        try:
            value = read(scene)
        except ComputationError:
            return "failed"
        return value if isinstance(value, str) else number(value)

    scenes = {name: Scene.load(preset).with_entries(entries) for name, entries in variants.items()}
    compile_all({variant_to_record(scene, True, RTOL, False, trajectory=True, fold=False) for scene in scenes.values()})
    rows = [[name, *(cell(read, scene) for read in readings.values())] for name, scene in scenes.items()]
    return Table(caption, ["variant", *readings], [*rows, ["paper", *printed]])
