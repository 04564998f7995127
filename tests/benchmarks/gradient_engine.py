"""When the kernel pays for derivatives: at first use, alone, in numbers.

    python -m tests.benchmarks.gradient_engine            measures, prints, writes the page
                                                            (docs/engineering/kernel-figures.md) and its record
    python -m tests.benchmarks.gradient_engine --print    only prints

Derivatives of e_n by all parameters at the default tolerance, at an impact of each scene that separates. Every engine
in a process of its own with a cache that is empty at first; CPU time with that of the compiler, the best of some calls.
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
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene, gradients_many, sensitivities
from wetdoublet.solvers.host.environment import environment

from .kernel import table
from .kinds import scenes as kinds

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "engineering" / "kernel-figures.md"
RECORD = PAGE.parent / "performance" / "gradient_engine.json"

BEGIN, END = "<!-- gradient engine -->", "<!-- end of gradient engine -->"
CALLS, MANY = 7, 1000
USER, PAIR = "a user's bridge law (`generate --template`)", "partner of three times the radius"
IMPACTS = {"granulation": (0.05, 75.0), "pendulum": (1.3, 60.0), USER: (0.05, 75.0), PAIR: (0.3, 45.0)}


def scene(name: str) -> Scene:
    """The scene of a row."""
    return kinds()[name] if name in (USER, PAIR) else Scene.load(name)


def spent() -> float:
    """CPU time so far, with the compiler's."""
    child = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + child.ru_utime + child.ru_stime


def taken(run: Callable[[], object]) -> float:
    """Seconds of CPU of a call."""
    before = spent()
    run()
    return spent() - before


def child(name: str, engine: str, method: str) -> dict[str, Any]:
    """First call, further calls, many collisions in a call: seconds a collision; and the gradient."""
    stokes, degrees = IMPACTS[name]
    asked = scene(name)
    impact = {"stokes": stokes, "angle": math.radians(degrees)}

    def run() -> Any:
        return sensitivities(asked, **impact, engine=engine, method=method)

    found: dict[str, Any] = {"first": taken(run), "again": min(taken(run) for _ in range(CALLS))}
    if engine == "taylor":
        many = {one: np.full(MANY, value) for one, value in impact.items()}
        found["many"] = min(taken(lambda: gradients_many(asked, **many, engine=engine)) for _ in range(CALLS)) / MANY
    one = run()
    return found | {"engine": one.engine, "elasticity": one.elasticity["restitution"]}


def measured(name: str) -> dict[str, Any]:
    """A row of the table."""
    found = {}
    with tempfile.TemporaryDirectory() as cache:
        runs = (("rosenbrock", "forward"), ("rosenbrock", "adjoint"), ("taylor", "forward"), ("taylor", "forward"))
        for engine, method in runs:  # the kernel's second process finds it compiled
            key = f"{engine} {method}" + (" cached" if f"{engine} {method}" in found else "")
            done = subprocess.run(
                [sys.executable, "-m", "tests.benchmarks.gradient_engine", "--child", name, engine, method],
                env=os.environ | {"WETDOUBLET_CACHE": cache}, capture_output=True, text=True, check=True,
            )  # fmt: skip
            found[key] = json.loads(done.stdout)
    kernel, fresh = found["taylor forward cached"], found["taylor forward"]
    forward, adjoint = found["rosenbrock forward"], found["rosenbrock adjoint"]
    assert (kernel["engine"], forward["engine"]) == ("taylor", "rosenbrock")
    rows = [[value or 0.0 for value in each["elasticity"].values()] for each in (kernel, forward)]
    apart = float(np.abs(np.subtract(*rows)).max() / np.abs(rows[1]).max())
    return {
        "scene": name,
        "Rosenbrock, ms": 1e3 * forward["again"],
        "its adjoint": 1e3 * adjoint["again"],
        "kernel, ms": 1e3 * kernel["again"],
        f"{MANY} by the kernel, us each": 1e6 * kernel["many"],
        "first call, Rosenbrock, ms": 1e3 * forward["first"],
        "kernel, compiled": 1e3 * kernel["first"],
        "kernel, to compile": 1e3 * fresh["first"],
        "which is so many by Rosenbrock": (fresh["first"] - kernel["first"]) / min(forward["again"], adjoint["again"]),
        "apart": apart,
    }


def main() -> None:
    """Measure everything."""
    if sys.argv[1:2] == ["--child"]:
        print(json.dumps(child(*sys.argv[2:])))  # noqa: T201 # for the process that asked
        return
    rows = [measured(name) for name in IMPACTS]
    text = f"{BEGIN}\n{table(rows)}\n{END}"
    print(text)  # noqa: T201 # a script
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps({"environment": environment(), "rows": rows}, indent=1) + "\n")
        page = PAGE.read_text()
        PAGE.write_text(page[: page.index(BEGIN)] + text + page[page.index(END) + len(END) :])


if __name__ == "__main__":
    main()
