"""Changes of outcome on lines through the scatter, and their derivatives by the free entries.

A change is bracketed by outcomes at points of a grid and located by dividing its bracket. Where the outcome beyond it
is not that of the far end, another change follows, so that strips narrower than the grid are found if they separate
different outcomes.

Beside a change the gradient of a result in free entries, speed and angle grows without bound along the normal of the
boundary (the time near a saddle as 1/d, e_n at a graze or at a continuous start as 1/sqrt(d), d the distance); the
rest of it is bounded and cancels in the difference of two gradients. Its direction gives the derivative of the
change's place by the implicit function theorem; the error is of order d.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .law import BoundLaw, outcomes_under, times_under
from .lines import Lines

GRID = 15  # points of a line at which the outcome is looked at
WITHIN = 1e-5  # of the probability on either side of a change
_LOOSER = 30.0  # most by which that grows with the distance from the centre: rare outcomes lie there
_LOOSEST = 0.02  # standard deviations within which a change is looked for again
_QUICK = 1000  # steps of a trajectory with derivatives, where an approximation replaces what takes longer
_CLOSE = 1e-8  # the same for derivatives that are exact
_FAR = 2e-6  # distance from a saddle at which that is taken, in standard deviations
_SHIFT, _STEP_OF_ENTRY = 0.1, 2e-3  # steps of an impact, and relative ones of an entry, over that distance
_BESIDE = 1e-5  # least distance at which gradients are taken, in standard deviations; the other is four times that
_GROWTH = 1.3, 8.0  # of a singular gradient from the farther to the nearer
_EXACTLY, _ROUGHLY = (1e-5, 32), (1e-4, 20)
"""Relative step of a free entry, where a change has no singular gradient, and halvings of the bracket of its place."""


@dataclass(frozen=True)
class Changes:
    """Changes of outcome, ascending in y along each line.

    Attributes:
        line, y: (changes,), line and place.
        error: (changes,), half the width of the bracket of the place.
        before, after: (changes,), outcomes below and above.
        first: (lines,), outcome at the lower end.
    """

    line: np.ndarray
    y: np.ndarray
    before: np.ndarray
    after: np.ndarray
    first: np.ndarray
    error: np.ndarray

    @property
    def size(self) -> int:
        return int(self.line.size)


def locate(
    law: BoundLaw, lines: Lines, grid: np.ndarray | int = GRID, within: float = WITHIN, kernel_alone: bool = False
) -> Changes:
    """The changes of outcome on lines.

    Arguments:
        grid: number of points from end to end, or (lines, points) of them.
        within: error of the probability on either side of a change, relative to that of a change at y = 0.
        kernel_alone: what the kernel does not follow to the end stays undecided.
    """
    if isinstance(grid, int):
        places = lines.low[:, None] + (lines.high - lines.low)[:, None] * np.linspace(0, 1, grid)
    else:
        places = grid
    line = np.repeat(np.arange(lines.size), places.shape[1])

    def outcomes(line: np.ndarray, y: np.ndarray) -> np.ndarray:
        where = lines.row[line], *lines.at(line, y)
        return outcomes_under([law], *where) if kernel_alone else law.outcomes(*where)

    outcome = outcomes(line, places.ravel()).reshape(places.shape)
    line, k = np.nonzero(outcome[:, 1:] != outcome[:, :-1])
    low, high = places[line, k], places[line, k + 1]
    before, after = outcome[line, k], outcome[line, k + 1]
    found: list[tuple[np.ndarray, ...]] = [(np.zeros(0, int), np.zeros(0), before[:0], after[:0], np.zeros(0))]
    while line.size:
        middle = (low + high) / 2
        seen = outcomes(line, middle)
        same = seen == before
        third = np.flatnonzero(~same & (seen != after))  # another change follows between the middle and the far end
        rest = line[third], middle[third], high[third], seen[third], after[third]
        low, high, after = np.where(same, middle, low), np.where(same, high, middle), np.where(same, after, seen)
        line, low, high, before, after = (
            np.concatenate(pair) for pair in zip((line, low, high, before, after), rest, strict=True)
        )
        done = high - low <= within * np.minimum(np.exp(middle_weight(low, high)), _LOOSER)
        found.append((line[done], ((low + high) / 2)[done], before[done], after[done], ((high - low) / 2)[done]))
        line, low, high, before, after = (each[~done] for each in (line, low, high, before, after))
    line, y, before, after, error = (np.concatenate(each) for each in zip(*found, strict=True))
    order = np.lexsort((y, line))
    return Changes(line[order], y[order], before[order], after[order], outcome[:, 0], error[order])


def middle_weight(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """y^2/2 at the point of a bracket that is nearest to the centre: minus the logarithm of the density there."""
    nearest = np.where((low < 0) & (high > 0), 0.0, np.minimum(np.abs(low), np.abs(high)))
    found: np.ndarray = nearest**2 / 2
    return found


@dataclass(frozen=True)
class Normals:
    """Normals of the boundary at changes, of arbitrary length; NaN where there is no singular gradient.

    Attributes:
        free: (changes, free entries).
        speed, angle: (changes,), by normal speed and by angle.
        along: (changes,), by the place on the line.
    """

    free: np.ndarray
    speed: np.ndarray
    angle: np.ndarray
    along: np.ndarray

    def slopes(self) -> np.ndarray:
        """Derivatives of the places by the free entries."""
        found: np.ndarray = -self.free / self.along[:, None]
        return found


def normals(law: BoundLaw, lines: Lines, changes: Changes, which: np.ndarray, quick: bool) -> Normals:
    """The normals at changes `which`, on the side that separates, or that rebounds.

    Arguments:
        quick: where the derivatives of the trajectories take many steps, take them from times of plain ones, to 1e-4.
    """
    line, y, before, after = (each[which] for each in (changes.line, changes.y, changes.before, changes.after))
    side = np.where(after > before, 1.0, -1.0)
    where = np.tile(line, 2)
    distance = np.maximum(_BESIDE if quick else _CLOSE, 3 * changes.error[which])
    at = np.concatenate([y + side * distance, y + 4 * side * distance])
    near = law.results(
        ("contact_time",), lines.row[where], *lines.at(where, at), forward=True, budget=_QUICK if quick else None
    )
    count, wanted = line.size, np.maximum(before, after)
    by_speed, by_angle = lines.slopes(where, at)
    along = near.speed[0] * by_speed + near.angle[0] * by_angle
    parts = [each[:count] - each[count:] for each in (near.free[0], near.speed[0], near.angle[0], along)]
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.abs(along[:count] / along[count:])
    sound = (near.outcome.reshape(2, count) == wanted).all(axis=0) & (growth > _GROWTH[0]) & (growth < _GROWTH[1])
    free, speed, angle, along = (np.where(sound.reshape(-1, *[1] * (each.ndim - 1)), each, np.nan) for each in parts)
    late = np.flatnonzero((near.outcome.reshape(2, count) < 0).any(axis=0)) if quick else np.zeros(0, int)
    if late.size:
        free[late], speed[late], angle[late] = _by_times(
            law, lines, line[late], y[late], side[late], np.maximum(_FAR, 4 * changes.error[which[late]])
        )
        by_speed, by_angle = lines.slopes(line[late], y[late])
        along[late] = speed[late] * by_speed + angle[late] * by_angle
    return Normals(free, speed, angle, along)


def _by_times(
    law: BoundLaw, lines: Lines, line: np.ndarray, y: np.ndarray, side: np.ndarray, distance: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals beside a saddle, where the contact time is linear in the logarithm of the distance from the boundary.

    Times at three distances give the rate, and how far the boundary is from where it was located. A displaced impact
    or entry changes the distance as its time says. NaN where the times do not rise towards the boundary.
    """
    row = lines.row[line]
    speed, angle = lines.at(line, y + side * distance)
    by_speed, by_angle = lines.slopes(line, y)
    step_speed = _SHIFT * distance * (np.abs(by_speed) + 1e-3 * speed)
    step_angle = _SHIFT * distance * (np.abs(by_angle) + 1e-3)
    steps = _STEP_OF_ENTRY * float(distance.min()) * law.scales
    displaced = [law.displaced(k, value + step) for k, (value, step) in enumerate(zip(law.values, steps))]
    possible = [k for k, each in enumerate(displaced) if each is not None]
    points = [
        (speed, angle), *(lines.at(line, y + factor * side * distance) for factor in (4, 16)),
        (speed + step_speed, angle), (speed, angle + step_angle), *((speed, angle) for _ in possible),
    ]  # fmt: skip
    laws = [law] * (len(points) - len(possible)) + [each for each in displaced if each is not None]
    every = (np.concatenate(each) for each in zip(*points, strict=True))
    times = times_under(laws, np.tile(row, len(points)), *every).reshape(len(points), -1)
    time, second, third = times[:3]
    with np.errstate(invalid="ignore", divide="ignore"):
        aside = np.interp((time - second) / (second - third), *_ASIDE, left=np.nan, right=np.nan)  # or no saddle
        rate = np.log((4 + aside) / (1 + aside)) / (time - second)
    rate[~(rate > 0)] = np.nan
    nearer = side * distance * (1 + aside) * np.expm1(-rate * (times[3:] - time))  # minus the change of the distance
    free = np.full((line.size, law.values.size), np.nan)
    free[:, possible] = (nearer[2:] / steps[possible, None]).T
    return free, nearer[0] / step_speed, nearer[1] / step_angle


