"""The energy ledger of collisions in space: it closes, and its kinetic energies are those of the vectors."""

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide, collide_pair

from ...helpers.two_bodies import bodies_of

FILM = Scene.load("granulation")
WALL = Scene.load("granulation").with_entries({"partner.wall": True})
LOST = ("normal_lubrication", "tangential_lubrication", "capillary", "dry_contact")
NORMAL = np.array([0.0, 0.6, -0.8])
VELOCITIES = np.array([[[1.0, 0, -2], [0, 0.3, 0]], [[0.4, 0, -0.1], [0, -0.2, 0.3]]])
SPINS = np.array([[2e3, 3e3, 1e4], [-4e3, 1e4, 1e3]])


def kinetic(scene, velocities, spins):
    """Kinetic energy relative to the centre of mass, or to the wall."""
    bodies = bodies_of(scene)
    relative = 0.5 * bodies.m * np.sum((velocities[:, 1] - velocities[:, 0]) ** 2, axis=-1)
    moving = 1 if scene.wall else 2
    inertia = np.array(bodies.inertias[:moving])
    return relative + 0.5 * np.sum(inertia[:, None] * spins[:, :moving] ** 2, axis=(-2, -1))


def balanced(scene, velocities, spins, engine):
    """Collide with a ledger, and hold it against the vectors."""
    found = collide_pair(scene, NORMAL, velocities, spins, ledger=True, engine=engine)
    book = {name.removeprefix("energy."): found[name].values for name in found.data_vars if name.startswith("energy.")}
    parted = found.outcome.values > 0
    assert parted.any()
    before = kinetic(scene, velocities, np.broadcast_to(spins, (len(velocities), *spins.shape)))
    after = kinetic(scene, found.velocities.values, found.spins.values)
    assert book["initial"] == pytest.approx(before, rel=1e-12)
    assert book["final"][parted] == pytest.approx(after[parted], rel=1e-7)
    assert book["residual"] == pytest.approx(0 * before, abs=1e-7 * before.max())
    lost = sum(book[name] for name in LOST)
    assert lost[parted] == pytest.approx((before - after)[parted], rel=1e-6)
    assert "attraction" not in book
    return book


@pytest.mark.slow
def test_it_closes_for_vectors():
    """Losses add up to what the velocities and spins have lost, out of the plane and beside a wall, by both engines."""
    book, other = (balanced(FILM, VELOCITIES, SPINS, engine) for engine in ("rosenbrock", "taylor"))
    assert (book["tangential_lubrication"] > 0).all()
    for name in LOST:
        assert book[name] == pytest.approx(other[name], rel=1e-7), name
    balanced(WALL, 5 * VELOCITIES, 5 * SPINS[:1], "rosenbrock")  # twist is not lost


def test_beside_a_wall_it_is_the_planar_ledger():
    """Term by term, of a sphere that slides and spins in one plane."""
    speed, angle, spin = 30.0, 0.6, 3e5
    planar = collide(WALL.with_entries({"impact.spin": spin}), speed=speed, angle=angle, engine="rosenbrock").energy
    velocity, rolls = [[speed * np.tan(angle), 0, -speed]], [np.cross([spin, 0, 0], [0, 0, -1.0])]
    found = collide_pair(WALL, [0, 0, -1], velocity, rolls, ledger=True, engine="rosenbrock")
    for name in ("initial", "final", *LOST):
        assert float(found[f"energy.{name}"]) == pytest.approx(getattr(planar, name), rel=1e-7, abs=1e-18), name
