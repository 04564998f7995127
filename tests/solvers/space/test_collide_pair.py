"""Collisions in space: what is conserved, what turning and moving the picture does, the plane, a wall, chains."""

import math

import numpy as np
import pint
import pytest
import xarray as xr
from wetdoublet.solvers import Scene, collide, collide_pair
from wetdoublet.solvers.errors import InputError
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.groups import si_values
from wetdoublet.solvers.space.by_casadi import own_axes
from wetdoublet.solvers.space.ends import Ends, gains_energy
from wetdoublet.solvers.space.pairs import Pairs, checked

from ...helpers.own_arm import surface

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
_FEW = 1e-9
GRANULATION = Scene.load("granulation")
UNEQUAL = GRANULATION.with_entries({"partner.radius": "0.2 mm", "partner.mass": "3e-5 g"})
ROUGH = GRANULATION.with_entries({"particles.friction": 0.3, "particles.contact_tangential_restitution": 0.2})
WALL = GRANULATION.with_entries({"partner.wall": True})
VECTORS = ("position", "normal", "velocities", "spins")


def sizes(scene):
    """Masses, moments of inertia and the distance of the centres at initial contact, SI."""
    own = si_values(scene, None, None)
    size, weight = own["radius_ratio"], own["mass_ratio"]
    radius = np.array([1 + 1 / size, 1 + size]) * own["reduced_radius"]
    mass = np.array([1 + 1 / weight, 1 + weight]) * own["reduced_mass"]
    return mass, 0.4 * mass * radius**2, radius.sum() + own["film_thickness"]


def arrivals(scene, count, seed, spinning=0.1):
    """Random normals, velocities and spins of pairs that approach, from slow to fast."""
    draw, own = np.random.default_rng(seed), si_values(scene, None, None)
    a = own["reduced_radius"]
    speed = 10 ** draw.uniform(-1.5, 1.0, count) * 6 * np.pi * own["viscosity"] * a**2 / own["reduced_mass"]
    normal = draw.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    velocities = draw.normal(size=(count, 2, 3)) * speed[:, None, None]
    opening = np.sum(normal * (velocities[:, 1] - velocities[:, 0]), axis=1)
    velocities[:, 1] -= (opening + speed)[:, None] * normal
    return normal, velocities, spinning * draw.normal(size=(count, 2, 3)) * (speed / a)[:, None, None]


def turning(seed):
    """A rotation."""
    found, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return found * np.sign(np.linalg.det(found))


def momentum(scene, distance, velocities, spins):
    """Angular momentum about the centre of mass, and the sum of the sizes of its parts."""
    mass, inertia, _ = sizes(scene)
    orbital = mass.prod() / mass.sum() * np.cross(distance, velocities[:, 1] - velocities[:, 0])
    parts = [orbital, *(inertia[k] * spins[:, k] for k in range(2))]
    return sum(parts), sum(np.linalg.norm(part, axis=1) for part in parts)


def energy(scene, velocities, spins):
    """Kinetic energy."""
    mass, inertia, _ = sizes(scene)
    return 0.5 * (mass[:, None] * velocities**2 + inertia[:, None] * spins**2).sum(axis=(-2, -1))


def same(found, expected, rows, names=VECTORS, rtol=_FEW):
    """Compare vectors by their length."""
    for name in names:
        ours, theirs = found[name][rows], expected[name][rows]
        scale = np.linalg.norm(theirs.reshape(len(theirs), -1), axis=1)
        gap = np.linalg.norm((ours - theirs).reshape(len(theirs), -1), axis=1)
        assert np.all(gap <= rtol * scale), (name, (gap / scale).max())


def values(data):
    """The variables of a Dataset."""
    return {name: data[name].values for name in data.data_vars}


@pytest.fixture(scope="module")
def equal():
    """Random collisions of equal spheres, and what became of them."""
    given = arrivals(GRANULATION, 150, 1)
    return given, values(collide_pair(GRANULATION, *given, rtol=1e-11))


