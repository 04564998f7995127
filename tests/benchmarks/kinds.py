"""What the kernel saves for scenes beyond the paper's; rewrites a table of docs/engineering/kernel-figures.md.

    python -m tests.benchmarks.kinds            measures, prints, writes the record and the page
    python -m tests.benchmarks.kinds --print    only prints

60 impacts of granulation (St 0.005 to 0.5, 0 to 85 degrees) by the kernel and by Rosenbrock compiled to C, both on one
core and at the same tolerance, taking turns; CPU time over all of them, the best of three runs; error in e_n against
Rosenbrock at 1e-12.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.derive.user_model.template import TEMPLATE
from wetdoublet.solvers import Scene
from wetdoublet.solvers.host.environment import environment
from wetdoublet.solvers.many.batch import Batch, validated_batch
from wetdoublet.solvers.many.by_casadi import run
from wetdoublet.solvers.many.by_kernel import collide_by_kernel
from wetdoublet.solvers.many.dataset import empty, fill
from wetdoublet.solvers.many.results import Block

from .measured.digits import of_rows
from .measured.tasks import Task

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "engineering" / "kernel-figures.md"
RECORD = PAGE.parent / "performance" / "kinds.json"

BEGIN, END = "<!-- kinds -->", "<!-- end of kinds -->"
RTOL, RUNS, REPEATS = 1e-9, 3, 20


def scenes() -> dict[str, Scene]:
    """A scene of each kind."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "mine.py"
        model.write_text(TEMPLATE)
        mine = Scene.load("granulation", model=model)
    wet, bare = Scene.load("granulation"), Scene.load("granulation-dry-bridge")
    return {
        "as in the paper": wet,
        "a user's bridge law (`generate --template`)": mine,
        "own rupture distance": wet.with_entries({"bridge.rupture": "own"}),
        "film that cavitates": wet.with_entries({"model.film": "cavitating"}),
        "film of constant volume": wet.with_entries({"model.film": "constant-volume"}),
        "van der Waals attraction, no bridge": bare.with_entries({"attraction.hamaker": 1e-18}),
        "partner of three times the radius": wet.with_entries({"partner.radius": 3e-4, "partner.density": 1500.0}),
        "wall": wet.with_entries({"partner.wall": True}),
    }


def measured(kind: str, scene: Scene) -> dict[str, Any]:
    """Microseconds a collision, largest error and number of wrong outcomes, by the kernel and by Rosenbrock."""
    impacts = Task("granulation", 60, (0.005, 0.5), 85.0).impacts()
    stokes, angle = (np.array([getattr(each, name) for each in impacts]) for name in ("stokes", "angle"))
    angle = np.where(
        (scene.bridge is None) & (angle < 0.02), 0.02, angle
    )  # nearly head-on without a bridge, films part in a time that diverges

    def request(rtol: float, engine: str, repeats: int = 1) -> Batch:
        of = ("outcome", "restitution")
        return validated_batch(
            scene, {"stokes": np.tile(stokes, repeats), "angle": np.tile(angle, repeats)}, {}, rtol, engine, of
        )

    def kernel() -> Block:
        repeated = request(RTOL, "taylor", REPEATS)
        found = empty(repeated.size, repeated.of)
        left = collide_by_kernel(repeated, np.arange(repeated.size), 1, lambda where, block: fill(found, where, block))
        assert not left.size
        return found

    exact = run(request(1e-12, "rosenbrock"), True)
    row: dict[str, Any] = {"scene": kind}
    runs: dict[str, tuple[Callable[[], Block], int]] = {
        "kernel": (kernel, REPEATS),
        "Rosenbrock, compiled": (lambda: run(request(RTOL, "rosenbrock"), True), 1),
    }
    least = dict.fromkeys(runs, math.inf)
    for _ in range(RUNS + 1):
        for name, (timed, repeats) in runs.items():
            before = time.process_time()
            found = timed()
            least[name] = min(least[name], 1e6 * (time.process_time() - before) / (stokes.size * repeats))
            error = np.abs(found["restitution"][: stokes.size] - exact["restitution"])
            row |= {name: least[name], f"error, {name.partition(',')[0]}": float(error.max())}
            row[f"wrong, {name.partition(',')[0]}"] = int((found["outcome"][: stokes.size] != exact["outcome"]).sum())
    row["ratio"] = least["Rosenbrock, compiled"] / least["kernel"]
    return row


def main() -> None:
    """Measure every kind."""
    rows = [measured(kind, scene) for kind, scene in scenes().items()]
    text = f"{BEGIN}\n{of_rows(rows)}\n{END}"
    print(text)  # noqa: T201 # a script
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps({"environment": environment(), "rtol": RTOL, "rows": rows}, indent=1) + "\n")
        page = PAGE.read_text()
        PAGE.write_text(page[: page.index(BEGIN)] + text + page[page.index(END) + len(END) :])


if __name__ == "__main__":
    main()
