"""The whole benchmark as one record: everything that `bench.json` holds and the tables and plots are made of."""

import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from typing import Any

from wetdoublet.solvers.host.environment import environment, one_core

from .cold import cold_start, first_use
from .gradient_work import gradient_work
from .growth import growth
from .near import near
from .peers.engines import Engine, engines
from .peers.heyoka_callbacks import around
from .reference import Reference, references
from .tasks import SEED, TASKS, Task, place
from .work import CALL, FINE, OFTEN, REPEATS, SETS, TOLERANCES, Point, Tell, work

Record = dict[str, Any]
MORE = ("gradient_work", "near", "growth", "first_use")


def bench(
    tasks: Sequence[Task] = TASKS,
    tolerances: Sequence[float] = TOLERANCES,
    repeats: int = REPEATS,
    cold: Callable[[], dict[str, list[float]]] = cold_start,
    which: Sequence[Engine] | None = None,
    more: Sequence[str] = MORE,
    tell: Tell = lambda _: None,
    fine: Sequence[float] = FINE,
    sets: int = SETS,
) -> Record:
    """Run the benchmark.

    Arguments:
        cold: measures the cold start.
        which: engines; by default all that are there.
        more: what else is measured, of MORE.
        tell: is told what goes on.
        fine: tolerances of engines that are fast.
        sets: times the collisions are repeated within one call of an engine that takes many.

    Returns:
        A record that JSON can hold: environment, settings, engines, tasks (references, points), cold start.
    """
    start = time.perf_counter()
    where = environment()  # the load before we add to it
    all_engines = engines() if which is None else which
    tell("cold start")
    started = cold()
    others: dict[str, Any] = {name: [] for name in MORE}
    alone: dict[str, Callable[[], Any]] = {
        "gradient_work": lambda: gradient_work(tasks, repeats, tell),
        "near": lambda: near(tell),
    }
    with one_core():
        found = []
        for task in tasks:
            tell(f"{task.preset}: reference values")
            truths = references(task.scene, task.impacts())
            points = work(task, truths, all_engines, tolerances, repeats, tell, fine, sets)
            found.append(task_record(task, truths, points))
        for name, measure in alone.items():
            if name in more:
                tell(name)
                others[name] = measure()
    for name, measure in (("growth", lambda: growth(tell)), ("first_use", first_use)):
        if name in more:
            tell(name)
            others[name] = measure()
    return {
        "environment": where,
        "settings": {
            "seed": SEED,
            "tolerances": list(tolerances),
            "repeats": repeats,
            "fine": list(fine),
            "often": OFTEN,
            "sets": sets,
            "call": CALL,
            "around_callback": around() if find_spec("heyoka") else None,
        },
        "engines": [{"name": each.name, "missing": each.missing} for each in all_engines],
        "tasks": found,
        **others,
        "cold_start": started,
        "wall": time.perf_counter() - start,
    }


def task_record(task: Task, truths: Sequence[Reference], points: Sequence[Point]) -> Record:
    """What tables and plots show of a task's collisions and points."""
    return {
        "preset": task.preset,
        "drawn": str(task),
        "collisions": _collisions(truths),
        "points": [
            {"engine": point.engine, "rtol": point.rtol, "summary": point.summary(), "said": point.said()}
            for point in points
        ],
    }


def _collisions(truths: Sequence[Reference]) -> Record:
    """How many there are and how well they are known.

    `differences` are the largest of e_n by each other method; `own_error` is the largest difference to the closest of
    them: an estimate of the reference's own error.
    """
    apart = [each for each in truths if each.counts and each.outcome != "stick"]
    others = list(apart[0].computed)[1:] if apart else []
    closest = [
        min(abs(value - each.restitution) for value in list(each.computed.values())[1:])
        for each in truths
        if each.outcome != "stick" and len(each.computed) > 1
    ]
    return {
        "decided_at_first_touch": sum(each.decided for each in truths),
        "counted": sum(each.counts for each in truths),
        "separate": len(apart),
        "reference": next(iter(apart[0].computed)) if apart else None,
        "differences": {
            name: max(abs(each.computed[name] - each.restitution) for each in apart if name in each.computed)
            for name in others
        },
        "own_error": max(closest, default=0.0),
        "left_out": [f"{place(each.impact)} is left out: {each.problem}." for each in truths if each.problem],
    }
