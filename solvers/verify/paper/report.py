"""The report: printed numbers beside ours, each part with figures, equations and variants; what all parts read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ....generated.automaton import STICK
from ...boundaries.boundary import boundary
from ...boundaries.changes import Change
from ...boundaries.result import Atlas
from ...errors import ComputationError
from ...formatting.style import INK, fill, letters, styled
from ...host.files import save
from ...scene.items import item
from ...scene.origin import Record
from ...scene.scene import Scene
from ...scene.schema import MEETING
from .printed import CITATION, NOT_COMPARED, PRINTED

TITLE = "Wet particles, oblique collisions: the paper and this model"
COLUMN, _DPI = 8.8, 300  # cm, width of a printed column
STOKES, ANGLE = "Stokes number $St_n$", r"impact angle $\theta_0$ (deg)"
_HEAD = ("quantity", "paper", "ours", "difference", "why, and what goes with it", "where the paper prints it")
_HOW_TO_READ = "“Rounds to it”: ours, rounded to the printed digits, is the printed number."
_ROWS, _COLUMNS = 541, 781  # of the raster of outcomes; their edges are drawn over by the curves
_STYLE: Any = {  # matplotlib's stubs type each key separately
    "font.size": 8, "axes.labelsize": 8.5, "axes.linewidth": 0.7, "xtick.labelsize": 7.5, "ytick.labelsize": 7.5,
    "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True, "lines.linewidth": 1.2,
    "legend.fontsize": 7,
}  # fmt: skip
BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"


class Comparison(Record):
    """Our number or finding for an entry of PRINTED, and why it differs."""

    key: str
    ours: float | str
    why: str = ""
    agrees: bool | None = item("for a finding in words, True if it agrees with the paper", default=None)

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
    """A part of the report: its text in Markdown, its pictures in the report's folder, and the presets used."""

    title: str
    text: str
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[str] = ()
    scenes: Sequence[str] = ()

    @classmethod
    def drawn(
        cls, title: str, file: str, caption: str, comparisons: Sequence[Comparison], *scenes: str, words: str = ""
    ) -> Part:
        """A part with one picture, and words before it."""
        return cls(title, f"{words}\n\n![{title}]({file})\n\n*{caption}*".lstrip(), comparisons, [file], scenes)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def report(parts: Sequence[Part], how: str) -> str:
    """The report in Markdown; `how` describes the computation."""
    comparisons = {comparison.key: comparison for section in parts for comparison in section.comparisons}
    compared = [(printed, comparisons[key]) for key, printed in PRINTED.items() if key in comparisons]
    rows = [
        (printed.what, printed.text, ours.ours if isinstance(ours.ours, str) else number(ours.ours), ours.verdict,
         ours.why, f"{printed.place}: “{printed.quote}”")
        for printed, ours in compared
    ]  # fmt: skip
    numbers = [f"The paper: {CITATION}.", _HOW_TO_READ, "## The numbers", table(_HEAD, rows)]
    numbers += ["Printed, but not compared:", table(("what", "why"), NOT_COMPARED)]
    blocks = [f"# {TITLE}", how, *(numbers if compared else ())]
    for section in parts:
        blocks += [f"## {section.title}", section.text]
    blocks += ["## Inputs", "From the paper's captions; “assumed” is printed nowhere."]
    blocks.append(_inputs([*dict.fromkeys(name for section in parts for name in section.scenes)]))
    return "\n\n".join(blocks) + "\n"


def _inputs(presets: Sequence[str]) -> str:
    """Table of the entries of the presets, with assumed values marked."""
    columns = []
    for scene in map(Scene.load, presets):
        assumed = dict(scene.guesses)
        columns.append({name: f"{value}{' (assumed)' * (name in assumed)}" for name, value in scene.given})
    names = dict.fromkeys(name for column in columns for name in column if name not in MEETING)
    rows = [(name, *(column.get(name, "-") for column in columns)) for name in names]
    return table(("entry", *presets), rows)


@contextmanager
def sheet(file: Path, height: float) -> Iterator[Figure]:
    """Context of a figure of the given height in cm, saved to `file` at the end; drawn once, after its layout."""
    with styled(_STYLE):
        figure = Figure(figsize=(COLUMN / 2.54, height / 2.54), dpi=_DPI)
        yield figure
        ConstrainedLayoutEngine().execute(figure)
        save(figure, file, dpi=_DPI)


def draw_map(
    axes: Axes, whole: Atlas, linewidth: float = 1.2, size: float = 12, covered: tuple[float, ...] = (0, 0, 0, 0)
) -> None:
    """Draw the regions and boundaries of an atlas of the impact angle, in degrees, continued to St = 0 and 90 deg.

    Arguments:
        size: of the regions' letters.
        covered: what has no letters: left, bottom, width and height as parts of the axes.
    """
    degrees, stokes = np.linspace(0.0, 90.0, _ROWS), np.linspace(0.0, whole.window[1], _COLUMNS)
    places = np.meshgrid(np.clip(np.radians(degrees), *whole.span), np.clip(stokes, *whole.window), indexing="ij")
    outcome = whole.region(*places)
    fill(axes, outcome, stokes, degrees)
    for curve in whole.curves:
        axes.plot(curve.stokes, np.degrees(curve.x), color=INK, linewidth=linewidth, zorder=3)
    left, bottom, width, height = covered
    across, up = (np.linspace(0, 1, count) for count in (_COLUMNS, _ROWS))
    outcome[np.ix_((up - bottom) * (up - bottom - height) < 0, (across - left) * (across - left - width) < 0)] = -1
    letters(axes, outcome, stokes, degrees, size=size)
    axes.set(xlim=(0, whole.window[1]), ylim=(0, 90), yticks=range(0, 91, 15), xlabel=STOKES, ylabel=ANGLE)


def changes_at(scene: Scene, *angles: float) -> tuple[tuple[Change, ...], ...]:
    """The changes of outcome at angles (rad), by the Stokes number; ComputationError where they are not traced."""
    traced = boundary(scene, angle=list(angles))
    for at, reason in traced.failed:
        raise ComputationError(f"{scene.name} at {degrees(at)}: {reason}")
    return traced.changes


def outcomes(changes: Sequence[Change]) -> tuple[str, ...]:
    """The outcomes between changes, in order of St."""
    return (*(change.before for change in changes[:1]), *(change.after for change in changes))


def ends_of_sticking(scene: Scene, *angles: float) -> list[Change]:
    """The change at which sticking ends at each angle: its Stokes number is St*, its centrifugal number Ce*."""
    ends = [change for line in changes_at(scene, *angles) for change in line if change.before == STICK]
    if len(ends) != len(angles):
        raise ComputationError("no boundary, or several, at which stick ends, where the paper has one")
    return ends


def number(value: float | None) -> str:
    """A number with four or more significant digits; a dash for None or NaN."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in rad as degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"
