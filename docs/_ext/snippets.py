"""Runs every command and Python snippet of README.md and the site's pages, in a folder of its own a page.

    python docs/_ext/snippets.py [PAGE ...]

Blocks of `python` on a page run one after another in one process; blocks of `console` and `sh` line by line. A command
whose line ends in `# exit status N` has to leave with that. Notebooks are executed when the site is built; commands
beside their cells run here. What pages compile is compiled quickly (`-Og`, unless flags are given), as for the site, so
that both can share a cache of kernels.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from wetdoublet.derive.user.template import TEMPLATE
from wetdoublet.solvers.scene.scenefile import read_text

ROOT = Path(__file__).resolve().parents[2]
MADE = ("_build", "_emitted", "auto_gallery", "api", "laws")
SET_UP = re.compile(
    r"^\s*(python3 -m venv|source |test -d|\.venv/bin/pip|pip install|"
    r"(\.venv/bin/)?python -m (pip|pytest|sphinx|tests)|asv )"
)
"""What sets up an environment, or measures for minutes, is run by the integration script or by hand."""
LONG = re.compile(
    r"wetdoublet (reproduce|bench|verify|compile|explore|design|fit \S+ \S+ .* --plot|boundary \S+ --angle 0:85 )"
    r"|--stress|:10000 "
)
"""Commands that take tens of seconds: `tests/test_docs.py` holds their options, tests of their own what they do, and
cells of the pages compute designs and fits; the site has an explorer of its own."""


def pages() -> list[Path]:
    """README.md and what was written by hand for the site."""
    site = (path for path in (ROOT / "docs").rglob("*.md") if not {*path.relative_to(ROOT).parts} & {*MADE})
    return [ROOT / "README.md", *sorted(site)]


def blocks(page: Path) -> list[tuple[str, str]]:
    """Language and text of every block of code to be run."""
    found = re.findall(
        r"^```(python|console|sh)\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    return [(language, text) for language, text in found if "from wetdoublet.derive.user import" not in text]


def commands(text: str, language: str) -> list[str]:
    """The command lines of a block; of a console those behind a dollar sign."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if language == "console":
        lines = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return [line for line in lines if not SET_UP.match(line) and not LONG.search(line)]


def run(page: Path) -> list[str]:
    """Run a page; what failed, a line each."""
    failures: list[str] = []
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {"WETDOUBLET_CFLAGS": "-Og", "CFLAGS": "-O0", **os.environ, "PATH": path}
    with tempfile.TemporaryDirectory() as folder:
        python = "".join(text for language, text in blocks(page) if language == "python")
        lines = [line for language, text in blocks(page) if language != "python" for line in commands(text, language)]
        for name, text in GIVEN.items():
            stem = name.partition(".")[0]
            if any(stem in line for line in lines) and f"--new {stem} " not in " ".join(lines):
                (Path(folder) / name).write_text(text, encoding="utf-8")
        for data, name in DATA.items():
            shutil.copy(ROOT / "docs/data" / data, Path(folder) / name)
        for line in lines:
            failures += _one(page, line, folder, environment)
        if python:
            done = subprocess.run(
                [sys.executable, "-c", PREAMBLE + python], cwd=folder, env=environment, capture_output=True, text=True
            )
            if done.returncode:
                failures.append(f"{page.name}: python: {done.stderr.strip().splitlines()[-1]}")
    return failures


DATA = {
    "synthetic-steel-spheres.csv": "impacts.csv", "films.csv": "films.csv", "materials.csv": "materials.csv",
}  # fmt: skip
"""Tables of the reader's, and what pages call them."""
GIVEN = {
    "my-scene.toml": read_text("granulation")[0], "mine.py": TEMPLATE,
    "bad.py": TEMPLATE.replace("stress * neck", "stress * R"),
}  # fmt: skip
"""A scene and models of the reader's, for pages that name them and do not make them."""
PREAMBLE = "import numpy as np\nst, theta = np.array([0.02, 0.03]), np.array([1.3, 1.3])\n"
"""What snippets take for given: arrays of Stokes numbers and angles."""


def _one(page: Path, line: str, folder: str, environment: dict[str, str]) -> list[str]:
    line = re.sub(r"\S*/bin/wetdoublet", "wetdoublet", line)
    expected = re.search(r"# exit status (\d+)", line)
    done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode == (int(expected[1]) if expected else 0):
        return []
    said = (done.stderr.strip().splitlines() or ["nothing on standard error"])[-1]
    return [f"{page.relative_to(ROOT)}: `{line}` left with {done.returncode}: {said}"]


def main() -> None:
    """Run all pages."""
    chosen = [Path(name).resolve() for name in sys.argv[1:]] or pages()
    sys.exit("\n".join(line for page in chosen for line in run(page)) or 0)


if __name__ == "__main__":
    main()
