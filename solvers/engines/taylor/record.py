"""Trajectories by the kernel, with their events, ledger and the polynomials of every step."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....generated.automaton import LAST_ANSWER, Purpose
from ..settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE
from ..steps import Steps
from .build import kernel
from .call import KernelImpacts, task, variant
from .headers import books_own
from .layout import ANSWER, ANSWER_IN_SPACE, HAPPENING, LEDGER, OWN_LEDGER, number, step_row

_ROOM = 64, 256  # events and steps of a collision


@dataclass(frozen=True)
class Recorded:
    """Trajectories: an ANSWER each, its events (the first `events` of a row), its LEDGER, and all steps.

    `peaks` has the largest margin of the glass criterion while closing (a logarithm; -inf if unknown). `decided` is the
    time (x0/v0) at which a stick was decided that ends at another.
    """

    answers: np.ndarray
    events: np.ndarray
    ledger: np.ndarray | None
    steps: Steps | None
    peaks: np.ndarray | None = None
    decided: float | None = None


def run_recorded(
    impacts: KernelImpacts,
    oblique: bool,
    rtol: float,
    ledger: bool = False,
    trajectory: bool = False,
    budget: int = KERNEL_STEPS,
    purpose: Purpose = Purpose.WHOLE,
    keep: bool = True,
    fold: bool = True,
    peaks: bool = False,
    events: bool = True,
    room: tuple[int, int] = _ROOM,
    until: float | None = None,
) -> Recorded:
    """Trajectories of impacts, all oblique or all head-on, with the angle turned.

    Arguments:
        ledger: also the energy ledger; the spin is then a state of its own.
        trajectory: also record every step.
        purpose: other than WHOLE only with a trajectory.
        fold: treat a partner equal to the sphere as an equal sphere.
        keep: return the steps; otherwise the same kernel integrates without recording them.
        events: also return the events, of undecided collisions the first and the last; otherwise answers only count
            them.
        peaks: also the largest margin of the glass criterion; only with a trajectory.
        room: events and steps of a collision that there is room for; where that is not enough, all are integrated
            again.
        until: time (x0/v0) to which a single collision is followed, a stick beyond its proof.
    """
    wanted = variant(impacts.scene, oblique, rtol, True, ledger, trajectory, fold, small=impacts.small)
    wanted = wanted if until is None else replace(wanted, limit=True, lanes=1)
    library = kernel(wanted)
    size, keep = impacts.size, keep and trajectory
    margins = np.full(size, -np.inf) if peaks else None
    log_room, step_room = room[0] * events, room[1] * size
    while True:
        answers, log = np.zeros(size, ANSWER), np.zeros((size, log_room), HAPPENING)
        ledgers = np.zeros(size if ledger else 0, OWN_LEDGER if books_own(wanted.choice) else LEDGER)
        rows = np.empty(step_room, step_row(library)) if keep else None  # the kernel counts the rows that it fills
        call = task(library, impacts, rtol, budget, answers)
        call.number("purpose", purpose)
        call.number("until", until or 0.0)
        if events:
            call.buffer("log", log)
        call.buffer("books", ledgers)
        if rows is not None:
            call.buffer("rows", rows)
        if margins is not None:
            call.buffer("peaks", margins)
        steps, most = call.run(), int(answers["events"][answers["status"] <= LAST_ANSWER].max(initial=0))
        if (most <= log_room or not events) and (rows is None or steps <= rows.size):
            break
        log_room, step_room = max(most, log_room), max(steps, step_room)
    turned = number(library, "row_turned") if trajectory else -1
    written = None if rows is None else Steps(rows[:steps], None if turned < 0 else turned)
    return Recorded(answers, log, ledgers if ledger else None, written, margins)


def recorded_in_space(impact: KernelImpacts, rtol: float) -> tuple[Any, np.ndarray]:
    """The answer of one pair in space, and its events with the modes between them (`HAPPENING`)."""
    library, room = kernel(variant(impact.scene, True, rtol, space=True)), _ROOM[1]
    while True:
        answers, log = np.zeros(1, ANSWER_IN_SPACE), np.zeros(room, HAPPENING)
        call = task(library, impact, rtol, KERNEL_STEPS_IN_SPACE, answers)
        call.buffer("log", log)
        call.run()
        events = int(answers["events"][0])
        if events <= room:
            return answers[0], log[:events]
        room = events
