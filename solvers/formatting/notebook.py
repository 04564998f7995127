"""Tables for notebooks: small ones in HTML, everything escaped, in the colours of the page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

MOST = 24  # rows; the rest is counted
_RULE = "border-bottom:1px solid rgba(128,128,128,.35)"
_CELL = "padding:.15em .9em .15em 0;text-align:left;vertical-align:top;background:none"
_FAINT = "opacity:.75"

Row = Sequence[str]


def view(title: str, rows: Sequence[Row], head: Row = (), notes: Sequence[str] = (), most: int = MOST) -> str:
    """A titled table with notes below it.

    Arguments:
        rows: cells as plain text; rows beyond `most` are only counted.
        head: names of the columns, if they have any.
    """
    more = [f"{len(rows) - most} more rows"] if len(rows) > most else []
    lines = ["<div>", f"<strong>{escape(title)}</strong>"]
    lines.append('<table style="border-collapse:collapse;margin:.3em 0;font-variant-numeric:tabular-nums">')
    if head:
        cells = "".join(f'<th style="{_CELL};{_RULE}">{escape(cell)}</th>' for cell in head)
        lines.append(f"<thead><tr>{cells}</tr></thead>")
    lines.append("<tbody>")
    lines += [_row(row) for row in rows[:most]]
    lines.append("</tbody></table>")
    lines += [f'<div style="{_FAINT};font-size:.9em">{escape(note)}</div>' for note in (*more, *notes)]
    return "\n".join([*lines, "</div>"])


def _row(row: Row) -> str:
    return "<tr>" + "".join(f'<td style="{_CELL}">{escape(cell)}</td>' for cell in row) + "</tr>"
