"""Writes the pages that are made from the code before Sphinx reads its sources."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import api
import drawings
import laws
import scene_entries
from wetdoublet.solvers.explorer.page_of_scene import explore

DOCS = Path(__file__).resolve().parents[1]


def put(path: Path, text: str) -> None:
    """Write a page if it has changed, so that Sphinx does not read it again for nothing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def write(_app: Any = None) -> None:
    """Write all pages and drawings."""
    for name, text in {**scene_entries.pages(), **laws.pages(), **api.pages()}.items():
        put(DOCS / name, text)
    laws.plots(DOCS / "reference" / "laws")
    drawings.write(DOCS / "_emitted")
    put(DOCS / "_emitted" / "site" / "explorer.html", explore("granulation").html)
    generated = DOCS.parent / "generated"
    put(DOCS / "_emitted" / "automaton.svg", (generated / "automaton.svg").read_text(encoding="utf-8"))
    put(DOCS / "_emitted" / "automaton.md", _events((generated / "automaton.md").read_text(encoding="utf-8")))


def _events(text: str) -> str:
    """The emitted table of events without its title and picture, which the page has."""
    body = text.partition("# The events of a collision")[2]
    return "\n".join(line for line in body.splitlines() if "automaton.svg" not in line)


def setup(app: Any) -> dict[str, bool]:
    """Register with Sphinx."""
    app.connect("config-inited", lambda app, _config: write(app))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    write()
