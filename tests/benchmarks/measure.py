"""Measure everything anew and write docs/performance.md: one command, on a quiet machine.

    python tests/benchmarks/measure.py [FOLDER] [SCENES]

FOLDER is docs/performance; SCENES (500) is what the stress test takes. Some ten minutes on two cores.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent


def main() -> None:
    """Run one measurement after another; each writes its record into the folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/performance")
    scenes = sys.argv[2] if len(sys.argv) > 2 else "500"
    bench = [sys.executable, "-m", "wetdoublet.solvers", "bench"]
    subprocess.run([*bench, "--out", str(folder)], check=True)
    (folder / "bench.md").unlink()  # the page has its tables
    for name in ("compile_flags.py", "cvodes_share.py"):
        subprocess.run([sys.executable, str(HERE / name), str(folder)], check=True)
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([*bench, "--stress", scenes, "--out", work], check=False)  # what it finds is in its record
        found = json.loads((Path(work) / "stress.json").read_text())
        del found["cases"]  # some megabytes
        (folder / "stress.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
        for picture in Path(work).glob("stress-*.png"):
            shutil.copyfile(picture, folder / picture.name)
    subprocess.run([sys.executable, str(HERE / "page.py"), str(folder)], check=True)


if __name__ == "__main__":
    main()
