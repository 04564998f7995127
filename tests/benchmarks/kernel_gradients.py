"""What the kernel's derivatives cost and how exact they are, beside heyoka's (docs/engineering/kernel-figures.md).

    python -m tests.benchmarks.kernel_gradients            measures, prints, writes the page and its JSON file
    python -m tests.benchmarks.kernel_gradients --print    only prints

25 collisions of each task that separate, repeated in one call; CPU time a collision, the best of some runs
that take turns; the error is the largest of all derivatives of e_n in theta, p = p_ref (1 + theta), over the largest
derivative of their collision, against forward derivatives of Rosenbrock at 1e-12.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import gradients_many
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.engines.taylor.machine import lanes
from wetdoublet.solvers.host.environment import environment
from wetdoublet.solvers.sensitivity.by_kernel import gradients_by_kernel
from wetdoublet.solvers.sensitivity.parameters import known

from .measured.gradient_task import Gradients
from .measured.peers.bulk import left_out
from .measured.tasks import Task

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "engineering" / "kernel-figures.md"
RECORD = PAGE.parent / "performance" / "kernel_gradients.json"

BEGIN, END = "<!-- gradients -->", "<!-- end of gradients -->"
TASKS = (Task("granulation", 60, (0.005, 0.5), 85.0), Task("pendulum", 20, (0.3, 3.0), 80.0))
COLLISIONS, RUNS = 1000, 5  # of a call, so that what a call costs beside them does not show
ERROR = 1e-8
OURS, THEIRS = (1e-7, 1e-8, 3e-9, 1e-9, 1e-10), (1e-7, 1e-8, 1e-9, 1e-10)
HEYOKA, ALONE = "heyoka", "heyoka without callbacks"
SOME = ("liquid.viscosity", "impact.angle", "impact.speed", "particles.reduced_mass")


def least(runs: dict[str, Callable[[], Any]], count: int) -> dict[str, float]:
    """Microseconds a collision of each run, the best of RUNS in which all take turns."""
    found = dict.fromkeys(runs, math.inf)
    for _ in range(RUNS):
        for name, run in runs.items():
            before = time.process_time()
            run()
            taken = time.process_time() - before - left_out(run)
            found[name] = min(found[name], 1e6 * taken / count)
    return found


def of_parameters(asked: Gradients, many: engine.Impacts) -> list[dict[str, Any]]:
    """Cost for 0, 1, 4 and 12 parameters, and what the first use costs."""
    rows = []
    size = len(asked.impacts)
    for rtol in (1e-8, 1e-9, 1e-10, 1e-12):
        runs: dict[str, Callable[[], Any]] = {"value": lambda rtol=rtol: engine.run_kernel(many, rtol)}
        for names in (SOME[:1], SOME, asked.names):
            runs[f"{len(names)}"] = lambda names=names, rtol=rtol: gradients_by_kernel(
                many, asked.kind, names, ("restitution",), rtol, backward=True
            )
            runs[f"{len(names)}, along"] = lambda names=names, rtol=rtol: gradients_by_kernel(
                many, asked.kind, names, ("restitution",), rtol
            )
        found = gradients_by_kernel(many, asked.kind, asked.names, ("restitution",), rtol, backward=True)
        assert found is not None
        error = float(asked.errors(found.first[0, :size]).max())
        rows.append({"rtol": rtol} | least(runs, many.angle.size) | {"largest error": error})
    return rows


def beside(asked: Gradients, many: engine.Impacts) -> dict[str, Any]:
    """The cheapest cost of all twelve derivatives to ERROR: kernel, `gradients_many`, variational heyoka both ways."""
    runs: dict[str, Callable[[], Any]] = {}
    exact: dict[str, float] = {}
    size, wrt = len(asked.impacts), list(asked.names)
    for rtol in OURS:
        runs[f"kernel {rtol}"] = lambda rtol=rtol: gradients_by_kernel(
            many, asked.kind, asked.names, ("restitution",), rtol, backward=True
        )
        found = gradients_by_kernel(many, asked.kind, asked.names, ("restitution",), rtol, backward=True)
        assert found is not None
        exact[f"kernel {rtol}"] = float(asked.errors(found.first[0, :size]).max())
        runs[f"gradients_many {rtol}"] = lambda rtol=rtol: gradients_many(
            asked.scene, speed=many.speed, angle=many.angle, wrt=wrt, rtol=rtol
        )
        rows = runs[f"gradients_many {rtol}"]().gradient.values[0, :size] * asked.units
        exact[f"gradients_many {rtol}"] = float(asked.errors(rows).max())
    if find_spec("heyoka") is not None:
        from .measured.gradient_work import variational_heyoka

        for rtol in THEIRS:
            for name, alone in ((HEYOKA, False), (ALONE, True)):
                run = variational_heyoka(asked, many.angle.size // size, rtol, alone)
                exact[f"{name} {rtol}"] = float(asked.errors(run()[:size]).max())
                runs[f"{name} {rtol}"] = run
    cost = least(runs, many.angle.size)
    row: dict[str, Any] = {"task": asked.scene.name, "collisions": size}
    for name in ("kernel", "gradients_many", HEYOKA, ALONE):
        good = [cost[each] for each in cost if each.rpartition(" ")[0] == name and exact[each] <= ERROR]
        row[name] = min(good) if good else None
    for name in ("kernel", "gradients_many"):
        row[f"{ALONE} / {name}"] = row[ALONE] / row[name] if row[ALONE] and row[name] else None
    row["all"] = {name: {"microseconds": cost[name], "largest error": exact[name]} for name in cost}
    return row


def table(rows: list[dict[str, Any]]) -> str:
    """Markdown."""

    def shown(value: object) -> str:
        return f"{value:.2g}" if isinstance(value, float) else "-" if value is None else str(value)

    heads = [name for name in rows[0] if name != "all"]
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join([*lines, *("| " + " | ".join(shown(row[name]) for name in heads) + " |" for row in rows)])


def main() -> None:
    """Measure everything."""
    record: dict[str, Any] = {"environment": environment(), "lanes": lanes(), "parameters": {}, "beside": []}
    texts = []
    for task in TASKS:
        asked = Gradients.of(task)
        assert set(SOME) <= set(known(asked.scene))
        stokes, angle = (np.array([getattr(each, name) for each in asked.impacts]) for name in ("stokes", "angle"))
        speed = asked.scene.speed_of(stokes)
        repeats = COLLISIONS // stokes.size
        many = engine.Impacts(asked.scene, np.tile(speed, repeats), np.tile(angle, repeats), {})
        rows = of_parameters(asked, many)
        record["parameters"][task.preset] = rows
        record["beside"].append(beside(asked, many))
        texts.append(f"{task.preset}, {stokes.size} collisions that separate:\n\n{table(rows)}\n")
    text = f"""{BEGIN}
Microseconds of CPU a collision, {COLLISIONS} in a call: the value alone, derivatives of e_n by 1, 4 and 12
parameters taken back along the trajectory, and carried along it:

{chr(10).join(texts)}
Derivatives by 12 parameters, the cheapest tolerance whose largest error is below {ERROR:g}, all in one run:

{table(record["beside"])}
{END}"""
    print(text)  # noqa: T201 # a script
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps(record, indent=1, default=str) + "\n")
        page = PAGE.read_text()
        PAGE.write_text(page[: page.index(BEGIN)] + text + page[page.index(END) + len(END) :])


if __name__ == "__main__":
    main()
