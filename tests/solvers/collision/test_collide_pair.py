"""Collisions in space: what becomes of single rows, of sticks and of twist, what is refused, and the energy ledger.

The harness has the rest: any arrival as the reference has it, the plane in any direction and in any frame.
"""

import numpy as np
import pytest
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, collide, collide_pair
from wetdoublet.solvers.collision.space.ends import Ends, gains_energy
from wetdoublet.solvers.collision.space.pairs import Bodies, checked
from wetdoublet.solvers.host.compiler import compiler

from ...helpers.random_in_space import arrivals, request
from ...helpers.two_bodies import bodies_of

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
GRANULATION = Scene.load("granulation")
ROUGH = GRANULATION.with_entries({"particles.friction": 0.3, "particles.contact_tangential_restitution": 0.2})
WALL = GRANULATION.with_entries({"partner.wall": True})
VECTORS = ("position", "normal", "velocities", "spins")


def arrived(scene, count, seed):
    """Random normals, velocities and spins of pairs that approach, from slow to fast."""
    draw, bodies = np.random.default_rng(seed), bodies_of(scene)
    speeds = scene.speed_of(1.0) * 10 ** draw.uniform(-1.5, 1.0, count)
    return request(bodies, [arrival for speed in speeds for arrival in arrivals(bodies, speed, 1, draw)])


def values(data):
    """The variables of a Dataset."""
    return {name: data[name].values for name in data.data_vars}


@pytest.fixture(scope="module")
def equal():
    """Random collisions of equal spheres, and what became of them."""
    given = arrived(GRANULATION, 60, 1)
    return given, values(collide_pair(GRANULATION, *given, rtol=1e-11))


UP, STILL = [0, 0, 1], [[0, 0, 0]] * 2


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_a_bad_row_leaves_the_others(engine):
    """Each row by its reason, beside a sound one: a pair that recedes or is nowhere, numbers, spins and directions."""
    rows = [
        (UP, 0.5, STILL, ""), (UP, -5.0, STILL, "do not approach"), (UP, np.nan, STILL, "not finite"),
        (UP, 1e200, STILL, "too far off"), (UP, 1e-300, STILL, "too far off"),
        (UP, 0.5, [[1e200, 1e200, 0], [0, 0, 0]], "too far off"), ([0, 0, 0], 0.5, STILL, "(0, 0, 0)"),
        ([0, np.nan, 1.0], 0.5, STILL, "no direction"), ([np.inf, 0, 0], 0.5, STILL, "no direction"),
    ]  # fmt: skip
    normals, speeds, spins, reasons = (list(column) for column in zip(*rows))
    velocities = np.array(speeds)[:, None, None] * np.array([UP, UP]) * [[[1.0], [0.0]]]
    found = values(collide_pair(GRANULATION, normals, velocities, spins, engine=engine))
    assert found["outcome"].tolist() == [0] + [-1] * (len(rows) - 1)
    assert all(part in why for part, why in zip(reasons, found["reason"].tolist(), strict=True))
    assert np.isnan(found["velocities"][1:]).all() and np.isfinite(found["velocities"][0]).all()


@pytest.mark.slow
@pytest.mark.parametrize("scene", [GRANULATION, WALL], ids=["spheres", "wall"])
def test_a_stick_depends_on_its_arrival_alone(scene):
    """No tolerance and no engine changes its motion, which is at contact; `until` says where they stopped."""
    given = arrived(scene, 60, 1)
    tight, loose = (values(collide_pair(scene, *given, rtol=rtol, engine="taylor")) for rtol in (1e-11, 1e-9))
    few = np.flatnonzero((tight["outcome"] == 0) & (loose["outcome"] == 0))
    other = values(collide_pair(scene, *(each[few[:2]] for each in given), engine="rosenbrock"))
    assert few.size and np.any(tight["until"][few] != loose["until"][few])
    assert np.isnan(tight["until"][tight["outcome"] > 0]).all()
    for name in (*VECTORS, "time", "gap", "angular_velocity", "centre_velocity"):
        assert np.array_equal(tight[name][few], loose[name][few], equal_nan=True), name
        assert np.array_equal(tight[name][few[:2]], other[name], equal_nan=True), name
    assert not tight["time"][few].any()
    assert tight["normal"][few] == pytest.approx(given[0][few], abs=1e-15)


