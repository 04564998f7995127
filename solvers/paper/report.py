"""The report: printed numbers compared with ours, then each part with figures, equations and variants."""

from collections.abc import Iterator, Sequence

from ..formatting.document import Block, Formulas, Table
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .parts import Part
from .printed import CITATION, NOT_COMPARED, PRINTED

TITLE = "Wet particles, oblique collisions: the paper and this model"
_HEAD = (
    "quantity", "paper", "ours", "difference", "with lever arm, tangential cut-off, glass criterion; bridge or strings",
    "why, and what goes with it",
)  # fmt: skip


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
