"""Trajectories that creep for long (runtime/implicit.h): beside a saddle, and in a film that opens slowly."""

import math

import numpy as np
import pytest
from wetdoublet.generated.automaton import Status
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.host.compiler import compiler

from ....helpers.data import BOUNDARIES

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")


def collided(scene: Scene, stokes: list[float], angle: float, rtol: float) -> np.ndarray:
    """Answers of the kernel."""
    speed = scene.speed_of(1.0) * np.array(stokes)
    found = engine.run_kernel(engine.KernelImpacts(scene, speed, np.full(len(stokes), angle), {}), rtol)
    assert found is not None
    return found


def escape() -> tuple[Scene, float, float]:
    """Scene, angle and Stokes number of a boundary between sticking and rotating apart, from the reference."""
    case = BOUNDARIES["granulation"]
    for degrees, changes in zip(case["angles_deg"], case["changes"], strict=True):
        for change in changes:
            if (change["from"], change["to"]) == ("stick", "stick-rotate-separate"):
                return Scene.from_dict(case["scene"]), math.radians(degrees), float(change["stokes"])
    raise AssertionError("no such boundary among the references")


def test_every_decade_nearer_the_saddle_costs_the_same_time():
    """Beside a saddle the unstable mode grows as exp(lambda t) from the distance: contact times of successive decades
    differ by ln(10)/lambda, and restitution tends to that of the unstable manifold, as the distance to zero.
    """
    scene, angle, boundary = escape()
    distances = [1e-4, 1e-5, 1e-6, 1e-7]
    found = collided(scene, [boundary * (1 + side * d) for side in (1, -1) for d in distances], angle, 1e-12)
    away, held = found[:4], found[4:]
    assert away["outcome"].tolist() == [1] * 4
    assert held["outcome"].tolist() == [0] * 4
    assert held["certified"].all()
    unequal = np.abs(np.diff(np.diff(away["time"])))
    # what is not linear beside the saddle goes with the distance: a tenth a decade, the boundary's own 1e-11 beside it
    assert unequal[1] < 0.2 * unequal[0]
    assert unequal[1] < 2e-3 * np.diff(away["time"])[-1]
    apart = np.abs(np.diff(away["shown"][:, 0]))
    np.testing.assert_allclose(apart[1:] / apart[:-1], 0.1, rtol=0.02)
    assert away["steps"].max() < 3000  # a Taylor step held to the fast modes: 1e4 and more


def test_collisions_that_creep_to_no_avail_keep_to_their_budget():
    """At 1e-9 rad without a bridge rounding decides when the doublet parts: handed over once the budget is spent, but
    for what one stay in implicit.h may take beyond it (its 4000 tries, and the trajectory to there).
    """
    scene = Scene.load("granulation-dry-bridge")
    impact = engine.KernelImpacts(scene, scene.speed_of(np.array([1e-3])), np.array([1e-9]), {})
    found = engine.run_kernel(impact, 1e-7, budget=1500)
    assert found is not None
    assert found["status"].tolist() == [2]
    assert found["steps"][0] < 1500 + 4100


def test_a_spent_budget_ends_a_collision_as_if_it_were_alone():
    """What waits for a lane takes its last step in any case, bit for bit, whichever neighbour makes room for it."""
    scene = Scene.load("granulation-dry-bridge")
    random = np.random.default_rng(3)
    speed, angle = scene.speed_of(0.02 * np.exp(random.normal(0, 2, 64))), 10 ** random.uniform(-7, 0, 64)
    impacts = engine.KernelImpacts(scene, speed, angle)
    together = engine.run_kernel(impacts, 1e-9, budget=1000)
    assert {Status.NO_BUDGET, Status.DECIDED} <= {*together["status"]}
    for k in range(64):
        alone = engine.run_kernel(impacts.subset(slice(k, k + 1)), 1e-9, budget=1000)
        assert alone.tobytes() == together[k : k + 1].tobytes()


def test_a_separation_that_rounding_decides_is_none():
    """Spins cancel the orbital angular momentum but for 1e-6 of it, without a film edge: the speed of separation falls
    as that part squared, to the rounding of the momenta. What the kernel says then is a status, and no outcome.
    """
    film = {"viscosity": 0.1, "film_thickness": 2e-6, "glass_transition_pressure": 1e15}
    sphere = {"radius": 1e-4, "mass": 1e-8, "roughness": 1e-8, "dry_restitution": 0.6}
    scene = Scene.from_dict({"particles": sphere, "liquid": film, "model": {"film": "infinite"}})
    left = 10 ** -np.linspace(5.3, 6.0, 40)
    speed, angle = np.full(40, scene.speed_of(0.5)), np.full(40, 0.5)
    orbital = 0.5e-8 * (2e-4 + 2e-6) ** 2 * speed * np.tan(angle) / 2e-4
    spins = -orbital * (1 + left) / (2 * 0.4 * 1e-8 * 1e-4**2)
    others = {"impact_spin": spins, "impact_partner_spin": spins.copy()}
    found = engine.run_kernel(engine.KernelImpacts(scene, speed, angle, others), 1e-9)
    assert found is not None
    within = found["status"] == Status.WITHIN_ROUNDING
    assert within.any()
    assert (found["outcome"][within] < 1).all()
    assert (left[within] < 10**-5.5).all()
    decided = found["status"] == Status.DECIDED
    assert (found["shown"][decided, 0] > 1e-15).all()
