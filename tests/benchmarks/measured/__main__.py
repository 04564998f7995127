"""Measure everything anew and write docs/engineering/performance.md: one command, on a quiet machine.

    python -m tests.benchmarks.measured [FOLDER] [SCENES] [--only PART,...]

FOLDER is docs/engineering/performance; SCENES (500) is what the stress test takes. Some ten minutes on two cores. With
the usual folder the figures of README.md are written as well. Parts are bench (time against error beside peers,
growth, cold start and first use), stress, law_in_c, and page, which measures
nothing. What fails is named at the end, and the rest is measured all the same; the page is then made from the older
record of that part.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from wetdoublet.solvers.host import files

from .page.document import write
from .page.plots import draw
from .run import bench

ROOT = Path(__file__).resolve().parents[3]
USUAL = ROOT / "docs" / "engineering" / "performance"
_WIDTH = 400  # characters of what is kept on one line


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


def run(module: str, *arguments: str, check: bool = True) -> None:
    """A module as a process of its own."""
    subprocess.run([sys.executable, "-m", module, *arguments], cwd=ROOT, check=check, stdout=subprocess.DEVNULL)


def peers(folder: Path) -> None:
    """Everything beside peers, and its pictures."""
    record = bench(tell=lambda what: print(what, file=sys.stderr))  # noqa: T201 -- a program
    files.write(folder / "bench.json", as_json(record) + "\n")
    draw(record, folder)


def stress(folder: Path, scenes: str) -> None:
    """Engines against each other; what it finds is in its record."""
    with tempfile.TemporaryDirectory() as work:
        run("wetdoublet.solvers", "verify", "--stress", scenes, "--out", work, check=False)
        found = json.loads((Path(work) / "stress.json").read_text())
        del found["cases"]  # some megabytes
        files.write(folder / "stress.json", as_json(found) + "\n")


def main() -> None:
    """Run one measurement after another; each writes its record into the folder."""
    asked = argparse.ArgumentParser()
    asked.add_argument("folder", nargs="?", type=Path, default=USUAL)
    asked.add_argument("scenes", nargs="?", default="500")
    asked.add_argument("--only", default="bench,stress,law_in_c,page")
    given = asked.parse_args()
    folder, failed = given.folder.resolve(), []
    folder.mkdir(parents=True, exist_ok=True)
    parts = {
        "bench": lambda: peers(folder), "stress": lambda: stress(folder, given.scenes),
        "law_in_c": lambda: run("tests.benchmarks.law_in_c", str(folder)),
        "page": lambda: write(folder, front=folder == USUAL),
    }  # fmt: skip
    for name in given.only.split(","):
        start = time.perf_counter()
        try:
            parts[name]()
        except (subprocess.CalledProcessError, OSError) as error:
            failed.append(f"{name}: {error}")
        sys.stdout.write(f"{name}: {time.perf_counter() - start:.0f} s\n")
    sys.exit("\n".join(failed) or 0)


if __name__ == "__main__":
    main()
