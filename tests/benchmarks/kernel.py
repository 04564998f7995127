"""What the Taylor kernel costs and how exact it is; rewrites the figures of docs/engineering/kernel-figures.md.

    python -m tests.benchmarks.kernel            measures, prints, writes the record and the page
    python -m tests.benchmarks.kernel --print    only prints

Both tasks of measured/tasks.py, each set repeated 20 times in one call; CPU time over the collisions that are
not decided at initial contact, the best of five runs; error against Rosenbrock at 1e-12.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.engines.taylor import build as library
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.engines.taylor.machine import lanes
from wetdoublet.solvers.engines.taylor.orders import order_for
from wetdoublet.solvers.host.environment import environment

from .measured.tasks import Task

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "engineering" / "kernel-figures.md"
RECORD = PAGE.parent / "performance" / "kernel.json"

BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"
TASKS = (Task("granulation", 60, (0.005, 0.5), 85.0), Task("pendulum", 20, (0.3, 3.0), 80.0))
REPEATS, RUNS = 20, 5
RTOLS = (1e-6, 1e-8, 1e-9, 1e-10, 1e-12)


def work() -> list[dict[str, Any]]:
    """Microseconds and largest error for each task and tolerance."""
    rows = []
    for task in TASKS:
        impacts = task.impacts()
        stokes, angle = (np.array([getattr(each, name) for each in impacts]) for name in ("stokes", "angle"))
        exact = collide_many(task.scene, stokes=stokes, angle=angle, rtol=1e-12, engine="rosenbrock")
        speed = task.scene.speed_of(stokes)
        many = engine.Impacts(task.scene, np.tile(speed, REPEATS), np.tile(angle, REPEATS), {})
        for rtol in RTOLS:
            cpu = math.inf
            for _ in range(RUNS):
                before = time.process_time()
                found = engine.run_kernel(many, rtol)
                cpu = min(cpu, time.process_time() - before)
            assert found is not None
            undecided = int((found["status"] != 1).sum())
            one = found[: len(impacts)]
            rows.append(
                {
                    "task": task.preset,
                    "rtol": rtol,
                    "order": order_for(rtol),
                    "microseconds": 1e6 * cpu / undecided,
                    "steps": float(one["steps"].sum() / (undecided / REPEATS)),
                    "largest error": float(np.abs(one["shown"][:, 0] - exact.restitution.values).max()),
                    "wrong": int((one["outcome"] != exact.outcome.values).sum()),
                }
            )
    return rows


def table(rows: list[dict[str, Any]]) -> str:
    """Markdown."""

    def shown(value: object) -> str:
        return f"{value:.2g}" if isinstance(value, float) else str(value)

    lines = ["| " + " | ".join(rows[0]) + " |", "|" + "---|" * len(rows[0])]
    return "\n".join([*lines, *("| " + " | ".join(map(shown, row.values())) + " |" for row in rows)])


def main() -> None:
    """Measure everything."""
    assert Scene.load("granulation")
    record = {"environment": environment(), "lanes": lanes(), "flags": library.FLAGS}
    record["work"] = work()
    text = f"""{BEGIN}
{record["lanes"]} lanes. CPU time a collision that is not decided at initial contact:

{table(record["work"])}

Beside heyoka, near a separatrix, from one collision to a million, and at first use: [performance.md](performance.md).
{END}"""
    print(text)  # noqa: T201 # a script
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps(record, indent=1, default=str) + "\n")
        page = PAGE.read_text()
        PAGE.write_text(page[: page.index(BEGIN)] + text + page[page.index(END) + len(END) :])


if __name__ == "__main__":
    main()
