"""`prove_boundary`: two Stokes numbers of proved opposite outcomes, as near to each other as they get."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..engines.interval.call import BOX, OUTCOME, enclose
from ..engines.interval.inputs import Inputs
from ..engines.interval.prove import Proof, prove_inputs
from ..errors import ComputationError, InputError
from ..scene.items import item
from ..scene.origin import Result
from ..scene.scene import Scene

_LINES = 48  # points of a line between which changes are looked for
_MOST = 60  # halvings
_NARROW = 1e-5  # relative width of boxes that are followed in sharper steps where those of boxes prove nothing
_SHARP = OUTCOME._replace(steps=2000)
_PART = 1 / 8  # least width of a stretch, as a part of its distance from the nearest change
Stretch = tuple[float, float]


class Change(NamedTuple):
    """Two Stokes numbers and their proved outcomes, between which the outcome changes at least once.

    Attributes:
        within: ends of the stretch around both beyond which the outcome is proved for every Stokes number, up to the
            next stretch of the line that is not. How often it changes within is not shown.
    """

    stokes: Stretch
    outcomes: tuple[str, str]
    within: Stretch

    @property
    def width(self) -> float:
        """Relative distance of both."""
        return self.stokes[1] / self.stokes[0] - 1


class ProvedBoundary(Result):
    """Changes of outcome along a line of constant angle (rad), each between two proved collisions.

    Example:
        >>> from wetdoublet.solvers import prove_boundary
        >>> prove_boundary("granulation", angle="10 deg", stokes=(0.25, 0.35)).changes
        ()
    """

    _keys = "angle changes undecided"

    scene: Scene
    angle: float
    changes: tuple[Change, ...]
    proved: tuple[Stretch, ...] = item(
        "stretches with one proved outcome each; neighbours have an end in common, or nothing is proved between"
    )
    undecided: tuple[Stretch, ...] = item(
        "what lies between two of them with the same outcome. Where there is none, every change of the line is within "
        "one of `changes`"
    )

    def __str__(self) -> str:
        counted = f"{len(self.changes)} change{'' if len(self.changes) == 1 else 's'}"
        lines = [f"at {math.degrees(self.angle):.10g} deg: {counted} between proved outcomes"]
        for change in self.changes:
            (low, high), (before, other) = change.stokes, change.outcomes
            named = f"{before} at St {low:.17g}, {other} at St {high:.17g}"
            lines.append(f"{named} (relative distance {change.width:.2g})")
            low, high = change.within
            if change.within != change.stokes:
                lines.append(f"  around it nothing is proved from St {low:.10g} to {high:.10g}")
        lines += [f"undecided: St {low:.10g} to {high:.10g}" for low, high in self.undecided]
        lines.append("everywhere else on the line the outcome is proved and does not change")
        return "\n".join(lines)


def prove_boundary(scene: Scene | str | Path, *, angle: float | str, stokes: tuple[float, float]) -> ProvedBoundary:
    """Enclose the changes of outcome along a line of constant angle between proved collisions.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        angle: impact angle, rad or a string with its unit.
        stokes: ends of the line.

    Raises:
        InputError: ends that do not rise, or are not admissible.
        ComputationError: collisions of this scene cannot be enclosed here.

    Example:
        >>> from wetdoublet.solvers import prove_boundary
        >>> (change,) = prove_boundary("granulation", angle="10 deg", stokes=(0.05, 0.5)).changes
        >>> change.outcomes, change.width < 1e-9
        (('stick', 'bounce'), True)
    """
    low, high = stokes
    if not 0 < low < high:
        raise InputError("stokes", list(stokes), "two Stokes numbers, the lower first")
    loaded = Scene.load(scene).with_impact(stokes=float(high), angle=angle)
    first = prove_inputs(Inputs.of(loaded))
    if not first and not first.steps:
        raise ComputationError(f"not provable here: {first.reason}")

    def at(number: float) -> Proof:
        return prove_inputs(Inputs.of(loaded.with_impact(stokes=number)), digits=False)

    numbers = [low, *map(float, np.geomspace(low, high, _LINES)[1:-1]), high]
    points = [(number, at(number).outcome) for number in numbers]
    proofs = [(number, outcome) for number, outcome in points if outcome is not None]
    pairs: list[tuple[Stretch, tuple[str, str]]] = []
    for (begin, before), (end, other) in itertools.pairwise(proofs):
        pairs += _between(at, begin, before, end, other) if before != other else ()
    assert loaded.angle is not None
    return ProvedBoundary(loaded, loaded.angle, *_cover(loaded, numbers, pairs))


def _cover(
    scene: Scene, numbers: Sequence[float], pairs: Sequence[tuple[Stretch, tuple[str, str]]]
) -> tuple[tuple[Change, ...], tuple[Stretch, ...], tuple[Stretch, ...]]:
    """The changes with the stretches around them, the stretches that are proved, and what is left between those.

    The line outside of the pairs is proved stretch by stretch; one that is not is halved, the nearer to a pair the more
    often. Neighbours have a Stokes number in common, and so the outcome. Where the sharpest proof fails, what is nearer
    to the pair is not tried.
    """
    inputs = Inputs.of(scene, {"impact.stokes": 1e-6})
    engine = inputs.engine()
    proved: list[Stretch] = []
    changing = [pair for pair, _ in pairs]

    def away(number: float) -> float:
        return min((abs(math.log(number / end)) for pair in changing for end in pair), default=math.inf)

    def cover(low: float, high: float) -> bool:
        narrow = high < low * (1 + _NARROW)
        box = {**inputs.ranges, "stokes": (low, high)}
        for settings in (BOX, _SHARP) if narrow else (BOX,):
            if enclose(engine, box, inputs.moving, settings).outcome:
                proved.append((low, high))
                return True
        middle = math.sqrt(low * high)
        if (narrow and math.log(high / low) < _PART * away(middle)) or not low < middle < high:
            return False
        far, near = ((low, middle), (middle, high)) if away(low) > away(high) else ((middle, high), (low, middle))
        return cover(*far) and cover(*near)

    ends = sorted({*numbers, *itertools.chain(*changing)})
    for low, high in itertools.pairwise(ends):
        if (low, high) not in changing:
            cover(low, high)
    proved.sort()
    edges = [ends[0], *itertools.chain(*proved), ends[-1]]
    gaps = [(low, high) for low, high in zip(edges[::2], edges[1::2], strict=True) if low < high]
    changes = [
        Change(pair, outcomes, next(gap for gap in gaps if gap[0] <= pair[0] and pair[1] <= gap[1]))
        for pair, outcomes in pairs
    ]
    return tuple(changes), tuple(proved), tuple(gap for gap in gaps if all(gap != change.within for change in changes))


def _between(at: Any, begin: float, first: str, end: float, other: str) -> Iterator[tuple[Stretch, tuple[str, str]]]:
    """The changes between two points with different outcomes: halved as long as the middle is proved.

    Where it is not, both ends move towards it as far as they can be proved.
    """
    for _ in range(_MOST):
        middle = math.sqrt(begin * end)
        if not begin < middle < end:
            break
        outcome = at(middle).outcome
        if outcome is None:
            begin, end = _towards(at, begin, first, middle), _towards(at, end, other, middle)
            break
        if outcome not in (first, other):  # a third one lies between
            yield from _between(at, begin, first, middle, outcome)
            yield from _between(at, middle, outcome, end, other)
            return
        begin, end = (middle, end) if outcome == first else (begin, middle)
    yield (begin, end), (first, other)


def _towards(at: Any, start: float, outcome: str, end: float) -> float:
    """The proved point nearest to `end` that halving finds, with this outcome."""
    for _ in range(_MOST):
        middle = math.sqrt(start * end)
        if middle in (start, end):
            break
        if at(middle).outcome == outcome:
            start = middle
        else:
            end = middle
        if abs(end / start - 1) < 1e-15:
            break
    return start
