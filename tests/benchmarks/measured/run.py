"""The whole benchmark as one record: everything that `bench.json` holds and the tables and plots are made of."""

import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from typing import Any

from wetdoublet.solvers.host.environment import environment, one_core

from .peers.engines import engines
from .peers.heyoka_callbacks import around
from .processes import cold_start, first_use, growth
from .tasks import SEED, TASKS, Task
from .timing import CALL, OFTEN, REPEATS, Engine, Tell
from .work import Reference, reference, work

Record = dict[str, Any]
MORE = ("growth", "first_use")


def bench(
    tasks: Sequence[Task] = TASKS, repeats: int = REPEATS, cold: Callable[[], dict[str, list[float]]] = cold_start,
    which: Sequence[Engine] | None = None, more: Sequence[str] = MORE, tell: Tell = lambda _: None, call: int = CALL,
) -> Record:  # fmt: skip
    """Run the benchmark, by default of all engines that are there.

    Arguments:
        cold: measures the cold start.
        more: what else is measured, of MORE.
        call: collisions in one call of an engine that takes many, at least.
    """
    start = time.perf_counter()
    where = environment()  # the load before we add to it
    which = engines() if which is None else which
    tell("cold start")
    started, found = cold(), list[Record]()
    others: dict[str, Any] = {name: [] for name in MORE}
    with one_core():
        for task in tasks:
            tell(f"{task.preset}: reference values")
            truths = [reference(task.scene, impact) for impact in task.impacts()]
            points = work(task, truths, which, repeats, tell, call)
            sample = {"preset": task.preset, "drawn": str(task), "collisions": _collisions(truths)}
            found.append(sample | {"points": points})
    others |= {each.__name__: each(tell=tell) for each in (growth, first_use) if each.__name__ in more}
    around_callback = around() if find_spec("heyoka") else None
    settings = {"seed": SEED, "repeats": repeats, "often": OFTEN, "call": call, "around_callback": around_callback}
    listed = [{"name": each.name, "missing": each.missing} for each in which]
    return {
        "environment": where, "settings": settings, "engines": listed, "tasks": found, **others, "cold_start": started,
        "wall": time.perf_counter() - start,
    }  # fmt: skip


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
        "left_out": [f"{each.impact} is left out: {each.problem}." for each in truths if each.problem],
    }
