"""The whole benchmark as one record: everything that `bench.json` holds and the tables and plots are made of."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from .cold import cold_start
from .engines import Engine, engines
from .environment import environment, one_core
from .features import HORIZON, Cost, costs
from .growth import growth
from .lines import lines
from .needs import gradients, structures
from .reference import Reference, references
from .tasks import SEED, TASKS, Task
from .work import REPEATS, SETS, TOLERANCES, Point, Tell, work

Record = dict[str, Any]
MORE = ("structures", "gradients", "lines", "growth")


def bench(
    tasks: Sequence[Task] = TASKS,
    tolerances: Sequence[float] = TOLERANCES,
    repeats: int = REPEATS,
    cold: Callable[[], dict[str, list[float]]] = cold_start,
    which: Sequence[Engine] | None = None,
    more: Sequence[str] = MORE,
    tell: Tell = lambda _: None,
) -> Record:
    """Run the benchmark.

    Arguments:
        cold: measures the cold start.
        which: engines; by default all that are there.
        more: what else is measured, of MORE.
        tell: is told what goes on.

    Returns:
        A record that JSON can hold: environment, settings, engines, tasks (references, points, costs), cold start.
    """
    start = time.perf_counter()
    where = environment()  # the load before we add to it
    all_engines = engines() if which is None else which
    tell("cold start")
    started = cold()
    with one_core():
        found = [_task(task, all_engines, tolerances, repeats, tell) for task in tasks]
        others = {}
        for name, measure in (("structures", structures), ("gradients", gradients), ("lines", lines)):
            tell(name)
            others[name] = measure() if name in more else []
    others["growth"] = growth(tell) if "growth" in more else []
    return {
        "environment": where,
        "settings": {
            "seed": SEED,
            "tolerances": list(tolerances),
            "repeats": repeats,
            "sets": SETS,
            "horizon": HORIZON,
        },
        "engines": [{"name": each.name, "missing": each.missing} for each in all_engines],
        "tasks": found,
        **others,
        "cold_start": started,
        "wall": time.perf_counter() - start,
    }


def _task(task: Task, all_engines: Sequence[Engine], tolerances: Sequence[float], repeats: int, tell: Tell) -> Record:
    tell(f"{task.preset}: reference values")
    truths = references(task.scene, task.impacts())
    points = work(task, truths, all_engines, tolerances, repeats, tell)
    tell(f"{task.preset}: certificate, ledger, trajectory")
    return {
        "preset": task.preset,
        "drawn": str(task),
        "collisions": [_truth(each) for each in truths],
        "points": [_point(each) for each in points],
        "costs": [_cost(each) for each in costs(task, truths, repeats)],
    }


def _truth(truth: Reference) -> Record:
    return {
        "stokes": truth.impact.stokes,
        "angle": math.degrees(truth.impact.angle),
        "outcome": truth.outcome,
        "restitution": truth.restitution,
        "decided_at_first_touch": truth.decided,
        "largest_difference": truth.difference,
        "computed": truth.computed,
        "problem": truth.problem,
    }


def _point(point: Point) -> Record:
    runs = [asdict(run) | {"error": error} for run, error in zip(point.timed, point.errors(), strict=True)]
    return {"engine": point.engine, "rtol": point.rtol, "summary": point.summary(), "runs": runs}


def _cost(cost: Cost) -> Record:
    return {name: value for name, value in asdict(cost).items() if name != "task"} | {"on": list(cost.on)}
