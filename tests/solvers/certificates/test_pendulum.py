"""The proof of sticks on strings: none escapes, every margin is needed, and no margin may be missing."""

import contextlib
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pytest
from casadi import SX
from wetdoublet.generated import oblique_strings
from wetdoublet.solvers import ComputationError, Scene
from wetdoublet.solvers.certificates import NoCertificate
from wetdoublet.solvers.engines.casadi import locate
from wetdoublet.solvers.engines.casadi.locate import EventLocator, EventSequence
from wetdoublet.solvers.engines.settings import Budget
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import Model, load, select_model
from wetdoublet.solvers.verify.audit import WithoutCertificate

pytestmark = pytest.mark.slow
COUNT = 400


@dataclass(frozen=True)
class Hung:
    """A random doublet on strings, ready to be located, and whether it separates when no proof ends its trajectory."""

    model: Model
    groups: dict[str, float]
    separates: bool

    def path(self) -> EventSequence:
        """Its trajectory with the proof."""
        return EventLocator(self.model, self.groups, 1e-9, budget=Budget(100_000)).run()  # rebounds take many


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def _variants(rng: np.random.Generator) -> dict[str, str]:
    return {
        "pendulum.law": ("exact", "small-angle")[rng.integers(2)],
        "model.glass": ("literal", "film-corrected")[rng.integers(2)],
        "model.tangential": ("immersed", "film")[rng.integers(2)],
    }


def _rebounding_pendulum(rng: np.random.Generator) -> tuple[Scene, float, float]:
    """One whose rebound decides: solids that lose little, met far out in the film, thick films, strings near the
    least length, angles down to nearly head-on, with and without elastic constants.
    """
    a = _log_uniform(rng, 1e-3, 1e-2)
    x0 = a * (_log_uniform(rng, 0.05, 6) if rng.random() < 0.5 else _log_uniform(rng, 0.005, 0.3))
    viscosity, mass = _log_uniform(rng, 0.03, 30), _log_uniform(rng, 0.1, 10) * 0.034 * (a / 6.3e-3) ** 3
    stokes = _log_uniform(rng, 0.05, 20)
    speed = stokes * 6 * math.pi * viscosity * a**2 / mass
    entries = Scene.load("pendulum").to_dict()
    if rng.random() < 0.5:
        del entries["particles"]["youngs_modulus"], entries["particles"]["poisson_ratio"]
    rough = _log_uniform(rng, 1e-5, 1e-2) if rng.random() < 0.3 else rng.uniform(0.05, 0.95)
    longer = (1.0001, 1.01, rng.uniform(1.05, 3), _log_uniform(rng, 3, 100))[rng.integers(4)]
    scene = Scene.from_dict(entries).with_entries(
        {
            "particles.reduced_radius": a,
            "particles.reduced_mass": mass,
            "particles.roughness": rough * x0,
            "particles.dry_restitution": float(rng.choice([1.0, 1.0, 0.99, 0.5])),
            "liquid.viscosity": viscosity,
            "liquid.film_thickness": x0,
            "liquid.glass_transition_pressure": _log_uniform(rng, 0.3, 300) * 3 * viscosity * a * speed / x0**2,
            "pendulum.length": (4 * a + x0 / 2) * longer,
            "pendulum.gravity": _log_uniform(rng, 0.01, 10) * speed**2 / x0,
            **_variants(rng),
        }
    )
    angle = rng.uniform(0.01, 3) if rng.random() < 0.5 else rng.uniform(3, 89)
    return scene, stokes, math.radians(angle)


@pytest.fixture(scope="module")
def strings() -> list[Hung]:
    """Doublets on strings of both kinds, followed without a proof to a cut-off, or for 1e4 x0/v0."""
    rng = np.random.default_rng(20)
    found = []
    for _ in range(COUNT):
        scene, stokes, angle = _rebounding_pendulum(rng)
        n = nondimensionalise(scene, scene.speed_of(stokes), angle)
        model = load(select_model(scene, oblique=True))
        free = WithoutCertificate(model, n.groups, 1e-9, budget=Budget(20_000))
        free.proof = NoCertificate()
        with contextlib.suppress(ComputationError):  # it creeps on, unseparated
            free.on(1e4)
        assert not free.path.certified
        found.append(Hung(model, n.groups, free.path.separated))
    return found


def _broken(monkeypatch: pytest.MonkeyPatch, change: Callable[[dict[str, SX]], dict[str, SX]]) -> None:
    """Change the margins of the proof on strings, as emitted and as numbers."""
    honest, numbers = oblique_strings.pendulum_margins, Model.values
    monkeypatch.setattr(
        oblique_strings, "pendulum_margins", lambda *args: {**(right := honest(*args)), **change(right)}
    )

    def values(model: Model, name: str, *args: object) -> dict[str, float]:
        right = numbers(model, name, *args)
        changed = change(right) if name == "pendulum_margins" else {}
        return right | {each: float(value) for each, value in changed.items()}

    monkeypatch.setattr(Model, "values", values)
    monkeypatch.setattr(locate, "locator", lru_cache(locate.locator.__wrapped__))


def _escapes(strings: list[Hung]) -> int:
    """How many doublets that separate are called proved sticks."""
    count = 0
    for one in strings:
        if one.separates:
            with contextlib.suppress(ComputationError):  # where false margins leave the locator without an event
                count += one.path().certified
    return count


@pytest.mark.parametrize(
    ("margin", "change"),
    [
        ("none", lambda right: {}),
        ("outward", lambda right: {"outward": 0 * right["outward"]}),
        ("impulse", lambda right: {"impulse": 0 * right["impulse"]}),
        ("film", lambda right: {"film": -1 + 0 * right["film"]}),
        ("recoil", lambda right: {"recoil": -1 + 0 * right["recoil"]}),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_the_sample_needs_every_margin(margin, change, strings: list[Hung], monkeypatch) -> None:
    """A proof on strings that leaves out one of its margins certifies doublets of this sample that separate."""
    _broken(monkeypatch, change)
    escapes = _escapes(strings)
    assert (escapes > 0) == (margin != "none")


@pytest.mark.parametrize("margin", ["outward", "pull", "impulse", "film", "recoil"])
def test_a_margin_that_is_no_number_proves_nothing(margin: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """NaN in any of the five, at a turn: not proved, though all else says so."""
    scene = Scene.load("pendulum")
    n = nondimensionalise(scene, scene.speed_of(0.3), math.radians(20))
    model = load(select_model(scene, oblique=True))
    held = {"outward": SX(1), "pull": SX(0), "impulse": SX(0), "film": SX(-1), "recoil": SX(-1)}
    for value, expected in ((None, True), (math.nan, False)):
        own = held if value is None else {**held, margin: SX(value)}
        with monkeypatch.context() as patch:
            _broken(patch, lambda _, own=own: own)
            one = EventLocator(model, n.groups, 1e-9)
            assert bool(one.proof.decided(np.array([0.9, 0.0, *one.y[2:]]), one.phase)) is expected
