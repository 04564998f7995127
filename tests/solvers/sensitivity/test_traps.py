"""The traps of differentiating through CasADi's integrators, each kept shut."""

from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import sensitivities
from wetdoublet.solvers.engines.casadi import integrators
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed, Tolerance, tolerance_for
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.sensitivity import derivatives
from wetdoublet.solvers.sensitivity import trajectory_expression as graph
from wetdoublet.solvers.sensitivity.derivatives import evaluate
from wetdoublet.solvers.sensitivity.problem import Problem

from ...helpers.sensitive import CASES, DRY

pytestmark = pytest.mark.slow

GLASS = CASES[0].scene
WRT = ("liquid.glass_transition_pressure", "bridge.volume", "liquid.film_thickness", "impact.angle")


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


def test_options_that_derivatives_rest_on() -> None:
    """CVODES controls the error of adjoint quadratures, absolute tolerances are 1e-3 of the relative ones, and the
    spacing of checkpoints is CasADi's own.
    """
    told = tolerance_for(1e-9, "rosenbrock", nondimensionalise(GLASS, float(GLASS.speed or 0), 0.5).groups)
    assert told.absolute == pytest.approx(1e-3 * told.relative)
    assert told.options("cvodes")["quad_err_con"] is True
    assert "steps_per_checkpoint" not in {**told.options("cvodes"), **told.options("rosenbrock")}


@pytest.mark.parametrize("plugin", ["cvodes", "rosenbrock"])
def test_integrators_that_are_differentiated_have_no_events(plugin: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Events are landed on outside (CVODES' own are silently wrong), and integrals are states, not quadratures."""
    built: list[tuple[str, str, set[str]]] = []
    usual = integrators.integrator

    def spied(name: str, engine: str, dae: dict[str, Any], *rest: Any) -> Any:
        built.append((name, engine, set(dae)))
        return usual(name, engine, dae, *rest)

    monkeypatch.setattr(integrators, "integrator", spied)
    # a tolerance that nothing else asks for, so that nothing is taken from the caches
    sensitivities(GLASS, ["rotation", "energy.capillary"], rtol=1.03e-9, engine=plugin)
    assert {name for name, engine, _ in built if engine == plugin} >= {"flow"}
    for name, engine, parts in built:
        assert parts == ({"x", "p", "ode", "zero"} if name == "locate" else {"x", "p", "ode"})
        assert engine == "rosenbrock" or "zero" not in parts


def test_a_failure_is_no_zero() -> None:
    """An integrator that gives up raises; zeros would look like a stick that depends on nothing."""
    problem = Problem.of(GLASS, float(GLASS.speed or 0), float(GLASS.angle or 0), WRT, "speed")
    path, _ = problem.located(1e-9)
    course = graph.course_of(path, path.model.choice)
    whole = graph.trajectory_expression(course, ("restitution",), "rosenbrock", Tolerance(1e-9, 1e-12))
    with pytest.raises(IntegrationFailed):
        evaluate(whole.function, path.p * np.nan, np.array([step.duration for step in path.steps]))
    durations = np.array([step.duration for step in path.steps]) / 3
    with pytest.raises(IntegrationFailed, match="misses"):
        derivatives.settled(whole, path.p, durations, np.arange(3), 1e-9)


def test_located_durations_need_not_be_exact() -> None:
    """The landing takes the rest: durations wrong by 1e-4 give the same derivatives once they are settled."""
    problem = Problem.of(GLASS, float(GLASS.speed or 0), float(GLASS.angle or 0), WRT, "speed")
    path, _ = problem.located(1e-9)
    right = problem.slopes(path, ("restitution",), "adjoint", "rosenbrock", 1e-10)
    steps = [type(step)(**{**vars(step), "duration": step.duration * (1 + 1e-4)}) for step in path.steps]
    path.steps[:] = steps
    found = problem.slopes(path, ("restitution",), "adjoint", "rosenbrock", 1e-10)
    assert found.first == pytest.approx(right.first, rel=1e-8)
    assert found.value == pytest.approx(right.value, rel=1e-9)
