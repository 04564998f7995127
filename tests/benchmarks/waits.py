"""What people wait for, in two versions of the package: an edited law, fits, proofs, checks, the installation.

    python -m tests.benchmarks.waits OLD NEW [--rounds N] [--only WORD,...]

OLD and NEW are git revisions or folders with a checkout. Each is installed into a folder of its own, beside the
packages of this environment, and then both take turns: every row is a chain of whole processes in a folder with an
empty cache, timed in processor seconds, those of compilers included; the least of the rounds counts. Printed are both
times, NEW over OLD, and what the last process computed: the largest relative difference between the numbers of both,
which says whether the faster one still answers the same.
"""

import argparse
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

say = partial(print, flush=True)
ROOT = Path(__file__).resolve().parents[2]
MODULE = (sys.executable, "-m", "wetdoublet.solvers")
MODEL = '''"""A bridge law of one's own."""
from wetdoublet.derive.user import *
law("bridge", "mine", force=2 * pi * a * sigma * cos(phi) / (1 + 3 * x / a))
'''
IMPACTS = """
import numpy as np
from wetdoublet.solvers import collide_many
draw = np.random.default_rng(1)
speed, angle = draw.uniform(0.1, 4.0, {rows}), draw.uniform(0.1, 1.2, {rows})
scattered = collide_many({scene!r}, speed=speed * draw.normal(1, 0.02, {rows}), angle=angle)
words = np.array(["stick", "stick-rotate-separate", "bounce"])
print("speed [m/s],speed_sd [%],angle [rad],outcome,restitution,restitution_sd")
for v, a, k, e in zip(speed, angle, scattered["outcome"].values, scattered["restitution"].values):
    print(f"{{v}},2,{{a}},{{words[k]}},{{max(0.0, e + draw.normal(0, 0.02)) if k else ''}},{{0.02 if k else ''}}")
"""
MANY = """
import numpy as np
from wetdoublet.solvers import collide_many
draw = np.random.default_rng(1)
most = {most}
found = collide_many({scene!r}, stokes=10 ** draw.uniform(-2.5, 0.5, most) * {scale}, angle=draw.uniform(0, 1.5, most),
                     rtol=1e-8)
print(found["outcome"].values[:1000].tolist(), np.nan_to_num(found["restitution"].values[:1000]).tolist())
"""
FREE = "liquid.viscosity,particles.roughness"
GRID = ("--stokes", "log:0.005:0.5:50", "--angle", "0:85:50")
MINE = ("granulation", "--model", "mine")
GENERATED = (*MODULE, "generate", "mine.py", "--out", "mine")
MAP, SENSITIVITY = (*MODULE, "map", *MINE, *GRID, "-o", "map.csv"), (*MODULE, "sensitivity", *MINE, "--json")
EDITED = ("sed", "-i", "s/3/4/", "mine.py")


@dataclass(frozen=True)
class Row:
    """A chain of processes that is timed as a whole; `before` is not timed. {source} is the version's checkout."""

    name: str
    chain: tuple[tuple[str, ...], ...]
    before: tuple[tuple[str, ...], ...] = ()
    is_memory: bool = False


def python(text: str, **values: object) -> tuple[str, ...]:
    return (sys.executable, "-c", text.format(**values))


def fit(scenes: dict[str, int], *options: str) -> Row:
    """A fit of so many drawn impacts of each scene; FILE > command writes what a process prints into FILE."""
    drawn = tuple((f"{name}.csv", ">", *python(IMPACTS, scene=name, rows=rows)) for name, rows in scenes.items())
    files = [word for name in scenes for word in (name, f"{name}.csv")]
    text = ", ".join(f"{rows} rows of {name}" for name, rows in scenes.items())
    return Row(f"fit: {text}", ((*MODULE, "fit", *files, "--free", FREE, *options, "--json"),), drawn)


