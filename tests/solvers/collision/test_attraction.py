"""Van der Waals attraction: where it enters, and the generalised centrifugal number."""

import math

import pytest
from wetdoublet.solvers import Scene

from ...helpers.reference import collide

A_H = 2e-12  # J, far above any real one, so that it shows in granulation
X0 = 8e-6


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
    constant = {"bridge.law": "constant", "attraction.hamaker": 0.0}
    one = collide(Scene.load("granulation").with_entries(constant), stokes=0.1, angle="60 deg", ledger=False)
    assert one.generalised_centrifugal == pytest.approx(one.centrifugal / (4 * math.pi), rel=1e-12)
    dry = Scene.load("granulation-dry-bridge").with_entries({"attraction.hamaker": A_H})
    one = collide(dry, stokes=0.1, angle="60 deg", ledger=False)
    omega0 = one.speed * math.tan(one.angle) / (4 * dry.reduced_radius)
    expected = dry.reduced_mass * omega0**2 * 6 * X0**2 / A_H
    assert one.generalised_centrifugal == pytest.approx(expected, rel=1e-12)
    assert collide("pendulum", ledger=False).generalised_centrifugal is None
    assert collide("granulation", angle=0.0, ledger=False).generalised_centrifugal == 0.0
