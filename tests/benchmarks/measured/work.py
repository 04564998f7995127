"""Run time and achieved error of every engine at every tolerance, on the same collisions in the same run."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.scene.scene import Scene

from .answers import Answer, Impact
from .peers.bulk import Bulk, left_out
from .peers.engines import Engine
from .reference import Reference
from .tasks import Task, place

TOLERANCES = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
FINE = tuple(
    10 ** (-0.5 * k) for k in range(12, 27)
)  # of fast engines: a coarse step would cost them more than it tells
REPEATS = 3  # the best of so many counts
OFTEN = 7  # times as many of fast engines
SETS = 20  # times all collisions are repeated in one call of an engine that takes many
CALL = 1000  # collisions in one call of a fast one, at least
_LONG = 0.05  # s: a collision that takes longer is not repeated
_DEAR = 2.0  # s: an engine whose collisions take longer in all is not asked for a tighter tolerance

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

    def share(self, found: Answer | str, cpu: float, wall: float) -> None:
        """Take this collision's part of a call for many."""
        if isinstance(found, str):
            self.failure = found
        else:
            self.outcome, self.restitution = found.outcome, found.restitution
        self.cpu, self.wall, self.runs = min(self.cpu, cpu), min(self.wall, wall), self.runs + 1

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
            "cpu_mean": sum(cpu) / len(cpu),
            "wall_mean": sum(wall) / len(wall),
            "error_largest": max(errors, default=None),
            "error_median": float(np.median(errors)) if errors else None,
            "wrong": sum(
                run.restitution is not None and run.outcome != truth.outcome
                for run, truth in zip(self.timed, self.references, strict=True)
            ),
            "failed": sum(run.restitution is None for run in self.timed),
        }

    def said(self) -> dict[str, list[str]]:
        """What the engine said of collisions that failed or came out wrong, and where."""
        found: dict[str, list[str]] = {}
        for run, truth in zip(self.timed, self.references, strict=True):
            wrong = f"{run.outcome} instead of {truth.outcome}" if run.outcome != truth.outcome else ""
            if what := run.failure or wrong:
                found.setdefault(what, []).append(place(truth.impact))
        return found


def work(
    task: Task,
    references: Sequence[Reference],
    engines: Sequence[Engine],
    tolerances: Sequence[float] = TOLERANCES,
    repeats: int = REPEATS,
    tell: Tell = lambda _: None,
    fine: Sequence[float] = FINE,
    sets: int = SETS,
) -> list[Point]:
    """Measure all engines that are there; they take turns, so that a busy machine slows all alike.

    Arguments:
        fine: tolerances of engines that are fast.
        sets: times the collisions are repeated within one call of an engine that takes many; more of fast ones.
    """
    counted = [each for each in references if each.counts]
    impacts = [each.impact for each in counted]
    if not impacts:
        return []
    ready: list[tuple[Engine, Point, Work]] = []
    dear: set[str] = set()
    asked = [(each, rtol) for each in engines for rtol in sorted(fine if each.fast else tolerances, reverse=True)]
    for engine, rtol in asked:
        if engine.missing or engine.name in dear:
            continue
        tell(f"{task.preset}: {engine.name} {rtol:.1e}")
        point = Point(task.preset, engine.name, rtol, [Timed() for _ in impacts], counted)
        copies = max(sets, -(-CALL // len(impacts))) if engine.fast else sets
        one = _prepared(engine, task.scene, impacts, rtol, point, copies)
        if engine.builds:
            one()  # builds and caches whatever is needed; what it takes does not count
            point.timed[:] = [Timed() for _ in impacts]
        start = time.process_time()
        one()
        if time.process_time() - start > _DEAR:
            dear.add(engine.name)
        ready.append((engine, point, one))
    for turn in range(1, repeats):
        for engine, point, one in ready:
            tell(f"{task.preset}: {turn + 1}/{repeats} {point.engine} {point.rtol:.0e}")
            for _ in range(OFTEN if engine.fast else 1):
                one()
    return [point for _, point, _ in ready]


Work = Callable[[], None]


def _prepared(engine: Engine, scene: Scene, impacts: list[Impact], rtol: float, point: Point, copies: int) -> Work:
    """A pass over all collisions that leaves what it found in the point; a long collision is not repeated."""
    if engine.many is not None:
        try:
            bulk = engine.many(scene, impacts * copies, rtol)
        except ComputationError as error:
            said = str(error)
            bulk = Bulk(lambda: None, lambda _: [said] * (copies * len(impacts)))
        return lambda: _shared(bulk, point)
    assert engine.one is not None
    one = engine.one(scene, impacts, rtol)

    def work() -> None:
        for k, timed in enumerate(point.timed):
            if not timed.runs or timed.wall < _LONG:
                timed.run(lambda k=k: one(k))  # type: ignore[misc]  # the default binds this turn's

    return work


def _shared(bulk: Bulk, point: Point) -> None:
    """One call for several times all collisions; each has its part of the time, and is wrong if it ever was."""
    cpu, wall = time.process_time(), time.perf_counter()
    result = bulk.run()
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    cpu, wall = cpu - left_out(bulk.run), wall - left_out(bulk.run)
    found, count = bulk.read(result), len(point.timed)
    cpu, wall = cpu / len(found), wall / len(found)
    for k, timed in enumerate(point.timed):
        answers, truth = found[k::count], point.references[k]
        worst = max(answers, key=lambda each: math.inf if isinstance(each, str) else _off(each, truth))
        timed.share(worst, cpu, wall)


def _off(found: Answer, truth: Reference) -> float:
    return 1e9 if found.outcome != truth.outcome else abs(found.restitution - truth.restitution)
