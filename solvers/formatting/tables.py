"""Tables: as Markdown, as plain text, and what a notebook shows of a scene or result."""

import re
from collections.abc import Sequence
from html import escape

_LINES = 60  # of a notebook; the rest is counted
_CELL = "text-align:left;padding:0 1em 0 0"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table whose columns also line up as text; the first is left-aligned."""
    widths = [max(len(row[k]) for row in (head, *rows)) for k in range(len(head))]

    def line(cells: Sequence[str]) -> str:
        padded = [
            cell.ljust(width) if k == 0 else cell.rjust(width) for k, (cell, width) in enumerate(zip(cells, widths))
        ]
        return "| " + " | ".join(padded) + " |"

    rule = [("-" * width if k == 0 else "-" * (width - 1) + ":") for k, width in enumerate(widths)]
    return "\n".join([line(head), line(rule), *(line(row) for row in rows)])


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of plain text in which the cells of each column begin at the same place."""
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def numbers_aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of plain text in which the cells of each column but the first end at the same place."""
    widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
    return ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip() for row in rows]


class NotebookTable:
    """A scene, or the result of one, whose text, with two spaces or more between columns, a notebook shows as a table
    in the colours of the page.
    """

    def _repr_html_(self) -> str:
        name, lines = getattr(getattr(self, "scene", None) or self, "name", ""), str(self).splitlines()
        heading = [] if lines[0].startswith(name) else [name]
        rest = [f"{len(lines) - _LINES} more lines"] if len(lines) > _LINES else []
        return f"<table>{''.join(map(_row, [*heading, *lines[:_LINES], *rest]))}</table>"


def _row(line: str) -> str:
    cells = re.split(" {2,}", line.rstrip())
    wide = " colspan=9" if len(cells) == 1 else ""
    return "<tr>" + "".join(f'<td{wide} style="{_CELL}">{escape(cell)}</td>' for cell in cells) + "</tr>"
