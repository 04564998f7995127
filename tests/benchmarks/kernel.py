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
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
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


def beside() -> list[dict[str, Any]]:
    """The cheapest CPU time at a largest error of 1e-8, kernel, `collide_many` and heyoka taking turns."""
    if find_spec("heyoka") is None:
        return [{"task": "heyoka is not installed"}]
    from wetdoublet.solvers.benchmarks.peer_heyoka import collisions

    rows = []
    for task in TASKS:
        impacts = task.impacts()
        stokes, angle = (np.array([getattr(each, name) for each in impacts]) for name in ("stokes", "angle"))
        exact = collide_many(task.scene, stokes=stokes, angle=angle, rtol=1e-12, engine="rosenbrock").restitution.values
        found = engine.answers(engine.Impacts(task.scene, task.scene.speed_of(stokes), angle, {}), 1e-9)
        assert found is not None
        left = np.flatnonzero(found["status"] != 1)
        truth = np.tile(exact[left], 2 * REPEATS)
        st, theta = np.tile(stokes[left], 2 * REPEATS), np.tile(angle[left], 2 * REPEATS)
        many = engine.Impacts(task.scene, task.scene.speed_of(st), theta, {})
        runs: list[tuple[str, Callable[[], Any]]] = []
        for rtol in (1e-7, 3e-8, 1e-8, 3e-9):
            runs.append(("kernel", partial(_kernel, many, rtol)))
            runs.append(("collide_many", partial(_collided, task.scene, st, theta, rtol)))
        for rtol in (1e-8, 1e-9, 1e-10, 1e-11):
            batch = collisions(task.scene, [impacts[k] for k in left] * (2 * REPEATS), rtol)
            runs.append(("heyoka", partial(_batch, batch)))
        least = [math.inf] * len(runs)
        exactly = [True] * len(runs)
        for _ in range(RUNS + 1):
            for k, (_, run) in enumerate(runs):
                before = time.process_time()
                values = run()
                least[k] = min(least[k], time.process_time() - before)
                exactly[k] &= bool(np.abs(values - truth).max() <= 1e-8)
        best = {
            name: min(1e6 * least[k] / st.size for k, (own, _) in enumerate(runs) if own == name and exactly[k])
            for name in ("kernel", "collide_many", "heyoka")
        }
        ratios = {f"heyoka / {name}": best["heyoka"] / best[name] for name in ("kernel", "collide_many")}
        rows.append({"task": task.preset, **best, **ratios})
    return rows


def _kernel(impacts: engine.Impacts, rtol: float) -> Any:
    found = engine.answers(impacts, rtol)
    assert found is not None
    return found["shown"][:, 0]


def _collided(scene: Scene, stokes: Any, angle: Any, rtol: float) -> Any:
    return collide_many(scene, stokes=stokes, angle=angle, rtol=rtol, engine="taylor").restitution.values


def _batch(batch: Any) -> Any:
    batch.run()
    return np.array(batch.restitutions)


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
    record["beside"] = beside()  # last: heyoka takes memory
    text = f"""{BEGIN}
{record["lanes"]} lanes. CPU time a collision that is not decided at first touch:

{table(record["work"])}

Microseconds of CPU a collision, cheapest tolerance whose largest error is below 1e-8, all in one run:

{table(record["beside"])}

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
