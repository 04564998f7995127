"""Normals of the boundary at changes of outcome, and the derivatives of their places by the free entries.

Beside a change the gradient of a result in free entries, speed and angle grows without bound along the normal of the
boundary (the time near a saddle as 1/d, e_n at a graze or at a continuous start as 1/sqrt(d), d the distance); the
rest of it is bounded and cancels in the difference of two gradients. Its direction gives the derivative of the
change's place by the implicit function theorem; the error is of order d.

A boundary that is met at initial contact has no such gradient: its place follows from the entries alone. There, and
where the gradients do not grow as they should, the change is located again with displaced entries.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import LAST_ANSWER
from ..engines.settings import KERNEL_STEPS
from .brackets import Brackets, Labels, enclose
from .experiment import Experiment

_SHORT = 1000  # steps of a trajectory with derivatives, where an approximation replaces what takes longer
_CLOSE, _BESIDE = 1e-8, 1e-5  # least distances at which gradients are taken, exact and approximate, and at 4 times it
_GROWTH = 1.3, 8.0  # of a singular gradient from the farther to the nearer
_FAR = 2e-6  # distance from a saddle at which times are taken
_SHIFT, _STEP_OF_ENTRY = 0.1, 2e-3  # steps of an impact, and relative ones of an entry, over that distance
_EXACT, _ROUGH = 1e-5, 1e-4  # relative step of an entry with which a change is located again
_REACH = (5.0, 100.0, 2000.0)  # half widths of the intervals in which it is sought in turn, over that step
_ENCLOSED, _ENCLOSED_ROUGHLY = 1e-6, 1e-4  # widths to which it is enclosed, over the same


@dataclass(frozen=True)
class Lines:
    """Lines of impacts on the rows of an experiment; a point lies at a distance y along its line.

    Attributes:
        row: (lines,), the row of each.
        speed, angle: (lines, 2), value at y = 0 and its derivative by y; m/s and rad.
        low, high: (lines,), the ends of each.
        relative: `speed` is the magnitude of the relative velocity, not the normal speed.
    """

    row: np.ndarray
    speed: np.ndarray
    angle: np.ndarray
    low: np.ndarray
    high: np.ndarray
    relative: bool

    def at(self, line: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normal speeds (m/s) and angles (rad) of points on lines."""
        angle = self.angle[line, 0] + self.angle[line, 1] * y
        speed = self.speed[line, 0] + self.speed[line, 1] * y
        return speed * np.cos(angle) if self.relative else speed, angle

    def slopes(self, line: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Their derivatives by y."""
        angle, by_angle = self.angle[line, 0] + self.angle[line, 1] * y, self.angle[line, 1]
        by_speed = self.speed[line, 1]
        if self.relative:
            speed = self.speed[line, 0] + self.speed[line, 1] * y
            by_speed = by_speed * np.cos(angle) - speed * np.sin(angle) * by_angle
        return by_speed, np.broadcast_to(by_angle, by_speed.shape)


def outcomes_along(experiment: Experiment, lines: Lines) -> Labels:
    """The outcomes at places on lines."""
    return lambda line, y: experiment.outcomes(lines.row[line], *lines.at(line, y))


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


def normals(experiment: Experiment, lines: Lines, changes: Brackets, approximate: bool) -> Normals:
    """The normals at changes, on the side that separates, or that rebounds.

    Arguments:
        approximate: where trajectories with derivatives take many steps, use the times of plain ones; normals to 1e-4.
    """
    line, y, count = changes.line, changes.place, changes.size
    side = np.where(changes.after > changes.before, 1.0, -1.0)
    where = np.tile(line, 2)
    distance = np.maximum(_BESIDE if approximate else _CLOSE, 3 * changes.error)
    at = np.concatenate([y + side * distance, y + 4 * side * distance])
    budget = _SHORT if approximate else KERNEL_STEPS
    near = experiment.results(("contact_time",), lines.row[where], *lines.at(where, at), forward=True, budget=budget)
    by_speed, by_angle = lines.slopes(where, at)
    along = near.speed[0] * by_speed + near.angle[0] * by_angle
    parts = [values[:count] - values[count:] for values in (near.free[0], near.speed[0], near.angle[0], along)]
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.abs(along[:count] / along[count:])
    outcome = near.outcome.reshape(2, count)
    sound = (outcome == np.maximum(changes.before, changes.after)).all(axis=0)
    sound &= (growth > _GROWTH[0]) & (growth < _GROWTH[1])
    free, speed, angle, along = (np.where(sound.reshape(-1, *[1] * (diff.ndim - 1)), diff, np.nan) for diff in parts)
    failures = np.flatnonzero((outcome < 0).any(axis=0)) if approximate else np.zeros(0, int)
    if failures.size:
        far = np.maximum(_FAR, 4 * changes.error[failures])
        free[failures], speed[failures], angle[failures] = _by_times(
            experiment, lines, line[failures], y[failures], side[failures], far
        )
        by_speed, by_angle = lines.slopes(line[failures], y[failures])
        along[failures] = speed[failures] * by_speed + angle[failures] * by_angle
    return Normals(free, speed, angle, along)


def _by_times(
    experiment: Experiment, lines: Lines, line: np.ndarray, y: np.ndarray, side: np.ndarray, distance: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals beside a saddle, where the contact time is linear in the logarithm of the distance from the boundary.

    Times at three distances give the rate, and how far the boundary is from where it was located. A displaced impact
    or entry changes the distance as its time says. NaN where the times do not rise towards the boundary.
    """
    speed, angle = lines.at(line, y + side * distance)
    by_speed, by_angle = lines.slopes(line, y)
    step_speed = _SHIFT * distance * (np.abs(by_speed) + 1e-3 * speed)
    step_angle = _SHIFT * distance * (np.abs(by_angle) + 1e-3)
    steps = _STEP_OF_ENTRY * float(distance.min()) * experiment.scales
    displaced = {k: copy for k, step in enumerate(steps) if (copy := experiment.displaced(k, step)) is not None}
    possible = list(displaced)
    points = [
        (speed, angle), *(lines.at(line, y + factor * side * distance) for factor in (4, 16)),
        (speed + step_speed, angle), (speed, angle + step_angle), *((speed, angle) for _ in possible),
    ]  # fmt: skip
    undisplaced = len(points) - len(possible)
    every, rows = experiment.joined([*[experiment] * (undisplaced - 1), *displaced.values()], lines.row[line])
    speeds, angles = (np.concatenate(column) for column in zip(*points, strict=True))
    answers = every.answers(rows, speeds, angles)
    done = (answers["status"] <= LAST_ANSWER) & (answers["outcome"] > 0)
    times = np.where(done, answers["time"], np.nan).reshape(len(points), -1)
    time, second, third = times[:3]
    with np.errstate(invalid="ignore", divide="ignore"):
        aside = np.interp((time - second) / (second - third), *_ASIDE, left=np.nan, right=np.nan)  # or no saddle
        rate = np.log((4 + aside) / (1 + aside)) / (time - second)
    rate[~(rate > 0)] = np.nan
    nearer = side * distance * (1 + aside) * np.expm1(-rate * (times[3:] - time))  # minus the change of the distance
    free = np.full((line.size, len(steps)), np.nan)
    free[:, possible] = (nearer[2:] / steps[possible, None]).T
    return free, nearer[0] / step_speed, nearer[1] / step_angle


_RATIOS = np.linspace(-0.6, 0.6, 241)  # of the error of a place to the distance from it
_ASIDE = (
    (np.log((4 + _RATIOS) / (1 + _RATIOS)) / np.log((16 + _RATIOS) / (4 + _RATIOS)))[::-1],
    _RATIOS[::-1],
)  # ratio of the differences of times, ascending, and that error


def slopes(experiment: Experiment, lines: Lines, changes: Brackets, approximate: bool = False) -> np.ndarray:
    """Derivatives of the places of changes of outcome by the free entries: (changes, free entries).

    NaN where a change has no singular gradient and is not found again with displaced entries.

    Arguments:
        approximate: as of `normals`.
    """
    normal = normals(experiment, lines, changes, approximate)
    by_free: np.ndarray = -normal.free / normal.along[:, None]
    missing = np.flatnonzero(~np.isfinite(by_free).all(axis=1))
    if missing.size:
        step = _ROUGH if approximate else _EXACT
        by_free[missing] = slopes_by_differences(experiment, lines, changes.subset(missing), step)
    return by_free


def slopes_by_differences(experiment: Experiment, lines: Lines, changes: Brackets, step: float = _EXACT) -> np.ndarray:
    """The same from the places of the changes with displaced entries; NaN where a change is not found again.

    Arguments:
        step: of an entry, over its value.
    """
    by_free = np.full((changes.size, len(experiment.rows.names)), np.nan)
    steps = step * experiment.scales
    ends = {k: [experiment.displaced(k, sign * size) for sign in (1, -1)] for k, size in enumerate(steps)}
    possible = [k for k, both in ends.items() if None not in both]
    moved = [end for k in possible for end in ends[k] if end is not None]
    if moved:
        places = places_again(moved, lines, changes, step).reshape(-1, 2, changes.size)
        by_free[:, possible] = (places[:, 0] - places[:, 1]).T / (2 * steps[possible])
    return by_free


def places_again(experiments: Sequence[Experiment], lines: Lines, changes: Brackets, step: float) -> np.ndarray:
    """Places of changes near where they were, in each experiment in turn; NaN where they are not found."""
    line, y, before, after = (
        np.tile(column, len(experiments)) for column in (changes.line, changes.place, changes.before, changes.after)
    )
    every, rows = experiments[0].joined(experiments[1:], lines.row[changes.line])

    def label(which: np.ndarray, places: np.ndarray) -> np.ndarray:
        return every.outcomes(rows[which], *lines.at(line[which], places))

    places, rest = np.full(y.size, np.nan), np.arange(y.size)
    for reach in _REACH:
        limits = lines.low[line[rest]], lines.high[line[rest]]
        low, high = (np.clip(y[rest] + side * reach * step, *limits) for side in (-1, 1))
        same = (label(rest, low) == before[rest]) & (label(rest, high) == after[rest])
        which = rest[same]
        wide = Brackets(which, low[same], high[same], np.ones(which.size, bool), np.zeros(which.size, bool))
        width = step * (_ENCLOSED_ROUGHLY if step >= _ROUGH else _ENCLOSED)
        places[which] = enclose(lambda which, at: label(which, at) == before[which], wide, width).place
        rest = rest[~same]
    return places
