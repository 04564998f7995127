"""Van der Waals attraction: its closed-form work, where it enters, and the generalised centrifugal number."""

import math

import pytest
from wetdoublet.solvers import Scene

from ...helpers.reference import collide

A_H = 2e-12  # J, far above any real one, so that it shows in granulation
X0 = 8e-6


def scene_of(bridge, **changes):
    """Granulation with van der Waals attraction, contact at 50 nm only, with or without the constant bridge."""
    entries = {
        "attraction.hamaker": A_H, "particles.roughness": "50 nm", "liquid.glass_transition_pressure": "1e6 GPa",
        "particles.youngs_modulus": "1e9 GPa", **({"bridge.law": "constant", "bridge.volume": 0.05} if bridge else {}),
    }  # fmt: skip
    return Scene.load("granulation" if bridge else "granulation-dry-bridge").with_entries({**entries, **changes})


@pytest.mark.parametrize("bridge", [True, False])
@pytest.mark.parametrize(("stokes", "angle"), [(0.12, 75.0), (12.0, 0.0)])
def test_the_work_is_the_potentials(bridge, stokes, angle):
    """The ledger's `attraction` is W(x_f) - W(x0) with W = -A a/(6 x), on any path, reversals included."""
    scene = scene_of(bridge)
    one = collide(scene, stokes=stokes, angle=math.radians(angle), rtol=1e-11)
    assert one.outcome != "stick"
    expected = A_H * scene.reduced_radius / 6 * (1 / X0 - 1 / scene.rupture_gap)
    # the integral runs down to the smallest gap and back: its error is relative to the work there
    size = A_H * scene.reduced_radius / (6 * one.smallest_gap)
    assert one.energy.attraction == pytest.approx(expected, abs=1e-7 * size)
    assert abs(one.energy.residual) < 1e-8 * one.energy.initial


def test_nothing_changes_without_it():
    """A Hamaker constant of zero is no attraction; and without the table no key of a result speaks of it."""
    scene = Scene.load("granulation")
    plain = collide(scene, rtol=1e-11).to_dict()
    zero = collide(scene.with_entries({"attraction.hamaker": 0.0}), rtol=1e-11).to_dict()
    assert zero["restitution"] == pytest.approx(plain["restitution"], rel=1e-9)
    assert "generalised_centrifugal" not in plain and "attraction" not in plain["energy"]
    assert zero["energy"]["attraction"] == 0.0


def test_the_generalised_number():
    """Ce_F = m omega0^2 a/F(x0): Ce/(4 pi cos phi) for the constant bridge, 6 m omega0^2 x0^2/A for van der Waals."""
    one = collide(scene_of(True, **{"attraction.hamaker": 0.0}), stokes=0.1, angle="60 deg", ledger=False)
    assert one.generalised_centrifugal == pytest.approx(one.centrifugal / (4 * math.pi), rel=1e-12)
    dry = scene_of(False)
    one = collide(dry, stokes=0.1, angle="60 deg", ledger=False)
    omega0 = one.speed * math.tan(one.angle) / (4 * dry.reduced_radius)
    expected = dry.reduced_mass * omega0**2 * 6 * X0**2 / A_H
    assert one.generalised_centrifugal == pytest.approx(expected, rel=1e-12)
    assert collide("pendulum", ledger=False).generalised_centrifugal is None
    assert collide("granulation", angle=0.0, ledger=False).generalised_centrifugal == 0.0
