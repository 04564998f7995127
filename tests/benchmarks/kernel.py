"""What the Taylor kernel costs and how exact it is; rewrites the figures of docs/kernel.md.

    python tests/benchmarks/kernel.py            measures, prints, writes docs/performance/kernel.json and the page
    python tests/benchmarks/kernel.py --print    only prints

Both tasks of solvers/benchmarks/tasks.py, each set repeated 20 times in one call; CPU time over the collisions that are
not decided at first touch, the best of five runs; error against Rosenbrock at 1e-12.
"""

from __future__ import annotations

import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.benchmarks.environment import environment
from wetdoublet.solvers.benchmarks.tasks import Task
from wetdoublet.solvers.taylor import engine, library

ROOT = Path(__file__).resolve().parents[2]
PAGE, RECORD = ROOT / "docs" / "kernel.md", ROOT / "docs" / "performance" / "kernel.json"
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"
TASKS = (Task("granulation", 60, (0.005, 0.5), 85.0), Task("pendulum", 20, (0.3, 3.0), 80.0))
REPEATS, RUNS = 20, 5
RTOLS = (1e-6, 1e-8, 1e-9, 1e-10, 1e-12)
SEPARATRIX = 0.049117734419372415  # St of granulation at 45 deg, by bisection at rtol 1e-13


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
                found = engine.answers(many, rtol)
                cpu = min(cpu, time.process_time() - before)
            assert found is not None
            undecided = int((found["status"] != 1).sum())
            one = found[: len(impacts)]
            rows.append(
                {
                    "task": task.preset,
                    "rtol": rtol,
                    "order": engine.order_for(rtol),
                    "microseconds": 1e6 * cpu / undecided,
                    "steps": float(one["steps"].sum() / (undecided / REPEATS)),
                    "largest error": float(np.abs(one["shown"][:, 0] - exact.restitution.values).max()),
                    "wrong": int((one["outcome"] != exact.outcome.values).sum()),
                }
            )
    return rows


def near() -> list[dict[str, Any]]:
    """Milliseconds of a collision near the S/SRS separatrix, kernel and compiled Rosenbrock, in blocks of 101."""
    rows = []
    for distance in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10):
        stokes = SEPARATRIX * (1 + distance * np.linspace(1.0, 1.01, 101))
        row: dict[str, Any] = {"distance": distance}
        for name in ("taylor", "rosenbrock"):
            collide_many("granulation", stokes=stokes[:1], angle=math.radians(45), engine=name)
            before = time.perf_counter()
            found = collide_many("granulation", stokes=stokes, angle=math.radians(45), engine=name)
            row[name] = 1e3 * (time.perf_counter() - before) / stokes.size
            row[f"{name} failed"] = int((found.outcome == -1).sum())
        rows.append(row)
    return rows


def growth() -> list[dict[str, Any]]:
    """Wall time of one call and the process's memory, 1e2 to 1e6 collisions over the map of the paper."""
    rows = []
    for count in (101, 10_000, 1_000_000):
        side = round(math.sqrt(count))
        stokes, angle = np.meshgrid(np.geomspace(0.005, 0.5, side), np.radians(np.linspace(0, 85, side)))
        before = time.perf_counter()
        collide_many("granulation", stokes=stokes.ravel(), angle=angle.ravel(), engine="taylor")
        wall = time.perf_counter() - before
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        rows.append({"collisions": side * side, "seconds": wall, "MB": memory})
    return rows


COLD = """
import time
import wetdoublet.solvers.many, xarray
before = time.perf_counter()
from wetdoublet.solvers import collide_many
collide_many("{preset}", stokes=0.5, angle=1.0, engine="taylor")
print(time.perf_counter() - before)
"""


def cold() -> list[dict[str, Any]]:
    """Seconds of a first call, and of the next process's first, beyond the imports."""
    rows = []
    for task in TASKS:
        with tempfile.TemporaryDirectory() as folder:
            row: dict[str, Any] = {"task": task.preset}
            for name in ("first", "second"):
                done = subprocess.run(
                    [sys.executable, "-c", COLD.format(preset=task.preset)],
                    env=os.environ | {"WETDOUBLET_CACHE": folder},
                    capture_output=True,
                    text=True,
                    check=True,
                )
                row[name] = float(done.stdout)
        rows.append(row)
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
    record = {"environment": environment(), "lanes": library.lanes(), "flags": library.FLAGS}
    record |= {"work": work(), "near": near(), "growth": growth(), "cold": cold()}
    text = f"""{BEGIN}
{record["lanes"]} lanes. CPU time a collision that is not decided at first touch:

{table(record["work"])}

Near the S/SRS separatrix at 45 degrees (relative distance in St), milliseconds a collision on all cores:

{table(record["near"])}

One call over the map of granulation, compilation included in the first row if it was needed:

{table(record["growth"])}

First call with an empty cache, and in the next process, seconds beyond the imports:

{table(record["cold"])}
{END}"""
    print(text)  # noqa: T201 # a script
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps(record, indent=1, default=str) + "\n")
        page = PAGE.read_text()
        PAGE.write_text(page[: page.index(BEGIN)] + text + page[page.index(END) + len(END) :])


if __name__ == "__main__":
    main()
