"""Changes of outcome along a line of constant angle: bracketed by samples, located, and confirmed by collisions."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

import numpy as np

from ...generated.automaton import BOUNCE, CRITERIA, OUTCOMES, ROTATE, STICK
from ..changes.brackets import Brackets, enclose
from ..changes.roots import Function, evaluate, root
from ..errors import ComputationError
from ..scene.contact import GAPS
from .line import Line
from .samples import known
from .scene_sampler import SceneSampler

# Kinds of change: a criterion is just met; a doublet begins to escape without or with a rebound; other.
GRAZE, FREE, REVERSED, PLAIN = "graze", "escape", "escape reversed", "plain"
DECLARED = "event"  # and its word: an event that a user's model declares begins to happen
MERGED = 1e-8  # relative distance below which changes are merged
_BESIDE = 1e-9  # relative distance at which both sides of a graze are computed
_ACCEPTED = 1e-6  # relative distance at which collisions must confirm a change
_LOCATED = 1e-8  # the same for one located by a smooth function; otherwise it is bracketed again by outcomes
_NARROW = 2e-9  # width in ln St to which outcomes bracket a change
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


def changes_along(
    lines: Sequence[Line], sampler: SceneSampler, samples: Sequence[np.ndarray]
) -> list[list[Change] | ComputationError]:
    """All changes between neighbouring samples of each line, each confirmed by collisions on both sides.

    The kernel brackets those of all lines together by outcomes. Where it does not complete collisions, or without a
    kernel, they are located by functions that are smooth through a change, or bracketed by Rosenbrock's outcomes.

    Returns:
        The changes of each line; or why one could not be located, or that collisions beside one contradict it.
    """
    if not lines:
        return []
    samples = [known(each) for each in samples]
    joined, line = np.concatenate(samples), np.repeat(np.arange(len(lines)), [each.size for each in samples])
    brackets = Brackets.between(line, joined["stokes"], joined["outcome"])
    enclosed = _enclosed(lines, sampler, brackets, True) if sampler.kernel else [[] for _ in range(brackets.size)]
    results = []
    for k in range(len(lines)):
        which = np.flatnonzero(brackets.line == k)
        results.append(_attempt(_completed, lines, sampler, brackets.part(which), [enclosed[j] for j in which]))
    done = [k for k, each in enumerate(results) if not isinstance(each, ComputationError)]
    agree = _confirmed(sampler, [(lines[k], results[k]) for k in done], _ACCEPTED)
    for k, each in zip(done, agree, strict=True):
        results[k] = _attempt(_accepted, results[k], each, samples[k])
    return results


def _attempt(step: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a step for one line, or its error, so that the other lines go on."""
    try:
        return step(*arguments)
    except ComputationError as error:
        return error


def _completed(
    lines: Sequence[Line], sampler: SceneSampler, brackets: Brackets, enclosed: list[list[Change]]
) -> list[Change]:
    """The changes in the brackets of a line; those that are missing are located by other means."""
    missing = [k for k, each in enumerate(enclosed) if not each]
    for k in missing:
        line, low, high, before, after = (each[k].item() for each in vars(brackets).values())
        try:
            enclosed[k] = _smooth(lines[line], low, high, OUTCOMES[before], OUTCOMES[after])
        except ComputationError:
            continue
    if missing:
        located = [(k, one) for k in missing for one in enclosed[k]]
        [agree] = _confirmed(sampler, [(lines[brackets.line[0]], [one for _, one in located])], _LOCATED)
        wrong = {k for (k, _), agrees in zip(located, agree, strict=True) if not agrees}
        for k in missing:
            if k in wrong or not enclosed[k]:
                [enclosed[k]] = _enclosed(lines, sampler, brackets.part(np.array([k])), False)
    return list(chain.from_iterable(enclosed))