@pytest.mark.slow
def test_turning_the_picture_turns_the_answer(equal):
    """In any direction, to what rounding becomes of within the tolerance."""
    (normal, velocities, spins), found = equal
    turn = turning(2)
    turned = values(collide_pair(GRANULATION, normal @ turn.T, velocities @ turn.T, spins @ turn.T, rtol=1e-11))
    assert np.array_equal(turned["outcome"], found["outcome"])
    back = {name: turned[name] @ turn for name in VECTORS}
    same(back, found, slice(None))


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_numbers_beyond_a_doubles_products_are_refused(engine):
    """Each row by its reason, beside a sound one: speeds and spins whose squares are no numbers."""
    speeds, spins = np.array([0.5, 1e200, 1e-300, 0.5]), np.array([0.0, 0.0, 0.0, 1e200])
    velocities = speeds[:, None, None] * [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]
    rates = spins[:, None, None] * [[1.0, 1.0, 0.0], [0.0, 0.0, 0.0]]
    found = collide_pair(GRANULATION, [0, 0, 1], velocities, rates, engine=engine)
    assert found.outcome.values.tolist() == [0, -1, -1, -1]
    assert all("too far off" in why for why in found.reason.values[1:].tolist())


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_a_normal_without_a_direction_marks_its_pair(engine):
    """Zero, NaN, infinite: the others are computed, and the reason shows what was given."""
    normals = [[0.0, 0.0, 2.0], [0.0, 0.0, 0.0], [0.0, math.nan, 1.0], [math.inf, 0.0, 0.0]]
    found = collide_pair(GRANULATION, normals, [[0.0, 0.0, 0.5], [0.0, 0.0, 0.0]], np.zeros((2, 3)), engine=engine)
    assert found.outcome.values.tolist() == [0, -1, -1, -1]
    assert "(0, 0, 0)" in str(found.reason.values[1])
    assert all("no direction" in why for why in found.reason.values[1:].tolist())
    assert np.isnan(found.velocities.values[1:]).all()


def test_head_on_is_head_on_in_every_direction():
    """Without a bridge only that sticks: rounding across the line of centres is no rotation."""
    normal, _, _ = arrivals(GRANULATION, 8, 3)
    velocities = np.stack([np.zeros_like(normal), -0.5 * normal], axis=1)
    found = collide_pair("granulation-dry-bridge", normal, velocities, np.zeros((2, 3)), engine="taylor")
    assert not found.outcome.values.any() and found.certified.values.all()
    away = collide_pair("granulation", normal, 100 * velocities, np.zeros((2, 3)), engine="taylor")
    assert (away.restitution > 0.9).all() and np.isnan(away.slip_restitution).all()  # a ratio to nothing


def test_a_common_velocity_is_added(equal):
    """Physics does not depend on the frame's velocity."""
    (normal, velocities, spins), found = equal
    common = np.array([3.0, -2.0, 1.0])
    moved = values(collide_pair(GRANULATION, normal, velocities + common, spins, rtol=1e-11))
    moved["velocities"] = moved["velocities"] - common
    same(moved, found, found["outcome"] > 0)


def test_hardly_out_of_the_plane_it_is_hardly_another_collision():
    """The vectors' kernel beside the planar one: a small spin out of the plane changes little."""
    normal, velocities = np.array([1.0, 0, 0]), np.array([[0.0, 0, 0], [-20.0, 15.0, 0]])
    spins = np.array([[0.0, 0, 3e5], [0.0, 0, -1e5]])
    tilted = spins + np.array([[1e-5, 1e-4, 0], [0, 0, 0]])
    flat, solid = (
        values(collide_pair(GRANULATION, normal, velocities, w, rtol=1e-11, engine="taylor")) for w in (spins, tilted)
    )
    assert flat["outcome"] == solid["outcome"] > 0
    for name in VECTORS:
        assert solid[name] == pytest.approx(flat[name], rel=1e-7, abs=1e-7 * np.abs(flat[name]).max())


def test_a_doublet_that_tumbles_keeps_its_phase():
    """After sixty turns in a film: the time has the error of the tolerance, the direction that times the angle."""
    scene = GRANULATION.with_entries(
        {
            "particles.reduced_radius": "0.2 mm", "particles.reduced_mass": "3e-5 g", "particles.dry_restitution": 0.8,
            "liquid.viscosity": 0.3, "partner.radius": "0.3 mm", "partner.mass": "3e-5 g", "bridge.volume": 0.02,
        }
    )  # fmt: skip
    normals = [[0.982, -0.138, -0.132], [0.472, 0.86, 0.193]]
    velocities = [
        [[-0.583, 0.024, -0.111], [-0.994, 0.127, -0.123]], [[-0.656, -0.611, 0.0525], [-0.742, -0.979, 0.202]],
    ]  # fmt: skip
    spins = [[[-6900, 4300, -1200], [-1600, -4700, 4400]], [[-4200, -5400, -1500], [6500, -5600, -2100]]]
    found, exact = (
        values(collide_pair(scene, normals, velocities, spins, rtol=rtol, engine=engine))
        for rtol, engine in ((_FEW, "taylor"), (_FEW / 10, "rosenbrock"))
    )
    assert found["time"] == pytest.approx(exact["time"], rel=3 * _FEW)
    assert found["normal"] == pytest.approx(exact["normal"], abs=3 * _FEW * 120 * math.pi)


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


