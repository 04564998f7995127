"""Distance of a collision from the nearest boundary, where derivatives jump or diverge, by the kernel.

Collisions at other speeds, on a geometric ladder of relative distances to both sides, show where the outcome, the
sequence of rebounds or that of declared events changes; the nearest change is enclosed. The switch of a rebound between
sliding and sticking is no such change: it is measured by the engine that differentiates.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from ...generated.automaton import CRITERIA, KINDS, LAST_ANSWER, EventKind
from ..boundaries.brackets import Brackets, enclose
from ..collision.by_kernel import words_of
from ..engines.taylor.call import KernelImpacts
from ..engines.taylor.record import run_recorded
from ..engines.taylor.tangent import DISTANCES, GRIPS
from ..errors import ComputationError
from ..model.dimensionless import Problem
from ..scene.groups import TIE
from ..scene.origin import Record
from ..scene.scene import Scene

LIMIT, PER_RTOL, WIDEST = 1e-6, 1e4, 1e-3
LADDER = tuple(np.geomspace(1e-9, 0.5, 30).tolist())
"""Relative distances at which neighbours of a collision are computed."""
FINE = 1e-11  # tolerance of these collisions
_WIDTH, _NARROWEST = 1e-2, 1e-11  # of an enclosed change: relative to its distance, and at least
_SAMPLES = 32  # of a round of enclosing it
# Widths past a change at which the opening speed tells a graze from a separatrix, and a rim from a saddle: its square
# varies with the root of the distance past a graze, linearly past a rim, where it vanishes, and about so past a saddle.
_BEYOND = np.array([4.0, 8.0, 16.0])
_BENT, _LOST = 0.6, 1.5  # ratios between those of these laws: of successive changes, 0.7 and 0.5; of values, 2 and 1
_NOISE = 1e-9

AT_ONCE = " at initial contact"
GLASS = "graze of the glass criterion"
TOUCH = "glass criterion met" + AT_ONCE
CONTACT = "graze of the contact gap"
SADDLE = "separatrix (saddle of the effective potential)"
RIM = "separatrix (rim: it just reaches the rupture gap)"
CHATTER = "chatter (it rests on the solids before it separates)"
DECLARED = "edge of the declared event"

_RESTS = KINDS[EventKind.RESTS]
_CUT_OFF = {
    KINDS[EventKind.HALF_TURN]: "half turn at separation",
    KINDS[EventKind.ROTATION_REVERSES]: "reversal of the rotation",
}
# these alone are no change, but tell what one is
_TURNS = tuple(KINDS[kind] for kind in (EventKind.TURNED, EventKind.FELL_BACK, EventKind.RUPTURE))


class Near(Record):
    """The nearest known boundary, and the collision's distance from it relative to the quantity `of`."""

    boundary: str
    distance: float
    of: str

    def __str__(self) -> str:
        return f"{self.boundary} at a relative distance of {self.distance:.2g} in {self.of}"


def limit(rtol: float) -> float:
    """Relative distance to a boundary within which no derivative is given.

    Errors of the trajectory are amplified by one over the distance; at the limit they reach rtol/limit = 1e-4 of a
    derivative.
    """
    return min(max(LIMIT, PER_RTOL * rtol), WIDEST)


def refused(near: Near, least: float) -> ComputationError:
    """The error for a collision nearer to a boundary than `least`."""
    return ComputationError(
        f"no derivative: the collision lies at the {near}, nearer than {least:.1g}",
        advice="move the impact; the boundary itself can be differentiated (wetdoublet boundary --wrt)",
    )


def checked(courses: Courses, separated: bool, rtol: float) -> Near | None:
    """The nearest boundary of a collision; ComputationError if it is too near for derivatives."""
    least = limit(rtol)
    near = along_speed(courses, LADDER if separated else (least,))
    if near is not None and near.distance < least:
        raise refused(near, least)
    return near


def check_grip(distance: float, rtol: float) -> None:
    """ComputationError if a rebound lies at the switch between sliding and sticking, by the logarithm of the ratio."""
    name, of = DISTANCES[GRIPS]
    if distance < limit(rtol):
        raise refused(Near(name, distance, of), limit(rtol))


def explained(courses: Courses, error: ComputationError, rtol: float) -> ComputationError:
    """The error for a trajectory that is not decided: names the boundary if it is close to one."""
    least = limit(rtol)
    near = along_speed(courses, [place for place in LADDER if place <= least])
    return error if near is None else refused(near, least)


@dataclass(frozen=True)
class Course:
    """What happens in a collision.

    Arguments:
        separated: None if that is not decided.
        events: words of its rebounds (with `AT_ONCE` at initial contact), turning points, declared events and end.
        speed: opening speed at separation.
    """

    separated: bool | None
    events: tuple[str, ...]
    speed: float

    @property
    def label(self) -> tuple[str, ...]:
        """Differs between courses with a boundary in between; of a stick only the outcome counts."""
        return tuple(word for word in self.events if word not in _TURNS) if self.separated else ("stick",)


