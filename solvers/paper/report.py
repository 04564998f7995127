"""The report: printed numbers compared with ours, then each part with figures, equations and variants."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...generated.automaton import OUTCOMES
from ..boundaries.result import Atlas
from ..formatting.document import Block, Formulas, Picture, Table
from ..formatting.style import EDGES, FILLS, HATCHES, INK, styled
from ..host.files import save
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .printed import CITATION, NOT_COMPARED, PRINTED
from .theory import number

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
class Part:
    """A part of the report: a title, then text, pictures, formulas and tables, in this order."""

    title: str
    words: str = ""
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[Picture] = ()
    formulas: Sequence[tuple[str, str, str]] = ()  # heading, LaTeX, note
    tables: Sequence[Table] = ()
    scenes: Sequence[str] = ()  # presets used


def blocks(parts: Sequence[Part], how: str) -> Iterator[Block]:
    """Content of the report in order; `how` describes the computation."""
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
        if part.formulas:
            yield Formulas(part.formulas)
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
