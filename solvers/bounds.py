"""Boundaries between outcomes, traced: every Stokes number at which the outcome changes, angle by angle.

Changes are roots of functions that are smooth through them (`probe`), found by a safeguarded secant method and followed
from one angle to the next; a coarse scan starts the tracing and takes over where the pattern changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from .changes import Change, between, followed
from .compiled import hush
from .cores import usable_cores
from .errors import ComputationError, InputError
from .probe import Line
from .requests import checked_numbers
from .scene import Scene
from .settings import RTOL, check_rtol
from .taylor.library import knows
from .validity import warn

STOKES = (1e-4, 100.0)
SHARPEST = 1e-13
_PER_DECADE = 1.7  # of the coarse scan
_BESIDE = 2.0  # factor about the changes of two lines in which those between them are looked for
_SURROUND = 1.3  # where the pattern of changes is another one than at the last angle
_CLOSE = 6  # times that the angles about a change of pattern are halved for a picture
_WORTH, _WORTH_BY_KERNEL = 30, 200  # angles that are worth starting a process for
_AROUND, _NEAR = 3e-3, 1e-4  # relative doubt of a prediction from two lines, and at least from three


@dataclass(frozen=True)
class Boundaries:
    """Changes of outcome for each angle (rad), ascending in St, and how many collisions they took.

    `failures` has the reason of each line that could not be traced (its changes are then empty), else "".
    """

    angles: tuple[float, ...]
    changes: tuple[tuple[Change, ...], ...]
    collisions: int
    failures: tuple[str, ...] = ()

    @property
    def failed(self) -> tuple[tuple[float, str], ...]:
        """Angle and reason of the lines that could not be traced."""
        return tuple(pair for pair in zip(self.angles, self.failures, strict=True) if pair[1])

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --json`."""
        return {"angles": list(self.angles), "changes": [[one.to_dict() for one in line] for line in self.changes]}

    def __str__(self) -> str:
        lines = ["angle (deg)   St              Ce          change"]
        for angle, changes in zip(self.angles, self.changes, strict=True):
            for one in changes:
                ce = "-" if one.centrifugal is None else f"{one.centrifugal:.6g}"
                lines.append(f"{math.degrees(angle):<13.6g} {one.stokes:<15.10g} {ce:<11} {one.before} -> {one.after}")
            if not changes:
                failure = next((reason for at, reason in self.failed if at == angle), "no change")
                lines.append(f"{math.degrees(angle):<13.6g} {failure}")
        points = sum(len(changes) for changes in self.changes)
        per = f", {self.collisions / points:.1f} a point" if points else ""
        return "\n".join([*lines, f"{points} points from {self.collisions} collisions{per}"])


@dataclass
class Traced:
    """Changes and failures of consecutive angles, and the collisions they took."""

    changes: list[tuple[Change, ...]]
    failures: list[str]
    collisions: int


