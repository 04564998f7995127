"""The traps of differentiating through CasADi's integrators, each kept shut."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest
from casadi import Function
from wetdoublet.solvers import Scene, sensitivities
from wetdoublet.solvers.collision.by_kernel import sequence_of
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed
from wetdoublet.solvers.engines.casadi.replay import replayed
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.sensitivity.by_casadi import derivatives, evaluate
from wetdoublet.solvers.sensitivity.trajectory import course_of, trajectory

from ...helpers.sensitive import CASES, DRY

pytestmark = pytest.mark.slow

GLASS = CASES[0].scene


# ---- events that are true where a phase starts


def test_a_criterion_true_at_first_touch() -> None:
    """Without a bridge, glass at initial contact: e_n = e_dry whatever else; so is its gradient."""
    found = sensitivities(DRY, ["restitution", "contact_time"], stokes=50.0, angle="20 deg", method="adjoint")
    assert found.value["restitution"] == 0.99
    row = found.gradient["restitution"]
    assert row["particles.dry_restitution"] == 1.0
    assert {value for name, value in row.items() if name != "particles.dry_restitution"} == {0.0}
    assert set(found.gradient["contact_time"].values()) == {0.0}


# ---- the integrators


@dataclass(frozen=True)
class Differentiable:
    """A collision as a function of groups and durations, with its values of both."""

    function: Function
    p: np.ndarray
    durations: np.ndarray

    @classmethod
    def of(cls, scene: Scene) -> Differentiable:
        n = nondimensionalise(scene, float(scene.speed or 0), float(scene.angle or 0))
        choice = select_model(scene, n.oblique)
        path, replay = replayed(partial(sequence_of, n), choice, (), "rosenbrock", 1e-10)
        function = trajectory(course_of(path, replay, choice), ("restitution",), "rosenbrock", replay.tolerance)
        p = load(choice).group_values(n.groups)
        return cls(function, p, np.array([piece.duration for piece in replay.pieces]))

    def gradient(self, durations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return derivatives(self.function, self.p, durations, np.eye(self.p.size), "adjoint", amplified=False)


def test_a_rebound_that_rests_loses_all_of_its_speed() -> None:
    """What differentiates takes the rest's share of the energy too, as the ledger does."""
    n = nondimensionalise(GLASS, float(GLASS.speed or 0), float(GLASS.angle or 0))
    choice = select_model(GLASS, n.oblique)
    course = course_of(*replayed(partial(sequence_of, n), choice, (), "rosenbrock", 1e-9), choice)
    leg = next(leg for leg in course.legs if leg.rebounds)
    p = course.model.group_values(n.groups)
    state = np.asarray(course.model.start(p))
    after, lost, *_ = (np.asarray(part.full()).ravel() for part in course.reset(replace(leg, holds=True))(state, p))
    assert after[1] == 0
    assert lost == pytest.approx(state[1] ** 2 / 2, rel=1e-15)


def test_a_failure_is_no_zero() -> None:
    """An integrator that gives up raises; zeros would look like a stick that depends on nothing."""
    collision = Differentiable.of(GLASS)
    with pytest.raises(IntegrationFailed):
        evaluate(collision.function, collision.p * np.nan, collision.durations)
    with pytest.raises(IntegrationFailed, match="misses"):
        collision.gradient(collision.durations / 3)


def test_durations_need_not_be_exact() -> None:
    """The landing takes the rest: durations wrong by 1e-4 give the same derivatives once they are corrected."""
    collision = Differentiable.of(GLASS)
    value, slopes = collision.gradient(collision.durations)
    found_value, found_slopes = collision.gradient(collision.durations * (1 + 1e-4))
    assert found_slopes == pytest.approx(slopes, rel=1e-8)
    assert found_value == pytest.approx(value, rel=1e-9)
