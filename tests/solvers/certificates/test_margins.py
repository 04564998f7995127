"""Margins of the proofs by the orbit, by attraction and at initial contact: what each holds, and what it must not."""

import math

import numpy as np
import pytest
from wetdoublet.generated.automaton import OPENING
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.certificates import NoCertificate, OrbitalMomentumCertificate, proof_for
from wetdoublet.solvers.certificates.attraction import AttractionCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.verify.audit import WithoutCertificate

from ...helpers.reference import collide

FLOATING = Scene.from_dict(
    {
        "particles": {"radius": 1e-4, "mass": 1e-8, "roughness": 1e-7, "dry_restitution": 0.9},
        "liquid": {"viscosity": 0.1, "film_thickness": 2.69e-4, "glass_transition_pressure": 1e12},
        "bridge": {"surface_tension": 0.15, "volume": 224.0},
        "impact": {"speed": 0.733, "angle": 0.935, "spin": 32000.0, "partner_spin": 27700.0},
    }
)


def trajectory(scene: Scene) -> EventLocator:
    """The locating trajectory of a scene with its impact."""
    n = nondimensionalise(scene, *scene.need_impact())
    return EventLocator(load(select_model(scene, n.oblique)), n.groups, 1e-9)


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_slip_energy_is_the_energy_above_rigid_rotation() -> None:
    """Midgap: slip energy is what is left of the rotation's energy beside L^2/(2 I) at that gap.

    It can be transferred by J between 0 and its rigid value; from beyond none, and against its sense that of J = 0.
    """
    one = trajectory(Scene.load("granulation").with_impact(stokes=0.05, angle=0.7))
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


def test_spins_that_throw_the_doublet_apart_are_not_held() -> None:
    """J(0) = 0 and L < 0: shear turns the orbit the other way, and it leaves. Neither bound of J may miss that."""
    scene = Scene.load("granulation").with_entries({"impact.spin": -5e4}).with_impact(stokes=0.03, angle=0.0)
    one = trajectory(scene)
    one.run()
    assert one.path.outcome == "stick-rotate-separate"
    y = one.model.start(one.p)
    assert one.model.values("attraction_margins", y, one.p)["hold"] < 0
    assert not AttractionCertificate(one.model, one.p, 1e-9).decided(y, one.phase)
    orbital = OrbitalMomentumCertificate(one.model, one.p, 1e-9, one.proof)
    states = [y, *one.path.ends[:-1]]
    assert not any(orbital.holds(each) for each in states)
    assert min(float(each[2]) for each in states) < 0


def test_it_swings_between_the_edge_and_its_last_maximum() -> None:
    """Followed without any proof, it reaches neither the edge at 2 a nor a larger gap."""
    n = nondimensionalise(FLOATING, *FLOATING.need_impact())
    model = load(select_model(FLOATING, oblique=True))
    free = WithoutCertificate(model, n.groups, 1e-9)
    path = free.on(40.0)
    proof, edge = proof_for(model, path.p, 1e-9), FLOATING.reduced_radius * 2 / n.length
    turns = [(step.phase, y) for step, y in zip(path.steps, path.ends, strict=True) if step.event == "turning"]
    first = next(k for k, (before, y) in enumerate(turns) if before.motion == OPENING and proof.decided(y, free.phase))
    later = [float(y[0]) for _, y in turns[first:]]
    assert len(later) > 10
    assert edge < min(later) < max(later) <= later[0] * (1 + 1e-8)