def boundary(
    scene: Scene | str | FilePath,
    *,
    angle: Any = None,
    stokes: tuple[float, float] = STOKES,
    rtol: float = RTOL,
    progress: Callable[[int], None] | None = None,
) -> Boundaries:
    """Every change of outcome along lines of constant angle.

    Arguments:
        scene: a Scene, a path or a preset's name.
        angle: impact angles in rad, a number or 1-D; default the scene's. Traced in ascending order.
        stokes: lowest and highest Stokes number.
        rtol: relative tolerance of the integrations.
        progress: called with the number of angles done.

    Returns:
        Boundaries, in the order of the angles given.

    Raises:
        InputError: an angle or Stokes number that cannot be. A line that fails is no error, it is marked.

    Example:
        >>> from wetdoublet.solvers import boundary
        >>> [round(one.stokes, 6) for one in boundary("granulation", angle=0.9599310885968813).changes[0]]
        [0.034232, 0.118639]
    """
    loaded = Scene.load(scene)
    angles = checked_numbers("impact.angle", loaded.angle if angle is None else angle).reshape(-1)
    low, high = (float(value) for value in checked_numbers("impact.stokes", stokes))
    if not low < high:
        raise InputError("stokes", f"{low}:{high}", "LO:HI with LO below HI", "is not ascending")
    rtol = check_rtol(rtol)
    warn(loaded)
    order = np.argsort(angles, kind="stable")
    worth = _WORTH_BY_KERNEL if knows(loaded) else _WORTH
    cores = min(usable_cores(), max(1, angles.size // worth))  # each part starts with a scan of its own
    parts = np.array_split(angles[order], cores)
    whole = Traced([], [], 0)
    tell = progress or (lambda _done: None)
    for part in _traces(loaded, parts, (low, high), rtol, tell):
        whole.changes += part.changes
        whole.failures += part.failures
        whole.collisions += part.collisions
        tell(len(whole.changes))
    back = np.argsort(order, kind="stable")
    return Boundaries(
        tuple(angles.tolist()),
        tuple(whole.changes[k] for k in back),
        whole.collisions,
        tuple(whole.failures[k] for k in back),
    )


def closed(scene: Scene, found: Boundaries, stokes: tuple[float, float], rtol: float = RTOL) -> Boundaries:
    """`found` with more angles where one pattern of changes gives way to another, up to where its curves meet.

    Between two neighbours the place is halved in on: 1/64 of their distance is left.
    """
    lines = sorted(zip(found.angles, found.changes, found.failures or [""] * len(found.angles), strict=True))
    more, collisions = list(lines), found.collisions
    for one, other in pairwise(lines):
        low, high = one, other
        around = [change.stokes for change in (*low[1], *high[1])]
        if low[2] or high[2] or _pattern(low[1]) == _pattern(high[1]):
            continue
        span = max(stokes[0], min(around) / _BESIDE), min(stokes[1], max(around) * _BESIDE)
        for _ in range(_CLOSE):
            traced = trace(scene, np.array([(low[0] + high[0]) / 2]), span, rtol)
            collisions += traced.collisions
            if traced.failures[0]:
                break
            middle = ((low[0] + high[0]) / 2, traced.changes[0], "")
            more.append(middle)
            low, high = (middle, high) if _pattern(middle[1]) == _pattern(low[1]) else (low, middle)
    angles, changes, failures = zip(*sorted(more), strict=True)
    return Boundaries(angles, changes, collisions, failures)


def _pattern(changes: tuple[Change, ...]) -> list[tuple[str, str]]:
    return [(one.before, one.after) for one in changes]


def _traces(
    scene: Scene, parts: Sequence[np.ndarray], span: tuple[float, float], rtol: float, tell: Callable[[int], None]
) -> Iterator[Traced]:
    """All parts in their order: the first in this process, which `tell` is told of, the others in one each."""
    others = []
    if len(parts) > 1:
        from loky import get_reusable_executor

        pool = get_reusable_executor(max_workers=len(parts) - 1, initializer=hush)
        others = [pool.submit(trace, scene, part, span, rtol) for part in parts[1:]]
    yield trace(scene, parts[0], span, rtol, tell)
    for other in others:
        yield other.result()


def trace(
    scene: Scene,
    angles: np.ndarray,
    span: tuple[float, float],
    rtol: float,
    tell: Callable[[int], None] = lambda _done: None,
) -> Traced:
    """Changes at ascending angles, each line started from the ones before.

    A line that fails is tried again from a scan, and a hundred times sharper; then it is left out with its reason.
    """
    traced = Traced([], [], 0)
    lines: list[tuple[Change, ...]] = []
    known: list[float] = []
    for angle in angles.tolist():
        changes: list[Change] | None = None
        reason = ""
        for sharper, follow in ((1.0, True), (1.0, False), (1e-2, False)):
            line = Line(scene, angle, max(rtol * sharper, SHARPEST))
            try:
                if follow and lines:
                    changes = _followed(line, np.array(known), lines, span) or between(line, _near(lines[-1], span))
                changes = changes or between(line, _even(span))
            except ComputationError as error:
                reason = str(line.numbers(span[0]).in_si(error)) if error.state else str(error)
            finally:
                traced.collisions += line.collisions
            if changes is not None:
                break
        traced.changes.append(tuple(changes or ()))
        traced.failures.append("" if changes is not None else reason)
        if changes is not None:
            lines.append(tuple(changes))
            known.append(angle)
        tell(len(traced.changes))
    return traced


def _even(span: tuple[float, float]) -> list[float]:
    decades = math.log10(span[1] / span[0])
    grid = np.geomspace(*span, max(3, 1 + math.ceil(decades * _PER_DECADE)))
    return [span[0], *grid[1:-1].tolist(), span[1]]


def _near(changes: tuple[Change, ...], span: tuple[float, float]) -> list[float]:
    """Stokes numbers that surround the changes of another line."""
    around = [one.stokes * part for one in changes for part in (1 / _SURROUND, _SURROUND)]
    return [span[0], *sorted(value for value in around if span[0] < value < span[1]), span[1]]


def _followed(
    line: Line, angles: np.ndarray, lines: list[tuple[Change, ...]], span: tuple[float, float]
) -> list[Change] | None:
    """Changes near their prediction from the lines before; None if the pattern is another one."""
    last = lines[-1]
    same = 1
    while same < min(3, len(lines)) and [one.kind for one in lines[-1 - same]] == [one.kind for one in last]:
        same += 1
    predicted, doubts = [], []
    for k in range(len(last)):
        history = [math.log(line_[k].stokes) for line_ in lines[-same:]]
        straight, bent = _extrapolated(angles[-same:], history, line.angle)
        predicted.append(math.exp(bent))
        doubts.append(_AROUND if same > 1 and bent == straight else _NEAR + abs(bent - straight) if same > 1 else 0.03)
    return followed(line, last, predicted, doubts, span)


def _extrapolated(angles: np.ndarray, values: list[float], angle: float) -> tuple[float, float]:
    """Extrapolation through the last points, and the one of one order less."""
    orders = []
    for count in (max(1, len(values) - 1), len(values)):
        at, of = angles[-count:], values[-count:]
        total = 0.0
        for k in range(count):
            others = np.delete(at, k)
            total += of[k] * float(np.prod((angle - others) / (at[k] - others))) if count > 1 else of[k]
        orders.append(total)
    return orders[0], orders[1]
