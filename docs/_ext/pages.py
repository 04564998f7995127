"""Writes the pages that are made from the code before Sphinx reads its sources."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import api
import automaton_drawing
import automaton_page
import laws
import scene_entries
from wetdoublet.solvers.explorer.page_of_scene import explore
from wetdoublet.solvers.scene.scenefile import PRESETS

DOCS = Path(__file__).resolve().parents[1]


def write(_app: Any = None, _config: Any = None) -> None:
    """Write all pages and drawings."""
    written = {**scene_entries.pages(), **laws.pages(), **api.pages(), "_emitted/automaton.md": automaton_page.page()}
    written["_emitted/certificates.md"] = automaton_page.certificates()
    written["_emitted/site/explorer.html"] = explore(*PRESETS).html
    for name, text in written.items():
        path = DOCS / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:  # else Sphinx reads it again for nothing
            path.write_text(text, encoding="utf-8")
    laws.plots(DOCS / "reference" / "laws")
    automaton_drawing.draw(DOCS / "_emitted" / "automaton.svg")


def required_arguments(_app: Any, context: Any, lines: list[str]) -> None:
    """Say of a command's arguments which are required: click is told of none, so that wrong options are named first."""
    names = iter(param.human_readable_name for param in context.command.params if param.param_type_name == "argument")
    for k, line in enumerate(lines):
        if line.strip().startswith("Optional argument") and not next(names).startswith("["):
            lines[k] = line.replace("Optional", "Required")


def setup(app: Any) -> dict[str, bool]:
    """Register with Sphinx."""
    app.setup_extension("sphinx_click")
    app.connect("config-inited", write)
    app.connect("sphinx-click-process-arguments", required_arguments)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
