"""Proofs for spins of any sense: a reflection changes nothing, and what separates is never called a stick."""

from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.certificates import OrbitalMomentumCertificate
from wetdoublet.solvers.certificates.attraction import AttractionCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from tests.benchmarks.spinning_sticks import by_casadi

pytestmark = pytest.mark.slow


def trajectory(scene: Scene) -> EventLocator:
    """The locating trajectory of a scene, to its end."""
    n = nondimensionalise(scene, *scene.need_impact())
    one = EventLocator(load(select_model(scene, n.oblique)), n.groups, 1e-9)
    one.run()
    return one


@pytest.mark.parametrize(
    "changes",
    [{}, {"attraction.hamaker": 1e-18}, {"partner.radius": "300 um", "partner.density": 2500}],
    ids=["bridge", "attraction", "pair"],
)
def test_a_reflection_changes_nothing(changes: dict[str, Any]) -> None:
    """Along the line of centres the sense of a spin is arbitrary: outcomes, times and proofs of both are the same."""
    outcomes = set()
    for spin in (3e2, 1e4, 3e4, 1e5):
        scene = Scene.load("granulation").with_entries(changes).with_impact(stokes=0.03, angle=0.0)
        one, other = (trajectory(scene.with_entries({"impact.spin": sign * spin})) for sign in (1.0, -1.0))
        assert one.path.kinds == other.path.kinds
        assert (one.path.outcome, one.path.certified) == (other.path.outcome, other.path.certified)
        assert one.path.time == pytest.approx(other.path.time, rel=1e-9)
        outcomes.add(one.path.outcome)
    assert len(outcomes) > 1


def test_spins_that_throw_the_doublet_apart_are_not_held() -> None:
    """J(0) = 0 and L < 0: shear turns the orbit the other way, and it leaves. Neither bound of J may miss that."""
    scene = Scene.load("granulation").with_entries({"impact.spin": -5e4}).with_impact(stokes=0.03, angle=0.0)
    one = trajectory(scene)
    assert one.path.outcome == "stick-rotate-separate"
    y = one.model.start(one.p)
    assert one.model.values("attraction_margins", y, one.p)["hold"] < 0
    assert not AttractionCertificate(one.model, one.p, 1e-9).decided(y, one.phase)
    orbital = OrbitalMomentumCertificate(one.model, one.p, 1e-9, one.proof)
    states = [y, *one.path.ends[:-1]]
    assert not any(orbital.holds(each) for each in states)
    assert min(float(each[2]) for each in states) < 0


@pytest.mark.parametrize(("kind", "partner"), [("bridge", ""), ("film", "pair")])
def test_no_certificate_holds_what_separates(kind: str, partner: str) -> None:
    """A small sample of the audit: at no event of a trajectory that separates is any certificate satisfied."""
    found = by_casadi(kind, partner, 6, 7)
    assert np.sum([held for held, _ in found.values()]) >= 6
    assert not any(escaped for _, escaped in found.values())
