"""Boundaries shared by several parts and traced once per run, and the resolution of figures."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ..boundaries.boundary import boundary
from ..boundaries.line import ready
from ..boundaries.look import Look
from ..engines.choice import collision_engine
from ..errors import ComputationError
from ..host.cores import usable_cores
from ..host.workers import lasting_workers
from ..scene.scene import Scene
from ..settings import RTOL
from .parts import number
from .printed import CURVES

if TYPE_CHECKING:
    from ..boundaries.boundary import Boundaries
    from ..boundaries.changes import Change

Line = tuple["Change", ...]
Span = tuple[float, float]  # range of St
Result = TypeVar("Result")

_FEW = 12  # angles; with more, `boundary` itself uses all cores
_TOP = 89.0  # degrees, the highest line of a map
_CORNER = 0.025  # smallest visible corner of a boundary, relative to the width of a map
_AT_ONCE = 9  # collisions in each round of bracketing a criterion
_ROUND, _BEND = 5, 2  # new angles between two whose outcomes differ, and where a boundary moves far


@dataclass(frozen=True)
class Job:
    """A scene, the angles (rad) to trace, and the range of Stokes numbers (None for the default)."""

    scene: Scene
    angles: tuple[float, ...]
    span: Span | None = None

    def trace(self) -> Boundaries:
        """Trace the lines."""
        if self.span is None:
            return boundary(self.scene, angle=list(self.angles))
        return boundary(self.scene, angle=list(self.angles), stokes=self.span)


@dataclass(frozen=True)
class Detail:
    """Resolution of the figures.

    Arguments:
        step: degrees between lines of a regime map.
        rounds: rounds of refinement between lines where a region begins.
        curve: points of a curve of Fig. 4b on each side of a boundary.
        critical: angles (rad) of the table of Ce*.
    """

    step: float = 2.5
    rounds: int = 2
    curve: int = 40
    critical: tuple[float, ...] = CURVES[2:]


class Desk:
    """Cache of traced lines by scene and angle; `say` is called with the current step."""

    def __init__(self, detail: Detail | None = None, say: Callable[[str], None] | None = None) -> None:
        self.detail = detail or Detail()
        self.collisions = 0
        self._say = say or (lambda _: None)
        self._known: dict[tuple[Scene, Span | None], dict[float, Line]] = {}
        self.failures: list[str] = []

    def say(self, what: str) -> None:
        """Report the current step."""
        self._say(what)

    def lines(self, scene: Scene, angles: Iterable[float]) -> list[Line]:
        """Changes of outcome at each angle (rad), in order; empty, with an entry in `failures`, where tracing fails."""
        return self.many([Job(scene, tuple(angles))])[0]

    def many(self, jobs: Sequence[Job]) -> list[list[Line]]:
        """The lines of several jobs; unknown ones are traced on all cores."""
        wanted: dict[tuple[Scene, Span | None], list[float]] = {}
        for job in jobs:
            known = self._known.setdefault((job.scene, job.span), {})
            missing = wanted.setdefault((job.scene, job.span), [])
            missing += [angle for angle in job.angles if angle not in known and angle not in missing]
        todo = [Job(scene, tuple(angles), span) for (scene, span), angles in wanted.items() if angles]
        ready([job.scene for job in todo])
        small = [job for job in todo if len(job.angles) < _FEW and collision_engine(job.scene) != "taylor"]
        large = [job for job in todo if job not in small]
        for job, traced in [*((job, job.trace()) for job in large), *zip(small, shared_out(Job.trace, small))]:
            self.collisions += traced.collisions
            self._known[job.scene, job.span] |= dict(zip(traced.angles, traced.changes))
            name = job.scene.name
            self.failures += [f"{name} at {math.degrees(angle):.4g} deg: {why}" for angle, why in traced.failed]
        return [[self._known[job.scene, job.span][angle] for angle in job.angles] for job in jobs]

    def map(self, scene: Scene, reach: float, first: float = 0.0) -> tuple[list[float], list[Line]]:
        """Angles (rad) of a regime map from `first` degrees on, and their lines.

        They are denser where a region begins, and where a boundary moves far on a map that ends at St = `reach`.
        """
        steps = np.arange(0.0, _TOP, self.detail.step).tolist()
        angles = [math.radians(value) for value in sorted({first, *(v for v in steps if v > first), _TOP})]
        lines = self.lines(scene, angles)
        for _ in range(self.detail.rounds):
            fresh: set[float] = set()
            for (low, here), (high, there) in pairwise(zip(angles, lines)):
                if not (here and there):
                    continue
                begins = outcomes(here) != outcomes(there)
                count = _ROUND if begins else _BEND if _far(here, there, reach) else 0
                fresh.update(np.linspace(low, high, count + 2).tolist()[1:-1])
            if not fresh:
                break
            angles = sorted({*angles, *fresh})
            lines = self.lines(scene, angles)
        return [angle for angle, line in zip(angles, lines) if line], [line for line in lines if line]


def outcomes(line: Line) -> tuple[str, ...]:
    """The outcomes along a line of constant angle, in order of St."""
    return (line[0].before, *(change.after for change in line)) if line else ()


def _far(here: Line, there: Line, reach: float) -> bool:
    """True if a boundary moves enough to be visible as a corner."""
    moved = (abs(min(one.stokes, reach) - min(other.stokes, reach)) for one, other in zip(here, there))
    return max(moved, default=0.0) > _CORNER * reach


def change_at(line: Line, before: str) -> Change:
    """The change at which an outcome ends; ComputationError if there is none."""
    for change in line:
        if change.before == before:
            return change
    raise ComputationError(f"no boundary at which {before} ends was found where the paper has one")


def shown(read: Callable[[], float]) -> str:
    """A number of a table, or `failed` if it cannot be computed, so that the others are still shown."""
    try:
        return number(read())
    except ComputationError:
        return "failed"


def criterion_met(scene: Scene, low: float, high: float, angle: float = 0.0, rtol: float = 1e-6) -> float:
    """The Stokes number between `low` and `high` from which a rebound criterion is met, bracketed to `rtol`."""
    look = Look(scene, RTOL)
    while high - low > rtol * high:
        stokes = np.geomspace(low, high, _AT_ONCE)
        met = look(np.full(stokes.size, angle), stokes)["reversal"] >= 0
        if met[0] or not met[-1]:
            raise ComputationError(f"no criterion is first met between St {low:g} and {high:g}")
        first = int(np.argmax(met))
        low, high = float(stokes[first - 1]), float(stokes[first])
    return math.sqrt(low * high)


def shared_out(function: Callable[[Any], Result], items: Sequence[Any]) -> list[Result]:
    """Results of the function for all items, computed on all cores."""
    if len(items) < 2:
        return [function(item) for item in items]
    with lasting_workers(usable_cores()) as pool:
        return list(pool.map(function, items))


def progress() -> Callable[[str], None]:
    """Progress texts on standard error, each replacing the last; nothing if it is no terminal."""
    if not sys.stderr.isatty():
        return lambda _: None

    def say(what: str) -> None:
        sys.stderr.write(f"\r\x1b[K{what}")
        sys.stderr.flush()

    return say
