"""Proofs for spins of any sense: what separates is never called a stick."""

from wetdoublet.solvers import Scene
from wetdoublet.solvers.certificates import OrbitalMomentumCertificate
from wetdoublet.solvers.certificates.attraction import AttractionCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model


def trajectory(scene: Scene) -> EventLocator:
    """The locating trajectory of a scene, to its end."""
    n = nondimensionalise(scene, *scene.need_impact())
    one = EventLocator(load(select_model(scene, n.oblique)), n.groups, 1e-9)
    one.run()
    return one


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
