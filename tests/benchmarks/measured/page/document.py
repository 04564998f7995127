"""Write docs/performance.md from the records of a run; no figure in it is typed.

    python -m tests.benchmarks.measured.page.document [FOLDER]

FOLDER (docs/performance) holds bench.json, compile_flags.json, cvodes_share.json and, if it was run, stress.json. With
the usual folder also the figures on the front page, README.md, between its marks.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from wetdoublet.solvers.formatting.markdown import ms, table

from ..cold import cold_table
from . import tables
from .targets import headline, target_table

Record = dict[str, Any]

README = Path(__file__).resolve().parents[4] / "README.md"
RECORDS = ("bench", "compile_flags", "cvodes_share")
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"


def page(bench: Record, flags: Record, share: Record, stress: Record | None, folder: str) -> str:
    """The page."""
    parts = [
        "# Performance",
        INTRODUCTION.format(folder=folder),
        tables.surroundings(bench),
        "## What was aimed at",
        target_table(bench),
        "## Run time against achieved error",
        f"![Work against error]({folder}/work.png)",
        WORK,
    ]
    for task in bench["tasks"]:
        parts += [f"### {task['preset']}", tables.sample(task), tables.equal_error(task), tables.work_table(task)]
        parts += [tables.failures(task)]
    parts += [
        "## What a ledger, a trajectory and the rotation cost",
        f"![Cost of features]({folder}/cost.png)",
    ]
    parts += [tables.cost_table(bench), tables.COST_NOTE]
    pictures = {"Near": "near.png", "Gradients to": "gradients.png", "From one": "growth.png"}
    for part in tables.others(bench):
        parts.append(part)
        parts += [
            f"![{part[3:]}]({folder}/{name})" for start, name in pictures.items() if part.startswith(f"## {start}")
        ]
    parts += ["## Cold start", cold_table(bench["cold_start"])]
    if stress is not None:
        parts += ["## Engines against each other", STRESS, f"**{stress['summary']}**"]
        parts += [stress["tables"]["rate"]] if "rate" in stress["tables"] else []
        parts += [stress["tables"]["disagreements"], stress["tables"]["failures"], stress["tables"]["engines"]]
        parts += [stress["tables"]["ledgers"], f"![Error and cost]({folder}/stress-map.png)"]
        parts += ["### Points beside boundaries", f"![Points beside boundaries]({folder}/stress-near.png)"]
        parts += [stress["tables"]["near"]]
    parts += ["## Why integrators are compiled with -O1", flags_table(flags), flags_text(flags)]
    parts += ["## Why CVODES is told rtol/30", SHARE, share_table(share), share_text(share)]
    return "\n\n".join(parts) + "\n"


INTRODUCTION = """\
Measured and written by `python -m tests.benchmarks.measured` (see [tests/benchmarks](../tests/benchmarks/README.md));
its records are in `{folder}/`. For one scene on your machine: `wetdoublet bench SCENE`.
The cores were shared: read the ratios."""

WORK = """\
A point is one engine at one tolerance (1e-5 to 1e-13 in steps of 100; taylor and heyoka 1e-6 to 1e-13 at every half
decade, and run more often): mean CPU time of a collision that is not decided
at initial contact, against the largest absolute error in e_n among those that separate. Everything runs on one core.

* **The same for all**: equations from the emitted modules, stop rule, stick certificate with its margin.
* **`cvodes`, `rosenbrock`** are `collide(ledger=False)` as a user calls it: the impact is checked, the path located
  (by the interpreted Rosenbrock), then integrated again by the engine, and a result made with its SI quantities.
  Locating is never looser than 1e-6.
* **Engines of many collisions** (`rosenbrock, compiled` and `taylor` by `collide_many` of outcome and restitution, the
  kernel without what that adds, heyoka, diffrax) get the whole set twenty times in one call; what they compile is not
  counted.
* **heyoka**: `taylor_adaptive_batch` with terminal events whose callbacks reverse, and refill a lane from the queue;
  8 lanes of AVX-512, groups that do not vary written in as numbers, not in compact mode (which is 1.5 times slower).
  Never looser than 1e-6 either: else the energy misses the level that proves a stick. Deciding at initial contact and
  that level are computed beforehand, for nothing. Its events are isolated on the step's polynomial, so that it misses
  no graze.
* **CVODE of scikit-sundae** has rates, Jacobian and events as machine code by numba; **scipy's** methods call CasADi
  functions with parameters bound once. Both stop at terminal events, with the rules of our own trajectories between
  them. scipy's look for grazing minima afterwards, CVODE does not.
* **diffrax**: Tsit5, jitted and vectorised over the set, its own events with a Newton root finder.
* An engine whose collisions take more than two seconds at one tolerance is not asked for the next.
* A peer that is not installed is named at the top, and so is a compiler that is missing. AMICI is not among the peers:
  there is no model of a collision for it here.
