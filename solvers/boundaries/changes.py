"""Changes of outcome along a line of constant angle: bracketed by samples, located, and confirmed by collisions."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ...generated.automaton import CRITERIA, OUTCOMES, STICK
from ..engines.settings import KERNEL_STEPS
from ..errors import ComputationError
from ..model.dimensionless import nondimensionalise
from ..scene.groups import GAPS
from ..scene.items import OUTCOME, item
from ..scene.origin import Record
from .brackets import Brackets, enclose
from .samples import SAMPLE_BUDGET, answers
from .samples_by_kernel import SceneSampler

# Kinds of change: a criterion is just met; a doublet begins to escape without or with a rebound; other.
GRAZE, FREE, REVERSED, PLAIN = "graze", "escape", "escape reversed", "plain"
DECLARED = "event"  # and its word: an event that a user's model declares begins to happen
MERGED = 1e-8  # relative distance below which changes are merged
_ACCEPTED = 1e-6  # relative distance at which collisions must confirm a change
_NARROW = 2e-9  # width in ln St to which outcomes bracket a change
_TOGETHER = 0.1  # part of a phase within which contact and a turning point just above it happen
_AT_ONCE = 16  # collisions of a round that are worth waiting for together: two for each lane of the kernel


class Change(Record):
    """A change of outcome at a Stokes number, from below to above."""

    _keys = "stokes centrifugal from=before to=after"

    stokes: float = item("Stokes number at which the outcome changes", "1")
    centrifugal: float | None = item("centrifugal number there", "1")
    before: str = item("outcome below", OUTCOME)
    after: str = item("outcome above", OUTCOME)
    kind: str = item(
        'what happens there: "graze" (a rebound criterion is just met), "escape" or "escape reversed" (a doublet '
        'begins to separate, without and with a rebound), "plain" (located by outcomes alone), or "event WORD" (a '
        "declared event of a user's model happens on one side only)"
    )
    merged: bool = item("True if it stands for several changes closer than 1e-8", default=False)


def changes_along(
    angles: Sequence[float], sampler: SceneSampler, samples: Sequence[np.ndarray]
) -> list[list[Change] | ComputationError]:
    """All changes between neighbouring samples of each line, each confirmed by collisions on both sides.

    Those of all lines are bracketed together by outcomes.

    Arguments:
        angles: of the lines, rad.

    Returns:
        The changes of each line; or why one could not be located, or that collisions beside one contradict it.
    """
    if not angles:
        return []
    samples = [answers(line_samples) for line_samples in samples]
    joined, line = np.concatenate(samples), np.repeat(np.arange(len(angles)), [sample.size for sample in samples])
    brackets = _enclosed(angles, sampler, Brackets.between(line, joined["stokes"], joined["outcome"]))
    lines = [_attempt(_located, sampler, angle, brackets.subset(brackets.line == k)) for k, angle in enumerate(angles)]
    done = [k for k, result in enumerate(lines) if not isinstance(result, ComputationError)]
    agree = _confirmed(sampler, [(angles[k], lines[k]) for k in done])
    for k, agrees in zip(done, agree, strict=True):
        lines[k] = _attempt(_accepted, lines[k], agrees, samples[k])
    return lines


def _attempt(step: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a step for one line, or its error, so that the other lines go on."""
    try:
        return step(*arguments)
    except ComputationError as error:
        return error


def _enclosed(angles: Sequence[float], sampler: SceneSampler, brackets: Brackets) -> Brackets:
    """The brackets divided by outcomes to _NARROW in ln St; with all steps where those of a sample do not decide."""

    def outcomes(budget: int, line: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        return sampler.outcomes(np.array(angles)[line], stokes, budget)

    for budget in (SAMPLE_BUDGET, KERNEL_STEPS):
        wide = np.log(brackets.high / brackets.low) >= MERGED
        labels = partial(outcomes, budget)
        narrow = enclose(labels, brackets.subset(wide), _NARROW, at_once=_AT_ONCE, unknown=-1, logarithmic=True)
        brackets = Brackets.joined([brackets.subset(~wide), narrow])
    return brackets


def _located(sampler: SceneSampler, angle: float, brackets: Brackets) -> list[Change]:
    """The changes in the narrow brackets of a line; ComputationError where collisions in one are not decided."""
    changes = []
    for _, low, high, first, last in zip(*(column.tolist() for column in vars(brackets).values()), strict=True):
        if math.log(high / low) >= MERGED:
            reason = sampler.reason(angle, low, high)
            raise ComputationError(f"a change of outcome between St {low:.10g} and {high:.10g}: {reason}")
        scene, stokes, before, after = sampler.scene, math.sqrt(low * high), OUTCOMES[first], OUTCOMES[last]
        centrifugal = nondimensionalise(scene, scene.speed_of(stokes), angle).centrifugal
        changes.append(Change(stokes, centrifugal, before, after, _kind(sampler, angle, low, high, before, after)))
    return changes


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
    expected = np.array([OUTCOMES.index(word) for word in (first, *(change.after for change in changes))])
    wrong = samples["outcome"] != expected[np.searchsorted([change.stokes for change in changes], samples["stokes"])]
    if wrong.any():
        at = samples["stokes"][wrong][0]
        raise ComputationError(f"the outcome at St {at:.10g} disagrees with the adjacent changes of outcome")
    merged: list[Change] = []
    for change in changes:
        if merged and change.stokes < merged[-1].stokes * (1 + MERGED):
            both = replace(merged.pop(), after=change.after, kind=PLAIN, merged=True)
            merged += [both] if both.before != both.after else []
        else:
            merged.append(change)
    return merged


def _confirmed(sampler: SceneSampler, lines: Sequence[tuple[float, list[Change]]]) -> list[np.ndarray]:
    """For each change of each line (its angle and changes), whether the collisions beside it have its outcomes.

    These are at a relative distance of _ACCEPTED below and above; a third of the gap where changes are close, and none
    where no collision fits between two that are merged.
    """
    angle, places, fits = [], [], []
    for at, changes in lines:
        stokes = np.array([change.stokes for change in changes])
        gaps = np.diff(stokes, prepend=0.0, append=math.inf) / 3
        below, above = (np.minimum(_ACCEPTED * stokes, gap) for gap in (gaps[:-1], gaps[1:]))
        places += [stokes - below, stokes + above]
        narrow = 3 * gaps < MERGED * np.append(stokes, math.inf)
        narrow[[0, -1]] = False
        fits += [narrow[:-1], narrow[1:]]
        angle += [at] * 2 * stokes.size
    fit = np.concatenate([*fits, np.zeros(0, bool)])
    if angle:
        words = [word for _, changes in lines for side in ("before", "after") for word in
                 (getattr(change, side) for change in changes)]  # fmt: skip
        fit |= sampler.outcomes(np.array(angle), np.concatenate(places)) == [OUTCOMES.index(word) for word in words]
    sides = np.split(fit, np.cumsum([pair.size for pair in places])[:-1])
    return [below & above for below, above in zip(sides[::2], sides[1::2])]


def _kind(sampler: SceneSampler, angle: float, low: float, high: float, before: str, after: str) -> str:
    """Kind of a change from its narrow bracket: by what happens first on one of its sides only."""
    declared = () if sampler.scene.package is None else sampler.scene.package.words
    if STICK not in (before, after) and not declared:
        return GRAZE
    sides = sampler.events(angle, low, high)
    if sides is None:
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
