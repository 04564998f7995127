"""CPU time of the kernel by order of its series, for each decade of tolerance; writes orders.json.

    python -m tests.benchmarks.orders            measures, prints and writes the record
    python -m tests.benchmarks.orders --print    only prints

Every order that the runtime has, from 8 to 16, at each tolerance from 1e-4 to 1e-13; the impacts of a scene in one
call, all oblique, as collide_many asks for them; orders take turns; the least CPU time of several runs; error in e_n
against order 16 at 1e-13. A decade's cost by an order is the geometric mean over the scenes, of each relative to its
own best order. What is printed last are the fewest orders that lose at most 5 % in every decade, and what the compiled
ones (`ORDERS`) lose.
"""

# ruff: noqa: T201 -- a script that prints
from __future__ import annotations

import itertools
import json
import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.settings import STEPS
from wetdoublet.solvers.engines.taylor.build import compile_all, kernel
from wetdoublet.solvers.engines.taylor.call import Impacts, bind_kernel, variant
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.engines.taylor.orders import order_for
from wetdoublet.solvers.engines.taylor.source import Variant
from wetdoublet.solvers.host.environment import environment
from wetdoublet.solvers.model.model import select_model

from .measured.digits import of_rows
from .measured.tasks import TASKS, Task

ROOT = Path(__file__).resolve().parents[2]
RECORD = ROOT / "docs" / "engineering" / "performance" / "orders.json"

ALL = range(8, 17)
RTOLS = tuple(10.0**-digits for digits in range(4, 14))
RUNS = 12
ALLOWED = 0.05  # loss against the best order


@dataclass(frozen=True)
class Series:
    """A scene, its impacts and its kernels by order."""

    name: str
    impacts: Impacts
    variants: dict[int, Variant]

    @classmethod
    def of(cls, name: str, scene: Scene, task: Task, repeats: int) -> Series:
        drawn = task.impacts()
        stokes, angle = (np.array([getattr(each, word) for each in drawn]) for word in ("stokes", "angle"))
        impacts = Impacts(
            scene, np.tile(scene.speed_of(stokes), repeats), np.tile(np.maximum(angle, 0.02), repeats), {}
        )
        one = variant(scene, select_model(scene, True, fold=True), 1e-9, False)
        return cls(name, impacts, {order: replace(one, order=order) for order in ALL})

    def answers(self, order: int, rtol: float) -> tuple[np.ndarray, float]:
        """Answers, and the CPU time of the call in seconds."""
        library = kernel(self.variants[order])
        assert library is not None
        run, found = bind_kernel(library, rtol, STEPS, jumps=2), np.zeros(self.impacts.angle.size, ANSWER)
        before = time.process_time()
        run(self.impacts, found)
        return found, time.process_time() - before


def cases() -> list[Series]:
    """Both presets of the paper's figures, and what makes a structure larger or a collision longer."""
    wet = Scene.load("granulation")
    partner = wet.with_entries({"partner.radius": 3e-4, "partner.density": 1500.0})
    attracted = Scene.load("granulation-dry-bridge").with_entries({"attraction.hamaker": 1e-18})
    return [
        Series.of("granulation", wet, TASKS[0], 30),
        Series.of("pendulum", Scene.load("pendulum"), TASKS[1], 60),
        Series.of("partner of three times the radius", partner, TASKS[0], 20),
        Series.of("van der Waals attraction, no bridge", attracted, TASKS[0], 5),
    ]


def measured(case: Series) -> list[dict[str, Any]]:
    """For each tolerance: microseconds and largest error by order."""
    exact, _ = case.answers(16, 1e-13)
    rows = []
    for rtol in RTOLS:
        least, error, wrong = dict.fromkeys(ALL, math.inf), dict[int, float](), dict[int, int]()
        for _ in range(RUNS):
            for order in ALL:
                found, cpu = case.answers(order, rtol)
                least[order] = min(least[order], cpu)
                error[order] = float(np.abs(found["shown"][:, 0] - exact["shown"][:, 0]).max())
                wrong[order] = int((found["outcome"] != exact["outcome"]).sum())
        live = int((exact["status"] != 1).sum())
        rows.append({
            "scene": case.name, "rtol": rtol, "microseconds": {k: 1e6 * v / live for k, v in least.items()},
            "error": error, "wrong": wrong,
        })  # fmt: skip
    return rows


def relative(rows: list[dict[str, Any]], rtol: float) -> dict[int, float]:
    """Cost of a decade by each order over that of its best: geometric means over the scenes."""
    own = [row["microseconds"] for row in rows if row["rtol"] == rtol]
    means = {
        order: math.exp(sum(math.log(each[order] / min(each.values())) for each in own) / len(own)) for order in ALL
    }
    return {order: mean / min(means.values()) for order, mean in means.items()}


def largest_loss(rows: list[dict[str, Any]], orders: tuple[int, ...]) -> float:
    """What the decade that fares worst loses if only these orders are compiled."""
    return max(min(relative(rows, rtol)[order] for order in orders) for rtol in RTOLS) - 1


def fewest(rows: list[dict[str, Any]]) -> tuple[float, tuple[int, ...]]:
    """The fewest orders with which no decade loses more than ALLOWED, and the largest loss."""
    for size in range(1, len(ALL)):
        found = min((largest_loss(rows, chosen), chosen) for chosen in itertools.combinations(ALL, size))
        if found[0] <= ALLOWED:
            return found
    return 0.0, tuple(ALL)


def costs(rows: list[dict[str, Any]]) -> str:
    """The table: of each tolerance the compiled order, its loss, and the relative cost of each order."""
    lines = []
    for rtol in RTOLS:
        cost, order = relative(rows, rtol), order_for(rtol)
        errors = [row["error"][order] / rtol for row in rows if row["rtol"] == rtol]
        lines.append(
            {"rtol": f"{rtol:.0e}", "compiled": order, "loss": f"{cost[order] - 1:.1%}", "error/rtol": max(errors)}
            | {str(each): f"{value:.2f}" for each, value in cost.items()}
        )
    return of_rows(lines)


def main() -> None:
    """Measure, say which orders are the fewest, and write the record."""
    found = cases()
    compile_all([each for case in found for each in case.variants.values()])
    rows = [row for case in found for row in measured(case)]
    wrong = sum(sum(row["wrong"].values()) for row in rows)
    loss, chosen = fewest(rows)
    print(costs(rows))  # a script
    print(f"fewest orders: {chosen}, at most {loss:.1%} lost; wrong outcomes: {wrong}")
    if "--print" not in sys.argv:
        RECORD.write_text(json.dumps({"environment": environment(), "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
