"""Run time and achieved error of every engine at every tolerance, on the same collisions in the same run.

What the answers should be comes from a method that no engine under test uses, with an estimate of its own error.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.scene.scene import Scene

from .peers.scipy_engine import ScipyAutomaton
from .tasks import Answer, Impact, Task, dimensionless
from .timing import CALL, REPEATS, Engine, Least, Tell, measured

Record = dict[str, Any]

RTOL = 1e-13
_RTOLS = (RTOL, 1e-12, 1e-11)  # of our engines


@dataclass(frozen=True)
class Reference:
    """The answer for an impact.

    Arguments:
        decided: the outcome is clear at initial contact; there is nothing to integrate.
        difference: largest difference in e_n between this value and the two others: the estimate of its error.
        computed: e_n by each of the three.
        problem: why it cannot serve; empty if it can.
    """

    impact: Impact
    outcome: str
    restitution: float
    decided: bool
    difference: float
    computed: dict[str, float]
    problem: str = ""

    @property
    def counts(self) -> bool:
        """Whether engines are measured on it."""
        return not self.decided and not self.problem


def reference(scene: Scene, impact: Impact) -> Reference:
    """The answer by DOP853 (explicit, order 8, scipy's event location), or by Rosenbrock where that cannot follow it.

    The others, Rosenbrock and CVODES at tolerances as tight as they take, say how far it can be trusted.
    """
    touch = collide(scene, stokes=impact.stokes, angle=impact.angle, engine="taylor", ledger=False)
    answers = {"rosenbrock": _replayed(scene, impact, "rosenbrock")}
    if touch.until != 0:
        if find_spec("scipy"):
            answers = {"DOP853": _followed(scene, impact)} | answers
        answers["cvodes"] = _replayed(scene, impact, "cvodes")
    computed = {name: answer for name, answer in answers.items() if answer is not None}
    outcomes = {name: answer.outcome for name, answer in computed.items()}
    first = next(iter(computed.values()))
    return Reference(
        impact,
        first.outcome,
        first.restitution,
        decided=touch.until == 0,
        difference=max(abs(answer.restitution - first.restitution) for answer in computed.values()),
        computed={name: answer.restitution for name, answer in computed.items()},
        problem="" if len(set(outcomes.values())) == 1 else f"the references disagree: {outcomes}",
    )


def _followed(scene: Scene, impact: Impact) -> Answer | None:
    """By DOP853; None for what peers do not have."""
    try:
        return ScipyAutomaton(dimensionless(scene, impact), RTOL, "DOP853").run()
    except ComputationError:
        return None


def _replayed(scene: Scene, impact: Impact, engine: str) -> Answer | None:
    """By an engine of ours, at the tightest tolerance that it completes."""
    for rtol in _RTOLS:
        try:
            result = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=engine, ledger=False)
        except ComputationError:
            continue
        return Answer(result.outcome, result.restitution) if result.engine == engine else None
    return None


def work(
    task: Task, references: Sequence[Reference], engines: Sequence[Engine], repeats: int = REPEATS,
    tell: Tell = lambda _: None, call: int = CALL,
) -> list[Record]:  # fmt: skip
    """A row an engine and tolerance, on the collisions that count."""
    truths = [each for each in references if each.counts]
    asked = task.scene, [each.impact for each in truths]
    found = measured(engines, asked, len(truths), repeats, lambda what: tell(f"{task.preset}: {what}"), call)
    return [row(engine.name, rtol, least, truths) for engine, rtol, least in found] if truths else []


def row(engine: str, rtol: float, least: Least, truths: Sequence[Reference]) -> Record:
    """Seconds and errors over all collisions; what the engine said of those that failed or came out wrong, and where.

    Errors are absolute, in e_n, of doublets that separate. Of copies of a collision the worst counts.
    """
    errors, said, counts = list[float](), dict[str, list[str]](), {"wrong": 0, "failed": 0}
    for k, truth in enumerate(truths):
        worst = max(least.found[k :: len(truths)], key=lambda each: _off(each, truth))
        if isinstance(worst, str) or worst.outcome != truth.outcome:
            counts["failed" if isinstance(worst, str) else "wrong"] += 1
            what = worst if isinstance(worst, str) else f"{worst.outcome} instead of {truth.outcome}"
            said.setdefault(what, []).append(str(truth.impact))
        elif truth.outcome != "stick":
            errors.append(_off(worst, truth))
    summary = {"cpu_mean": least.cpu, "error_largest": max(errors, default=None), **counts}
    return {"engine": engine, "rtol": rtol, "summary": summary, "said": said}


def _off(found: Answer | str, truth: Reference) -> float:
    if isinstance(found, str) or found.outcome != truth.outcome:
        return math.inf
    return abs(found.restitution - truth.restitution)
