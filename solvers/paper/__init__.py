"""Reproduction of the paper: its figures, table and numbers, and a report that compares them with ours."""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from ..host.progress import Progress

if TYPE_CHECKING:
    from .report import Part

_HOMES = {
    "table1": "table1", "fig1": "pendulum", "fig3": "pendulum", "fig4a": "granules", "fig4b": "restitution",
    "factors": "granules",
}  # fmt: skip
PARTS = tuple(_HOMES)
"""Each is a function of this name, in the module beside it here, from the output folder to a `Part`."""


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

    from ..formatting.document import markdown
    from ..host.files import write_all_in
    from .report import TITLE, blocks

    folder.mkdir(parents=True, exist_ok=True)
    parts: list[Part] = []
    stopped = None
    try:
        for name in which:
            if progress is not None:
                progress(len(parts), len(which))
            parts.append(getattr(import_module(f".{_HOMES[name]}", __name__), name)(folder))
    except KeyboardInterrupt:
        if not parts:
            raise
        rest, file = ", ".join(which[len(parts) :]), folder / "report.md"
        stopped = KeyboardInterrupt(f"interrupted: {len(parts)} of {len(which)} parts are in {file}; without {rest}")
    ours, date = f"wetdoublet {version('wetdoublet')}", time.strftime("%Y-%m-%d", time.gmtime())
    how = f"Computed by {ours} in one run on {date}; what is quoted names its source."
    written = write_all_in(folder, {"report.md": markdown(TITLE, blocks(parts, how))})
    if stopped is not None:
        raise stopped
    return [*(folder / picture.file for part in parts for picture in part.pictures), *written]
