"""What boundaries ask of a flight (solvers/probe.py), by the kernel: outcomes, the approach, and how an escape went.

Each returns None where the kernel hands a flight over, or there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..numbers import Numbers
from ..scene import Scene
from .engine import Impacts
from .one import FELL_BACK, TURNED, kind_of
from .record import Purpose, Recorded, Steps, recorded

NO_BUDGET = 2  # status of a flight that has spent its steps (runtime/queue.h)
_APPROACH_BUDGET = 2000  # steps: an approach that the film stops creeps for ever
_PARTS = np.linspace(0, 1, 5)  # of a step, at which a flight is looked at
_FINER = 12  # parts of the surroundings of a maximum, again and again
_ZOOMS = 4


@dataclass(frozen=True)
class Seen:
    """A whole collision: its outcome, the first criterion met, whether it was decided at first touch."""

    outcome: str
    reversal: str | None
    at_touch: bool


@dataclass(frozen=True)
class Escaping:
    """A flight to where it separates, falls back or rests.

    Attributes:
        decided: the flight has come to its end; else it has spent its steps.
        end: the last state.
        times, states: of the flight, states as columns; phases that end at rest in the gap only by their ends.
    """

    decided: bool
    separated: bool
    fell_back: bool
    end: np.ndarray
    times: np.ndarray
    states: np.ndarray


def seen(scene: Scene, speeds: Sequence[float], angle: float, rtol: float) -> list[Seen | None] | None:
    """Whole collisions at normal speeds (m/s) and one angle (rad), all in one call."""
    all_at = np.array(speeds)
    impacts = Impacts(scene, all_at, np.full(all_at.size, angle), {})
    found = recorded(impacts, angle > 0, rtol, trajectory=True, keep=False)
    if found is None:
        return None
    return [Seen(*kind_of(each), bool(each["time"] == 0)) if each["status"] <= 1 else None for each in found.answers]


def approach(
    scene: Scene,
    n: Numbers,
    rtol: float,
    solids: dict[str, float],
    states: int,
    pressure: Callable[[np.ndarray], np.ndarray],
    creeping: float,
) -> tuple[float, float] | None:
    """Largest pressure and smallest gap (x0) of an approach.

    Arguments:
        solids: quantities in SI that say what the solids do, instead of the scene's.
        states: how many of the series are the model's own.
        pressure: of states, as columns.
        creeping: an approach that has spent its steps has been stopped if it is slower than this (v0).
    """
    told = _flown(scene, np.array([n.speed]), n.angle, rtol, solids, Purpose.APPROACH, _APPROACH_BUDGET)
    if told is None or told.steps is None or not told.steps.rows.size:
        return None
    rows = told.steps.rows[told.steps.rows["closing"] != 0]
    steps = Steps(rows, told.steps.turned)
    end = float(rows["time"][-1] + rows["length"][-1])
    last = steps.states(np.array([end]))[:, 0]
    if told.answers["status"][0] > 1 and not abs(last[1]) < creeping:
        return None

    def at(times: np.ndarray) -> np.ndarray:
        return pressure(steps.states(times)[:states])

    times, y = steps.within(_PARTS[:-1])  # no time twice: a maximum lies between its neighbours
    times, values = np.append(times, end), pressure(np.column_stack([y, last])[:states])
    for _ in range(_ZOOMS):
        top = int(np.argmax(values))
        times = np.linspace(times[max(top - 1, 0)], times[min(top + 1, times.size - 1)], _FINER + 1)
        values = at(times)
    return _summit(times, values), float(last[0])


def escaping(
    scene: Scene, n: Numbers, rtol: float, solids: dict[str, float], start: np.ndarray, budget: int
) -> Escaping | None:
    """A flight that goes on until it separates, falls back or rests; proved a stick only while it approaches.

    Arguments:
        start: the model's states at first touch.
        budget: steps.
    """
    told = _flown(scene, np.array([n.speed]), n.angle, rtol, solids, Purpose.ESCAPE, budget)
    if told is None or told.steps is None or told.answers["status"][0] > NO_BUDGET:
        return None
    decided = bool(told.answers["status"][0] < NO_BUDGET)
    answer, rows, size = told.answers[0], told.steps.rows, start.size
    happened = told.events[0, : answer["events"]]
    separated = bool(answer["outcome"])
    fell_back = not separated and happened.size > 0 and int(happened["kind"][-1]) == FELL_BACK
    if not rows.size:
        end = start.copy()
        end[1] = answer["shown"][0] if separated else end[1]
        return Escaping(decided, separated, fell_back, end, np.zeros(1), start[:, None])
    ends = rows["time"] + rows["length"]
    # phases that end at rest in the gap, by the times at which they do
    turns = happened["time"][np.isin(happened["kind"], (TURNED, FELL_BACK))]
    lasts = np.append(np.flatnonzero(np.diff(rows["phase"])), rows.size - 1)
    resting_end = dict(zip(rows["phase"][lasts].tolist(), np.isin(ends[lasts], turns).tolist(), strict=True))
    looked_at = np.array([not resting_end[phase] for phase in rows["phase"].tolist()])
    times, states = Steps(rows[looked_at], None).within(_PARTS)
    more, turned = Steps(rows[lasts], None).within(np.ones(1))
    end = turned[:size, -1]
    if separated:
        end[1] = answer["shown"][0]
    times = np.concatenate([np.zeros(1), times, more])
    states = np.hstack([start[:, None], states[:size], turned[:size]])
    return Escaping(decided, separated, fell_back, end, times, states)


def _summit(at: np.ndarray, values: np.ndarray) -> float:
    """The largest of values on an even grid, by the parabola through it and its neighbours."""
    top = int(np.argmax(values))
    if top in (0, at.size - 1):
        return float(values[top])
    before, here, after = (float(value) for value in values[top - 1 : top + 2])
    bend = before - 2 * here + after
    return here - (after - before) ** 2 / (8 * bend) if bend < 0 else here


def _flown(
    scene: Scene,
    speeds: np.ndarray,
    angle: float,
    rtol: float,
    solids: dict[str, float],
    purpose: Purpose,
    budget: int,
) -> Recorded | None:
    others = {name: np.full(speeds.size, value) for name, value in solids.items()}
    impacts = Impacts(scene, speeds, np.full(speeds.size, angle), others)
    return recorded(impacts, angle > 0, rtol, trajectory=True, budget=budget, purpose=purpose, fold=False)
