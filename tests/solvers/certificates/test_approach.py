"""The proofs at initial contact: what they decide never separates, in whatever scene, and both engines agree."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.certificates.approach import Approach
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import Model, load, select_model

pytestmark = pytest.mark.slow

_LAWS = {
    "bridge": ("mikami", "willett-simple", "lambert", "soulie", "constant"),
    "film": ("finite", "infinite", "cavitating"),
    "glass": ("literal", "film-corrected"),
    "tangential": ("immersed", "film"),
}


def _drawn(rng: np.random.Generator, strings: bool) -> tuple[Scene, float, float]:
    """A scene far from the library's, its Stokes number and angle."""

    def between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    def one(slot: str) -> str:
        return _LAWS[slot][rng.integers(len(_LAWS[slot]) - (strings and slot == "film"))]

    a = between(1e-5, 3e-3)
    film, viscosity, stokes = between(1e-3, 0.5 if strings else 0.2) * a, between(1e-3, 30), between(3e-3, 5)
    mass = between(0.3, 3) * 2500 * 4 * math.pi / 3 * (2 * a) ** 3 / 2
    speed = stokes * 6 * math.pi * viscosity * a**2 / mass
    entries = {
        "particles.reduced_radius": a,
        "particles.reduced_mass": mass,
        "particles.roughness": between(1e-3, 0.9) * film,
        "particles.dry_restitution": float(rng.choice([1.0, 0.99, 0.5])),
        "liquid.viscosity": viscosity,
        "liquid.film_thickness": film,
        "liquid.glass_transition_pressure": between(1, 3000) * 3 * viscosity * a * speed / film**2,
        **{f"model.{slot}": one(slot) for slot in ("film", "glass", "tangential")},
    }
    if strings:
        entries |= {
            "pendulum.gravity": between(1e-3, 10) * speed**2 / film,
            "pendulum.length": (4 * a + film / 2) * float(rng.choice([1.01, 1.5, 50])),
        }
    else:
        entries |= {
            "bridge.surface_tension": between(1e-3, 1),
            "bridge.volume": between(0.05, 1),
            "bridge.law": one("bridge"),
        }
    tables = Scene.load("pendulum" if strings else "granulation").with_entries(entries).to_dict()
    if not strings and rng.integers(2):
        tables["partner"] = {"radius": between(0.3, 3) * 2 * a, "mass": between(0.3, 3) * 2 * mass}
    return Scene.from_dict(tables), stokes, math.radians(rng.uniform(0.5, 88))


@pytest.mark.parametrize("scene", ["granulation", "pendulum"])
def test_most_sticks_are_decided_at_initial_contact(scene: str) -> None:
    """Both engines decide alike, and more than half of all sticks without a step."""
    rng = np.random.default_rng(8)
    stokes, angle = np.exp(rng.uniform(math.log(0.01), math.log(1.0), 60)), rng.uniform(0.02, 1.4, 60)
    kernel, reference = (
        collide_many(scene, stokes=stokes, angle=angle, engine=engine, of=["outcome", "until"])
        for engine in ("taylor", "rosenbrock")
    )
    assert kernel["outcome"].values.tolist() == reference["outcome"].values.tolist()
    sticks = kernel["outcome"].values == 0
    at_contact = [sticks & (found["until"].values == 0) for found in (kernel, reference)]
    assert at_contact[0].tolist() == at_contact[1].tolist()
    assert at_contact[0].sum() > sticks.sum() / 2


def test_the_bound_of_the_closing_speed_holds() -> None:
    """On the way in, along trajectories of random scenes, the closing speed is below the bound of its part."""
    rng = np.random.default_rng(3)
    compared = 0
    for _ in range(12):
        scene, stokes, angle = _drawn(rng, False)
        n = nondimensionalise(scene, scene.speed_of(stokes), angle)
        model = load(select_model(scene, oblique=True))
        p = model.group_values(n.groups)
        y = np.array(model.start(p))
        for part in Approach(model, p, 0.0).parts(y.copy()):
            while part.gap < y[0] <= part.start and y[1] < 0:
                y = _stepped(model, y, p)
                compared += 1
                assert not part.gap <= y[0] <= part.start or -y[1] <= part.fastest * (1 + 1e-6)
            if not y[1] < 0:
                break
    assert compared > 200


def _stepped(model: Model, y: np.ndarray, p: np.ndarray) -> np.ndarray:
    """A short step of the classical Runge-Kutta method inside the film."""

    def rate(at: np.ndarray) -> np.ndarray:
        return np.array(list(model.values("right_hand_side", at, p).values()))

    first = rate(y)
    h = 0.02 * min(y[0] / max(abs(y[1]), 1e-3), abs(y[1]) / max(abs(first[1]), 1e-12) + 1e-4)
    second = rate(y + h / 2 * first)
    third = rate(y + h / 2 * second)
    return y + h / 6 * (first + 2 * second + 2 * third + rate(y + h * third))
