"""Measure everything anew and write docs/performance.md: one command, on a quiet machine.

    python tests/benchmarks/measure.py [FOLDER] [SCENES]

FOLDER is docs/performance; SCENES (500) is what the stress test takes. Some ten minutes on two cores. With the usual
folder the figures of README.md and docs/kernel.md are written as well. What fails is named at the end, and the rest is
measured all the same; the page is then made from the older record of that part.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
USUAL = HERE.parents[1] / "docs" / "performance"
BENCH = (sys.executable, "-m", "wetdoublet.solvers", "bench")


def bench(folder: Path) -> None:
    """Run time against error, and all that goes with it."""
    subprocess.run([*BENCH, "--out", str(folder)], check=True, stdout=subprocess.DEVNULL)
    (folder / "bench.md").unlink()  # the page has its tables


def script(name: str, *arguments: str) -> None:
    """Another of this folder's."""
    subprocess.run([sys.executable, str(HERE / name), *arguments], check=True, stdout=subprocess.DEVNULL)


def stress(folder: Path, scenes: str) -> None:
    """Engines against each other; what it finds is in its record."""
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([*BENCH, "--stress", scenes, "--out", work], check=False, stdout=subprocess.DEVNULL)
        found = json.loads((Path(work) / "stress.json").read_text())
        del found["cases"]  # some megabytes
        (folder / "stress.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        for picture in Path(work).glob("stress-*.png"):
            shutil.copyfile(picture, folder / picture.name)


def main() -> None:
    """Run one measurement after another; each writes its record into the folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else USUAL).resolve()
    scenes = sys.argv[2] if len(sys.argv) > 2 else "500"
    folder.mkdir(parents=True, exist_ok=True)
    parts = {
        "bench": lambda: bench(folder),
        "compile_flags": lambda: script("compile_flags.py", str(folder)),
        "cvodes_share": lambda: script("cvodes_share.py", str(folder)),
        "stress": lambda: stress(folder, scenes),
    }
    if folder == USUAL:
        parts["kernel"] = lambda: script("kernel.py")
        parts["kinds"] = lambda: script("kinds.py")
        parts["kernel_gradients"] = lambda: script("kernel_gradients.py")
        parts["gradient_engine"] = lambda: script("gradient_engine.py")
    parts["page"] = lambda: script("page.py", str(folder))
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