ROWS = (
    Row("install from a clone", ((sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-build-isolation",
        "--no-compile", "--target", "installed", "./clone"),), (("git", "clone", "-q", "{source}", "clone"),)),
    Row("first law, then a map", (GENERATED, MAP, ("cat", "map.csv"))),
    Row("first law, then a sensitivity", (GENERATED, SENSITIVITY)),
    Row("edited law, then a map", (EDITED, GENERATED, MAP, ("cat", "map.csv")), (GENERATED,)),
    Row("edited law, then a sensitivity", (EDITED, GENERATED, SENSITIVITY), (GENERATED,)),
    Row("verify", ((*MODULE, "verify", "granulation"),)),
    Row("bench", ((*MODULE, "bench", "granulation", "--out", "bench"),)),
    Row("reproduce", ((*MODULE, "reproduce", "all", "--out", "paper"),)),
    fit({"lactose-pvp": 200}),
    fit({"lactose-pvp": 1000}),
    fit({"granulation": 100, "lactose-pvp": 100}, "--own", "liquid.viscosity"),
    Row("proved map", ((*MODULE, "prove", "granulation", "--map", "--stokes", "log:0.005:0.5:51", "--angle", "1:85:51",
        "--json"),)),
    Row("1e6 collisions, granulation", (python(MANY, scene="granulation", scale=1, most=10**6),)),
    Row("1e6 collisions, pendulum", (python(MANY, scene="pendulum", scale=40, most=10**6),)),
    Row("memory of 1e6 collisions", (python(MANY, scene="granulation", scale=1, most=10**6),), is_memory=True),
)  # fmt: skip


@dataclass(frozen=True)
class Version:
    """A checkout, and the folder where it is installed."""

    source: Path
    installed: Path

    @classmethod
    def of(cls, given: str, work: Path) -> "Version":
        source = Path(given)
        if not source.is_dir():
            source = work / "source"
            subprocess.run(["git", "clone", "--quiet", str(ROOT), str(source)], check=True)
            subprocess.run(["git", "-C", str(source), "checkout", "--quiet", given], check=True)
        version = cls(source.resolve(), work / "installed")
        version.spent(ROWS[0], work)
        return version

    def spent(self, row: Row, folder: Path) -> tuple[float, str]:
        """Processor seconds of a row in a folder, or MB where it is about memory, and what the last process printed."""
        (folder / "mine.py").write_text(MODEL)
        environment = os.environ | {"PYTHONPATH": str(self.installed), "WETDOUBLET_CACHE": str(folder / "cache")}
        (folder / "cache").mkdir(exist_ok=True)
        printed, start = "", 0.0
        for k, command in enumerate((*row.before, *row.chain)):
            if k == len(row.before):
                start = _processor_seconds()
            file, words = (command[0], command[2:]) if command[1] == ">" else ("", command)
            call = [word.format(source=self.source) if word == "{source}" else word for word in words]
            if row.is_memory:
                call = [sys.executable, "-c", _PEAK, *call]
            done = subprocess.run(call, cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(f"{row.name}: {' '.join(call)}: {done.stderr.strip() or done.stdout.strip()}")
            printed = done.stdout
            if file:
                (folder / file).write_text(printed)
        return float(printed) if row.is_memory else _processor_seconds() - start, printed


_PEAK = """
import resource, subprocess, sys
subprocess.run([sys.argv[1], "-c", "import wetdoublet.solvers.many, xarray"], check=True)
imports = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
subprocess.run(sys.argv[1:], check=True, capture_output=True)
print((resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss - imports) / 1024)
"""


def _processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def difference(old: str, new: str) -> str:
    """The largest relative difference between the numbers of two texts, in words."""
    a, b = (np.array(re.findall(r"-?\d+\.\d+(?:e-?\d+)?", text), float) for text in (old, new))
    if a.size != b.size or not a.size:
        return f"{a.size} and {b.size} numbers" if a.size else ""
    return f"{np.max(np.abs(a - b) / np.maximum(np.maximum(np.abs(a), np.abs(b)), 1e-9)):.1e}"


def measured(versions: tuple[Version, Version], rows: tuple[Row, ...], rounds: int) -> Iterator[str]:
    """A line for each row."""
    for row in rows:
        least, printed = [float("inf")] * 2, ["", ""]
        for _ in range(rounds):
            for k, version in enumerate(versions):
                with tempfile.TemporaryDirectory() as folder:
                    spent, printed[k] = version.spent(row, Path(folder))
                least[k] = min(least[k], spent)
        unit = "MB" if row.is_memory else "s"
        old, new = least
        yield f"{row.name:44} {old:8.2f} {new:8.2f} {unit:2}  {new / old:5.2f}  {difference(*printed)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", default="", help="words of which a row's name has one")
    given = parser.parse_args()
    words = [word for word in given.only.split(",") if word]
    rows = tuple(row for row in ROWS if not words or any(word in row.name for word in words))
    with tempfile.TemporaryDirectory() as work:
        folders = [Path(work, name) for name in ("old", "new")]
        for folder in folders:
            folder.mkdir()
        old, new = (Version.of(text, folder) for text, folder in zip((given.old, given.new), folders, strict=True))
        say(f"{'':44} {'old':>8} {'new':>8}     ratio  largest relative difference of what is printed")
        for line in measured((old, new), rows, given.rounds):
            say(line)


if __name__ == "__main__":
    main()
