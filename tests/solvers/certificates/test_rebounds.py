"""Chatter and rest in space: their certificates, beside the trajectory followed without them."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.certificates import at_maximum
from wetdoublet.solvers.certificates.in_space import ReboundCertificate
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


SPINNING = (  # velocities and spins out of any plane, with much slip
    np.array([[0.2907, -0.005, 0.127], [-0.672, 0.1817, -1.3355]]),
    np.array([[-21.4, 62.9, 69.7], [-34.5, 283.8, 44.0]]),
)


def test_chatter_in_space_is_a_proved_stick() -> None:
    """Where the energy is above the barrier, and the planar certificates do not apply."""
    found = collide_pair(SCENE, NORMAL, *SPINNING, engine="rosenbrock")
    assert int(found.outcome) == 0, str(found.reason.values)
    assert bool(found.certified)


def test_no_later_maximum_of_the_gap_is_higher() -> None:
    """The trajectory is followed without certificates for many rebounds after the first maximum it is proved at."""
    pair = checked(SCENE, NORMAL, *SPINNING)
    model = load(select_model(SCENE, True, space=True))
    groups = groups_of(pair, own_axes(pair)).groups
    proved = EventLocator(model, groups, 1e-8, ("rotation",))
    proof = proved.proof
    assert isinstance(proof, ReboundCertificate)
    path = proved.run()
    assert path.certified
    assert at_maximum(path.y, proved.phase)
    assert not proof.beside.decided(path.y, proved.phase)
    elastic = EventLocator(model, {**groups, "dry_restitution": 1.0}, 1e-8, ("rotation",)).proof
    assert not elastic.decided(path.y, proved.phase)  # what is not lost may be returned
    on = WithoutCertificate(model, groups, 1e-8, ("rotation",)).on(path.time * 1.2)
    highest = float(path.y[0])
    later = [float(end[0]) for step, end in zip(on.steps, on.ends, strict=True) if "fell back" in step.kinds]
    assert len(later) > 10
    assert not on.separated
    assert max(later) <= highest * (1 + 1e-9)


RESTING = Scene.from_dict(
    {
        "particles": {"radius": 2.3e-4, "density": 2700.0, "roughness": 9e-7, "dry_restitution": 0.77}
        | {"friction": 0.21, "contact_tangential_restitution": 0.3},
        "liquid": {"viscosity": 0.031, "film_thickness": 1.7e-5},
        "bridge": {"law": "rabinovich", "surface_tension": 0.048, "volume": 0.004, "contact_angle": 0.3665},
        "attraction": {"hamaker": 3e-19},
    }
)
TWISTED = (  # pairs that come to rest with friction, and turn on with twist
    ([-0.784, 0.235, -0.574], [[-0.003, 0.225, 0.018], [0.476, 0.62, -0.195]], [[39, 144, -721], [1002, 232, 782]]),
    ([-0.46, -0.707, -0.537], [[-0.037, -0.587, -1], [0.151, -0.843, -0.564]], [[88, -344, 638], [-971, -1360, -550]]),
)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_rest_with_friction_and_twist_is_a_proved_stick(engine: str) -> None:
    """Where the slip energy without the share of the spins would do to release the doublet."""
    found = collide_pair(RESTING, *map(np.array, zip(*TWISTED, strict=True)), engine=engine)
    assert found.outcome.values.tolist() == [0, 0], found.reason.values.tolist()
    assert found.certified.values.all()


@pytest.mark.slow
def test_the_centrifugal_force_at_rest_stays_below_its_bound() -> None:
    """Followed without certificates from the start of rest, through sliding, while the slip falls by a third."""
    for normal, velocities, spins in TWISTED:
        pair = checked(RESTING, np.array(normal), np.array(velocities), np.array(spins, float))
        model = load(select_model(RESTING, True, space=True))
        groups = groups_of(pair, own_axes(pair)).groups
        path = EventLocator(model, groups, 1e-8, ("rotation",)).run()
        states = [path.y] + [
            WithoutCertificate(model, groups, 1e-8, ("rotation",)).on(path.time + later).y for later in (0.2, 0.6)
        ]
        bounds = [model.values("resting_bound", y, path.p) for y in states]
        forces = [model.values("inward_force", y, path.p)["inward_force"] for y in states]
        outward = [bound["inward"] - force for bound, force in zip(bounds, forces, strict=True)]
        most = [bound["outward"] for bound in bounds]
        assert all(force > 0 for force in forces)
        assert max(outward) < most[0] < bounds[0]["inward"]
        assert most == sorted(most, reverse=True)  # the slip energy never grows
        slips = [model.values("surface_slip", y, path.p)["surface_slip"] for y in states]
        assert slips[-1] < slips[0] / 1.5
