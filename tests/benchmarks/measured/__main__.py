"""Measure everything anew and write docs/engineering/performance.md: one command, on a quiet machine.

    python -m tests.benchmarks.measured [FOLDER] [SCENES]

FOLDER is docs/engineering/performance; SCENES (500) is what the stress test takes. Some ten minutes on two cores. With
the usual folder the figures of README.md are written as well. What fails is named at the end, and the rest is measured
all the same; the page is then made from the older record of that part.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .page.record import as_json

ROOT = Path(__file__).resolve().parents[3]
USUAL = ROOT / "docs" / "engineering" / "performance"


def run(module: str, *arguments: str, check: bool = True) -> None:
    """A module as a process of its own."""
    subprocess.run([sys.executable, "-m", module, *arguments], cwd=ROOT, check=check, stdout=subprocess.DEVNULL)


def script(name: str, *arguments: str) -> None:
    """One of the benchmarks."""
    run(f"tests.benchmarks.{name}", *arguments)


def stress(folder: Path, scenes: str) -> None:
    """Engines against each other; what it finds is in its record."""
    with tempfile.TemporaryDirectory() as work:
        run("wetdoublet.solvers", "verify", "--stress", scenes, "--out", work, check=False)
        found = json.loads((Path(work) / "stress.json").read_text())
        del found["cases"]  # some megabytes
        (folder / "stress.json").write_text(as_json(found) + "\n", encoding="utf-8")


def main() -> None:
    """Run one measurement after another; each writes its record into the folder."""
    asked = argparse.ArgumentParser()
    asked.add_argument("folder", nargs="?", type=Path, default=USUAL)
    asked.add_argument("scenes", nargs="?", default="500")
    given = asked.parse_args()
    folder, scenes = given.folder.resolve(), given.scenes
    folder.mkdir(parents=True, exist_ok=True)
    parts = {
        "bench": lambda: script("measured.page.record", str(folder)),
        "stress": lambda: stress(folder, scenes),
        "law_in_c": lambda: script("law_in_c", str(folder)),
    }
    parts["page"] = lambda: script("measured.page.document", str(folder))
    failed = []
    for name, measure in parts.items():
        start = time.perf_counter()
        try:
            measure()
        except (subprocess.CalledProcessError, OSError) as error:
            failed.append(f"{name}: {error}")
        sys.stdout.write(f"{name}: {time.perf_counter() - start:.0f} s\n")
    sys.exit("\n".join(failed) or 0)


if __name__ == "__main__":
    main()
