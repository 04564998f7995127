"""Run time and achieved error of every engine at every tolerance, on the same collisions in the same run."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import ComputationError
from .engines import Answer, Collide, Engine
from .reference import Reference
from .tasks import Task

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
REPEATS = 3  # the best of so many counts
_LONG = 0.1  # s: a collision that takes longer is not repeated

Tell = Callable[[str], None]


@dataclass
class Timed:
    """One collision by one engine: the best CPU and wall time (s) of its runs."""

    cpu: float = math.inf
    wall: float = math.inf
    runs: int = 0
    outcome: str = ""
    restitution: float | None = None
    failure: str = ""

    def run(self, one: Callable[[], Answer]) -> None:
        """Run once more and keep what was best."""
        cpu, wall = time.process_time(), time.perf_counter()
        try:
            found = one()
            self.outcome, self.restitution = found.outcome, found.restitution
        except ComputationError as error:
            self.failure = str(error)
        self.cpu, self.wall = min(self.cpu, time.process_time() - cpu), min(self.wall, time.perf_counter() - wall)
        self.runs += 1


@dataclass(frozen=True)
class Point:
    """One engine at one tolerance on the collisions of a task that count."""

    task: str
    engine: str
    rtol: float
    timed: list[Timed]
    references: list[Reference] = field(repr=False)

    def errors(self) -> list[float | None]:
        """Absolute error in e_n; None where the outcome is wrong, not reached, or a stick (which is exactly 0)."""
        return [
            None
            if run.restitution is None or run.outcome != truth.outcome or truth.outcome == "stick"
            else abs(run.restitution - truth.restitution)
            for run, truth in zip(self.timed, self.references, strict=True)
        ]

    def summary(self) -> dict[str, float | int | None]:
        """Seconds and errors over all collisions; None without a collision to compare."""
        errors = [error for error in self.errors() if error is not None]
        cpu, wall = [run.cpu for run in self.timed], [run.wall for run in self.timed]
        return {
            "cpu_median": float(np.median(cpu)),
            "cpu_total": sum(cpu),
            "cpu_mean": sum(cpu) / len(cpu),
            "wall_median": float(np.median(wall)),
            "wall_total": sum(wall),
            "error_largest": max(errors, default=None),
            "error_median": float(np.median(errors)) if errors else None,
            "wrong": sum(
                run.restitution is not None and run.outcome != truth.outcome
                for run, truth in zip(self.timed, self.references, strict=True)
            ),
            "failed": sum(run.restitution is None for run in self.timed),
        }


def work(
    task: Task,
    references: Sequence[Reference],
    engines: Sequence[Engine],
    tolerances: Sequence[float] = TOLERANCES,
    repeats: int = REPEATS,
    tell: Tell = lambda _: None,
) -> list[Point]:
    """Measure all engines that are there; they take turns, so that a busy machine slows all alike."""
    counted = [each for each in references if each.counts]
    impacts = [each.impact for each in counted]
    if not impacts:
        return []
    ready: list[tuple[Engine, Point, Collide]] = []
    for rtol in tolerances:
        for engine in engines:
            if not engine.missing:
                point = Point(task.preset, engine.name, rtol, [Timed() for _ in impacts], counted)
                ready.append((engine, point, engine.prepare(task.scene, impacts, rtol)))
    for engine, point, one in ready:
        if engine.builds or point.rtol == max(tolerances):
            tell(f"{task.preset}: building {point.engine} {point.rtol:.0e}")
            _warm(one, len(impacts))
    for turn in range(repeats):
        for _, point, one in ready:
            tell(f"{task.preset}: {turn + 1}/{repeats} {point.engine} {point.rtol:.0e}")
            for k, timed in enumerate(point.timed):
                if turn == 0 or timed.wall < _LONG:
                    timed.run(lambda k=k, one=one: one(k))  # type: ignore[misc]  # the defaults bind this turn's
    return [point for _, point, _ in ready]


def _warm(one: Collide, count: int) -> None:
    """A pass that builds and caches whatever is needed."""
    for k in range(count):
        Timed().run(lambda k=k: one(k))  # type: ignore[misc]  # the default binds this turn's
