"""The report: printed numbers compared with ours, then each part with figures, equations and variants."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ..errors import ComputationError
from ..formatting.document import Block, Formulas, Picture, Table
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .printed import CITATION, NOT_COMPARED, PRINTED

TITLE = "Wet particles, oblique collisions: the paper and this model"
_HEAD = (
    "quantity", "paper", "ours", "difference", "with lever arm, tangential cut-off, glass criterion; bridge or strings",
    "why, and what goes with it",
)  # fmt: skip


@dataclass(frozen=True)
class Comparison:
    """A printed number or finding with ours.

    Arguments:
        key: key of the printed entry.
        ours: computed number, or the finding in words.
        used: the variants used.
        why: reason for a difference, or a comment.
        agrees: for a finding in words, True if it agrees with the paper.
        beside: a second number of ours, as text.
    """

    key: str
    ours: float | str
    used: str
    why: str = ""
    agrees: bool | None = None
    beside: str = ""

    @property
    def verdict(self) -> str:
        """Text of the relative difference and rounding to the printed digits; for words, agreement."""
        printed = PRINTED[self.key]
        if isinstance(self.ours, str):
            return "agrees" if self.agrees else "differs"
        rounded = f"{self.ours:.{printed.digits}f}" == printed.text
        difference = round(100 * (self.ours / printed.value - 1), 1) + 0.0
        return f"{difference:+.1f} %" + (" (rounds to it)" if rounded else "")

    @property
    def shown(self) -> str:
        text = self.ours if isinstance(self.ours, str) else number(self.ours)
        return f"{text} {self.beside}".strip()


@dataclass(frozen=True)
class Part:
    """One part: a title, then text, figures, formulas and tables, in this order."""

    title: str
    words: str = ""
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[Picture] = ()
    formulas: Sequence[tuple[str, str, str]] = ()  # heading, LaTeX, note
    tables: Sequence[Table] = ()
    scenes: Sequence[str] = ()  # presets used


def number(value: float | None) -> str:
    """A number with four or more significant digits; a dash for None or NaN."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in rad as degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"


def shown(read: Callable[[], float]) -> str:
    """A number of a table, or `failed` if it cannot be computed, so that the others are still shown."""
    try:
        return number(read())
    except ComputationError:
        return "failed"


def blocks(parts: Sequence[Part], how: str) -> Iterator[Block]:
    """Content of the report in order; `how` describes the computation."""
    comparisons = {one.key: one for part in parts for one in part.comparisons}
    compared = [(entry, comparisons[entry.key]) for entry in PRINTED.values() if entry.key in comparisons]
    if compared:
        yield f"The paper: {CITATION}."
    yield how
    if compared:
        yield (
            "“With” has the variants used where the paper leaves a choice open; how the numbers move under the others "
            "is in the tables further down. “Rounds to it”: ours, rounded to the printed digits, is the printed number."
        )
        yield "## The numbers"
        rows = [(entry.what, entry.text, one.shown, one.verdict, one.used, one.why) for entry, one in compared]
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
    presets = dict.fromkeys(name for part in parts for name in part.scenes)
    if presets:
        yield "## Inputs"
        yield _inputs(list(presets))
    if compared:
        yield "## Sources"
        sources = [(entry.what, entry.place, f"“{entry.quote}”") for entry, _ in compared]
        yield Table("Where the paper prints it", ("quantity", "place", "words"), sources)


def _inputs(presets: Sequence[str]) -> Table:
    """Table of the entries of the presets, with assumed values marked."""
    scenes = [Scene.load(name) for name in presets]
    rows = []
    for name in dict.fromkeys(name for scene in scenes for name, _ in scene.given if name not in MEETING):
        cells = []
        for scene in scenes:
            value = dict(scene.given).get(name)
            assumed = " (assumed)" if name in dict(scene.guesses) else ""
            cells.append("-" if value is None else f"{value}{assumed}")
        rows.append((name, *cells))
    return Table("Presets, from the paper's captions; “assumed” is printed nowhere", ("entry", *presets), rows)