def test_a_stick_turns_as_one_body(equal):
    """Velocities and spins of a stick are those of a rigid rotation, but for twist."""
    _, found = equal
    stuck = found["outcome"] == 0
    rate, place, normal = (found[name][stuck] for name in ("angular_velocity", "position", "normal"))
    relative = found["velocities"][stuck, 1] - found["velocities"][stuck, 0]
    assert relative == pytest.approx(np.cross(rate, place), abs=1e-9 * np.abs(relative).max())
    for k in range(2):
        rest = found["spins"][stuck, k] - rate
        along = np.sum(rest * normal, axis=1, keepdims=True) * normal
        assert rest == pytest.approx(along, abs=1e-9 * np.abs(rate).max())
    assert np.isnan(found["angular_velocity"][~stuck]).all()


def test_an_end_with_more_energy_is_no_answer(equal):
    """Of a trajectory whose numbers are replaced by impossible ones, and of no other."""
    given, found = equal
    pairs = checked(GRANULATION, *given)
    ends = Ends.blank(pairs.size)
    ends.outcome[:], ends.gap[:], ends.normal[:] = found["outcome"], found["gap"], found["normal"]
    relative = found["velocities"][:, 1] - found["velocities"][:, 0]
    ends.opening[:] = np.sum(relative * found["normal"], axis=1)
    ends.turning[:] = np.cross(found["position"], relative) / np.sum(found["position"] ** 2, axis=1)[:, None]
    ends.spins[:] = found["spins"]
    assert not gains_energy(pairs, ends, 1e-9).any()
    row = int(np.argmax(ends.outcome))
    ends.opening[row] *= 1e8
    assert np.flatnonzero(gains_energy(pairs, ends, 1e-9)).tolist() == [row]


@pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
def test_validity_has_the_sentences_of_a_planar_collision():
    """A liquid with inertia, a thick film, a bridge with too much liquid and a law beyond its range; a fly-by."""
    scene = GRANULATION.with_entries(
        {
            "liquid.density": 1000.0, "liquid.viscosity": 1e-3, "liquid.film_thickness": 3e-5, "bridge.law": "willett",
            "bridge.volume": 0.3, "liquid.glass_transition_pressure": 1e9,
        }
    )  # fmt: skip
    bodies, speed, angle = bodies_of(scene), 3.0, np.array([0.3, 1.45])
    across = speed * np.tan(angle) * (1 + bodies.film_thickness / bodies.contact)
    velocities = [[[0.0, 0, 0], [y, 0, -speed]] for y in across]
    found = collide_pair(scene, [0, 0, 1], velocities, np.zeros((2, 3)), engine="taylor")
    alone = [set(collide(scene, speed=speed, angle=each, ledger=False).validity) for each in angle.tolist()]
    assert any("fly-by" in sentence for sentence in alone[1])
    assert set(found.attrs["validity"]) == alone[0] | alone[1]
    assert collide_pair(GRANULATION, [0, 0, 1], [[0, 0, 0], [0, 0, -1.0]], np.zeros((2, 3))).attrs["validity"] == []


@pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")
def test_a_liquid_that_thins_collides_in_space_as_in_the_plane():
    """And both say that the contact outlasts the rate of the plateau."""
    law = {"liquid.law": "power-law", "liquid.flow_index": 0.6, "liquid.plateau_rate": "1e7 1/s"}
    scene, bodies = GRANULATION.with_entries(law), bodies_of(GRANULATION)
    across = 8.0 * np.tan(0.4) * (1 + bodies.film_thickness / bodies.contact)
    found = collide_pair(scene, [0, 0, 1], [[0, 0, 0], [0, across, -8.0]], np.zeros((2, 3)))
    plane = collide(scene, speed=8.0, angle=0.4, ledger=False)
    assert float(found.restitution) == pytest.approx(plane.restitution, rel=1e-7)
    assert found.attrs["validity"] == [*plane.validity] and "liquid.plateau_rate" in plane.validity[0]


