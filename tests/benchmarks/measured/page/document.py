"""Write docs/engineering/performance.md from the records of a run; no figure in it is typed.

    python -m tests.benchmarks.measured.page.document [FOLDER]

FOLDER (docs/engineering/performance) holds bench.json, compile_flags.json, cvodes_share.json and, if they were run,
stress.json and law_in_c.json. With the usual folder also the figures on the front page, README.md, between its marks.
"""

import json
import sys
from pathlib import Path
from typing import Any

from ...law_in_c import section as exported_law
from ..cold import cold_table
from . import beside_heyoka, tables
from .targets import headline, target_table

Record = dict[str, Any]

README = Path(__file__).resolve().parents[4] / "README.md"
RECORDS = ("bench", "compile_flags", "cvodes_share")
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"


def page(
    bench: Record, flags: Record, share: Record, stress: Record | None, folder: str, law: Record | None = None
) -> str:
    """The page."""
    parts = [
        "# Performance",
        INTRODUCTION,
        "## What was aimed at",
        target_table(bench),
        "## Beside heyoka, whose callbacks are Python's",
        beside_heyoka.three_ways(bench),
        beside_heyoka.note(bench),
        "## Run time against achieved error",
        f"![Work against error]({folder}/work.png)",
        WORK,
    ]
    for task in bench["tasks"]:
        parts += [f"### {task['preset']}", tables.sample(task), tables.equal_error(task)]
        parts += [text for text in [tables.failures(task)] if text]
    parts += ["## What a ledger, a trajectory and the rotation cost", f"![Cost of features]({folder}/cost.png)"]
    parts += [tables.COST_NOTE]
    pictures = {"Near": "near.png", "Gradients to": "gradients.png", "From one": "growth.png"}
    for part in tables.others(bench):
        title, _, body = part.partition("\n\n")
        drawn = [f"![{title[3:]}]({folder}/{name})" for start, name in pictures.items() if title[3:].startswith(start)]
        parts += [title, *drawn, *([body] if body else [])]
    if law is not None:
        parts.append(exported_law(law))
    parts += ["## Cold start", cold_table(bench["cold_start"])]
    if stress is not None:
        parts += ["## Engines against each other", STRESS, f"**{stress['summary']}**"]
        parts += [stress["tables"]["disagreements"], stress["tables"]["engines"], stress["tables"]["ledgers"]]
        parts += [f"![Error and cost]({folder}/stress-map.png)"]
        parts += [f"![Points beside boundaries]({folder}/stress-near.png)"]
    parts += ["## Why integrators are compiled with -O1, and CVODES is told rtol/30", flags_text(flags)]
    parts += [f"{SHARE} {share_text(share)}"]
    parts += ["## The machine", tables.surroundings(bench)]
    return "\n\n".join(parts) + "\n"


INTRODUCTION = """\
Measured and written by `python -m tests.benchmarks.measured`; the records lie beside the pictures.
For one scene on your machine: `wetdoublet bench SCENE`. The cores were shared: read the ratios."""

WORK = """\
A point is one engine at one tolerance: mean CPU time of a collision that is not decided at initial contact, on one
core, against the largest absolute error in e_n among those that separate.

* **The same for all**: the emitted equations, the stop rule, the stick certificate with its margin.
* **`cvodes`, `rosenbrock`** are `collide(ledger=False)` as a user calls it: located, then integrated by the engine.
* **Engines of many collisions** get the whole set twenty times in one call, `taylor` and heyoka so often that there
  are 1000; compilation is not counted. `taylor` is `collide_many` of outcome and restitution, "kernel alone" leaves out
  what that adds.
* **heyoka**: batches of 8 lanes with a queue and terminal events, `fast_math`, not in compact mode. The level of energy
  that proves a stick is computed beforehand, for nothing.
* **CVODE of scikit-sundae** has rates, Jacobian and events as machine code by numba; **scipy's** methods call CasADi
  functions; **diffrax** is Tsit5, jitted and vectorised, with its own events.
* **Reference values** by DOP853 at 1e-13, which no engine under test uses. Below the grey line an error cannot be told
  from the reference's own."""

STRESS = """\
`wetdoublet verify --stress N`: a quasi-random sample of everything a scene may say, and points set at 1e-3 to 1e-12 of
boundaries, each by every engine. Two engines disagree where their outcomes differ, or e_n by more than 1e3 rtol times
its conditioning; that is explained only where a change of outcome lies within 1e3 rtol of the Stokes number, found by
moving it. Certified sticks are continued without their certificate; ledgers must close."""

SHARE = """\
CVODES and Rosenbrock integrate the same located paths with the same landing on events, told the same relative
tolerance; median error in e_n of the separating collisions among those drawn, and the median of the collisions' own
ratios to Rosenbrock."""


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
    return " ".join([said, *lines])


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
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/engineering/performance")
    records = [json.loads((folder / f"{name}.json").read_text()) for name in RECORDS]
    stress = folder / "stress.json"
    found = json.loads(stress.read_text()) if stress.is_file() else None
    law = folder / "law_in_c.json"
    exported = json.loads(law.read_text()) if law.is_file() else None
    folder.with_suffix(".md").write_text(page(*records, found, folder.name, exported), encoding="utf-8")
    if folder.resolve() == README.parent / "docs" / "engineering" / "performance":
        README.write_text(fronted(README.read_text(encoding="utf-8"), records[0]), encoding="utf-8")


def fronted(text: str, bench: Record) -> str:
    """The front page with the figures of a record between its marks."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{headline(bench)}\n{END}{after}" if after else text


if __name__ == "__main__":
    main()