def _accepted(changes: list[Change], agree: np.ndarray, samples: np.ndarray) -> list[Change]:
    """The changes of a line, those closer than MERGED combined, or left out where the outcome returns to the first.

    Raises:
        ComputationError: collisions or samples contradict one of them.
    """
    if not agree.all():
        raise ComputationError(
            f"collisions beside St {changes[int(np.argmin(agree))].stokes:.10g} do not agree with a change of outcome "
            "there",
            advice="try a smaller --rtol",
        )
    first = changes[0].before if changes else OUTCOMES[samples["outcome"][0]]
    expected = np.array([OUTCOMES.index(word) for word in (first, *(one.after for one in changes))])
    wrong = samples["outcome"] != expected[np.searchsorted([one.stokes for one in changes], samples["stokes"])]
    if wrong.any():
        at = samples["stokes"][wrong][0]
        raise ComputationError(f"the outcome at St {at:.10g} disagrees with the adjacent changes of outcome")
    merged: list[Change] = []
    for one in changes:
        if merged and one.stokes < merged[-1].stokes * (1 + MERGED):
            both = replace(merged.pop(), after=one.after, kind=PLAIN, merged=True)
            merged += [both] if both.before != both.after else []
        else:
            merged.append(one)
    return merged


def _smooth(line: Line, low: float, high: float, before: str, after: str) -> list[Change]:
    """Changes within a bracket, located by smooth functions; empty if these show none."""
    if line.model.own_events:
        return []  # a declared event may come first, at which none of these functions is smooth

    def escape(low: float, high: float, before: str, after: str, rebound: bool) -> list[Change]:
        stokes = _signed_root(lambda at: line.escape(at, rebound), low, high, after != STICK)
        return [] if stokes is None else [_change(line, stokes, before, after, REVERSED if rebound else FREE)]

    if BOUNCE not in (before, after) and (changes := escape(low, high, before, after, False)):
        return changes
    met_below, met_above = line.criterion(low) >= 0, line.criterion(high) >= 0
    if met_below == met_above:
        return escape(low, high, before, after, True) if met_below and ROTATE not in (before, after) else []

    def criterion(stokes: float) -> tuple[bool, float | None]:
        value = line.criterion(stokes)
        return value >= 0, value

    def outcome(stokes: float, met: bool) -> str:
        return (BOUNCE if met else ROTATE) if line.escape(stokes, met)[0] else STICK

    graze = _signed_root(criterion, low, high, met_above)
    if graze is None:
        return []
    below, above = graze * (1 - _BESIDE), graze * (1 + _BESIDE)
    now, then = outcome(below, met_below), outcome(above, met_above)
    changes = []
    for first, last, one, other, met in ((low, below, before, now, met_below), (above, high, then, after, met_above)):
        if first == above and now != then:
            changes.append(_change(line, graze, now, then, GRAZE))
        if one != other:
            escapes = {one, other} == {STICK, BOUNCE if met else ROTATE} and last > first
            located = escape(first, last, one, other, met) if escapes else []
            if not located:
                return []
            changes += located
    return changes


def _signed_root(function: Function, low: float, high: float, rises: bool) -> float | None:
    """The root of a function with a change of sign in either direction; None without one."""

    def upwards(stokes: float) -> tuple[bool, float | None]:
        positive, value = function(stokes)
        return positive == rises, value if rises or value is None else -value

    at_low, at_high = evaluate(upwards, low), evaluate(upwards, high)
    if at_low.positive or not at_high.positive:
        return None
    return root(upwards, at_low, at_high)


