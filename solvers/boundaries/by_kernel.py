"""Collisions for boundaries by the kernel: outcomes and margins of many, the approach and the escape of one.

`approach` and `escaping` return None where the kernel does not complete a collision; all return None without a kernel.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import BOUNCE, LAST_ANSWER, OUTCOMES, ROTATE, STICK, EventKind, Purpose, Status
from ..collision.by_kernel import words_of
from ..engines.taylor.call import Impacts
from ..engines.taylor.endless import limits
from ..engines.taylor.record import Recorded, Steps, run_recorded
from ..model.dimensionless import DimensionlessGroups
from ..model.model import select_model
from ..scene.groups import sideways
from ..scene.scene import Scene

_APPROACH_BUDGET = 2000  # steps; an approach stopped by the film creeps indefinitely
LOOK_BUDGET = 20_000  # steps of a sampled collision; limits how close to a separatrix collisions are sampled
_PARTS = np.linspace(0, 1, 5)  # parts of a step at which a trajectory is sampled
_FINER = 12  # subdivisions, in each round, of the neighbourhood of a maximum
_ZOOMS = 4
_EARLIER = 5  # the last state of chatter is compared with the state after this fraction (1/n) of its steps


Happenings = list[tuple[str, float]]
"""Events of a collision, their words and times (x0/v0)."""
LOOK = np.dtype(
    [
        ("outcome", "i1"),  # 0 stick, 1 stick-rotate-separate, 2 bounce, -1 not completed by the kernel
        ("creeps", "?"),  # step budget exhausted after few events
        ("chatters", "?"),  # step budget exhausted after many events
        ("reversal", "i1"),  # the first criterion met, in the order glass, elastic, rough; -1 for none
        ("at_touch", "?"),  # decided at initial contact
        ("events", "i4"),  # number of events
        ("restitution", "f8"),
        ("time", "f8"),  # end time, x0/v0
        ("smallest_gap", "f8"),  # x0
        ("final_gap", "f8"),  # x0
        ("glass", "f8"),  # largest margin of the glass criterion while closing; -inf where none is known
    ]
)
"""Record of a sampled collision."""


@dataclass(frozen=True)
class Escaping:
    """A trajectory until it separates, falls back or rests.

    Attributes:
        decided: the trajectory has reached its end; else its step budget is exhausted.
        end: the last state.
        times, states: samples, states as columns; phases that end at rest in the gap only by their ends.
    """

    decided: bool
    separated: bool
    fell_back: bool
    end: np.ndarray
    times: np.ndarray
    states: np.ndarray


def looked(
    scene: Scene,
    speed: np.ndarray,
    angle: np.ndarray,
    rtol: float,
    purpose: Purpose = Purpose.WHOLE,
    solids: Mapping[str, np.ndarray] | None = None,
    budget: int = LOOK_BUDGET,
) -> np.ndarray | None:
    """An array of LOOK for collisions at normal speeds (m/s) and angles (rad), in one call of each kernel.

    Arguments:
        solids: SI quantities of the rebound criteria that replace the scene's.
    """
    found = np.zeros(speed.size, LOOK)
    for oblique in (True, False):
        which = np.flatnonzero(sideways(scene, angle, {}) == oblique)
        if not which.size:
            continue
        others = {name: values[which] for name, values in (solids or {}).items()}
        impacts = Impacts(scene, speed[which], angle[which], others)
        recorded = run_recorded(
            impacts, oblique, rtol, trajectory=True, budget=budget, purpose=purpose, keep=False, fold=False,
            peaks=True, events=False,
        )  # fmt: skip
        if recorded is None or recorded.peaks is None:
            return None
        answers = recorded.answers
        part = np.zeros(which.size, LOOK)
        part["outcome"] = np.where(answers["status"] <= LAST_ANSWER, answers["outcome"], -1)
        part["creeps"], part["chatters"] = (
            answers["status"] == status for status in (Status.NO_BUDGET, Status.CHATTER)
        )
        part["at_touch"] = answers["time"] == 0
        part["restitution"] = answers["shown"][:, 0]
        part["glass"] = recorded.peaks
        for name in ("reversal", "events", "time", "smallest_gap", "final_gap"):
            part[name] = answers[name]
        if purpose == Purpose.WHOLE and not others:
            _take_limits(part, impacts, answers, oblique, rtol, budget)
        found[which] = part
    return found


def happenings(
    scene: Scene, speed: np.ndarray, angle: float, rtol: float, budget: int = LOOK_BUDGET
) -> list[Happenings] | None:
    """The events of collisions at normal speeds (m/s) and an angle (rad); None if one is not completed."""
    impacts = Impacts(scene, speed, np.full(speed.size, angle), {})
    recorded = run_recorded(
        impacts, scene.turns(angle), rtol, trajectory=True, budget=budget, keep=False, fold=False
    )  # fmt: skip
    if recorded is None or (recorded.answers["status"] > LAST_ANSWER).any():
        return None
    words = words_of(scene)
    rows = [log[:count] for log, count in zip(recorded.events, recorded.answers["events"], strict=True)]
    return [[(words[int(row["kind"])], float(row["time"])) for row in own] for own in rows]


def _take_limits(
    part: np.ndarray, impacts: Impacts, answers: np.ndarray, oblique: bool, rtol: float, budget: int
) -> None:
    """Fill in the limit outcomes of doublets that entered and left their film until the step budget was exhausted."""
    endless = np.flatnonzero(part["chatters"])
    if not endless.size:
        return
    those = impacts.part(endless)
    before = run_recorded(those, oblique, rtol, trajectory=True, budget=budget // _EARLIER, keep=False, events=False)
    assert before is not None  # the kernel is available
    choice = select_model(impacts.scene, oblique, fold=False)
    held = limits(before.answers, answers[endless], impacts.scene, those.speed, those.angle, choice, rtol)
    for k, stays in zip(endless.tolist(), held, strict=True):
        if stays is not None:
            reached = BOUNCE if part["reversal"][k] >= 0 else ROTATE
            part["outcome"][k] = OUTCOMES.index(STICK if stays else reached)
            part["restitution"][k] = part["time"][k] = np.nan


def approach(
    scene: Scene,
    n: DimensionlessGroups,
    rtol: float,
    solids: dict[str, float],
    states: int,
    pressure: Callable[[np.ndarray], np.ndarray],
    creeping: float,
) -> tuple[float, float] | None:
    """Largest pressure and smallest gap (x0) of an approach.

    Arguments:
        solids: SI quantities of the rebound criteria that replace the scene's.
        states: number of series that are states of the model.
        pressure: function of states, as columns.
        creeping: speed (v0) below which an approach that exhausted its steps counts as stopped.
    """
    recorded = _run_kernel(scene, np.array([n.speed]), n.angle, rtol, solids, Purpose.APPROACH, _APPROACH_BUDGET)
    if recorded is None or recorded.steps is None or not recorded.steps.rows.size:
        return None
    rows = recorded.steps.rows[recorded.steps.rows["closing"] != 0]
    if not rows.size:
        return None
    steps = Steps(rows, recorded.steps.turned)
    end = float(rows["time"][-1] + rows["length"][-1])
    last = steps.states(np.array([end]))[:, 0]
    if recorded.answers["status"][0] > LAST_ANSWER and not abs(last[1]) < creeping:
        return None

    def at(times: np.ndarray) -> np.ndarray:
        return pressure(steps.states(times)[:states])

    times, y = steps.within(_PARTS[:-1])  # drop repeated times, so that a maximum lies between its neighbours
    times, values = np.append(times, end), pressure(np.column_stack([y, last])[:states])
    for _ in range(_ZOOMS):
        top = int(np.argmax(values))
        times = np.linspace(times[max(top - 1, 0)], times[min(top + 1, times.size - 1)], _FINER + 1)
        values = at(times)
    return _summit(times, values), float(last[0])


def escaping(
    scene: Scene, n: DimensionlessGroups, rtol: float, solids: dict[str, float], start: np.ndarray, budget: int
) -> Escaping | None:
    """A trajectory until it separates, falls back or rests; certificates end it only while it approaches.

    Arguments:
        start: the model's states at initial contact.
        budget: largest number of steps.
    """
    recorded = _run_kernel(scene, np.array([n.speed]), n.angle, rtol, solids, Purpose.ESCAPE, budget)
    if recorded is None or recorded.steps is None or recorded.answers["status"][0] > Status.NO_BUDGET:
        return None
    decided = bool(recorded.answers["status"][0] < Status.NO_BUDGET)
    answer, rows, size = recorded.answers[0], recorded.steps.rows, start.size
    happened = recorded.events[0, : answer["events"]]
    separated = bool(answer["outcome"])
    fell_back = not separated and happened.size > 0 and int(happened["kind"][-1]) == EventKind.FELL_BACK
    if not rows.size:
        end = start.copy()
        end[1] = answer["shown"][0] if separated else end[1]
        return Escaping(decided, separated, fell_back, end, np.zeros(1), start[:, None])
    ends = rows["time"] + rows["length"]
    # end times of phases that end at rest in the gap
    turns = happened["time"][np.isin(happened["kind"], (EventKind.TURNED, EventKind.FELL_BACK))]
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
    """The maximum of values on an even grid, by a parabola through the largest and its neighbours."""
    top = int(np.argmax(values))
    if top in (0, at.size - 1):
        return float(values[top])
    before, here, after = (float(value) for value in values[top - 1 : top + 2])
    bend = before - 2 * here + after
    return here - (after - before) ** 2 / (8 * bend) if bend < 0 else here


def _run_kernel(
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
    return run_recorded(impacts, scene.turns(angle), rtol, trajectory=True, budget=budget, purpose=purpose, fold=False)
