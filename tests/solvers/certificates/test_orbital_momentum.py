"""The proof by the orbit's momentum: what it holds never separates, what separates it never holds."""

import math
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, boundary, collide_many
from wetdoublet.solvers.certificates import NoCertificate, OrbitalMomentumCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.engines.settings import STEPS, Budget
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.scene.schema import BRIDGE_LAWS

from ...helpers.reference import collide

pytestmark = pytest.mark.slow


def trajectory(scene: Scene, steps: int = STEPS) -> Any:
    """The locating trajectory of a scene with its impact."""
    n = nondimensionalise(scene, *scene.need_impact())
    return EventLocator(load(select_model(scene, oblique=True)), n.groups, 1e-9, budget=Budget(steps))


def impacts(count: int, seed: int, shear: str = "immersed") -> list[Scene]:
    """Granulation with other liquids, bridges and solids that take little, at impacts around the first escape."""
    rng = np.random.default_rng(seed)
    scenes = []
    for k in range(count):
        entries = {
            "model.tangential": shear,
            "bridge.law": BRIDGE_LAWS[k % len(BRIDGE_LAWS)],
            "particles.dry_restitution": (1.0, float(rng.uniform(0.5, 1)))[k % 2],
            "liquid.glass_transition_pressure": float(np.exp(rng.uniform(math.log(1e4), math.log(1e8)))),
            "bridge.surface_tension": float(np.exp(rng.uniform(math.log(3e-3), math.log(0.3)))),
        }
        scene = Scene.load("granulation").with_entries(entries)
        stokes, angle = float(np.exp(rng.uniform(math.log(5e-3), math.log(3)))), math.radians(rng.uniform(5, 85))
        scenes.append(scene.with_impact(stokes=stokes, angle=angle))
    return scenes


CHATTER = {
    "particles": {
        "reduced_radius": 3.38495e-05,
        "density": 1480.37,
        "roughness": 6.10038e-11,
        "dry_restitution": 0.825808,
    },
    "liquid": {"viscosity": 1.58886e-05, "film_thickness": 1.55505e-09, "glass_transition_pressure": 1345760.0},
    "bridge": {"surface_tension": 0.437132, "volume": 0.00010298, "contact_angle": 0.0, "law": "willett"},
}


def test_cycles_on_glassy_liquid_are_held_where_they_first_turn_back() -> None:
    """Reversed by the glass criterion, pulled back by the bridge: proved where it first falls back.

    Energy lets it escape for twenty thousand cycles, since it counts the slip, which the orbit will never get back.
    """
    scene = Scene.from_dict(CHATTER).with_impact(stokes=807.994, angle=1.38286)
    found = collide(scene, ledger=False, engine="cvodes")
    assert (found.outcome, found.certified) == ("stick", True)
    by_kernel = collide(scene, ledger=False, engine="taylor")
    for each in (found, by_kernel):
        assert [event.kind for event in each.events] == ["glass", "fell back"]


def test_chatter_on_strings_ends() -> None:
    """On strings the torque makes slip, which no proof covers: after some cycles of falling maxima it is a stick, and
    not called proved.
    """
    tables = CHATTER | {
        "particles": CHATTER["particles"] | {"dry_restitution": 1.0},
        "pendulum": {"length": 1e-3, "gravity": 9.81},
    }
    scene = Scene.from_dict(tables).with_impact(stokes=807.994, angle=1.38286)
    found = collide(scene, ledger=False, engine="cvodes")
    assert (found.outcome, found.certified) == ("stick", False)
    assert 20 < [event.kind for event in found.events].count("fell back") < 30


