"""The report: printed numbers compared with ours, then each part with figures, equations and variants."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Sequence
from itertools import groupby
from pathlib import Path

from ..host import files
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .parts import Comparison, Part, Table
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


def _not_compared() -> Table:
    return Table("Printed, but not compared", ("what", "why"), NOT_COMPARED)


def _lead(parts: Sequence[Part], how: str) -> list[str]:
    if not any(part.comparisons for part in parts):
        return [how]
    read = (
        "“With” has the variants used where the paper leaves a choice open; how the numbers move under the others is "
        "in the tables further down. “Rounds to it”: ours, rounded to the printed digits, is the printed number."
    )
    return [f"The paper: {CITATION}.", how, read]


# ---- Markdown


def markdown(parts: Sequence[Part], how: str) -> str:
    """The report in Markdown; formulas in LaTeX between dollars."""
    out = [f"# {_TITLE}", "", *(line for text in _lead(parts, how) for line in (text, ""))]
    if any(part.comparisons for part in parts):
        out += ["## The numbers", "", *_md_table(compared(parts)), *_md_table(_not_compared())]
    for part in parts:
        out += [f"## {part.title}", ""]
        out += [part.words, ""] if part.words else []
        for picture in part.pictures:
            out += [f"![{_plain(picture.caption)}]({picture.file})", "", f"*{picture.caption}*", ""]
        for heading, lines in groupby(part.formulas, key=lambda line: line[0]):
            out += [f"### {heading}", ""]
            for _, latex, note in lines:
                out += [f"$$ {latex} $$", "", *([note, ""] if note else [])]
        for table in part.tables:
            out += _md_table(table)
    if any(part.scenes for part in parts):
        out += ["## Inputs", "", *_md_table(inputs(parts))]
    if any(part.comparisons for part in parts):
        out += ["## Sources", "", *_md_table(sources(parts))]
    return "\n".join(out).rstrip() + "\n"


def _md_table(table: Table) -> list[str]:
    rows = [table.head, ["---"] * len(table.head), *table.rows]
    cells = ["| " + " | ".join(cell.replace("|", r"\|") for cell in row) + " |" for row in rows]
    return [f"**{table.caption}**", "", *cells, ""]


def _plain(caption: str) -> str:
    return re.sub(r"[\[\]*_]", "", caption.split(".", maxsplit=1)[0])


# ---- HTML


def page(parts: Sequence[Part], how: str) -> str:
    """The report as one HTML page; figures are linked, formulas are shown as a figure and as LaTeX."""
    body = [f"<h1>{html.escape(_TITLE)}</h1>", *(f"<p>{html.escape(text)}</p>" for text in _lead(parts, how))]
    if any(part.comparisons for part in parts):
        body += ["<h2>The numbers</h2>", _html_table(compared(parts)), _html_table(_not_compared())]
    for part in parts:
        body.append(f"<h2>{html.escape(part.title)}</h2>")
        body += [f"<p>{html.escape(part.words)}</p>"] if part.words else []
        for picture in part.pictures:
            caption = html.escape(picture.caption)
            alt = html.escape(_plain(picture.caption))
            image = f'<img src="{picture.file}" alt="{alt}" width="{picture.width * _PER_CM:.0f}">'
            body.append(f"<figure>{image}<figcaption>{caption}</figcaption></figure>")
        if part.formulas:
            rows = [f"<tr><td><code>{html.escape(latex)}</code></td></tr>" for _, latex, _ in part.formulas]
            body.append(f"<details><summary>LaTeX</summary><table>{''.join(rows)}</table></details>")
        body += map(_html_table, part.tables)
    if any(part.scenes for part in parts):
        body += ["<h2>Inputs</h2>", _html_table(inputs(parts))]
    if any(part.comparisons for part in parts):
        body += ["<h2>Sources</h2>", _html_table(sources(parts))]
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