* **Reference values** by DOP853 at 1e-13, which no engine under test uses. Where an error is below the difference to
  the next best computation (grey in the plot), it cannot be told from the reference's own."""

STRESS = """\
`wetdoublet verify --stress N`: a quasi-random sample of everything a scene may say, and points set at 1e-3 to 1e-12 of
boundaries, each by every engine. Two engines disagree where their outcomes differ, or e_n by more than 1e3 rtol times
its conditioning; that is explained only where a change of outcome lies within 1e3 rtol of the Stokes number, found by
moving it. Certified sticks are continued without their certificate; ledgers must close."""

SHARE = """\
Both engines integrate the same located paths with the same landing on events, told the same relative tolerance; median
error in e_n of the separating collisions among those drawn, and the median of the collisions' own ratios to
Rosenbrock."""


def flags_table(flags: Record) -> str:
    """Compile and run time by level."""
    base = {row["task"]: row for row in flags["rows"] if row["level"] == "-O1"}
    rows = []
    for row in flags["rows"]:
        first, inside = (base[row["task"]][name] for name in ("first_pass", "integrators"))
        rows.append(
            [
                f"{row['task']}, libraries: {row['libraries']}",
                row["level"],
                f"{row['first_pass']:.2f} ({row['first_pass'] / first:.2f})",
                f"{ms(row['integrators'])} ({row['integrators'] / inside:.2f})",
            ]
        )
    head = ["task", "flag", "first pass, s (of -O1)", "CPU ms a collision inside integrators (of -O1)"]
    return table(head, rows)


def flags_text(flags: Record) -> str:
    """From how many collisions on a higher level would pay."""
    lines = []
    for task in dict.fromkeys(row["task"] for row in flags["rows"]):
        found = {row["level"]: row for row in flags["rows"] if row["task"] == task}
        dearer = found["-O3"]["first_pass"] - found["-O1"]["first_pass"]
        gained = found["-O1"]["integrators"] - found["-O3"]["integrators"]
        if gained > 0:
            lines.append(
                f"{task}: -O3 costs {dearer:.2f} s more once and has it back after {dearer / gained:.0f} collisions."
            )
        else:
            lines.append(f"{task}: -O3 costs {dearer:.2f} s more once and is not faster.")
    said = (
        f"`python -m tests.benchmarks.compile_flags`, rtol {flags['rtol']:g}. A library belongs to one flow and one "
        "tolerance, so that every new tolerance waits for the compiler: the first use counts more than the rest."
    )
    return "\n".join([said, *lines])


def share_table(share: Record) -> str:
    """Median errors and ratios."""
    rows = []
    for row in share["rows"]:
        error, ratio = row["median_error"], row["median_ratio"]
        rows.append(
            [
                f"{row['task']}, {row['collisions']} collisions",
                f"{row['rtol']:.0e}",
                *(f"{error[name]:.1e}" for name in ("rosenbrock", "cvodes", "cvodes/30")),
                *(f"{ratio[name]:.3g}" for name in ("cvodes", "cvodes/30")),
            ]
        )
    return table(["task", "rtol", "rosenbrock", "cvodes", "cvodes at rtol/30", "ratio", "ratio at rtol/30"], rows)


def share_text(share: Record) -> str:
    """What the table says."""
    both = {name: [row["median_ratio"][name] for row in share["rows"]] for name in ("cvodes", "cvodes/30")}
    most = max(row["median_error"]["cvodes/30"] / row["rtol"] for row in share["rows"])
    return (
        f"`python -m tests.benchmarks.cvodes_share`. At equal tolerances CVODES' error is {min(both['cvodes']):.0f} to "
        f"{max(both['cvodes']):.0f} times Rosenbrock's; at rtol/30 {min(both['cvodes/30']):.1f} to "
        f"{max(both['cvodes/30']):.0f} times, and its median error is at most {most:.2g} rtol."
    )


def main() -> None:
    """Read, and write the page beside the folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/performance")
    records = [json.loads((folder / f"{name}.json").read_text()) for name in RECORDS]
    stress = folder / "stress.json"
    found = json.loads(stress.read_text()) if stress.is_file() else None
    folder.with_suffix(".md").write_text(page(*records, found, folder.name), encoding="utf-8")
    if folder.resolve() == README.parent / "docs" / "performance":
        README.write_text(fronted(README.read_text(encoding="utf-8"), records[0]), encoding="utf-8")


def fronted(text: str, bench: Record) -> str:
    """The front page with the figures of a record between its marks."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{headline(bench)}\n{END}{after}" if after else text


if __name__ == "__main__":
    main()