UNEQUAL = {"partner.radius": "200 um", "partner.mass": "8e-5 g"}
ALONG = np.array([1.0, 2.0, -0.3]) / np.linalg.norm([1.0, 2.0, -0.3])
TWISTS = 2e4, 1e6  # rad/s: the first is 5 times as fast as the approach at the surface


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
@pytest.mark.parametrize("entries", [{}, UNEQUAL | {"particles.friction": 0.3}])
def test_twist_alone_is_the_head_on_law(entries: dict[str, object], engine: str) -> None:
    """Outcome, proof, e_n and time of the planar collision; both twists stay, and are in the ledger."""
    scene = GRANULATION.with_entries(entries)
    inertia = np.array(Bodies.of(scene).inertia)
    for speed in (0.5437, 3.0):  # a stick, a bounce
        planar = collide(scene, speed=speed, angle=0.0, engine=engine)
        for twist in TWISTS:
            spins = np.array([twist, -0.3 * twist])[:, None] * ALONG
            found = collide_pair(scene, 3.0 * ALONG, [speed * ALONG, 0.0 * ALONG], spins, engine=engine, ledger=True)
            assert OUTCOMES[int(found.outcome)] == planar.outcome, str(found.reason.values)
            assert bool(found.certified) == planar.certified
            assert float(found.restitution) == pytest.approx(planar.restitution, rel=1e-10)
            np.testing.assert_allclose(found.spins, spins, rtol=0, atol=1e-14 * twist)
            np.testing.assert_allclose(found.normal, ALONG, rtol=0, atol=1e-15)
            twisting = 0.5 * inertia @ np.array([twist, 0.3 * twist]) ** 2
            assert planar.energy is not None
            for term in ("initial", "final"):
                expected = getattr(planar.energy, term) + twisting
                assert float(found[f"energy.{term}"]) == pytest.approx(expected, rel=1e-9)


def test_the_smallest_motion_across_is_no_twist_alone() -> None:
    """A slip a thousand times above rounding turns the line of centres, and twist with it."""
    across = np.cross(ALONG, [0.0, 0.0, 1.0])
    spins = 1e5 * ALONG + 1e-8 * across / np.linalg.norm(across)
    found = collide_pair(GRANULATION, ALONG, [3.0 * ALONG, 0.0 * ALONG], [spins, spins], rtol=1e-11)
    assert np.max(np.abs(found.normal.values - ALONG)) < 1e-12
    assert found.outcome == 2


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
    book, other = (balanced(GRANULATION, VELOCITIES, SPINS, engine) for engine in ("rosenbrock", "taylor"))
    assert (book["tangential_lubrication"] > 0).all()
    for name in LOST:
        assert book[name] == pytest.approx(other[name], rel=1e-7), name
    balanced(WALL, 5 * VELOCITIES, 5 * SPINS[:1], "rosenbrock")  # twist is not lost


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["taylor", "cvodes"])
def test_it_closes_for_a_stick_beside_a_wall(engine):
    """Of its planar collisions each is decided at another time: their ledgers run to one time."""
    speed = WALL.speed_of(0.02)
    moving, spins = np.array([[[0.3 * speed, 0.2 * speed, speed], [0, 0, 0]]]), np.array([[[100.0, -200.0, 50.0]]])
    found = collide_pair(WALL, [0, 0, 1], moving[0], spins[0], ledger=True, engine=engine)
    assert int(found.outcome) == 0
    before = kinetic(WALL, moving, spins)
    assert float(found["energy.initial"]) == pytest.approx(before[0], rel=1e-12)
    assert abs(float(found["energy.residual"])) < 1e-8 * before[0]


def test_a_contact_where_a_stick_is_decided_is_in_the_ledger():
    """Beside a wall four planar collisions give it, which all end at one contact: it is behind all of them."""
    scene = Scene.from_toml("""
        particles.reduced_radius = "9.41138 um"
        particles.density = "751.504 kg/m^3"
        particles.roughness = "3.45053e-08 m"
        particles.dry_restitution = 0.0663816
        liquid.viscosity = "0.068371 Pa s"
        liquid.film_thickness = "8.13022e-07 m"
        liquid.glass_transition_pressure = "213240000000.0 Pa"
        bridge.volume = 0.181138
        bridge.contact_angle = "0 rad"
        bridge.law = "soulie"
        bridge.rupture = "common"
        bridge.surface_tension = "324.729 uN/m"
        attraction.hamaker = "2.19469e-13 J"
        model = {film = "cavitating", tangential = "immersed"}
        partner = {wall = true}
    """)
    normal = (0.9600173152314087, -0.07153808725872322, -0.2706456290562283)
    velocities = ((22.951347780855663, 63.72047656598894, -80.286573095806), (0.0, 0.0, 0.0))
    spins = ((2250550.809730682, -8149055.328729709, -2700031.604016313),)
    kernel, other = (
        values(collide_pair(scene, normal, velocities, spins, rtol=1e-10, ledger=True, engine=engine))
        for engine in ("taylor", "rosenbrock")
    )
    assert kernel["outcome"] == other["outcome"] == OUTCOMES.index("stick")
    assert kernel["energy.dry_contact"] > 0
    for name in ("energy.dry_contact", "energy.final"):
        assert kernel[name] == pytest.approx(other[name], rel=1e-6)