@pytest.mark.slow
@pytest.mark.parametrize("scene", [GRANULATION, WALL], ids=["spheres", "wall"])
def test_a_stick_depends_on_its_arrival_alone(scene):
    """No tolerance and no engine changes its motion, which is at contact; `until` says where they stopped."""
    given = arrivals(scene, 150, 1)
    given = (*given[:2], given[2][:, :1]) if scene.wall else given
    tight, loose = (values(collide_pair(scene, *given, rtol=rtol, engine="taylor")) for rtol in (1e-11, 1e-6))
    few = np.flatnonzero((tight["outcome"] == 0) & (loose["outcome"] == 0))
    other = values(collide_pair(scene, *(each[few[:3]] for each in given), engine="rosenbrock"))
    assert few.size > 3
    assert np.any(tight["until"][few] != loose["until"][few])
    assert np.isnan(tight["until"][tight["outcome"] > 0]).all()
    for name in (*VECTORS, "time", "gap", "angular_velocity", "centre_velocity"):
        assert np.array_equal(tight[name][few], loose[name][few], equal_nan=True), name
        assert np.array_equal(tight[name][few[:3]], other[name], equal_nan=True), name
    assert not tight["time"][few].any()
    assert tight["normal"][few] == pytest.approx(given[0][few], abs=1e-15)


def test_sliding_and_rolling_along_a_wall_superpose():
    """A wall turns nothing out of a plane: the sum of two planar collisions, and twist stays."""
    slide, spin, twist = np.array([3.0, 0, 0]), np.array([0, 0, 4e4]), np.array([0.0, -7e4, 0])
    down = np.array([0.0, -1.0, 0])
    fall = 30.0 * down

    def hit(velocity, rate):
        return values(collide_pair(WALL, down, velocity[None], rate[None], rtol=1e-11, engine="taylor"))

    both = hit(fall + slide + slide[[2, 1, 0]], spin + 2 * spin[[2, 1, 0]] + twist)
    one, other = hit(fall + slide, spin), hit(fall + slide[[2, 1, 0]], 2 * spin[[2, 1, 0]])
    assert both["outcome"] == one["outcome"] > 0
    rebound = -both["restitution"] * fall
    assert both["velocities"][0] - rebound == pytest.approx(
        one["velocities"][0] - rebound + other["velocities"][0] - rebound, rel=1e-10, abs=1e-10
    )
    assert both["spins"][0] == pytest.approx(one["spins"][0] + other["spins"][0] + twist, rel=1e-10, abs=1e-6)
    assert np.isnan(both["spins"][1]).all()


def test_what_comes_out_goes_in_again():
    """100 collisions with random normals, in a frame that moves: none is refused, and energy is never created."""
    draw = np.random.default_rng(8)
    velocities, spins = draw.normal(size=(2, 3)) * 30, draw.normal(size=(2, 3)) * 1e5
    outcomes = []
    for _ in range(100):
        normal = draw.normal(size=3)
        normal *= -np.sign(normal @ (velocities[1] - velocities[0]))
        found = collide_pair(UNEQUAL, normal, velocities, spins, engine="taylor")
        assert not str(found.reason.values), str(found.reason.values)
        after = found.velocities.values, found.spins.values
        assert energy(UNEQUAL, *after) <= energy(UNEQUAL, velocities, spins) * (1 + 1e-9)
        velocities, spins = after
        outcomes.append(int(found.outcome))
        if outcomes[-1] == 0:  # they are thrown again
            velocities = draw.normal(size=(2, 3)) * 30
    assert len(set(outcomes)) > 1


