"""What a notebook shows of a scene or result: the text that is printed, as a table in the colours of the page."""

import re
from html import escape

_LINES = 60  # the rest is counted
_CELL = "text-align:left;padding:0 1em 0 0"


class NotebookTable:
    """A scene, or the result of one, whose text has two spaces or more between columns."""

    def _repr_html_(self) -> str:
        name, lines = getattr(getattr(self, "scene", None) or self, "name", ""), str(self).splitlines()
        heading = [] if lines[0].startswith(name) else [name]
        rest = [f"{len(lines) - _LINES} more lines"] if len(lines) > _LINES else []
        return f"<table>{''.join(map(_row, [*heading, *lines[:_LINES], *rest]))}</table>"


def _row(line: str) -> str:
    cells = re.split(" {2,}", line.rstrip())
    wide = " colspan=9" if len(cells) == 1 else ""
    return "<tr>" + "".join(f'<td{wide} style="{_CELL}">{escape(cell)}</td>' for cell in cells) + "</tr>"
