"""Derivatives of collisions with vectors, against central differences of `collide_pair`."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_pair, pair_gradients

UNEQUAL = Scene.load("granulation").with_entries({"partner.radius": "0.2 mm", "partner.mass": "3e-5 g"})
WALL = Scene.load("granulation").with_entries({"partner.wall": True})
RESULTS = ("restitution", "time", "gap", "normal", "position", "velocities", "spins")
NORMAL = np.array([0.0, 0.6, -0.8])
VELOCITIES = np.array([[1.0, 0, -2], [0, 0.3, 0]])
SPINS = np.array([[2e3, 3e3, 1e4], [-4e3, 1e4, 1e3]])
_STEP = 2e-5


def differences(scene, inputs, name):
    """Central differences in a parameter, by name of the result."""
    ends = []
    kind, *place = name.split(".")
    step = _STEP * {"normal": 1.0, "velocities": 1.0, "spins": 1e4}.get(kind, scene.entries.get(name))
    for sign in (1, -1):
        moved = {key: np.array(values) for key, values in inputs.items()}
        own = scene
        if kind in inputs:
            moved[kind][(*map(int, place[:-1]), "xyz".index(place[-1]))] += sign * step
        else:
            own = scene.with_entries({name: scene.entries[name] + sign * step})
        ends.append(collide_pair(own, **moved, rtol=1e-12, engine="rosenbrock"))
    return {key: (ends[0][key].values - ends[1][key].values) / (2 * step) for key in RESULTS}, step


def agree(scene, inputs, names):
    """Derivatives against differences, by the size of a result's change or of its rounding."""
    found = pair_gradients(scene, **inputs)
    assert not str(found.reason.values)
    assert int(found.outcome) > 0
    for name in names:
        expected, step = differences(scene, inputs, name)
        for key, slope in expected.items():
            ours = found[f"d_{key}"].sel(parameter=name).values
            size = np.nanmax(np.abs(slope)) + _STEP / step * np.nanmax(np.abs(found[key].values))
            assert ours == pytest.approx(slope, abs=1e-6 * size, nan_ok=True), (name, key)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.05, 0.5])
def test_of_spheres_that_rub(friction):
    """By friction and the tangential restitution too, of a contact that slides (0.05) and of one that grips (0.5)."""
    rough = {"particles.friction": friction, "particles.contact_tangential_restitution": 0.3}
    scene = UNEQUAL.with_entries(rough | {"model.contact_friction": "all"})
    inputs = {"normal": NORMAL, "velocities": 3 * VELOCITIES, "spins": 3 * SPINS}
    agree(scene, inputs, (*rough, "liquid.viscosity", "spins.0.x", "velocities.1.z"))


def test_beside_a_wall():
    """Sliding, rolling and twist, and a wall that moves."""
    inputs = {"normal": NORMAL, "velocities": 5 * VELOCITIES, "spins": 5 * SPINS[:1]}
    found = agree(WALL, inputs, ("liquid.film_thickness", "normal.z", "velocities.1.x", "spins.0.y"))
    assert np.isnan(found.spins.values[1]).all()
    assert not any(str(name).startswith("spins.1") for name in found.parameter.values)


def test_a_stick_and_a_pair_that_recedes_say_so():
    """They have no derivatives; rows keep their shape, and the others are not lost."""
    velocities = np.array([5 * VELOCITIES, -VELOCITIES, 0.02 * VELOCITIES])[:, None]
    found = pair_gradients(WALL, NORMAL, velocities, 0.02 * SPINS[:1], wrt=["velocities", "liquid.viscosity"])
    assert found.d_spins.shape == (3, 1, 2, 3, 7)
    assert [str(why) for why in found.reason.values[:1, 0]] == [""]
    assert "do not approach" in str(found.reason.values[1, 0])
    assert "stick" in str(found.reason.values[2, 0])
    assert np.isnan(found.d_velocities.values[1:]).all()
    assert np.isfinite(found.d_velocities.values[0]).all()


def test_near_a_boundary_it_is_refused_by_name():
    """Just above the speed at which a sphere leaves the wall."""

    def outcome(scale):
        return int(collide_pair(WALL, NORMAL, scale * VELOCITIES, SPINS[:1], engine="rosenbrock").outcome)

    stuck, parted = 1.004, 1.01
    assert outcome(stuck) == 0 < outcome(parted)
    while parted - stuck > 1e-5:
        middle = (stuck + parted) / 2
        stuck, parted = (middle, parted) if outcome(middle) == 0 else (stuck, middle)
    found = pair_gradients(WALL, NORMAL, parted * VELOCITIES, SPINS[:1], wrt="velocities")
    assert "no derivative: the collision lies at the" in str(found.reason.values)
    assert np.isnan(found.d_velocities.values).all()