def test_a_bad_row_leaves_the_others():
    """A pair that recedes, and one that is nowhere, say so; the others are computed."""
    velocities = np.zeros((3, 2, 3))
    velocities[:, 1, 0] = -20.0, 5.0, np.nan
    found = values(collide_pair(GRANULATION, [1, 0, 0], velocities, np.zeros((2, 3)), engine="taylor"))
    assert list(found["outcome"] < 0) == [False, True, True]
    assert "do not approach" in found["reason"][1]
    assert "not finite" in found["reason"][2]
    assert np.isnan(found["velocities"][1:]).all()
    assert np.isfinite(found["velocities"][0]).all()


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
    own, distance = si_values(scene, None, None), sizes(scene)[2]
    speed, angle = 3.0, np.array([0.3, 1.45])
    across = speed * np.tan(angle) * distance / (distance - own["film_thickness"])
    velocities = [[[0.0, 0, 0], [y, 0, -speed]] for y in across]
    found = collide_pair(scene, [0, 0, 1], velocities, np.zeros((2, 3)), engine="taylor")
    alone = [set(collide(scene, speed=speed, angle=each, ledger=False).validity) for each in angle.tolist()]
    assert any("fly-by" in sentence for sentence in alone[1])
    assert set(found.attrs["validity"]) == alone[0] | alone[1]
    assert collide_pair(GRANULATION, [0, 0, 1], [[0, 0, 0], [0, 0, -1.0]], np.zeros((2, 3))).attrs["validity"] == []


def test_velocities_and_spins_carry_units():
    """Vectors in cm/s and revolutions per minute give what the same ones in SI do."""
    units = pint.UnitRegistry()
    velocities, spins = np.array([[0.0, 0.0, 20.0], [5.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.0], [2e4, 0.0, -5e4]])
    plain = values(collide_pair(GRANULATION, [0, 0, 1], velocities, spins))
    given = 100 * velocities * units.cm / units.s, spins * 30 / np.pi * units.rpm
    found = values(collide_pair(GRANULATION, [0, 0, 1], *given))
    assert found["velocities"] == pytest.approx(plain["velocities"], rel=1e-9)
    as_data = xr.DataArray(100 * velocities, attrs={"units": "cm/s"})
    found = values(collide_pair(GRANULATION, [0, 0, 1], as_data, spins))
    assert found["velocities"] == pytest.approx(plain["velocities"], rel=1e-9)


@pytest.mark.parametrize(
    ("scene", "normal", "velocities", "spins", "field"),
    [
        (GRANULATION, [0, 1], np.ones((2, 3)), np.ones((2, 3)), "normal"),
        (GRANULATION, [0, 0, 1], np.ones((1, 3)), np.ones((2, 3)), "velocities"),
        (GRANULATION, [0, 0, 1], np.ones((4, 2, 3)), np.ones((3, 2, 3)), "normal, velocities, spins"),
        (WALL, [0, 0, 1], np.ones((1, 3)), np.ones((2, 3)), "spins"),
        (GRANULATION, [0, 0, 1], [["fast"] * 3] * 2, np.ones((2, 3)), "velocities"),
        (GRANULATION, [0, 0, 1], [["5 m"] * 3] * 2, np.ones((2, 3)), "velocities"),
        (GRANULATION, [0, 0, 1], np.ones((2, 3)), None, "spins"),
        ("pendulum", [0, 0, 1], np.ones((2, 3)), np.ones((2, 3)), "pendulum"),
        (ROUGH.with_entries({"partner.wall": True}), [0, 0, 1], np.ones((1, 3)), np.ones((1, 3)), "particles.friction"),
    ],
)
def test_bad_input_is_named(scene, normal, velocities, spins, field):
    """Shapes, and scenes that there is no collision in space for."""
    with pytest.raises(InputError) as caught:
        collide_pair(scene, normal, velocities, spins)
    assert caught.value.field == field


def test_an_arm_with_which_angular_momentum_drifts_is_refused():
    """A pair in space keeps its angular momentum; with the surface arm of a model file it would not."""
    with pytest.raises(InputError, match="^model.arm: "):
        collide_pair(surface("granulation"), [0, 0, 1], np.ones((2, 3)), np.ones((2, 3)))


def test_what_is_a_rotation_is_one_threshold():
    """Beside spheres that spin about their line, motion of 1e-13 of that turns the line: axes go along with it."""
    sideways = 1e-13 * np.array([0.6, 0.8, 0.0])
    first = np.array([0, 0, 1.0]) + sideways
    velocities = np.array([[first, -first]])
    spins = np.array([[[0, 0, 1 / (2 * GRANULATION.reduced_radius)]] * 2])
    pair = Pairs(GRANULATION, (), np.array([[0, 0, 1.0]]), velocities, spins)
    assert abs(own_axes(pair)[1] @ [0.8, -0.6, 0.0]) == pytest.approx(1, abs=1e-12)
