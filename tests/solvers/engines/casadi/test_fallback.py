"""Collisions end where an integrator fails at the tolerance it is given, or lands beside their events."""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from wetdoublet.solvers import collide
from wetdoublet.solvers.collision.by_casadi import by_casadi
from wetdoublet.solvers.engines.casadi.integrators import Tolerance, tolerance_for
from wetdoublet.solvers.model.dimensionless import nondimensionalise

IMPACTS = {"granulation": (0.06, "60 deg"), "pendulum": (1.5, "45 deg")}


@pytest.mark.parametrize("preset", IMPACTS)
@pytest.mark.parametrize("engine", ["cvodes", "rosenbrock"])
def test_the_located_trajectory_is_returned_where_an_engine_cannot(preset: str, engine: str) -> None:
    """It has the outcome, events, outputs and ledger of the trajectory; the result names Rosenbrock's method."""
    stokes, angle = IMPACTS[preset]
    usual = collide(preset, stokes=stokes, angle=angle, engine="rosenbrock")

    def soon(rtol: float, plugin: str, groups: Mapping[str, float]) -> Tolerance:
        return replace(tolerance_for(rtol, plugin, groups), steps=3)

    n = nondimensionalise(usual.scene, usual.speed, usual.angle)
    found = by_casadi(usual.scene, n, 1e-9, engine, True, True, control=soon)
    assert (found.engine, found.outcome, found.reversal) == ("rosenbrock", usual.outcome, usual.reversal)
    assert [event.kind for event in found.events] == [event.kind for event in usual.events]
    for name in ("restitution", "contact_time", "rotation", "smallest_gap", "final_spin"):
        assert getattr(found, name) == pytest.approx(getattr(usual, name), rel=1e-7)
    assert found.energy is not None
    assert usual.energy is not None
    assert found.energy.to_dict() == pytest.approx(usual.energy.to_dict(), abs=1e-7 * usual.energy.initial)
    assert found.trajectory is not None
    assert float(found.trajectory.gap[-1]) == pytest.approx(float(found.trajectory.gap.max()), rel=1e-9)
