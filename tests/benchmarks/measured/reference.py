"""What the answers should be: by a method that no engine under test uses, with an estimate of its own error."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec

from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.casadi.locate import locate
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.scene.scene import Scene

from .answers import Answer, Impact, answer, dimensionless
from .peers.scipy_engine import ScipyLocator

RTOL = 1e-13
_CVODES_RTOLS = (1e-13, 1e-12, 1e-11)  # the tightest that it completes


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
    n = dimensionless(scene, impact)
    model = load(select_model(scene, n.oblique))
    path = locate(model, n.groups, RTOL)
    found = {"rosenbrock": answer(path)}
    if path.time > 0:
        if find_spec("scipy"):
            found = {"DOP853": answer(ScipyLocator(model, n.groups, RTOL, "DOP853").run())} | found
        cvodes = _cvodes(scene, impact)
        if cvodes is not None:
            found["cvodes"] = cvodes
    first = next(iter(found.values()))
    outcomes = {name: each.outcome for name, each in found.items()}
    return Reference(
        impact,
        first.outcome,
        first.restitution,
        decided=path.time == 0,
        difference=max(abs(each.restitution - first.restitution) for each in found.values()),
        computed={name: each.restitution for name, each in found.items()},
        problem="" if len(set(outcomes.values())) == 1 else f"the references disagree: {outcomes}",
    )


def _cvodes(scene: Scene, impact: Impact) -> Answer | None:
    for rtol in _CVODES_RTOLS:
        try:
            found = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine="cvodes", ledger=False)
        except ComputationError:
            continue
        return Answer(found.outcome, found.restitution)
    return None
