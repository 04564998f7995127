"""Global error in e_n of CVODES and of Rosenbrock when both are told the same tolerance.

    python -m tests.benchmarks.cvodes_share [FOLDER]

Writes FOLDER/cvodes_share.json (docs/engineering/performance). The paths are located once, at 1e-13; both engines then
integrate the same phases and land on the same events, so that only the integrators differ.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers.engines.casadi.integrators import Tolerance
from wetdoublet.solvers.engines.casadi.locate import locate
from wetdoublet.solvers.engines.casadi.replay import Stopped, replay
from wetdoublet.solvers.host.environment import environment
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Flow, Region

from .measured.answers import Impact, dimensionless
from .measured.reference import reference
from .measured.tasks import TASKS, Task

RTOLS = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11)
COUNT = 60  # impacts drawn a task, by the seed of the benchmark


def errors(task: Task, impact: Impact) -> dict[str, list[float | None]] | None:
    """Errors by engine at every tolerance; None for a stick."""
    n = dimensionless(task.scene, impact)
    model = load(select_model(task.scene, True))
    path = locate(model, n.groups, 1e-13)
    if not path.separated:
        return None
    truth = reference(task.scene, impact)
    flow = Flow(model.choice, Region(1, 1, False), ())

    def error(plugin: str, rtol: float) -> float | None:
        try:
            collided = replay(path, plugin, Tolerance(rtol, 1e-3 * rtol), flow, model.start(path.p))
        except Stopped:
            return None
        return abs(model.values("outputs", collided.y, path.p)["restitution"] - truth.restitution)

    shares = {"rosenbrock": ("rosenbrock", 1.0), "cvodes": ("cvodes", 1.0), "cvodes/30": ("cvodes", 1 / 30)}
    return {name: [error(plugin, rtol * share) for rtol in RTOLS] for name, (plugin, share) in shares.items()}


def summary(task: Task) -> list[dict[str, Any]]:
    """Median errors and the median of their ratios, collision by collision."""
    drawn = Task(task.preset, COUNT, task.stokes, task.degrees)
    found = [each for impact in drawn.impacts() if (each := errors(drawn, impact)) is not None]
    rows = []
    for k, rtol in enumerate(RTOLS):
        whole = [each for each in found if all(values[k] for values in each.values())]
        column = {name: np.array([each[name][k] for each in whole], dtype=float) for name in found[0]}
        rows.append(
            {
                "task": task.preset,
                "rtol": rtol,
                "collisions": len(whole),
                "left_out": len(found) - len(whole),
                "median_error": {name: float(np.median(values)) for name, values in column.items()},
                "median_ratio": {
                    name: float(np.median(column[name] / column["rosenbrock"])) for name in ("cvodes", "cvodes/30")
                },
            }
        )
    return rows


def main() -> None:
    """Measure, and write the record."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/engineering/performance")
    folder.mkdir(parents=True, exist_ok=True)
    rows = [row for task in TASKS for row in summary(task)]
    record = {"environment": environment(), "rows": rows}
    (folder / "cvodes_share.json").write_text(json.dumps(record, indent=1) + "\n")
    for row in rows:
        sys.stdout.write(f"{row}\n")


if __name__ == "__main__":
    main()
