"""Reports: one sequence of blocks, as Markdown and as one HTML page that loads nothing but the pictures beside it."""

import html
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from .markdown import unpadded

_PER_CM = 60  # pixels of a picture's width
_VIEWPORT = '<meta name="viewport" content="width=device-width, initial-scale=1">'
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


@dataclass(frozen=True)
class Table:
    """A table: a caption, which may be empty, a head, rows of text."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Picture:
    """A picture: file name in the report's folder, caption, intended width in cm."""

    file: str
    caption: str
    width: float

    @property
    def alternative(self) -> str:
        """The first sentence of the caption without markup, for readers who do not see the picture."""
        return re.sub(r"[\[\]*_]", "", self.caption.split(".", maxsplit=1)[0])


@dataclass(frozen=True)
class Formulas:
    """Equations: heading of the group, LaTeX and note of each. HTML shows only the LaTeX, folded."""

    lines: Sequence[tuple[str, str, str]]


Block = str | Sequence[str] | Table | Picture | Formulas
"""A paragraph, or a heading if the text begins with `## `; a list, a table, a picture, or equations."""


def report(title: str, blocks: Iterable[Block]) -> dict[str, str]:
    """The report as Markdown and as HTML, by file name."""
    content = list(blocks)
    return {"report.md": markdown(title, content), "report.html": html_page(title, content)}


def markdown(title: str, blocks: Iterable[Block]) -> str:
    """The report in Markdown; formulas in LaTeX between dollars."""
    out = [f"# {title}"]
    for block in blocks:
        if isinstance(block, str):
            out.append(block)
        elif isinstance(block, Table):
            out += [f"**{block.caption}**"] if block.caption else []
            out.append("\n".join(unpadded(block.head, block.rows)))
        elif isinstance(block, Picture):
            out += [f"![{block.alternative}]({block.file})", f"*{block.caption}*"]
        elif isinstance(block, Formulas):
            for heading, lines in groupby(block.lines, key=lambda line: line[0]):
                out.append(f"### {heading}")
                out += [text for _, latex, note in lines for text in (f"$$ {latex} $$", note) if text]
        else:
            out.append("\n".join(f"* {line}" for line in block))
    return "\n\n".join(out) + "\n"


def html_page(title: str, blocks: Iterable[Block]) -> str:
    """The report as one HTML page; pictures are files beside it, and formulas only their LaTeX, without their notes."""
    body = [f"<h1>{html.escape(title)}</h1>"]
    for block in blocks:
        if isinstance(block, str):
            tag, text = ("h2", block[3:]) if block.startswith("## ") else ("p", block)
            body.append(f"<{tag}>{html.escape(text)}</{tag}>")
        elif isinstance(block, Table):
            body.append(_html_table(block))
        elif isinstance(block, Picture):
            caption, alternative = html.escape(block.caption), html.escape(block.alternative)
            image = f'<img src="{block.file}" alt="{alternative}" width="{block.width * _PER_CM:.0f}">'
            body.append(f"<figure>{image}<figcaption>{caption}</figcaption></figure>")
        elif isinstance(block, Formulas):
            rows = "".join(f"<tr><td><code>{html.escape(latex)}</code></td></tr>" for _, latex, _ in block.lines)
            body.append(f"<details><summary>LaTeX</summary><table>{rows}</table></details>")
        else:
            body.append(f"<ul>{''.join(f'<li>{html.escape(line)}</li>' for line in block)}</ul>")
    head = f'<meta charset="utf-8">{_VIEWPORT}<title>{html.escape(title)}</title><style>{_STYLE}</style>'
    return f'<!doctype html>\n<html lang="en"><head>{head}</head><body>\n' + "\n".join(body) + "\n</body></html>\n"


def _html_table(table: Table) -> str:
    """A table whose cells carry the name of their column, which a narrow page shows before them."""
    names = [html.escape(cell) for cell in table.head]
    lines = [f'<tr class="head">{"".join(f"<th>{name}</th>" for name in names)}</tr>']
    for row in table.rows:
        cells = (f'<td data-label="{name}">{html.escape(cell)}</td>' for name, cell in zip(names, row, strict=True))
        lines.append(f"<tr>{''.join(cells)}</tr>")
    caption = f"<caption>{html.escape(table.caption)}</caption>" if table.caption else ""
    return f'<div class="table"><table>{caption}' + "\n".join(lines) + "</table></div>"
