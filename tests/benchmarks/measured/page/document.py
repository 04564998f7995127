"""Write docs/engineering/performance.md from the records of a run; no figure in it is typed."""

import json
from pathlib import Path
from typing import Any

from ...law_in_c import section as exported_law
from . import tables
from .targets import headline, target_table

Record = dict[str, Any]

README = Path(__file__).resolve().parents[4] / "README.md"
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"


def page(bench: Record, stress: Record | None, folder: str, law: Record | None = None) -> str:
    """The page."""
    parts = ["# Performance", INTRODUCTION, "## What was aimed at", target_table(bench)]
    parts += ["## Run time against achieved error", f"![Work against error]({folder}/work.png)"]
    around = bench["settings"]["around_callback"]
    parts.append(f"{WORK}\n{ALONE.format(around=f': {1e9 * around:.0f} ns a call' if around else '')}")
    for task in bench["tasks"]:
        parts += [f"### {task['preset']}", tables.sample(task), tables.of_collisions_at_equal_error(task)]
        parts += [text for text in [tables.failures(task)] if text]
    if bench["growth"]:
        parts += ["## From one collision to many", f"![From one collision to many]({folder}/growth.png)"]
    if law is not None:
        parts.append(exported_law(law))
    if stress is not None:
        parts += ["## Engines against each other", STRESS, f"**{stress['summary']}**", stress["disagreements"]]
    parts += ["## The machine", tables.surroundings(bench)]
    return "\n\n".join(parts) + "\n"


INTRODUCTION = """\
Measured and written by `python -m tests.benchmarks.measured`; the records lie beside the pictures.
For one scene on your machine: `wetdoublet bench SCENE`. The cores were shared: read the ratios."""

WORK = """\
A point is one engine at one tolerance: mean CPU time of a collision that is not decided at initial contact, on one
core, against the largest absolute error in e_n among those that separate.

* **The same for all**: the emitted equations, the stop rule, the stick certificate with its margin.
* **`cvodes`, `rosenbrock`** are `collide(ledger=False)` as a user calls it: the kernel's phases, replayed.
* **Engines of many collisions** get the whole set so often in one call that there are some 1000; compilation is not
  counted. `taylor` is `collide_many` of outcome and restitution, "kernel alone" leaves out what that adds.
* **heyoka**: batches of 8 lanes with a queue and terminal events, `fast_math`, not in compact mode. The level of energy
  that proves a stick is computed beforehand, for nothing; it does not get our jump along the slow manifold, nor the
  bound of the impulse where a trajectory turns.
* **scipy's** methods call CasADi functions.
* **Reference values** by DOP853 at 1e-13, which no engine under test uses. Below the grey line an error cannot be told
  from the reference's own."""

ALONE = """\
* **heyoka, without callbacks**: its events end in callbacks, which from Python are Python. This is less the CPU time
  within them, by a clock in each, and less the way from heyoka to Python, measured on an oscillator whose crossings
  call a function that does nothing{around}. A caller in C++ waits at least so long."""

STRESS = """\
`wetdoublet verify --stress N`: a quasi-random sample of everything a scene may say, and points set at 1e-3 to 1e-12 of
boundaries, each by every engine. Two engines disagree where their outcomes differ, or e_n by more than 1e3 rtol times
its conditioning; that is explained only where a change of outcome lies within 1e3 rtol of the Stokes number, found by
moving it. Certified sticks are continued without their certificate; ledgers must close."""


def write(folder: Path, front: bool) -> None:
    """The page from bench.json and, if they were run, stress.json and law_in_c.json; README.md between its marks."""
    files = [folder / f"{name}.json" for name in ("bench", "stress", "law_in_c")]
    bench, stress, law = (json.loads(file.read_text()) if file.is_file() else None for file in files)
    folder.with_suffix(".md").write_text(page(bench, stress, folder.name, law), encoding="utf-8")
    if front:
        README.write_text(fronted(README.read_text(encoding="utf-8"), bench), encoding="utf-8")


def fronted(text: str, bench: Record) -> str:
    """The front page with the figures of a record between its marks."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{headline(bench)}\n{END}{after}" if after else text