Courses = Callable[[np.ndarray], list[Course]]
"""Speeds, as factors of that of the collision -> what happens at each."""


def course(answer: np.void, log: np.ndarray, words: Sequence[str], speed: float) -> Course:
    """The course of a recorded collision.

    Arguments:
        words: of the events by the kernel's numbers.
        speed: opening speed, if it separates.
    """
    rows, passed_over = log[: answer["events"]], {*KINDS} - {*CRITERIA, *_TURNS, *_CUT_OFF, _RESTS}
    happened = [(words[kind], time) for kind, time in rows[["kind", "time"]].tolist()]
    happened = [(word, time) for word, time in happened if word not in passed_over]
    events = tuple(word + AT_ONCE if word in CRITERIA and time == 0 else word for word, time in happened)
    return Course(bool(answer["outcome"] > 0) if answer["status"] <= LAST_ANSWER else None, events, speed)


def courses_of(scene: Scene, n: Problem, factors: np.ndarray) -> list[Course]:
    """What happens in a scene's collision at other speeds."""
    impacts = KernelImpacts(scene, n.speed * factors, np.full(factors.size, n.angle), small=True)
    ran, words = run_recorded(impacts, n.oblique, FINE, ledger=True), words_of(scene)
    speeds = ran.answers["shown"][:, 0].tolist()
    rows = zip(ran.answers, ran.events, speeds, strict=True)
    return [course(answer, log, words, speed) for answer, log, speed in rows]


def along_speed(courses: Courses, ladder: Sequence[float]) -> Near | None:
    """The nearest change of a collision's course with its speed; None if there is none on the ladder."""
    places = np.concatenate([-np.array(ladder)[::-1], [0.0], ladder])
    numbers: dict[tuple[str, ...] | None, int] = {None: -1}

    def labels(_: np.ndarray, place: np.ndarray) -> np.ndarray:
        keys = [None if other.separated is None else other.label for other in courses(1 + place)]
        return np.array([numbers.setdefault(key, len(numbers)) for key in keys])

    label = labels(places, places)
    here = next((key for key, number in numbers.items() if number == label[len(ladder)]), None)
    if here is not None and _RESTS in here:
        return Near(CHATTER, 0.0, "rebound speed")
    valid = label >= 0
    changes = Brackets.between(np.zeros(int(valid.sum()), int), places[valid], label[valid])
    if not changes.size:
        return None
    closest = np.argsort(np.maximum(np.abs(changes.low), np.abs(changes.high)))[:2]  # one to either side
    closed = enclose(labels, changes.subset(closest), _width, at_once=_SAMPLES, unknown=-1)
    nearest = closed.subset(np.argmin(np.abs(closed.place), keepdims=True))
    distance = max(abs(nearest.place[0]), nearest.error[0])  # beside a course that is not decided it is the error
    return Near(_name(courses, nearest), float(distance), "impact.stokes")


def _width(brackets: Brackets) -> np.ndarray:
    return np.asarray(np.maximum(_WIDTH * np.abs(brackets.place), _NARROWEST))


def _name(courses: Courses, change: Brackets) -> str:
    """The name of an enclosed change, from what differs between the courses at its ends."""
    ends = np.append(change.low, change.high)
    low, high = courses(1 + ends)
    pairs = zip_longest(low.events, high.events, fillvalue="")
    differing = next(({*pair} for pair in pairs if pair[0] != pair[1]), {""})
    if "glass" + AT_ONCE in differing and "" not in differing:
        return TOUCH
    differing = {word.removesuffix(AT_ONCE) for word in differing}
    for word in differing - {"", *KINDS}:
        return f"{DECLARED} {word}"
    criteria = differing & CRITERIA.keys()
    graze = GLASS if "glass" in criteria else TIE if len(criteria) > 1 else CONTACT
    if criteria and "" not in differing:
        return graze
    if _RESTS in differing and low.separated and high.separated:
        return CHATTER
    for word in differing & _CUT_OFF.keys():
        return _CUT_OFF[word]
    width = np.ptp(ends) if high.separated else -np.ptp(ends)
    beyond = (ends[1] if high.separated else ends[0]) + _BEYOND * width
    slow, middle, fast = (beside.speed**2 for beside in courses(1 + beyond))
    rise = abs(middle - slow)
    if criteria and rise > max(_BENT * abs(fast - middle), _NOISE * middle):  # a stick that is proved before it turns
        return graze
    return RIM if middle > _LOST * slow else SADDLE
