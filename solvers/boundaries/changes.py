"""Changes of outcome along a line of constant angle: bracketed by samples, located, and confirmed by collisions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from ...generated.automaton import BOUNCE, CRITERIA, OUTCOMES, ROTATE, STICK
from ..errors import ComputationError
from ..scene.contact import GAPS
from .line import Line
from .look import Look
from .roots import Function, root, sample
from .samples import known

# Kinds of change: a criterion is just met; a doublet begins to escape without or with a rebound; other.
GRAZE, FREE, REVERSED, PLAIN = "graze", "escape", "escape reversed", "plain"
DECLARED = "event"  # and its word: an event that a user's model declares begins to happen
MERGED = 1e-8  # relative distance below which changes are merged
_BESIDE = 1e-9  # relative distance at which both sides of a graze are computed
_ACCEPTED = 1e-6  # relative distance at which collisions must confirm a change
_LOCATED = 1e-8  # the same for one located by a smooth function; otherwise it is bracketed again by outcomes
_NARROW = 2e-9  # width in ln St to which outcomes bracket a change
_ROUNDS = 48  # rounds of dividing brackets; 16 suffice where every collision is decided
_PARTS = 16  # most subdivisions of a bracket in a round
_TOGETHER = 0.1  # part of a phase within which contact and a turning point just above it happen
_AT_ONCE = 16  # collisions of a round that are worth waiting for together: two for each lane of the kernel


@dataclass(frozen=True)
class Change:
    """A change of outcome at a Stokes number, from below to above. Ce is None without a bridge.

    Attributes:
        kind: "graze" (a rebound criterion is just met), "escape" or "escape reversed" (a doublet begins to separate,
            without and with a rebound), "plain" (located by outcomes alone), or "event WORD" (a declared event of a
            user's model happens on one side only).
        merged: True if it stands for several changes closer than 1e-8.
    """

    stokes: float
    centrifugal: float | None
    before: str
    after: str
    kind: str
    merged: bool = False

    def to_dict(self) -> dict[str, float | str | None]:
        """The change as in the JSON object of `wetdoublet boundary`."""
        return {"stokes": self.stokes, "centrifugal": self.centrifugal, "from": self.before, "to": self.after}


@dataclass(frozen=True)
class _Bracket:
    """Two Stokes numbers of a line with different outcomes, and the criterion first met at each (-1 for none)."""

    line: Line
    low: float
    high: float
    before: str
    after: str
    met: tuple[int, int]

    @property
    def width(self) -> float:
        return math.log(self.high / self.low)

    def divided(self, count: int) -> np.ndarray:
        """Stokes numbers that divide it into `count` parts, even in the logarithm, without its ends."""
        inside: np.ndarray = self.low * (self.high / self.low) ** (np.arange(1, count) / count)
        return inside


def changes_along(
    lines: Sequence[Line], look: Look, samples: Sequence[np.ndarray]
) -> list[list[Change] | ComputationError]:
    """All changes between neighbouring samples of each line, each confirmed by collisions on both sides.

    The kernel brackets those of all lines together by outcomes. Where it does not complete collisions, or without a
    kernel, they are located by functions that are smooth through a change, or bracketed by Rosenbrock's outcomes.

    Returns:
        The changes of each line; or why one could not be located, or that collisions beside one contradict it.
    """
    samples = [known(own) for own in samples]
    brackets = [_brackets(line, own) for line, own in zip(lines, samples, strict=True)]
    everything = list(chain.from_iterable(brackets))
    enclosed = iter(_enclosed(look, everything, True) if look.kernel else [[] for _ in everything])
    found = [_attempt(_completed, line, look, own, [next(enclosed) for _ in own]) for line, own in zip(lines, brackets)]
    good = [k for k, own in enumerate(found) if not isinstance(own, ComputationError)]
    agrees = _confirmed(look, [(lines[k], found[k]) for k in good], _ACCEPTED)
    for k, own in zip(good, agrees, strict=True):
        found[k] = _attempt(_accepted, found[k], own, samples[k])
    return found


def _attempt(step: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a step for one line, or its error, so that the other lines go on."""
    try:
        return step(*arguments)
    except ComputationError as error:
        return error


def _brackets(line: Line, samples: np.ndarray) -> list[_Bracket]:
    """Neighbouring samples with different outcomes."""
    places = np.flatnonzero(np.diff(samples["outcome"])).tolist()
    return [_bracket(line, samples[k], samples[k + 1]) for k in places]


def _bracket(line: Line, low: np.void, high: np.void) -> _Bracket:
    outcomes = OUTCOMES[low["outcome"]], OUTCOMES[high["outcome"]]
    met = int(low["reversal"]), int(high["reversal"])
    return _Bracket(line, float(low["stokes"]), float(high["stokes"]), *outcomes, met)


def _completed(line: Line, look: Look, brackets: list[_Bracket], found: list[list[Change]]) -> list[list[Change]]:
    """Changes of each bracket of a line; those that are missing are located by other means."""
    missing = [k for k, own in enumerate(found) if not own]
    first = [_located(line, brackets[k]) for k in missing]
    [agrees] = _confirmed(look, [(line, first)], _LOCATED)
    for k, own, good in zip(missing, first, agrees, strict=True):
        found[k] = own if good else _enclosed(look, [brackets[k]], False)[0]
    return found


def _accepted(found: list[list[Change]], agrees: list[bool], samples: np.ndarray) -> list[Change]:
    """The changes of a line.

    Raises:
        ComputationError: collisions contradict one of them.
    """
    if not all(agrees):
        at = next(one[0].stokes for one, good in zip(found, agrees, strict=True) if not good)
        raise ComputationError(
            f"collisions beside St {at:.10g} do not agree with a change of outcome there", advice="try a smaller --rtol"
        )
    changes = [one for own in found for one in own]
    _demand_agreement(changes, samples)
    return _merged(changes)


def _located(line: Line, bracket: _Bracket) -> list[Change]:
    """Changes within a bracket, located by smooth functions; empty if these show none."""
    try:
        found = _smooth(line, bracket.low, bracket.high, bracket.before, bracket.after)
    except ComputationError:
        found = None
    return [] if found is None else [_change(line, *one) for one in found]


Found = tuple[float, str, str, str]  # Stokes number, outcomes below and above, kind


def _smooth(line: Line, low: float, high: float, before: str, after: str) -> list[Found] | None:
    if line.model.own_events:
        return None  # a declared event may come first, at which none of these functions is smooth
    if BOUNCE not in (before, after):
        free = _signed_root(_escaping(line, False), low, high, after == ROTATE)
        if free is not None:
            return [(free, before, after, FREE)]
    met_below, met_above = line.criterion(low) >= 0, line.criterion(high) >= 0
    if met_below == met_above:
        if not met_below or ROTATE in (before, after):
            return None
        rebounds = _signed_root(_escaping(line, True), low, high, after == BOUNCE)
        return None if rebounds is None else [(rebounds, before, after, REVERSED)]
    graze = _signed_root(_criterion(line), low, high, met_above)
    if graze is None:
        return None
    below, above = graze * (1 - _BESIDE), graze * (1 + _BESIDE)
    now, then = _outcome(line, below, met_below), _outcome(line, above, met_above)
    found: list[Found] = []
    for first, last, one, other, met in ((low, below, before, now, met_below), (above, high, then, after, met_above)):
        if first == above and now != then:
            found.append((graze, now, then, GRAZE))
        if one != other:
            if {one, other} != {STICK, BOUNCE if met else ROTATE} or last <= first:
                return None
            escape = _signed_root(_escaping(line, met), first, last, other != STICK)
            if escape is None:
                return None
            found.append((escape, one, other, REVERSED if met else FREE))
    return found


def _outcome(line: Line, stokes: float, met: bool) -> str:
    if not line.escape(stokes, met).separates:
        return STICK
    return BOUNCE if met else ROTATE


def _signed_root(function: Function, low: float, high: float, rises: bool) -> float | None:
    """The root of a function with a change of sign in either direction; None without one."""

    def upwards(stokes: float) -> tuple[bool, float | None]:
        positive, value = function(stokes)
        return positive == rises, value if rises or value is None else -value

    at_low, at_high = sample(upwards, low), sample(upwards, high)
    if at_low.positive or not at_high.positive:
        return None
    return root(upwards, at_low, at_high)


def _criterion(line: Line) -> Function:
    def function(stokes: float) -> tuple[bool, float | None]:
        value = line.criterion(stokes)
        return value >= 0, value

    return function


def _escaping(line: Line, rebound: bool) -> Function:
    def function(stokes: float) -> tuple[bool, float | None]:
        found = line.escape(stokes, rebound)
        return found.separates, found.value

    return function


def _confirmed(look: Look, lines: Sequence[tuple[Line, list[list[Change]]]], distance: float) -> list[list[bool]]:
    """For each group of changes of each line, True if collisions beside them have the right outcomes.

    Arguments:
        distance: relative distance of these collisions, below and above; a third of the gap where changes are close.
    """
    places = [_beside([one for group in groups for one in group], distance) for _, groups in lines]
    angle = np.repeat([line.angle for line, _ in lines], [stokes.size for stokes, _ in places])
    if not angle.size:
        return [[bool(group) for group in groups] for _, groups in lines]
    seen = look.outcomes(angle, np.concatenate([stokes for stokes, _ in places]))["outcome"]
    own = np.split(seen, np.cumsum([stokes.size for stokes, _ in places])[:-1])
    return [
        _agreeing(groups, outcomes, narrow)
        for (_, groups), outcomes, (_, narrow) in zip(lines, own, places, strict=True)
    ]


def _beside(changes: list[Change], distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Stokes numbers below and above the changes of a line, and where no collision fits between two that are merged."""
    stokes = np.array([one.stokes for one in changes])
    gaps = np.diff(stokes, prepend=0.0, append=math.inf) / 3
    below = stokes - np.minimum(distance * stokes, gaps[:-1])
    above = stokes + np.minimum(distance * stokes, gaps[1:])
    narrow = 3 * gaps < MERGED * np.append(stokes, math.inf)
    narrow[[0, -1]] = False
    return np.concatenate([below, above]), narrow


def _agreeing(groups: list[list[Change]], seen: np.ndarray, narrow: np.ndarray) -> list[bool]:
    """For each group of changes of a line, True if the outcomes seen below and above each are its own."""
    agrees, k, size = [], 0, seen.size // 2
    for group in groups:
        own = range(k, k + len(group))
        k += len(group)
        below_fits = [narrow[j] or seen[j] == OUTCOMES.index(one.before) for j, one in zip(own, group)]
        above_fits = [narrow[j + 1] or seen[j + size] == OUTCOMES.index(one.after) for j, one in zip(own, group)]
        agrees.append(bool(group) and all(below_fits) and all(above_fits))
    return agrees


def _enclosed(look: Look, brackets: Sequence[_Bracket], kernel_only: bool) -> list[list[Change]]:
    """Refine brackets of any lines together by outcomes until each is narrower than _NARROW in ln St.

    Few brackets are divided into many parts, many into two: the fewest collisions that fill the kernel's lanes. One
    whose collisions are undecided is divided into _PARTS.

    Arguments:
        kernel_only: return no changes for a bracket in which the kernel decides no collision.

    Raises:
        ComputationError: no collision in a bracket could be decided.
    """
    open_ = list(enumerate(brackets))
    closed: list[list[_Bracket]] = [[] for _ in brackets]
    undecided: set[int] = set()
    slow: set[int] = set()
    for _ in range(_ROUNDS):
        if not open_:
            break
        parts = 1 + math.ceil(_AT_ONCE / len(open_))
        counts = [_PARTS if k in slow else min(parts, _PARTS) for k, _ in open_]
        grids = [one.divided(count) for (_, one), count in zip(open_, counts)]
        sizes = [grid.size for grid in grids]
        angle = np.repeat([one.line.angle for _, one in open_], sizes)
        seen = np.split(look.outcomes(angle, np.concatenate(grids), kernel_only), np.cumsum(sizes)[:-1])
        narrower: list[tuple[int, _Bracket]] = []
        for (k, one), grid, own in zip(open_, grids, seen, strict=True):
            usable = own["outcome"] >= 0
            if usable.any():
                narrower += [(k, each) for each in _parts_of(one, grid[usable], own[usable])]
            elif one.width < MERGED:  # a band narrower than the error of collisions
                closed[k].append(one)
            elif grid.size < _PARTS - 1:
                slow.add(k)
                narrower.append((k, one))
            elif kernel_only:
                undecided.add(k)
            else:
                reason = look.reason(one.line.angle, one.low, one.high)
                raise ComputationError(f"a change of outcome between St {one.low:.10g} and {one.high:.10g}: {reason}")
        open_ = [(k, one) for k, one in narrower if one.width > _NARROW and k not in undecided]
        for k, one in narrower:
            if one.width <= _NARROW:
                closed[k].append(one)
    if open_ and not kernel_only:
        one = open_[0][1]
        raise ComputationError(f"a change of outcome between St {one.low:.10g} and {one.high:.10g} is not enclosed")
    undecided |= {k for k, _ in open_}
    return [
        [] if k in undecided else [_enclosed_change(one) for one in sorted(own, key=lambda one: one.low)]
        for k, own in enumerate(closed)
    ]


def _parts_of(bracket: _Bracket, grid: np.ndarray, seen: np.ndarray) -> list[_Bracket]:
    """The narrower brackets given by collisions within one."""
    at = [bracket.low, *grid.tolist(), bracket.high]
    outcomes = [bracket.before, *(OUTCOMES[k] for k in seen["outcome"]), bracket.after]
    met = [bracket.met[0], *seen["reversal"].tolist(), bracket.met[1]]
    return [
        _Bracket(bracket.line, at[k], at[k + 1], outcomes[k], outcomes[k + 1], (met[k], met[k + 1]))
        for k in range(len(at) - 1)
        if outcomes[k] != outcomes[k + 1]
    ]


def _enclosed_change(one: _Bracket) -> Change:
    return _change(one.line, math.sqrt(one.low * one.high), one.before, one.after, _kind(one))


def _kind(one: _Bracket) -> str:
    """Kind of a change from its narrow bracket: by what happens first on one of its sides only."""
    declared = [each.word for each in one.line.model.own_events]
    if STICK not in (one.before, one.after) and not declared:
        return GRAZE
    try:
        low, high = one.line.happenings(one.low, one.high)
    except ComputationError:
        return PLAIN
    words = [[word for word, _ in side] for side in (low, high)]
    for word in (word for side in words for word in side if word in declared):
        if (word in words[0]) != (word in words[1]):
            return f"{DECLARED} {word}"
    k = next((k for k, (a, b) in enumerate(zip(*words)) if a != b), min(len(low), len(high)))
    begin = low[k - 1][1] if k else 0.0
    ends = [side[k] for side in (low, high) if len(side) > k]
    if any(_just_met(word, time - begin, [other - begin for _, other in ends]) for word, time in ends):
        return GRAZE
    return REVERSED if any(word in CRITERIA for word in words[0][:k]) else FREE


def _just_met(word: str, time: float, times: list[float]) -> bool:
    """True if an event of one side only is a rebound criterion that is just met.

    Contact is just met where the other side turns, at the same time. Where a saddle parts both sides, one is drawn into
    contact, at another time.
    """
    return word in CRITERIA and not (word in GAPS and max(times) - min(times) > _TOGETHER * time)


def _demand_agreement(changes: list[Change], samples: np.ndarray) -> None:
    """Raise ComputationError unless every sample has the outcome implied by the changes below it."""
    at = np.array([one.stokes for one in changes])
    where = np.searchsorted(at, samples["stokes"])
    first = changes[0].before if changes else OUTCOMES[samples["outcome"][0]]
    expected = np.array([OUTCOMES.index(first), *(OUTCOMES.index(one.after) for one in changes)])[where]
    wrong = samples["stokes"][samples["outcome"] != expected]
    if wrong.size:
        raise ComputationError(f"the outcome at St {wrong[0]:.10g} disagrees with the adjacent changes of outcome")


def _merged(changes: list[Change]) -> list[Change]:
    """Changes with those closer than MERGED combined; none where the outcome returns to the first."""
    found: list[Change] = []
    for one in changes:
        if found and one.stokes < found[-1].stokes * (1 + MERGED):
            both = replace(found.pop(), after=one.after, kind=PLAIN, merged=True)
            if both.before != both.after:
                found.append(both)
        else:
            found.append(one)
    return found


def _change(line: Line, stokes: float, before: str, after: str, kind: str) -> Change:
    return Change(stokes, line.numbers(stokes).centrifugal, before, after, kind)