_RATIOS = np.linspace(-0.6, 0.6, 241)  # of the error of a place to the distance from it
_ASIDE = (
    (np.log((4 + _RATIOS) / (1 + _RATIOS)) / np.log((16 + _RATIOS) / (4 + _RATIOS)))[::-1],
    _RATIOS[::-1],
)  # ratio of the differences of times, ascending, and that error


def slopes(law: BoundLaw, lines: Lines, changes: Changes, which: np.ndarray, quick: bool = False) -> np.ndarray:
    """Derivatives of the places of changes `which` by the free entries: (changes, free entries)."""
    found = normals(law, lines, changes, which, quick).slopes()
    missing = np.flatnonzero(~np.isfinite(found).all(axis=1))
    if missing.size:
        found[missing] = _by_differences(law, lines, changes, which[missing], *(_ROUGHLY if quick else _EXACTLY))
    return found


def _by_differences(
    law: BoundLaw, lines: Lines, changes: Changes, which: np.ndarray, step: float, halvings: int
) -> np.ndarray:
    """The same from the changes' places at displaced free entries, for boundaries without a singular gradient.

    Such a boundary is met at initial contact, where its place follows from the entries alone. Zero where the change
    is not found again.
    """
    found = np.zeros((which.size, law.values.size))
    steps = step * law.scales
    ends = [[law.displaced(k, value + sign * steps[k]) for sign in (1, -1)] for k, value in enumerate(law.values)]
    shown = [k for k, pair in enumerate(ends) if None not in pair]
    displaced = [each for k in shown for each in ends[k] if each is not None]
    if displaced:
        places = _again(displaced, lines, changes, which, halvings).reshape(-1, 2, which.size)
        slope = (places[:, 0] - places[:, 1]) / (2 * steps[shown, None])
        found[:, shown] = np.where(np.isfinite(slope), slope, 0.0).T
    return found


def _again(laws: Sequence[BoundLaw], lines: Lines, changes: Changes, which: np.ndarray, halvings: int) -> np.ndarray:
    """Places of changes near where they were, for each law in turn; NaN where they are not found."""
    line, y, before, after = (
        np.tile(each[which], len(laws)) for each in (changes.line, changes.y, changes.before, changes.after)
    )

    def seen(places: np.ndarray) -> np.ndarray:
        return outcomes_under(laws, lines.row[line], *lines.at(line, places))

    low, high = y - _LOOSEST, y + _LOOSEST
    there = (seen(low) == before) & (seen(high) == after)
    for _ in range(halvings):
        middle = (low + high) / 2
        below = seen(middle) == before
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(there, (low + high) / 2, np.nan)
