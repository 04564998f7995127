"""What the answers should be: by a method that no engine under test uses, with an estimate of its own error."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec

from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.scene.scene import Scene

from .answers import Answer, Impact, dimensionless
from .peers.scipy_engine import ScipyAutomaton

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


def references(scene: Scene, impacts: Sequence[Impact]) -> list[Reference]:
    """The answers for all impacts of a scene."""
    return [reference(scene, impact) for impact in impacts]


def reference(scene: Scene, impact: Impact) -> Reference:
    """The answer by DOP853 (explicit, order 8, scipy's event location), or by Rosenbrock where there is no scipy.

    The others, Rosenbrock and CVODES at tolerances as tight as they take, say how far it can be trusted.
    """
    touch = collide(scene, stokes=impact.stokes, angle=impact.angle, engine="taylor", ledger=False)
    answers = {"rosenbrock": _replayed(scene, impact, "rosenbrock")}
    if touch.until != 0:
        if find_spec("scipy"):
            answers = {"DOP853": ScipyAutomaton(dimensionless(scene, impact), RTOL, "DOP853").run()} | answers
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


def _replayed(scene: Scene, impact: Impact, engine: str) -> Answer | None:
    """By an engine of ours, at the tightest tolerance that it completes."""
    for rtol in _RTOLS:
        try:
            result = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=engine, ledger=False)
        except ComputationError:
            continue
        return Answer(result.outcome, result.restitution) if result.engine == engine else None
    return None
