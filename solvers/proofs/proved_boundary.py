"""`prove_boundary`: two Stokes numbers of proved opposite outcomes, as near to each other as they get."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..engines.interval.inputs import Inputs
from ..engines.interval.prove import Proof, prove_inputs
from ..errors import ComputationError, InputError
from ..scene.origin import origin
from ..scene.scene import Scene

_LINES = 48  # points of a line between which changes are looked for
_MOST = 60  # halvings


class Change(NamedTuple):
    """Two Stokes numbers and their proved outcomes, between which the outcome changes at least once."""

    stokes: tuple[float, float]
    outcomes: tuple[str, str]

    @property
    def width(self) -> float:
        """Relative distance of both."""
        return self.stokes[1] / self.stokes[0] - 1


@dataclass(frozen=True)
class ProvedBoundary:
    """Changes of outcome along a line of constant angle (rad), each between two proved collisions.

    That there is one change only between two points, or none elsewhere, is not proved.

    Example:
        >>> from wetdoublet.solvers import prove_boundary
        >>> prove_boundary("granulation", angle="10 deg", stokes=(0.2, 0.5)).changes
        ()
    """

    scene: Scene
    angle: float
    changes: tuple[Change, ...]

    def __str__(self) -> str:
        lines = [f"at {math.degrees(self.angle):.10g} deg: {len(self.changes)} changes between proved outcomes"]
        for each in self.changes:
            (low, high), (one, other) = each.stokes, each.outcomes
            named = f"{one} at St {low:.17g}, {other} at St {high:.17g}"
            lines.append(f"{named} (relative distance {each.width:.2g})")
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet prove --boundary --json`."""
        changes = [{"stokes": list(each.stokes), "outcomes": list(each.outcomes)} for each in self.changes]
        return {"angle": self.angle, "changes": changes, **origin(self.scene)}


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

    points = [(float(number), at(float(number)).outcome) for number in np.geomspace(low, high, _LINES)]
    known = [(number, outcome) for number, outcome in points if outcome is not None]
    changes: list[Change] = []
    for (left, one), (right, other) in itertools.pairwise(known):
        changes += _between(at, left, one, right, other) if one != other else ()
    assert loaded.angle is not None
    return ProvedBoundary(loaded, loaded.angle, tuple(changes))


def _between(at: Any, left: float, one: str, right: float, other: str) -> Iterator[Change]:
    """The changes between two points with different outcomes: halved as long as the middle is proved.

    Where it is not, both ends move towards it as far as they can be proved.
    """
    for _ in range(_MOST):
        middle = math.sqrt(left * right)
        if not left < middle < right:
            break
        outcome = at(middle).outcome
        if outcome is None:
            left, right = _towards(at, left, one, middle), _towards(at, right, other, middle)
            break
        if outcome not in (one, other):  # a third one lies between
            yield from _between(at, left, one, middle, outcome)
            yield from _between(at, middle, outcome, right, other)
            return
        left, right = (middle, right) if outcome == one else (left, middle)
    yield Change((left, right), (one, other))


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
