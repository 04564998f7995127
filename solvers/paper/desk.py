"""Boundaries that several parts share, traced once a run; and how finely everything is drawn."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .. import boundary
from ..errors import ComputationError
from ..scene import Scene
from ..simulate import collide

if TYPE_CHECKING:
    from ..bounds import Boundaries
    from ..changes import Change

Line = tuple["Change", ...]
Job = tuple[Scene, Sequence[float]]

_FEW = 12  # angles; more are shared out among the cores by `boundary` itself
_TOP = 89.0  # degrees, the highest line of a map
_ROUND = 9  # angles put between two whose outcomes differ


@dataclass(frozen=True)
class Detail:
    """How finely the figures are drawn.

    Arguments:
        step: degrees between lines of a regime map.
        rounds: how often the lines between which a region begins are refined.
        curve: points a curve of Fig. 4b has on either side of a boundary.
    """

    step: float = 2.5
    rounds: int = 2
    curve: int = 40


class Desk:
    """What has been traced, by scene and angle; `say` is told what is being done."""

    def __init__(self, detail: Detail | None = None, say: Callable[[str], None] | None = None) -> None:
        self.detail = detail or Detail()
        self.collisions = 0
        self._say = say or (lambda _: None)
        self._known: dict[Scene, dict[float, Line]] = {}
        self._failed: dict[Scene, dict[float, str]] = {}

    def say(self, what: str) -> None:
        """Tell what is being done."""
        self._say(what)

    def lines(self, scene: Scene, angles: Iterable[float]) -> list[Line]:
        """Changes of outcome at each angle (rad), in their order."""
        return self.many([(scene, tuple(angles))])[0]

    def many(self, jobs: Sequence[Job]) -> list[list[Line]]:
        """The lines of several scenes; what is not known yet is traced on all cores."""
        wanted: dict[Scene, list[float]] = {}
        for scene, angles in jobs:
            known, missing = self._known.setdefault(scene, {}), wanted.setdefault(scene, [])
            missing += [angle for angle in angles if angle not in known and angle not in missing]
        small = [(scene, tuple(angles)) for scene, angles in wanted.items() if 0 < len(angles) < _FEW]
        large = [(scene, tuple(angles)) for scene, angles in wanted.items() if len(angles) >= _FEW]
        found = [(job, _trace(*job)) for job in large]
        found += zip(small, _shared_out(small))
        for (scene, _), traced in found:
            self.collisions += traced.collisions
            self._known[scene] |= dict(zip(traced.angles, traced.changes))
            self._failed.setdefault(scene, {}).update(traced.failed)
        return [[self._line(scene, angle) for angle in angles] for scene, angles in jobs]

    def _line(self, scene: Scene, angle: float) -> Line:
        if reason := self._failed.get(scene, {}).get(angle):
            raise ComputationError(f"boundaries of {scene.name} at {math.degrees(angle):.4g} deg: {reason}")
        return self._known[scene][angle]

    def map(self, scene: Scene, first: float = 0.0) -> tuple[list[float], list[Line]]:
        """Angles (rad) of a regime map from `first` degrees on, crowded where a region begins; their lines."""
        steps = np.arange(0.0, _TOP, self.detail.step).tolist()
        angles = [math.radians(value) for value in sorted({first, *(v for v in steps if v > first), _TOP})]
        lines = self.lines(scene, angles)
        for _ in range(self.detail.rounds):
            between = [
                (low, high)
                for (low, here), (high, there) in pairwise(zip(angles, lines))
                if outcomes(here) != outcomes(there)
            ]
            if not between:
                break
            angles = sorted({*angles, *(new for ends in between for new in np.linspace(*ends, _ROUND + 2).tolist())})
            lines = self.lines(scene, angles)
        return angles, lines


def outcomes(line: Line) -> tuple[str, ...]:
    """The outcomes along a line of constant angle, going up in St."""
    return (line[0].before, *(change.after for change in line)) if line else ()


def change_at(line: Line, before: str) -> Change:
    """The change at which an outcome ends; LookupError if it does not."""
    for change in line:
        if change.before == before:
            return change
    raise LookupError(f"no change from {before}")


def criterion_met(scene: Scene, low: float, high: float, angle: float = 0.0, rtol: float = 1e-7) -> float:
    """The Stokes number, between `low` and `high`, from which a reversal criterion is met, bisected to `rtol`."""

    def met(stokes: float) -> bool:
        one = collide(scene, stokes=stokes, angle=angle, engine="rosenbrock", ledger=False)
        return one.reversal is not None

    if met(low) or not met(high):
        raise ValueError(f"no criterion is first met between St {low:g} and {high:g}")
    while high - low > rtol * high:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if met(middle) else (middle, high)
    return math.sqrt(low * high)


def _trace(scene: Scene, angles: Sequence[float]) -> Boundaries:
    return boundary(scene, angle=list(angles))


def _shared_out(jobs: Sequence[Job]) -> list[Boundaries]:
    """Small traces, each by one core."""
    if len(jobs) < 2:
        return [_trace(*job) for job in jobs]
    from loky import get_reusable_executor

    pool = get_reusable_executor(max_workers=os.cpu_count() or 1)
    return list(pool.map(_trace, *zip(*jobs)))


def progress() -> Callable[[str], None]:
    """Words on standard error on a terminal, each in place of the last; nothing elsewhere."""
    if not sys.stderr.isatty():
        return lambda _: None

    def say(what: str) -> None:
        sys.stderr.write(f"\r\x1b[K{what}")
        sys.stderr.flush()

    return say
