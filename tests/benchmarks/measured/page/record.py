"""A benchmark's record on disk: JSON, tables and pictures in one folder."""

from __future__ import annotations

import json
from pathlib import Path

from wetdoublet.solvers.host import files

from ..run import Record
from .plots import draw
from .tables import report


def write(record: Record, folder: Path) -> tuple[str, list[Path]]:
    """Write bench.json, bench.md, work.png and cost.png; returns the text of the tables and the files."""
    folder.mkdir(parents=True, exist_ok=True)
    text = report(record)
    data, tables = folder / "bench.json", folder / "bench.md"
    files.write(data, json.dumps(record, indent=1, allow_nan=False) + "\n")
    files.write(tables, text)
    return text, [data, tables, *draw(record, folder)]
