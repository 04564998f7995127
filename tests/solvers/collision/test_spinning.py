"""Bodies that arrive with spins, beside references written from the physics alone."""

import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers.spinning import Planar, U, impact_of
from ...helpers.two_bodies import bodies_of

SAME = 1e-8

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


def test_a_resting_doublet_that_its_spins_lift_is_released_once() -> None:
    """At release no force is left: rounding decides neither the direction nor the events (head-on, unequal spins)."""
    entries = {
        "particles": {"radius": 3.5e-3, "mass": 2.1e-3, "roughness": 1e-8, "dry_restitution": 0.0},
        "liquid": {"viscosity": 4.2e-3, "film_thickness": 5.3e-5, "glass_transition_pressure": 6.6},
        "impact": {"stokes": 5.3, "angle": 0.0, "partner_spin": -1.05, "spin": -1.5},
        "bridge": {"surface_tension": 8.8e-9, "volume": 6e-4, "contact_angle": 0.85, "law": "constant"},
        "attraction": {"hamaker": 3.0e-14},
        "model": {"film": "cavitating", "glass": "film-corrected"},
    }
    scene = Scene.from_dict(entries)
    course = Planar(bodies_of(scene), impact_of(scene))
    end = course.run()
    for engine in ("rosenbrock", "taylor"):
        found = collide(scene, rtol=1e-11, engine=engine)
        assert [event.kind for event in found.events] == ["glass", "rests", "released", "film edge", "rupture"]
        assert found.outcome == end.outcome == "bounce"
        assert found.restitution == pytest.approx(end.state[U] / course.speed, rel=SAME)
