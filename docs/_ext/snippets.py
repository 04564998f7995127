"""Runs every command and Python snippet of README.md and the site's pages, in a folder of its own a page.

    python docs/_ext/snippets.py [PAGE ...]

Blocks of `python` on a page run together, blocks of `console` and `sh` line by line. A command whose line ends in
`# exit status N` has to leave with that. Notebooks are executed when the site is built; commands beside their cells run
here. Commands of `wetdoublet` and snippets are processes forked from this one, which has imported everything already.
"""

from __future__ import annotations

import multiprocessing
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from wetdoublet.derive.user.template import TEMPLATE
from wetdoublet.solvers.commands.cli import COMMANDS, cli
from wetdoublet.solvers.scene.scenefile import read_text

ROOT = Path(__file__).resolve().parents[2]
MADE = {"_build", "_emitted", "auto_gallery", "api", "laws"}
SET_UP = re.compile(
    r"^\s*(python3 -m venv|source |test -d|\.venv/bin/pip|pip install|"
    r"(\.venv/bin/)?python -m (pip|pytest|sphinx|tests)|asv )"
)
"""What sets up an environment, or measures for minutes, is run by the integration script or by hand."""
LONG = re.compile(
    r"wetdoublet (reproduce|bench|verify|compile|explore|design|fit \S+ \S+ .* --plot|boundary \S+ --angle 0:85 )"
    r"|--stress|--scheduler|:10000 "
    r"|wetdoublet (averages|boundary granulation|critical lactose-pvp|fit pendulum)"
    r"|wetdoublet map (my-powder.toml|granulation --stokes log:0.005:0.5:60)"
)
"""Commands that take tens of seconds, or do what a cell of their page does: `tests/test_docs.py` holds their options,
tests of their own what they do; the site has an explorer of its own."""
DATA = {
    "synthetic-steel-spheres.csv": "impacts.csv", "films.csv": "films.csv", "materials.csv": "materials.csv",
    "synthetic-flow-curve.csv": "curve.csv",
}  # fmt: skip
"""Tables of the reader's, and what pages call them."""
TESTED = {"surprises.md"}
"""Pages of which every line has a test of its own."""
GIVEN = {
    "my-scene.toml": read_text("granulation")[0], "mine.py": TEMPLATE,
    "bad.py": TEMPLATE.replace("stress * neck", "stress * R"), "fitted.toml": read_text("pendulum")[0],
}  # fmt: skip
"""Scenes and models of the reader's, for pages that name them and do not make them."""
PREAMBLE = "import numpy as np\nst, theta = np.array([0.02, 0.03]), np.array([1.3, 1.3])\n"
"""What snippets take for given: arrays of Stokes numbers and angles."""


def pages() -> list[Path]:
    """README.md and what was written by hand for the site."""
    site = (path for path in (ROOT / "docs").rglob("*.md") if not {*path.relative_to(ROOT).parts} & (MADE | TESTED))
    return [ROOT / "README.md", *sorted(site)]


def blocks(page: Path) -> list[tuple[str, str]]:
    """Language and text of every block of code to be run."""
    matches = re.findall(
        r"^```(python|console|sh)\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    return [(language, text) for language, text in matches if "from wetdoublet.derive.user import" not in text]


def commands(text: str, language: str) -> list[str]:
    """The command lines of a block; of a console those behind a dollar sign."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if language == "console":
        lines = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return [re.sub(r"\S*/bin/wetdoublet", "wetdoublet", line) for line in lines
            if not SET_UP.match(line) and not LONG.search(line)]  # fmt: skip


def run(page: Path) -> list[str]:
    """Run a page; what failed, a line each."""
    failures = []
    python = "".join(text for language, text in blocks(page) if language == "python")
    lines = [line for language, text in blocks(page) if language != "python" for line in commands(text, language)]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for given, text in GIVEN.items():
            stem = given.partition(".")[0]
            if any(stem in line for line in lines) and f"--new {stem} " not in " ".join(lines):
                (folder / given).write_text(text, encoding="utf-8")
        for data, given in DATA.items():
            shutil.copy(ROOT / "docs/data" / data, folder / given)
        for line in lines:
            expected = re.search(r"# exit status (\d+)", line)
            status, errors = _line(line, folder)
            if status != (int(expected[1]) if expected else 0):
                failures.append(f"{page.relative_to(ROOT)}: `{line}` left with {status}: {errors}")
        if python:
            status, errors = _forked(lambda: exec(PREAMBLE + python, {"__name__": "__main__"}), folder)
            if status:
                failures.append(f"{page.relative_to(ROOT)}: python: {errors}")
    return failures


def _line(line: str, folder: Path) -> tuple[int, str]:
    words = shlex.split(line, comments=True)
    if words[0] == "wetdoublet" and not {"|", ">", "&&", "&"} & {*words}:
        return _forked(lambda: cli.main(words[1:]), folder)
    done = subprocess.run(["bash", "-c", line], cwd=folder, capture_output=True, text=True)
    return done.returncode, _last(done.stderr)


def _forked(work: Callable[[], object], folder: Path) -> tuple[int, str]:
    """Exit status of a child that does this in a folder, and the last line of its standard error."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as errors:

        def child() -> None:
            os.chdir(folder)
            sys.path.insert(0, "")
            with Path(os.devnull).open("r+") as null:
                for stream, to in enumerate((null, null, errors)):
                    os.dup2(to.fileno(), stream)
            work()

        process = multiprocessing.get_context("fork").Process(target=child)
        process.start()
        process.join()
        errors.seek(0)
        return process.exitcode or 0, _last(errors.read())


def _last(text: str) -> str:
    return (text.strip().splitlines() or ["nothing on standard error"])[-1]


def main() -> None:
    """Run all pages."""
    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    os.environ.setdefault("WETDOUBLET_CFLAGS", "-Og -fno-inline -fno-unroll-loops")  # as conf.py
    os.environ.setdefault("CFLAGS", "-O0")
    for module in ("casadi", "h5netcdf", "matplotlib.figure", "pandas", "scipy.optimize", "xarray", *_COMMANDS):
        __import__(module)
    chosen = [Path(name).resolve() for name in sys.argv[1:]] or pages()
    sys.exit("\n".join(line for page in chosen for line in run(page)) or 0)


_COMMANDS = ["wetdoublet.solvers.commands." + name.replace("-", "_") for name in COMMANDS]

if __name__ == "__main__":
    main()