def _confirmed(sampler: SceneSampler, lines: Sequence[tuple[Line, list[Change]]], distance: float) -> list[np.ndarray]:
    """For each change of each line, whether the collisions beside it have its outcomes.

    Arguments:
        distance: relative distance of these collisions, below and above; a third of the gap where changes are close,
            and none where no collision fits between two that are merged.
    """
    angle, places, fits = [], [], []
    for line, changes in lines:
        stokes = np.array([one.stokes for one in changes])
        gaps = np.diff(stokes, prepend=0.0, append=math.inf) / 3
        below, above = (np.minimum(distance * stokes, each) for each in (gaps[:-1], gaps[1:]))
        places += [stokes - below, stokes + above]
        narrow = 3 * gaps < MERGED * np.append(stokes, math.inf)
        narrow[[0, -1]] = False
        fits += [narrow[:-1], narrow[1:]]
        angle += [line.angle] * 2 * stokes.size
    fit = np.concatenate([*fits, np.zeros(0, bool)])
    if angle:
        words = [word for _, changes in lines for side in ("before", "after") for word in
                 (getattr(one, side) for one in changes)]  # fmt: skip
        fit |= sampler.outcomes(np.array(angle), np.concatenate(places))["outcome"] == [
            OUTCOMES.index(w) for w in words
        ]
    sides = np.split(fit, np.cumsum([each.size for each in places])[:-1])
    return [below & above for below, above in zip(sides[::2], sides[1::2])]


def _enclosed(
    lines: Sequence[Line], sampler: SceneSampler, brackets: Brackets, kernel_only: bool
) -> list[list[Change]]:
    """The changes within each bracket of any lines, all enclosed together by outcomes to _NARROW in ln St.

    Arguments:
        kernel_only: no changes of a bracket within which the kernel does not decide a collision.

    Raises:
        ComputationError: no collision within a bracket could be decided.
    """
    angle = np.array([line.angle for line in lines])[brackets.line]

    def labels(which: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        return np.asarray(sampler.outcomes(angle[which], stokes, kernel_only)["outcome"])

    wide = replace(brackets, line=np.arange(brackets.size))
    narrow = enclose(labels, wide, _NARROW, at_once=_AT_ONCE, unknown=-1, logarithmic=True)
    changes: list[list[Change]] = [[] for _ in range(brackets.size)]
    undecided = set()
    for k, low, high, before, after in zip(*(each.tolist() for each in vars(narrow).values()), strict=True):
        line = lines[brackets.line[k]]
        if math.log(high / low) < MERGED:
            kind = _kind(line, low, high, OUTCOMES[before], OUTCOMES[after])
            changes[k].append(_change(line, math.sqrt(low * high), OUTCOMES[before], OUTCOMES[after], kind))
        elif kernel_only:  # a narrower band may be the error of collisions
            undecided.add(k)
        else:
            reason = sampler.reason(line.angle, low, high)
            raise ComputationError(f"a change of outcome between St {low:.10g} and {high:.10g}: {reason}")
    return [[] if k in undecided else each for k, each in enumerate(changes)]


def _kind(line: Line, low: float, high: float, before: str, after: str) -> str:
    """Kind of a change from its narrow bracket: by what happens first on one of its sides only."""
    declared = [each.word for each in line.model.own_events]
    if STICK not in (before, after) and not declared:
        return GRAZE
    try:
        sides = line.events(low, high)
    except ComputationError:
        return PLAIN
    below, above = ([word for word, _ in side] for side in sides)
    for word in below + above:
        if word in declared and (word in below) != (word in above):
            return f"{DECLARED} {word}"
    k = next((k for k, (a, b) in enumerate(zip(below, above)) if a != b), min(len(below), len(above)))
    begin = sides[0][k - 1][1] if k else 0.0
    parting = [(side[k][0], side[k][1] - begin) for side in sides if len(side) > k]
    apart = max((time for _, time in parting), default=0.0) - min((time for _, time in parting), default=0.0)
    # At a graze of contact the other side turns at the same time. At a saddle one side is drawn into contact, and
    # the other turns at another time.
    if any(word in CRITERIA and not (word in GAPS and apart > _TOGETHER * time) for word, time in parting):
        return GRAZE
    return REVERSED if any(word in CRITERIA for word in below[:k]) else FREE


def _change(line: Line, stokes: float, before: str, after: str, kind: str) -> Change:
    return Change(stokes, line.numbers(stokes).centrifugal, before, after, kind)
