"""Chatter in space: the certificate by rebounds, beside the trajectory followed without it."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.certificates import at_maximum
from wetdoublet.solvers.certificates.rebounds import ReboundCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.space.by_casadi import groups_of, own_axes
from wetdoublet.solvers.space.pairs import checked
from wetdoublet.solvers.verify.audit import WithoutCertificate

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
SCENE = Scene.from_dict(
    {
        "particles": {"radius": 1.704e-3, "mass": 1.191e-5, "roughness": 2.2e-8, "dry_restitution": 0.82},
        "liquid": {"viscosity": 0.0657, "film_thickness": 8.23e-6, "glass_transition_pressure": 1.7e8},
        "bridge": {"law": "mikami", "surface_tension": 0.149, "volume": 0.0676, "contact_angle": 0.18},
        "attraction": {"hamaker": 9e-12},
    }
)
NORMAL = np.array([0.1133, 0.9518, 0.285])


def spinning() -> tuple[np.ndarray, np.ndarray]:
    """Velocities and spins out of any plane, with much slip."""
    velocities = np.array([[0.2907, -0.005, 0.127], [-0.672, 0.1817, -1.3355]])
    return velocities, np.array([[-21.4, 62.9, 69.7], [-34.5, 283.8, 44.0]])


def test_chatter_in_space_is_a_proved_stick() -> None:
    """Where the energy is above the barrier, and the planar certificates do not apply."""
    velocities, spins = spinning()
    found = collide_pair(SCENE, NORMAL, velocities, spins, engine="rosenbrock")
    assert int(found.outcome) == 0, str(found.reason.values)
    assert bool(found.certified)


def test_no_later_maximum_of_the_gap_is_higher() -> None:
    """The trajectory is followed without certificates for many rebounds after the first maximum it is proved at."""
    pair = checked(SCENE, NORMAL, *spinning())
    model = load(select_model(SCENE, True, space=True))
    groups = groups_of(pair, own_axes(pair)).groups
    proved = EventLocator(model, groups, 1e-8, ("rotation",))
    proof = proved.proof
    assert isinstance(proof, ReboundCertificate)
    path = proved.run()
    assert path.certified
    assert at_maximum(path.y, proved.phase)
    assert not proof.beside.decided(path.y, proved.phase)
    on = WithoutCertificate(model, groups, 1e-8, ("rotation",)).on(path.time * 1.2)
    highest = float(path.y[0])
    later = [float(end[0]) for step, end in zip(on.steps, on.ends, strict=True) if "fell back" in step.kinds]
    assert len(later) > 10
    assert not on.separated
    assert max(later) <= highest * (1 + 1e-9)


def test_an_elastic_rebound_proves_nothing() -> None:
    """What is not lost may be returned: the same state, with other spheres."""
    pair = checked(SCENE, NORMAL, *spinning())
    model = load(select_model(SCENE, True, space=True))
    groups = groups_of(pair, own_axes(pair)).groups
    proved = EventLocator(model, groups, 1e-8, ("rotation",))
    y = proved.run().y
    elastic = EventLocator(model, {**groups, "dry_restitution": 1.0}, 1e-8, ("rotation",)).proof
    assert proved.proof.decided(y, proved.phase)
    assert not elastic.decided(y, proved.phase)
