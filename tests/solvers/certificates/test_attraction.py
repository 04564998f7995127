"""The proof that attraction alone holds a doublet: what it proves never separates, and what it must not prove."""

import math

import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ...helpers.reference import collide

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("margin", "stokes", "angle", "dry"),
    [("hold", 0.1, 60, 0.99), ("escape", 0.3, 1, 0.3)],
    ids=["thrown out", "bounces"],
)
def test_what_the_hold_does_not_prove(margin: str, stokes: float, angle: float, dry: float) -> None:
    """A doublet that the centrifugal force parts has no hold; one that bounces off has more energy than the hold takes.

    Each escapes, so each of these two conditions is needed.
    """
    scene = Scene.load("granulation").with_entries({"particles.dry_restitution": dry})
    found = collide(scene, stokes=stokes, angle=math.radians(angle))
    assert found.outcome != "stick"
    n = nondimensionalise(scene, found.speed, found.angle)
    model = load(select_model(scene, oblique=True))
    p = model.group_values(n.groups)
    margins = model.values("attraction_margins", model.start(p), p)
    met = {"hold": margins["hold"] > 0, "escape": margins["escape"] < 0, "rebound": margins["rebound"] < 0}
    assert not met[margin]
    if margin == "escape":
        assert met["hold"]
        assert met["rebound"]


@pytest.mark.parametrize("engine", ["rosenbrock", "taylor"])
def test_first_touch_inside_the_solids_proves_nothing(engine: str) -> None:
    """Soft spheres whose elastic length exceeds the rupture distance: reversed at initial contact, and flung apart.

    The bridge would hold them if they could not come nearer than that length; they are nearer already.
    """
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 1.57499e-05,
                "density": 593.912,
                "roughness": 1.07868e-10,
                "dry_restitution": 0.0147641,
                "youngs_modulus": 341783.0,
                "poisson_ratio": 0.155996,
            },
            "liquid": {"viscosity": 5.92857, "film_thickness": 5.48097e-07, "glass_transition_pressure": 62055.1},
            "bridge": {"surface_tension": 0.638201, "volume": 0.00527027, "contact_angle": 0.897883, "law": "constant"},
            "pendulum": {"length": 0.000103993, "gravity": 0.215366},
            "model": {"tangential": "film"},
        }
    )
    found = collide(scene, stokes=0.0469348, angle=0.586923, engine=engine, ledger=False)
    assert (found.outcome, found.certified) == ("bounce", False)
    # along the line of centres only the centrifugal force and the bridge's are left: no film beyond x0, no shear
    assert found.restitution == pytest.approx(flung(scene, found.speed), rel=1e-6)


def flung(scene: Scene, speed: float) -> float:
    """u/v0 at rupture, from e_dry at x = x0 with J as it was there and the bridge's constant force."""
    a, x0, end = scene.reduced_radius, scene.liquid.film_thickness, scene.rupture_gap
    near, far = 4 * a + x0, 4 * a + end
    momentum = near**2 * speed * math.tan(0.586923) / (4 * a)
    work = 4 * math.pi * a * 0.638201 * math.cos(0.897883) * (end - x0) / scene.reduced_mass
    squared = (0.0147641 * speed) ** 2 + momentum**2 * (1 / near**2 - 1 / far**2) - 2 * work
    return math.sqrt(squared) / speed
