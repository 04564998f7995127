"""Reproduction of the paper: a module for each figure, table and number, and a report that compares them with ours."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from ..host.progress import Progress

if TYPE_CHECKING:
    from .lines import PaperLines
    from .report import Part

PARTS = ("table1", "fig1", "fig3", "fig4a", "fig4b", "factors")
"""Each is the function `make` of the module of that name."""


def reproduce(
    which: Sequence[str], folder: Path, *, lines: PaperLines | None = None, say: Callable[[str], None] | None = None,
    progress: Progress | None = None,
) -> list[Path]:  # fmt: skip
    """Compute parts of the paper and write the report on them.

    Arguments:
        which: names from PARTS.
        folder: output folder; created if absent.
        lines: with the resolution of the figures; None for print quality.
        say: called with a text on the current step.
        progress: called with (parts done, parts in all).

    Returns:
        Paths of the written files, the report's last.

    Raises:
        KeyboardInterrupt: an interrupt; the report on the parts that were finished is written before.
    """
    from importlib.metadata import version

    from ..formatting.document import report
    from ..host.files import write_all_in
    from .lines import PaperLines
    from .report import TITLE, blocks

    folder.mkdir(parents=True, exist_ok=True)
    lines = lines or PaperLines()
    lines.say = say or lines.say
    parts: list[Part] = []
    stopped = None
    try:
        for name in which:
            if progress is not None:
                progress(len(parts), len(which))
            parts.append(import_module(f".{name}", __name__).make(lines, folder))
    except KeyboardInterrupt:
        if not parts:
            raise
        rest, file = ", ".join(which[len(parts) :]), folder / "report.md"
        stopped = KeyboardInterrupt(f"interrupted: {len(parts)} of {len(which)} parts are in {file}; without {rest}")
    pictures = [folder / picture.file for part in parts for picture in part.pictures]
    counted = f", from {lines.collisions} collisions" if lines.collisions else ""
    failed = f" Not traced: {'; '.join(lines.failures)}." if lines.failures else ""
    date, ours = time.strftime("%Y-%m-%d", time.gmtime()), f"wetdoublet {version('wetdoublet')}"
    how = f"Computed by {ours} in one run on {date}{counted}; none of our numbers is typed in.{failed}"
    written = write_all_in(folder, report(TITLE, blocks(parts, how)))
    if stopped is not None:
        raise stopped
    return [*pictures, *written]
