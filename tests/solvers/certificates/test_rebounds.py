"""Chatter in space: the certificate by rebounds, beside the trajectory followed without it."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.certificates import at_maximum
from wetdoublet.solvers.certificates.rebounds import ReboundCertificate
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Phase
from wetdoublet.solvers.space.by_casadi import groups_of, own_axes
from wetdoublet.solvers.space.pairs import checked
from wetdoublet.solvers.verify.audit import WithoutCertificate

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
SCENE = Scene.from_dict(
    {
        "particles": {"radius": 1.7e-3, "mass": 1.19e-5, "roughness": 2.2e-8, "dry_restitution": 0.8},
        "liquid": {"viscosity": 0.066, "film_thickness": 8.2e-6, "glass_transition_pressure": 1.7e8},
        "bridge": {"law": "mikami", "surface_tension": 0.17, "volume": 0.07, "contact_angle": 0.2},
    }
)
NORMAL, SPEED = np.array([0.6, 0.0, 0.8]), 0.05


def spinning() -> tuple[np.ndarray, np.ndarray]:
    """Velocities and spins out of any plane, with much slip."""
    velocities = np.array([[0.0, 0.0, 0.0], [0.1, 0.12, 0.0]])
    velocities[1] -= (NORMAL @ velocities[1] + SPEED) * NORMAL
    return velocities, np.array([[120.0, -40.0, 90.0], [-60.0, 30.0, 20.0]])


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
    """What is not lost may be returned."""
    scene = SCENE.with_entries({"particles.dry_restitution": 1.0})
    pair = checked(scene, NORMAL, *spinning())
    model = load(select_model(scene, True, space=True))
    p = model.group_values(groups_of(pair, own_axes(pair)).groups)
    located = EventLocator(model, dict(zip(model.groups, p, strict=True)), 1e-8, ("rotation",))
    y = np.append(model.start(p), np.zeros(2))
    y[1] = 0.0
    assert not located.proof.decided(y, Phase(film=1, shear=1, motion=located.phase.motion))
