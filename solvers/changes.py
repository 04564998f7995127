"""Changes of outcome along a line of constant angle: found between two Stokes numbers, or followed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from .errors import ComputationError
from .probe import Line
from .roots import LOCATED, Function, Sample, around, root, sample

STICK, ROTATE, BOUNCE = "stick", "stick-rotate-separate", "bounce"
# What happens at a change: a criterion is just met; a doublet begins to escape, not reversed or reversed; other.
GRAZE, FREE, REVERSED, PLAIN = "graze", "escape", "escape reversed", "plain"
_BESIDE = 1e-9  # relative distance at which the two sides of a graze are looked at


@dataclass(frozen=True)
class Change:
    """A change of outcome at a Stokes number, going up. Ce is None without a bridge."""

    stokes: float
    centrifugal: float | None
    before: str
    after: str
    kind: str

    def to_dict(self) -> dict[str, float | str | None]:
        """As in the JSON object of `wetdoublet boundary`."""
        return {"stokes": self.stokes, "centrifugal": self.centrifugal, "from": self.before, "to": self.after}


def between(line: Line, grid: Sequence[float]) -> list[Change]:
    """All changes that show between neighbours of a grid of Stokes numbers, or at a criterion between them."""
    changes: list[Change] = []
    line.look(grid)
    for low, high in pairwise(grid):
        changes += _in_bracket(line, low, high)
    return changes


def _in_bracket(line: Line, low: float, high: float) -> list[Change]:
    before, after = line.outcome(low), line.outcome(high)
    if before == after and (before != STICK or line.met(low) == line.met(high)):
        return []
    if before == STICK and after == ROTATE:
        return [_change(line, _escape(line, low, high, False), before, after, FREE)]
    if after == BOUNCE or before == after:
        return _past_criterion(line, low, high, before, after)
    return [_change(line, _bisected(line, low, high, before), before, after, PLAIN)]


def _past_criterion(line: Line, low: float, high: float, before: str, after: str) -> list[Change]:
    """Changes about the Stokes number at which the approach first meets a criterion."""
    at_low, at_high = sample(_criterion(line), low), sample(_criterion(line), high)
    if at_low.positive and before == STICK and after == BOUNCE:
        return [_change(line, _escape(line, low, high, True), before, after, REVERSED)]
    if at_low.positive or not at_high.positive:
        return [] if before == after else [_change(line, _bisected(line, low, high, before), before, after, PLAIN)]
    graze = root(_criterion(line), at_low, at_high)
    below, above, free, bounces = beside(line, graze)
    changes: list[Change] = []
    if before == STICK and free:
        changes.append(_change(line, _escape(line, low, below, False), STICK, ROTATE, FREE))
    elif before != STICK and not free:
        changes.append(_change(line, _bisected(line, low, below, before), before, STICK, PLAIN))
    now, then = ROTATE if free else STICK, BOUNCE if bounces else STICK
    if now != then:
        changes.append(_change(line, graze, now, then, GRAZE))
    if after == BOUNCE and not bounces:
        changes.append(_change(line, _escape(line, above, high, True), STICK, BOUNCE, REVERSED))
    elif after != BOUNCE and bounces:
        changes.append(_change(line, _bisected(line, above, high, BOUNCE), BOUNCE, after, PLAIN))
    return changes


def beside(line: Line, graze: float) -> tuple[float, float, bool, bool]:
    """Stokes numbers just below and above a graze; whether the doublet escapes unreversed, and reversed, there."""
    below, above = graze * (1 - _BESIDE), graze * (1 + _BESIDE)
    return below, above, line.escape(below, False).separates, line.escape(above, True).separates


def followed(line: Line, pattern: Sequence[Change], predicted: Sequence[float], doubts: Sequence[float],
             span: tuple[float, float]) -> list[Change] | None:  # fmt: skip
    """The changes of `pattern` near their predictions; None if this line has another pattern."""
    changes: list[Change] = []
    for one, near, doubt in zip(pattern, predicted, doubts, strict=True):
        function = _function(line, one.kind)
        bracket = around(function, near, doubt, *span) if function and span[0] < near < span[1] else None
        if function is None or bracket is None:
            return None
        if one.kind == REVERSED and line.criterion(math.exp(bracket[0].at)) < 0:
            return None  # a doublet not reversed there: a graze may lie between, where the function jumps
        found = root(function, *bracket)
        if one.kind == GRAZE:
            # a doublet that rotates below is seen to by the collision between this change and the last
            free = one.before == ROTATE or line.escape(found * (1 - _BESIDE), False).separates
            bounces = line.escape(found * (1 + _BESIDE), True).separates
            if (one.before, one.after) != (ROTATE if free else STICK, BOUNCE if bounces else STICK):
                return None
        changes.append(_change(line, found, one.before, one.after, one.kind))
    edges = [span[0], *(one.stokes for one in changes), span[1]]
    if edges != sorted(edges):
        return None
    expected = [one.before for one in changes] + [changes[-1].after] if changes else []
    middles = [math.sqrt(low * high) for low, high in pairwise(edges)]
    # nearer to the outermost changes than the middle of so many decades
    middles[0], middles[-1] = max(middles[0], edges[1] / 2), min(middles[-1], edges[-2] * 2)
    line.look(middles)
    return changes if changes and [line.outcome(middle) for middle in middles] == expected else None


def _function(line: Line, kind: str) -> Function | None:
    if kind == GRAZE:
        return _criterion(line)
    return _escaping(line, kind == REVERSED) if kind in (FREE, REVERSED) else None


def _criterion(line: Line) -> Function:
    def function(stokes: float) -> tuple[bool, float | None]:
        value = line.criterion(stokes)
        return value >= 0, value

    return function


def _escaping(line: Line, reversed_: bool) -> Function:
    def function(stokes: float) -> tuple[bool, float | None]:
        found = line.escape(stokes, reversed_)
        return found.separates, found.value

    return function


def _escape(line: Line, low: float, high: float, reversed_: bool) -> float:
    function = _escaping(line, reversed_)
    ends: list[Sample] = [sample(function, low), sample(function, high)]
    if ends[0].positive or not ends[1].positive:
        raise ComputationError(
            f"no change of outcome between St {low:.10g} and {high:.10g} where one was expected",
            advice="the two ends differ by less than the tolerance: try a smaller --rtol",
        )
    return root(function, *ends)


def _bisected(line: Line, low: float, high: float, before: str) -> float:
    """Where the outcome stops being `before`, by outcomes alone."""
    while math.log(high / low) > LOCATED:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if line.outcome(middle) == before else (low, middle)
    return math.sqrt(low * high)


def _change(line: Line, stokes: float, before: str, after: str, kind: str) -> Change:
    return Change(stokes, line.numbers(stokes).centrifugal, before, after, kind)
