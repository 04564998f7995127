"""The benchmark's record on disk: JSON and pictures in one folder.

    python -m tests.benchmarks.measured.page.record FOLDER

Measures everything that is in it: some minutes, the first time longer, as integrators are compiled.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from wetdoublet.solvers.host import files

from ..run import Record, bench
from .plots import draw

_WIDTH = 400  # characters of what is kept on one line


def write(record: Record, folder: Path) -> list[Path]:
    """Write bench.json and the pictures; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    data = folder / "bench.json"
    files.write(data, as_json(record) + "\n")
    return [data, *draw(record, folder)]


def as_json(value: Any, indent: str = "") -> str:
    """JSON with a row of a table on a line; lists and objects that are longer are broken."""
    flat = json.dumps(value, allow_nan=False)
    if not isinstance(value, dict | list) or len(flat) <= _WIDTH:
        return flat
    inner = indent + " "
    if isinstance(value, list):
        rows, (start, end) = [as_json(each, inner) for each in value], "[]"
    else:
        rows, (start, end) = [f"{json.dumps(key)}: {as_json(each, inner)}" for key, each in value.items()], "{}"
    return f"{start}\n{inner}" + f",\n{inner}".join(rows) + f"\n{indent}{end}"


def _tell(what: str) -> None:
    sys.stderr.write(f"{what}\n")


if __name__ == "__main__":
    asked = argparse.ArgumentParser()
    asked.add_argument("folder", type=Path)
    write(bench(tell=_tell), asked.parse_args().folder)
