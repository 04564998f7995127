"""Reproduction of the paper: its figures, table and numbers, and a report that compares them with ours."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..host.progress import Progress

if TYPE_CHECKING:
    from .report import Part

PARTS = ("table1", "fig1", "fig3", "fig4a", "fig4b", "factors")
"""Each is a function of this name in a module beside this one, from the output folder to a `Part`."""


def reproduce(which: Sequence[str], folder: Path, *, progress: Progress | None = None) -> list[Path]:
    """Compute parts of the paper and write the report on them.

    Arguments:
        which: names from PARTS.
        folder: output folder; created if absent.
        progress: called with (parts done, parts in all).

    Returns:
        Paths of the written files, the report's last.

    Raises:
        KeyboardInterrupt: an interrupt; the report on the parts that were finished is written before.
    """
    from importlib.metadata import version

    from ..host.files import write
    from . import granules, pendulum, table1
    from .report import markdown

    functions = vars(table1) | vars(pendulum) | vars(granules)
    folder.mkdir(parents=True, exist_ok=True)
    file, stopped = folder / "report.md", None
    parts: list[Part] = []
    try:
        for name in which:
            if progress is not None:
                progress(len(parts), len(which))
            parts.append(functions[name](folder))
    except KeyboardInterrupt:
        if not parts:
            raise
        rest = ", ".join(which[len(parts) :])
        stopped = KeyboardInterrupt(f"interrupted: {len(parts)} of {len(which)} parts are in {file}; without {rest}")
    ours, date = f"wetdoublet {version('wetdoublet')}", time.strftime("%Y-%m-%d", time.gmtime())
    how = f"Computed by {ours} in one run on {date}; what is quoted names its source."
    write(file, markdown(parts, how))
    if stopped is not None:
        raise stopped
    return [*(folder / picture.file for part in parts for picture in part.pictures), file]
