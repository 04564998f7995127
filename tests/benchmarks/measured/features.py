"""What a ledger, a trajectory and the rotation cost: switched on one at a time, as ratios to the bare collision."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.settings import RTOL
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.scene.scene import Scene

from .answers import Impact
from .reference import Reference
from .tasks import Task

FEATURES = ("ledger", "trajectory", "rotation")
TOGETHER = FEATURES[:2]
IN_BULK = {"rosenbrock, compiled": "rosenbrock", "taylor": "taylor"}
ENGINES = ("cvodes", "rosenbrock", *IN_BULK)
_FEW = 100  # collisions in one call that are not compiled for
_MANY = 40  # times the collisions in one call of the kernel, so that what a call costs does not show


@dataclass(frozen=True)
class Cost:
    """Mean CPU time (s) of a collision with some features on, best of the repeats, and its ratio to none."""

    task: str
    engine: str
    outcome: str  # "separating" or "stick"
    collisions: int
    on: tuple[str, ...]
    cpu: float
    ratio: float


Setup = tuple[str, ...]
_SETUPS: tuple[Setup, ...] = ((), *((name,) for name in TOGETHER), TOGETHER)
_OF_MANY: tuple[Setup, ...] = ((), ("rotation",))


def costs(
    task: Task, references: Sequence[Reference], repeats: int = 3, engines: Sequence[str] = ENGINES
) -> list[Cost]:
    """The table of a task at the default tolerance."""
    found = []
    for outcome in ("separating", "stick"):
        impacts = [
            each.impact for each in references if each.counts and (each.outcome == "stick") == (outcome == "stick")
        ]
        if impacts:
            for name in engines:
                found += _of_engine(task, name, outcome, impacts, repeats)
    return found


def _of_engine(task: Task, name: str, outcome: str, impacts: list[Impact], repeats: int) -> list[Cost]:
    """One engine's rows; those of many collisions have neither ledger nor trajectory."""
    compiled = name in IN_BULK
    if compiled and compiler() is None:
        return []
    setups = _OF_MANY if compiled else _SETUPS
    copies = (_MANY if name == "taylor" else 1 + _FEW // len(impacts)) if compiled else 1
    runs = {
        on: _in_bulk(task.scene, impacts * copies, name, on) if compiled else _chained(task.scene, impacts, name, on)
        for on in setups
    }
    best = dict.fromkeys(setups, float("inf"))
    for turn in range(repeats + 1):  # the first pass builds
        for on, run in runs.items():
            start = time.process_time()
            run()
            taken = time.process_time() - start
            best[on] = min(best[on], taken) if turn else best[on]
    count = len(impacts)
    return [
        Cost(task.preset, name, outcome, count, on, best[on] / (count * copies), best[on] / best[()]) for on in setups
    ]


def _chained(scene: Scene, impacts: list[Impact], plugin: str, on: Setup) -> Callable[[], object]:
    with_features: Any = {"ledger": "ledger" in on, "trajectory": "trajectory" in on}
    return lambda: [
        collide(scene, stokes=each.stokes, angle=each.angle, rtol=RTOL, engine=plugin, **with_features)
        for each in impacts
    ]


def _in_bulk(scene: Scene, impacts: list[Impact], name: str, on: Setup) -> Callable[[], object]:
    stokes, angle = (np.array([getattr(each, what) for each in impacts]) for what in ("stokes", "angle"))
    of = ("outcome", "restitution", *(["rotation"] if "rotation" in on else []))
    return lambda: collide_many(scene, stokes=stokes, angle=angle, engine=IN_BULK[name], of=of)
