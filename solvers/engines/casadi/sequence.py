"""The phases of a collision and the events between them, as the kernel has recorded them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....generated.automaton import BOUNCE, CLOSING, CRITERIA, ENDS, EVENTS, KINDS, OPENING, ROTATE, STICK, EventKind
from ...model.model import Model
from ...model.phases import Phase
from ...scene.groups import contact_gap

_RESTS, _ROLLS, _RUPTURE, _SLIDES = (
    KINDS[kind] for kind in (EventKind.RESTS, EventKind.ROLLS, EventKind.RUPTURE, EventKind.SLIDES)
)
_TURNS = next(event.words for event in EVENTS if event.name == "turning")
_EVENT_OF = {word: event for event in EVENTS for word in event.words}
_BY_NAME = {event.name: event for event in EVENTS}


@dataclass(frozen=True)
class PhaseRun:
    """One phase of a duration (x0/v0) up to an event, and the events reported.

    Arguments:
        event: name of the event function to land on; None if the trajectory ends inside the phase.
        kinds: events reported at its end, in order.
        rebounds: the doublet rebounds at its end.
        holds: the normal velocity is zero from here on, or until release.
        own: name of the declared event that happens at its end, whether or not the phase landed on it.
    """

    phase: Phase
    duration: float
    event: str | None
    kinds: tuple[str, ...]
    rebounds: bool = False
    holds: bool = False
    own: str = ""

    @property
    def criterion(self) -> str:
        """The criterion by which the doublet rebounds at its end; empty if it does not."""
        return self.kinds[0] if self.rebounds else ""


@dataclass(frozen=True)
class EventSequence:
    """The phases and events of a collision.

    Arguments:
        groups: dimensionless groups of the collision.
        edge_watched: as of a `Flow`.
        separated: it ends apart.
        certified: of a stick, whether separation is excluded by a proof.
        time, smallest_gap: of the whole collision, x0/v0 and x0.
        parting: opening speed at separation over v0; 0 of a stick.
        slip: of the surfaces at separation over that at initial contact; NaN where there is none.
        decided: time at which a stick was decided, if it is followed beyond that.
    """

    groups: Mapping[str, float]
    edge_watched: bool
    steps: tuple[PhaseRun, ...]
    separated: bool
    certified: bool
    time: float
    smallest_gap: float
    parting: float
    slip: float
    decided: float | None = None

    @property
    def kinds(self) -> list[str]:
        return [kind for step in self.steps for kind in step.kinds]

    @property
    def reversal(self) -> str | None:
        """The first criterion met."""
        return next((kind for kind in self.kinds if kind in CRITERIA), None)

    @property
    def outcome(self) -> str:
        if not self.separated:
            return STICK
        return BOUNCE if self.reversal else ROTATE


def sequence(
    answer: Mapping[str, Any],
    log: np.ndarray,
    words: Sequence[str],
    model: Model,
    groups: Mapping[str, float],
    decided: float | None = None,
) -> EventSequence:
    """The phases of a collision from the kernel's answer and its log.

    Arguments:
        log: events with the mode that follows each (`HAPPENING`).
        words: of the events by the kernel's numbers.
        decided: time at which a stick was decided, where the log runs beyond that.
    """
    edge = tangential_edge(model, groups)
    rupture = groups["rupture_gap"] if model.bridge else 1.0
    phase, last, steps, over = Phase(film=1, shear=int(edge >= 1.0), motion=CLOSING), 0.0, [], False
    for rows in _simultaneous(_moving(log, words), words):
        time = float(rows[-1]["time"])
        kinds = tuple(words[int(row["kind"])] for row in rows)
        step = _run(model, phase, time - last, kinds)
        steps.append(step)
        phase, last, over = _following(model, phase, rows[-1]), time, _ends(model, step)
    separated = bool(answer["outcome"] > 0)
    if not (over or separated):
        steps.append(PhaseRun(phase, float(answer["time"]) - last, None, ()))
    return EventSequence(
        groups=groups,
        edge_watched=edge != 1.0 and min(contact_gap(groups), 1.0) < edge < rupture,
        steps=tuple(steps),
        separated=separated,
        certified=bool(answer["certified"]),
        time=float(answer["time"]),
        smallest_gap=float(answer["smallest_gap"]),
        parting=float(answer["shown"][model.names("outputs").index("restitution")]) if separated else 0.0,
        slip=float(answer["slip"]) if separated and model.oblique else np.nan,
        decided=decided,
    )


def tangential_edge(model: Model, groups: Mapping[str, float]) -> float:
    """The gap (x0) at which the tangential force ends; infinite head-on."""
    if not model.oblique:
        return np.inf
    given = (groups[str(symbol)] for symbol in model.extra("shear", "edge"))
    return float(model.laws.shear.edge(groups["aspect"], *given))


def _moving(log: np.ndarray, words: Sequence[str]) -> np.ndarray:
    """The events without pairs of turns at one time: there the velocity touches zero, by rounding to either side."""
    turns = np.array([words[kind] in _TURNS for kind in log["kind"]], bool)
    pauses = turns[:-1] & turns[1:] & (log["time"][:-1] == log["time"][1:])
    for k in np.flatnonzero(pauses[1:] & pauses[:-1]) + 1:  # of three turns the first two
        pauses[k] &= not pauses[k - 1]
    moving = np.ones(log.size, bool)
    moving[:-1] &= ~pauses
    moving[1:] &= ~pauses
    return log[moving]


def _simultaneous(log: np.ndarray, words: Sequence[str]) -> Iterator[list[np.void]]:
    """The events by phase: a rebound with the rupture, or the rest and rolling, that it brings about."""
    rows: list[np.void] = []
    for row in log:
        word, before = words[int(row["kind"])], words[int(rows[-1]["kind"])] if rows else ""
        follows = (word in (_RUPTURE, _RESTS) and before in CRITERIA) or (word == _ROLLS and before == _RESTS)
        if rows and not (follows and row["time"] == rows[-1]["time"]):
            yield rows
            rows = []
        rows.append(row)
    if rows:
        yield rows


def _run(model: Model, phase: Phase, duration: float, kinds: tuple[str, ...]) -> PhaseRun:
    word = kinds[0]
    if word in CRITERIA:
        surface = "glass" if word == "glass" else "contact"
        landed = surface if duration > 0 else None
        return PhaseRun(phase, duration, landed, kinds, rebounds=True, holds=_RESTS in kinds)
    own = next((event for event in model.own_events if event.word == word), None)
    if own is not None:
        return PhaseRun(phase, duration, own.name if duration > 0 else None, kinds, own=own.name)
    event = _EVENT_OF[word]
    if word in (_ROLLS, _SLIDES):
        event = _BY_NAME["rolling" if phase.rolling else "slipping"]
    return PhaseRun(phase, duration, event.name if duration > 0 else None, kinds)


def _following(model: Model, phase: Phase, row: np.void) -> Phase:
    """The phase with the mode that the kernel has noted."""
    motion = CLOSING if row["closing"] else OPENING
    return replace(
        phase,
        film=int(row["film"]),
        shear=int(row["shear"]),
        motion=motion,
        resting=bool(row["resting"]),
        cavitated=model.cavitates and motion == OPENING,
        sliding=int(row["sliding"]),
        rolling=bool(row["rolling"]),
    )


def _ends(model: Model, step: PhaseRun) -> bool:
    """True if the event at the end of a phase ends the collision."""
    if step.own:
        return next(event.row.actions[-1] != "go on" for event in model.own_events if event.name == step.own)
    return step.kinds[0] not in CRITERIA and _EVENT_OF[step.kinds[0]].actions[-1] in ENDS
