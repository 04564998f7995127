"""The report: printed numbers compared with ours, then each part with figures, equations and variants."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path

from ..formatting.markdown import unpadded
from ..host import files
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .parts import Comparison, Part, Picture, Table
from .printed import CITATION, NOT_COMPARED, PRINTED

_TITLE = "Wet particles, oblique collisions: the paper and this model"
_HEAD = (
    "quantity",
    "paper",
    "ours",
    "difference",
    "with lever arm, tangential cut-off, glass criterion; bridge or strings",
    "why, and what goes with it",
)
_VIEWPORT = '<meta name="viewport" content="width=device-width, initial-scale=1">'
_PER_CM = 60  # width on the page, pixels
_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #202020; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; margin: 1rem 0; font-size: 0.86rem; }
caption { text-align: left; font-weight: 600; padding: 0.3rem 0; }
th, td { border-bottom: 1px solid #ddd; padding: 0.3rem 0.6rem; text-align: left; vertical-align: top; }
th { border-bottom: 2px solid #888; } figure { margin: 1.2rem 0; } figcaption { font-size: 0.86rem; color: #555; }
code { font-size: 0.86em; overflow-wrap: anywhere; } img { max-width: 100%; height: auto; } .table { overflow-x: auto; }
@media (max-width: 640px) { /* a row of a table becomes a card: each cell under the name of its column */
  body { margin: 1rem auto; } h1 { font-size: 1.3rem; }
  table, tbody, tr, td, caption { display: block; } tr.head { display: none; }
  tr { border: 1px solid #ccc; border-radius: 4px; margin: 0.6rem 0; padding: 0.3rem 0; }
  td { border: 0; padding: 0.15rem 0.6rem; overflow-wrap: anywhere; }
  td[data-label]::before { content: attr(data-label) ": "; color: #555; }
}
"""


def write(parts: Sequence[Part], folder: Path, how: str) -> list[Path]:
    """Write report.md and report.html into `folder`; `how` describes the computation."""
    both = [(folder / "report.md", markdown(parts, how)), (folder / "report.html", page(parts, how))]
    for file, text in both:
        files.write(file, text)
    return [file for file, _ in both]


def compared(parts: Iterable[Part]) -> Table:
    """Table of all compared numbers, in the paper's order."""
    found: list[Comparison] = [one for part in parts for one in part.comparisons]
    order = list(PRINTED)
    rows = []
    for one in sorted(found, key=lambda one: order.index(one.key)):
        printed = one.printed
        rows.append((printed.what, printed.text, one.shown, one.verdict, one.used, one.why))
    return Table("Every number the paper prints, beside ours", _HEAD, rows)


def sources(parts: Iterable[Part]) -> Table:
    """Table of the places of the compared numbers in the paper."""
    keys = {one.key for part in parts for one in part.comparisons}
    rows = [(entry.what, entry.place, f"“{entry.quote}”") for entry in PRINTED.values() if entry.key in keys]
    return Table("Where the paper prints it", ("quantity", "place", "words"), rows)


def inputs(parts: Iterable[Part]) -> Table:
    """Table of the entries of the presets used, with assumed values marked."""
    presets = dict.fromkeys(name for part in parts for name in part.scenes)
    scenes = [Scene.load(name) for name in presets]
    guesses = {(scene.name, name) for scene in scenes for name, _ in scene.guesses}
    names = dict.fromkeys(name for scene in scenes for name, _ in scene.given if name not in MEETING)
    rows = []
    for name in names:
        cells = []
        for scene in scenes:
            value = dict(scene.given).get(name)
            assumed = " (assumed)" if (scene.name, name) in guesses else ""
            cells.append("-" if value is None else f"{value}{assumed}")
        rows.append((name, *cells))
    return Table("Presets, from the paper's captions; “assumed” is printed nowhere", ("entry", *presets), rows)


def _blocks(parts: Sequence[Part], how: str) -> Iterator[str | Table | Picture | Sequence[tuple[str, str, str]]]:
    """Content of the report in order: headings (with `## `), text, figures, formulas and tables."""
    comparisons = any(part.comparisons for part in parts)
    if comparisons:
        yield f"The paper: {CITATION}."
    yield how
    if comparisons:
        yield (
            "“With” has the variants used where the paper leaves a choice open; how the numbers move under the others "
            "is in the tables further down. “Rounds to it”: ours, rounded to the printed digits, is the printed number."
        )
        yield "## The numbers"
        yield compared(parts)
        yield Table("Printed, but not compared", ("what", "why"), NOT_COMPARED)
    for part in parts:
        yield f"## {part.title}"
        if part.words:
            yield part.words
        yield from part.pictures
        if part.formulas:
            yield part.formulas
        yield from part.tables
    if any(part.scenes for part in parts):
        yield "## Inputs"
        yield inputs(parts)
    if comparisons:
        yield "## Sources"
        yield sources(parts)


def markdown(parts: Sequence[Part], how: str) -> str:
    """The report in Markdown; formulas in LaTeX between dollars."""
    out = [f"# {_TITLE}"]
    for block in _blocks(parts, how):
        if isinstance(block, str):
            out.append(block)
        elif isinstance(block, Table):
            out += [f"**{block.caption}**", "\n".join(unpadded(block.head, block.rows))]
        elif isinstance(block, Picture):
            out += [f"![{_plain(block.caption)}]({block.file})", f"*{block.caption}*"]
        else:
            for heading, lines in groupby(block, key=lambda line: line[0]):
                out.append(f"### {heading}")
                out += [text for _, latex, note in lines for text in (f"$$ {latex} $$", note) if text]
    return "\n\n".join(out) + "\n"


def _plain(caption: str) -> str:
    return re.sub(r"[\[\]*_]", "", caption.split(".", maxsplit=1)[0])


def page(parts: Sequence[Part], how: str) -> str:
    """The report as one HTML page; figures are linked, formulas are shown as a figure and as LaTeX."""
    body = [f"<h1>{html.escape(_TITLE)}</h1>"]
    for block in _blocks(parts, how):
        if isinstance(block, str):
            tag, text = ("h2", block[3:]) if block.startswith("## ") else ("p", block)
            body.append(f"<{tag}>{html.escape(text)}</{tag}>")
        elif isinstance(block, Table):
            body.append(_html_table(block))
        elif isinstance(block, Picture):
            caption, alt = html.escape(block.caption), html.escape(_plain(block.caption))
            image = f'<img src="{block.file}" alt="{alt}" width="{block.width * _PER_CM:.0f}">'
            body.append(f"<figure>{image}<figcaption>{caption}</figcaption></figure>")
        else:
            rows = "".join(f"<tr><td><code>{html.escape(latex)}</code></td></tr>" for _, latex, _ in block)
            body.append(f"<details><summary>LaTeX</summary><table>{rows}</table></details>")
    head = f'<meta charset="utf-8">{_VIEWPORT}<title>{html.escape(_TITLE)}</title><style>{_STYLE}</style>'
    return f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n' + "\n".join(body) + "\n</body></html>\n"


def _html_table(table: Table) -> str:
    names = [html.escape(cell) for cell in table.head]
    head = "".join(f"<th>{name}</th>" for name in names)
    rows = [
        "<tr>"
        + "".join(f'<td data-label="{name}">{html.escape(cell)}</td>' for name, cell in zip(names, row, strict=True))
        + "</tr>"
        for row in table.rows
    ]
    caption = f"<caption>{html.escape(table.caption)}</caption>"
    return f'<div class="table"><table>{caption}<tr class="head">{head}</tr>\n' + "\n".join(rows) + "</table></div>"
