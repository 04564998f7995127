"""Collisions end where an integrator fails at the tolerance it is given, or lands beside their events."""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.collision.by_casadi import by_casadi
from wetdoublet.solvers.engines.casadi.integrators import Tolerance, tolerance_for
from wetdoublet.solvers.errors import ModelWarning
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


def test_grazing_incidence_pulled_in_by_strings() -> None:
    """89.97 deg at St 5e-5: gravity swings the spheres together at 4e7 times the speed of impact.

    A tolerance for a doublet that turns within 1e-4 of x0 would be below the rounding of that motion.
    """
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 9.10416e-3, "density": 2466.94, "roughness": 1.01768e-4, "dry_restitution": 1.0,
            },
            "liquid": {
                "viscosity": 2.66928e-5, "film_thickness": 3.96381e-4, "glass_transition_pressure": 4.77684e9,
            },
            "pendulum": {"length": 0.457281, "gravity": 22.476, "law": "small-angle"},
            "model": {"glass": "film-corrected"},
        }
    )  # fmt: skip
    found = collide(scene, stokes=4.7542e-05, angle=1.57033, engine="rosenbrock", ledger=False)
    assert found.outcome == "stick"
    assert [event.kind for event in found.events] == ["rough", "rotation reverses"]


def test_solids_that_give_nothing_back() -> None:
    """Head-on with e_dry = 0 the reversal leaves both at rest, just inside the film: a stick, and proved."""
    scene = Scene.load("granulation-dry-bridge").with_entries(
        {
            "particles.dry_restitution": 0.0,
            "liquid.glass_transition_pressure": "0.3 Pa",
            "model.glass": "film-corrected",
        }
    )
    found = collide(scene, stokes=6e-5, angle=0.0, ledger=False)
    assert (found.outcome, found.certified, found.reversal) == ("stick", True, "glass")


def test_the_requested_tolerance_answers_where_no_tighter_one_does() -> None:
    """Chatter on glass at 1e8 times the impact's speed: no replay meets its events, and tighter ones never finish.

    The located trajectory of the requested tolerance is returned: the kernel's stick, with a closed ledger.
    """
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 6.60317e-3, "density": 8790.62, "roughness": 1.62237e-9, "dry_restitution": 1.0,
                "youngs_modulus": 3.07472e10, "poisson_ratio": 0.0407191,
            },
            "liquid": {
                "viscosity": 2.37774e-4, "film_thickness": 1.39208e-4, "glass_transition_pressure": 3.24086e8,
            },
            "bridge": {
                "surface_tension": 2.33658e-3, "volume": 0.276518, "contact_angle": 0.0, "law": "willett-simple",
            },
            "pendulum": {"length": 103.195, "gravity": 5.03466},
            "model": {"film": "infinite", "glass": "film-corrected"},
        }
    )  # fmt: skip
    with pytest.warns(ModelWarning, match="bridge.volume"):
        found = collide(scene, stokes=1.23641e-6, angle=1.56365, engine="rosenbrock")
    assert (found.outcome, found.reversal) == ("stick", "glass")
    assert found.energy is not None
    terms = found.energy.to_dict()
    assert abs(terms["residual"]) < 1e-7 * max(abs(value) for value in terms.values())
