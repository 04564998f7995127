"""One collision by the Taylor kernel, with its ledger and trajectory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import CLOSING, KINDS, LAST_ANSWER, OPENING, OUTCOMES
from ..engines.casadi.sequence import EventSequence, sequence
from ..engines.steps import Steps
from ..engines.taylor.call import KernelImpacts
from ..engines.taylor.record import Recorded, run_recorded
from ..engines.taylor.undecided import SEPARATES, undecided
from ..errors import ComputationError
from ..model.dimensionless import Problem
from ..model.model import Model
from ..results import DEFINITIONS, TERMS
from ..scene.scene import Scene
from ..scene.user_model_declared import TABLE
from .assemble import assembled
from .result import Collision

if TYPE_CHECKING:
    import xarray

    from ..engines.casadi.trajectory import Stretch


def words_of(scene: Scene) -> tuple[str, ...]:
    """Words of events by the kernel's numbers: the library's, then those of declared events."""
    return KINDS if scene.package is None else (*KINDS, *scene.package.words)


def recorded(
    problem: Problem, rtol: float, ledger: bool = False, trajectory: bool = False, until: float | None = None
) -> Recorded:
    """One collision by the kernel, with its events.

    Arguments:
        until: time (x0/v0) to which a stick is followed on after it is decided.

    Raises:
        ComputationError: phase, time and state, in SI, if the outcome is not decided; or there is no kernel.
    """
    ran = run_recorded(KernelImpacts.single(problem), problem.oblique, rtol, ledger, trajectory, until=until)
    answer, words = ran.answers[0], words_of(problem.scene)
    if answer["status"] > LAST_ANSWER:
        log = ran.events[0, : answer["events"]]
        declared = next((word for word in (words[kind] for kind in log["kind"][::-1]) if word not in KINDS), "")
        states = problem.model(full=ledger).state
        last = log[-1] if log.size else None
        package = problem.scene.package
        own = package is not None and package.table == TABLE
        raise problem.in_si(undecided(answer, tuple(states), last, declared, own))
    if until is not None and answer["outcome"] > 0:
        raise ComputationError(f"a stick that is decided, not proved, {SEPARATES}", advice="leave out --until")
    return ran


def followed(problem: Problem, rtol: float, until: float | None, **options: bool) -> Recorded:
    """One collision by the kernel; a stick is followed to a time (s), before its decision or beyond."""
    ran = recorded(problem, rtol, **options)
    if until is None or ran.answers["outcome"][0] > 0:
        return ran
    longer = recorded(problem, rtol, **options, until=until / problem.time)
    longer.answers["certified"] = ran.answers["certified"]
    return replace(longer, decided=float(ran.answers["time"][0]))


def sequence_of(problem: Problem, rtol: float, until: float | None = None) -> EventSequence:
    """The phases and events of one collision, as the kernel finds them; `until` (s) as for `followed`."""
    return sequence_in(problem, followed(problem, rtol, until, ledger=True))


def sequence_in(problem: Problem, ran: Recorded) -> EventSequence:
    """The phases and events of a record with a ledger."""
    answer, words, model = ran.answers[0], words_of(problem.scene), problem.model(full=True)
    return sequence(answer, ran.events[0, : answer["events"]], words, model, problem.groups, ran.decided)


def collision(
    problem: Problem, rtol: float, ledger: bool = False, trajectory: bool = False, until: float | None = None
) -> Collision:
    """The collision by one call of the kernel.

    Arguments:
        ledger: include the energy ledger and the drift of angular momentum.
        trajectory: include the trajectory, sampled from the Taylor series of the steps.
        until: time (s) to which a stick is followed.

    Raises:
        ComputationError: as `recorded` and `assembled`.
    """
    record = followed(problem, rtol, until, ledger=ledger, trajectory=trajectory)
    answer, account = _row(record.answers), None if record.ledger is None else _row(record.ledger)
    separated = answer["outcome"] > 0
    names, words = problem.model(full=ledger).names("outputs"), words_of(problem.scene)
    log = record.events[0, : answer["events"]]
    results = dict(zip(names, answer["shown"].tolist())) if separated else {}
    results |= {name: answer[str(DEFINITIONS[name].place)] for name in ("rotation", "smallest_gap", "slip_restitution")}
    return assembled(
        problem,
        results,
        outcome=OUTCOMES[answer["outcome"]],
        reversal=KINDS[answer["reversal"]] if answer["reversal"] >= 0 else None,
        certified=bool(answer["certified"]),
        time=answer["time"],
        final_gap=answer["final_gap"],
        events=[(words[kind], time) for kind, time in zip(log["kind"].tolist(), log["time"].tolist(), strict=True)],
        engine="taylor",
        steps=answer["steps"],
        decided=record.decided,
        rtol=rtol,
        terms=account and {name: account[field] for name, field in TERMS.items() if field in account},
        momentum=account["momentum"] if account else 1.0,
        trajectory=_trajectory(problem, rtol, record, ledger) if trajectory else None,
    )


def _row(rows: np.ndarray) -> dict[str, Any]:
    """The only row of a structured array, as Python's numbers (arithmetic with numpy's scalars is slow)."""
    return dict(zip(rows.dtype.names or (), rows[0].tolist(), strict=True))


def _trajectory(problem: Problem, rtol: float, recorded: Recorded, full: bool) -> xarray.Dataset:
    from ..engines.casadi.trajectory import dataset  # imports xarray
    from ..model.rebound import reset

    assert recorded.steps is not None
    model, outcome = problem.model(full=full), OUTCOMES[recorded.answers["outcome"][0]]
    p = model.group_values(problem.groups)
    first, reversal = model.start(p), int(recorded.answers["reversal"][0])
    if reversal >= 0:  # where initial contact decides, the state after it
        first = reset(model.choice, KINDS[reversal])(first, p)[0].full().ravel()
    return dataset([*_stretches(recorded.steps, model, full)], model, problem, first, outcome, "taylor", rtol)


def _stretches(steps: Steps, model: Model, ledger: bool) -> Iterator[Stretch]:
    """The phases of one collision, each with a sampler of its states; none where initial contact decides the outcome.

    Arguments:
        ledger: its terms are the last series of a step, the work against all attractions the first behind the states.
    """
    from ..engines.casadi.trajectory import TAKEN, Stretch
    from ..model.phases import Phase

    rows, turned, size = steps.rows, steps.turned, len(model.state)
    terms = [name for name in model.names("energy_rates") if name != "capillary"] if ledger else []
    firsts = np.flatnonzero(np.diff(rows["phase"], prepend=-1)) if rows.size else np.zeros(0, int)
    for first, end in zip(firsts, np.append(firsts[1:], rows.size)):
        block, row = Steps(rows[first:end], turned), rows[first]
        start = float(row["time"])
        duration = float(rows[end - 1]["time"] + rows[end - 1]["length"]) - start

        def sample(
            parts: np.ndarray, block: Steps = block, start: float = start, duration: float = duration
        ) -> tuple[np.ndarray, dict[str, np.ndarray]]:
            y = block.states(start + parts * duration)
            along = dict(zip(terms, y[len(y) - len(terms) :], strict=True))
            if ledger and "capillary" in model.works:
                along["capillary"] = y[size] - along.get("attraction", 0.0)
            along = {name: along[name] for name in TAKEN if name in along}
            return y[:size], along if turned is None else {"rotation": y[turned], **along}

        if duration > 0.0:
            phase = Phase(int(row["film"]), 0, CLOSING if row["closing"] else OPENING, bool(row["resting"]))
            yield Stretch(str(phase), start, duration, sample)