def test_spin_that_is_locked_out_does_not_count() -> None:
    """Held by the bridge beyond the film, where the shear law `film` ends: the spin it keeps cannot part them.

    By the slip energy as far as the rupture distance it could; it came back to the film two thousand times unproved.
    """
    entries = {"bridge.law": "constant", "bridge.volume": 0.5, "model.tangential": "film"}
    entries |= {"particles.dry_restitution": 0.0, "particles.roughness": "4 um"}
    scene = Scene.load("granulation").with_entries(entries).with_impact(stokes=0.1, angle="34 deg")
    found = collide(scene, ledger=False)
    assert (found.outcome, found.certified) == ("stick", True)
    one = trajectory(scene)
    y = one.run().y
    turning = y[2] / (4 + one.groups["aspect"] * y[0]) ** 2
    assert one.model.values("orbital_margins", y, one.p)["slip"] < 0 < turning  # it does spin faster
    whole = OrbitalMomentumCertificate(one.model, one.p, 1e-9, NoCertificate())
    assert whole.holds(y)
    whole.edge = whole.end
    assert not whole.holds(y)


def test_both_forms_take_the_same_away() -> None:
    """What counts of the slip is the same with the spin as a state and with the spin eliminated."""
    one = trajectory(impacts(1, 2, "film")[0])
    full = load(select_model(impacts(1, 2, "film")[0], oblique=True, full=True))
    both = []
    for model in (one.model, full):
        p = model.group_values(one.groups)
        y = model.start(p)
        y[0], y[2:3] = 1.2, 8.0
        if y.size > 3:
            y[3] = ((4 + one.groups["aspect"]) ** 2 - 8.0) / 6.4  # L is that of initial contact
        proof = OrbitalMomentumCertificate(model, p, 1e-9, NoCertificate())
        gaps = np.linspace(1.2, proof.end, 5)
        _, energy = proof.margins(gaps, y, 8.0)
        both.append(proof.exchange(gaps, y, energy))
    assert both[0] == pytest.approx(both[1], rel=1e-12)
    assert both[0][-1] > 0


def test_slip_energy_is_the_energy_above_rigid_rotation() -> None:
    """Midgap: slip energy is what is left of the rotation's energy beside L^2/(2 I) at that gap.

    It can be transferred by J between 0 and its rigid value; from beyond none, and against its sense that of J = 0.
    """
    one = trajectory(impacts(1, 2)[0])
    model, p = one.model, one.p
    for gap, orbit, counts in (
        (0.3, 10.0, 10.0),
        (1.0, 9.0, 9.0),
        (4.0, 1.0, 1.0),
        (1.0, 14.0, None),
        (1.0, -2.0, 0.0),
    ):
        found = model.values("orbital_margins", np.array([gap, 0.0, orbit]), p)
        if counts is None:
            assert found["slip_energy"] == 0
            continue
        y = np.array([gap, 0.0, counts])
        rest = model.values("energies", y, p)["kinetic"] - model.values("effective_potential", y, p)["energy"]
        assert found["slip_energy"] == pytest.approx(rest, rel=1e-12)


CIRCLING: dict[str, Any] = {
    "particles": {"reduced_radius": 3.833e-5, "reduced_mass": 1.1012e-8, "roughness": 7.0824e-8,
                  "dry_restitution": 0.99, "youngs_modulus": 4.4107e10, "poisson_ratio": 0.18895},
    "liquid": {"viscosity": 0.43474, "film_thickness": 2.3255e-6, "glass_transition_pressure": 8.7363e7},
    "bridge": {"surface_tension": 0.021042, "volume": 0.010709, "contact_angle": 0.39614, "law": "constant"},
    "model": {"tangential": "film"},
}  # fmt: skip


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_circling_in_and_out_of_the_film_is_decided(engine: str) -> None:
    """Just below its separatrix a doublet leaves the film and comes back, thousands of times: a stick, and proved.

    Just above it separates; both engines say so, and the traced boundary lies between.
    """
    if engine == "taylor" and compiler() is None:
        pytest.skip("no C compiler")
    scene, angle = Scene.from_dict(CIRCLING), 0.5939
    seen = collide_many(scene, stokes=[0.729, 0.731], angle=angle, engine=engine)
    assert seen.outcome.values.tolist() == [0, 1]
    assert seen.certified.values[0]
    (first, *_) = boundary(scene, angle=angle, stokes=(0.5, 0.8)).changes[0]
    assert 0.729 < first.stokes < 0.731
