"""Surprises, by row of their page, in closed form or beside an integrator of their own."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, boundary, collide, collide_many, collide_pair, critical, sensitivities

from ..helpers.mechanics import Arrival, N, W
from ..helpers.scanned import Scan
from ..helpers.two_bodies import bodies_of
from .test_surprises import (
    BACKSPIN,
    BESIDE,
    FILM,
    GRANULATION,
    LIQUID,
    PENDULUM,
    STEEP,
    TENSION,
    WALL,
    alone,
    at,
    mean,
    partner,
    stokes,
)  # fmt: skip

pytestmark = pytest.mark.slow  # many collisions by an integrator in Python


def test_7_dry_restitution_does_nothing() -> None:
    numbers = {e: stokes(GRANULATION.with_entries({"particles.dry_restitution": e}), 0.0)[0] for e in (0.99, 0.61, 0.5)}
    assert numbers[0.99] == pytest.approx(0.11532089, rel=1e-7)
    assert numbers[0.61] == pytest.approx(numbers[0.99], rel=1e-9)
    assert numbers[0.5] / numbers[0.99] - 1 == pytest.approx(0.0043288, rel=1e-3)
    film = Scene.load("granulation-dry-bridge")
    escapes = [stokes(film.with_entries({"particles.dry_restitution": e}), 0.0)[0] for e in (0.99, 0.396, 0.38)]
    assert escapes[1] == pytest.approx(escapes[0], rel=1e-9)
    assert escapes[2] > escapes[0] * (1 + 1e-6)


def loss(s: float) -> float:
    """What a film takes from x0 to s x0, in units of the Stokes number."""
    return math.log(1 / s) - 1.5 + 2 * s - s * s / 2


def test_15_glass_makes_e_n_larger_than_roughness_does() -> None:
    """In closed form: the gap at which the pressure is met, and the film's loss to there and back."""
    one, liquid = PENDULUM.particles, PENDULUM.liquid
    number = 1.1 * stokes(PENDULUM, 0.0)[0]
    scale = 3 * liquid.viscosity * one.reduced_radius * PENDULUM.speed_of(number) / liquid.film_thickness**2
    pressure = liquid.glass_transition_pressure
    assert pressure is not None
    gap = brentq(lambda s: scale * (1 - loss(s) / number) / s**2 - pressure, 0.12, 0.5)
    expected = one.dry_restitution * (1 - loss(gap) / number) - loss(gap) / number
    assert expected == pytest.approx(0.22448, rel=1e-4)
    found = collide(PENDULUM, stokes=number, angle=0.0)
    assert found.restitution == pytest.approx(expected, rel=2e-4)  # strings
    asperity = one.roughness / liquid.film_thickness
    least = (1 + 1 / one.dry_restitution) * loss(asperity)
    rough = one.dry_restitution * (1 - loss(asperity) / (1.1 * least)) - loss(asperity) / (1.1 * least)
    assert rough == pytest.approx(0.0900, rel=1e-3)
    assert expected / rough == pytest.approx(2.5, rel=0.01)


def test_16_surface_tension_makes_it_stick_less() -> None:
    """Between the critical speeds of one and four times the surface tension the weaker bridge sticks."""
    for scene in (GRANULATION, WALL):
        strong = scene.with_entries({TENSION: 0.075})
        speed = math.sqrt(at(scene) * at(strong))
        assert alone(scene, speed).outcome == "stick"
        assert alone(strong, speed).outcome == "bounce"


def test_18_film_and_glass_pressure_are_one_number() -> None:
    number = 1.2 * stokes(PENDULUM, 0.0)[0]
    names = ["liquid.film_thickness", "liquid.glass_transition_pressure"]
    found = sensitivities(PENDULUM, of=["restitution"], wrt=names, stokes=number, angle=0.0)
    slopes = [found.elasticity["restitution"][name] for name in names]
    assert slopes == pytest.approx([-2.9124, -1.4562], rel=1e-4)
    thick = PENDULUM.with_entries({"liquid.film_thickness": 840e-6, "liquid.glass_transition_pressure": 3e6})
    both = [collide(scene, stokes=number, angle=0.0).restitution for scene in (PENDULUM, thick)]
    assert both[1] == pytest.approx(both[0], rel=1e-4)  # strings


def test_19_the_critical_speed_has_a_minimum_over_the_film() -> None:
    thin, least, thick = (at(GRANULATION.with_entries({FILM: film})) for film in (1.5e-6, 2.3e-6, 8e-6))
    assert least < thin < thick


def test_21_viscosity_raises_e_n() -> None:
    number = stokes(PENDULUM, 0.0)[0]
    for factor, expected in ((1.5, -0.22363), (3.0, 0.0097976)):
        speed = PENDULUM.speed_of(factor * number)
        values = [collide(PENDULUM.with_entries({"liquid.viscosity": 12 * k}), speed=speed, angle=0.0, engine="cvodes",
                          rtol=1e-12).restitution for k in (0.999, 1.001)]  # fmt: skip
        slope = math.log(values[1] / values[0]) / math.log(1.001 / 0.999)
        assert slope == pytest.approx(expected, rel=1e-3)
        found = sensitivities(PENDULUM, of=["restitution"], wrt=["liquid.viscosity"], speed=speed, angle=0.0)
        assert found.elasticity["restitution"]["liquid.viscosity"] == pytest.approx(expected, rel=1e-4)


def test_2_a_separation_lasts_a_thousand_times_longer() -> None:
    first, second = stokes(GRANULATION, STEEP)
    near = collide(GRANULATION, stokes=1.01 * first, angle=STEEP)
    assert near.contact_time == pytest.approx(7.33835e-3, rel=1e-4)
    assert near.rotation == pytest.approx(3.85644 * math.tau, rel=1e-4)
    end = alone(GRANULATION, near.speed, STEEP)
    assert end.time == pytest.approx(near.contact_time, rel=1e-5)
    assert math.atan2(end.state[N + 1], end.state[N]) % math.tau == pytest.approx(near.rotation % math.tau, rel=1e-5)
    exact = boundary(GRANULATION, angle=STEEP, rtol=1e-12).changes[0][0].stokes
    times = [collide(GRANULATION, stokes=exact * (1 + d), angle=STEEP, rtol=1e-12).contact_time for d in (1e-5, 1e-6)]
    assert times[1] - times[0] == pytest.approx(22.036e-3, rel=1e-3)
    for number in (1.001 * second, 0.3):
        assert 6e-6 < collide(GRANULATION, stokes=number, angle=STEEP).contact_time < 30e-6
    angles = np.arcsin(np.sqrt((np.arange(4000) + 0.5) / 4000))
    found = collide_many(GRANULATION, relative_speed=1.0, angle=angles, of=("contact_time", "rotation"))
    apart = found.outcome.values > 0
    assert np.mean(found.contact_time.values[apart] > 1e-3) == pytest.approx(0.613, abs=2e-3)
    assert np.mean(found.rotation.values[apart] > math.tau) == pytest.approx(0.3405, abs=2e-3)


def test_3_that_time_grows_as_a_third_power() -> None:
    rates = []
    for viscosity in (200.0, 1000.0):
        scene = LIQUID.with_entries({"liquid.viscosity": viscosity})
        number = boundary(scene, angle=STEEP, rtol=1e-12).changes[0][0].stokes
        times = [collide(scene, stokes=number * (1 + d), angle=STEEP, rtol=1e-12).contact_time for d in (1e-5, 1e-6)]
        rates.append(times[1] - times[0])
    assert math.log(rates[1] / rates[0]) / math.log(5) == pytest.approx(0.3243, rel=5e-3)


def turns_over(shear: float, centrifugal: float) -> bool:
    """Whether a doublet at 60 deg separates, with a tangential force `shear` times the model's: SI, by scipy."""
    body = bodies_of(GRANULATION)
    m, a, x0 = body.m, body.a, body.film_thickness
    omega = math.sqrt(centrifugal * 0.025 / m)
    speed = omega * 4 * a / math.tan(STEEP)

    def rates(_: float, y: np.ndarray) -> list[float]:
        x, u, turning, spin = max(y[0], 1e-3 * x0), *y[1:]
        r = 4 * a + x
        drag = body.drag(x) * u if x < x0 else 0.0
        drags = shear * 8 * math.pi * body.viscosity * a**2 * (turning - spin) * max(math.log(2 * a / x), 0.0)
        rise = drags * r / 2 / (3.2 * m * a**2)
        return [u, r * turning**2 - (drag + body.pull(x)) / m, -(drags / m + 2 * u * turning) / r, rise]

    def apart(_: float, y: np.ndarray) -> float:
        return float(y[0] - body.rupture)

    def near(t: float, y: np.ndarray) -> float:  # far inside the saddle
        return float(y[0] - 0.3 * x0) if t > 1e-3 else 1.0

    apart.terminal = near.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(rates, (0, 0.5), [x0, -speed, omega, 0.0], "Radau", events=[apart, near], rtol=1e-8,
                      atol=[1e-13, 1e-8, 1e-4, 1e-4])  # fmt: skip
    return bool(found.t_events[0].size)


@pytest.mark.parametrize(
    ("shear", "expected", "relative"), [(1.0, 4.06318, 1e-4), (0.01, 4.03, 2e-3), (0.0, 2.118, 1e-3)]
)
def test_4_the_tangential_law_hardly_moves_the_boundary(shear: float, expected: float, relative: float) -> None:
    low, high = expected * (1 - 0.02), expected * (1 + 0.02)
    assert not turns_over(shear, low)
    assert turns_over(shear, high)
    while high / low - 1 > relative / 4:
        middle = (low + high) / 2
        low, high = (low, middle) if turns_over(shear, middle) else (middle, high)
    assert low == pytest.approx(expected, rel=relative)


def test_4_and_12_centrifugal_numbers_of_boundaries() -> None:
    for entries, degrees, expected in (
        ({"model.tangential": "immersed"}, 60, 4.06318), ({"model.tangential": "film"}, 60, 4.06054),
        *(({"liquid.glass_transition_pressure": "1 PPa", "bridge.volume": volume}, 45, number)
          for volume, number in ((0.01, 2.89385), (0.1, 4.12112), (1.0, 4.43518))),
    ):  # fmt: skip
        line = boundary(GRANULATION.with_entries(entries), angle=math.radians(degrees)).changes[0]
        assert line[0].centrifugal == pytest.approx(expected, rel=1e-5)


def test_9_22_and_30_oblique() -> None:
    """On strings the boundary is a speed; of larger spheres it is hardly lower; the lighter sphere spins faster."""
    for entries, expected in (({"pendulum.length": 0.5}, 0.1046290), ({"pendulum.length": 2.0}, 0.0525433),
                              ({"liquid.viscosity": 48.0}, 0.105391)):  # fmt: skip
        assert critical(PENDULUM.with_entries(entries), angle=STEEP).rows[0].speed == pytest.approx(expected, rel=2e-4)
    larger = GRANULATION.with_entries({"particles.reduced_radius": 1e-4, "particles.reduced_mass": 4.16e-8})
    assert at(larger, STEEP) / at(GRANULATION, STEEP) == pytest.approx(0.761166, rel=1e-5)
    found = collide(partner(GRANULATION, 1.0, 10.0), stokes=0.3, angle=STEEP)
    assert found.final_spin / found.final_spin_partner == pytest.approx(2.37925, rel=1e-5)


def test_5_restitution_jumps() -> None:
    second = stokes(GRANULATION, STEEP)[1]
    for side, expected, accuracy in ((-1e-6, 0.737332, 1e-4), (1e-6, 0.867856, 3e-3)):
        assert collide(GRANULATION, stokes=second * (1 + side), angle=STEEP).restitution == pytest.approx(
            expected, rel=accuracy
        )
    for degrees, expected in ((30, 0.157), (45, 0.269), (60, 0.460), (75, 0.978), (85, 2.947)):
        angle = math.radians(degrees)
        found = collide(GRANULATION, stokes=stokes(GRANULATION, angle)[0] * (1 + 1e-6), angle=angle)
        assert found.restitution == pytest.approx(expected, abs=6e-4)


def test_6_with_backspin_faster_can_stick() -> None:
    assert stokes(BACKSPIN, STEEP) == pytest.approx([0.0190840, 0.0756485, 0.118652], rel=1e-5)
    for number, sticks in ((0.0189, False), (0.0192, True), (0.0755, True), (0.0758, False)):
        assert (alone(BACKSPIN, BACKSPIN.speed_of(number), STEEP).outcome == "stick") == sticks


def test_11_the_ceiling_of_rebounds_without_glass() -> None:
    one, liquid = GRANULATION.particles, GRANULATION.liquid
    ceiling = one.reduced_mass * liquid.film_thickness**2 * 20e6
    ceiling /= 18 * math.pi * liquid.viscosity**2 * one.reduced_radius**3
    assert ceiling == pytest.approx(0.2354078, rel=1e-6)
    for degrees in (82, 85):
        assert stokes(GRANULATION, math.radians(degrees))[-1] == pytest.approx(ceiling, rel=1e-8)
    corrected = GRANULATION.with_entries({"model.glass": "film-corrected"})
    assert stokes(corrected, math.radians(85))[-1] > 10 * ceiling


def ends() -> tuple[float, float]:
    """Distances of the centres at initial contact and at rupture."""
    body = bodies_of(GRANULATION)
    return body.contact + body.film_thickness, body.contact + body.rupture


def test_14_rigid_rotation_would_overspin_less() -> None:
    """Just below the ceiling, where e_t is least, rigid rotation of the same L would have more."""
    first, last = ends()
    assert first * last / (last**2 + 6.4 * bodies_of(GRANULATION).a ** 2) > 0.6448 * (1 + 1e-3)


def test_24_a_wall_lets_go_with_a_jump() -> None:
    for scene, expected in ((WALL, 0.556198), (GRANULATION, 0.400298)):
        speed = at(scene)
        assert collide(scene, speed=speed * (1 + 1e-6), angle=0.0).restitution == pytest.approx(expected, rel=1e-3)
        # it rises as a square root from there
        assert alone(scene, speed * (1 + BESIDE)).restitution == pytest.approx(expected, rel=0.05)


def test_28_a_wall_gives_back_what_the_bridge_leaves() -> None:
    """In closed form: the dry restitution, less the work of the bridge; whatever the viscosity."""
    speed, angle = at(WALL), math.radians(45)
    body, normal = bodies_of(WALL), 1.5 * speed
    gap = np.linspace(body.film_thickness, body.rupture, 20_001)
    work = np.trapezoid([body.pull(float(x)) for x in gap], gap)
    closed = math.sqrt(body.dry_restitution**2 - 2 * work / (body.m * normal**2))
    assert closed == pytest.approx(0.967236, abs=1e-6)
    for viscosity in (2.0, 3.0):
        thicker = WALL.with_entries({"liquid.viscosity": viscosity})
        assert collide(thicker, speed=normal, angle=angle).restitution == pytest.approx(closed, rel=1e-8)


def twisted(number: float, twist: float) -> tuple[object, Arrival]:
    """Equal twists (rad/s) at 60 deg: by the toolkit, and the arrival for another."""
    speed = GRANULATION.speed_of(number)
    velocities = ((0.0, 0.0, 0.0), (-speed, math.tan(STEEP) * 1.04 * speed, 0.0))
    spins = ((twist, 0.0, 0.0), (twist, 0.0, 0.0))
    return collide_pair(GRANULATION, [1, 0, 0], velocities, spins), Arrival((1.0, 0.0, 0.0), velocities, spins)


def test_13_twist_parts_a_stick() -> None:
    """In closed form: all of L in rigid rotation at the roughness, where the bridge just holds."""
    body, number = bodies_of(GRANULATION), 0.02
    omega = math.tan(STEEP) * GRANULATION.speed_of(number) / body.contact
    r = body.contact + body.roughness
    holds = (r**2 + 6.4 * body.a**2) * math.sqrt(body.m * body.pull(body.roughness) / r)
    orbital = body.m * (body.contact + body.film_thickness) ** 2 * omega
    closed = math.sqrt(holds**2 - orbital**2) / (2 * body.inertias[0]) / omega
    assert closed == pytest.approx(3.015, rel=5e-3)
    below, above, fast = (twisted(number, k * omega)[0] for k in (0.999 * 3.015, 1.001 * 3.015, 3.1))
    assert [int(each.outcome) for each in (below, above, fast)] == [0, 2, 2]
    assert float(fast.time) == pytest.approx(0.77368, rel=1e-3)


def test_33_twist_throws_a_pair_out_of_its_plane() -> None:
    for number, expected in ((0.1, 33.62), (0.3, 0.9406)):
        found, arrival = twisted(number, 2e4)
        relative = found.velocities.values[1] - found.velocities.values[0]
        angle = math.degrees(math.asin(relative[2] / np.linalg.norm(relative)))
        assert angle == pytest.approx(expected, rel=1e-3)
        end = Scan(bodies_of(GRANULATION), arrival, None, 1e-9).run()
        assert relative == pytest.approx(np.array(end.state[W : W + 3]), rel=1e-5)


@pytest.mark.usefixtures("optimized")
def test_34_means_are_those_of_collisions_by_another_engine() -> None:
    """Of e_n, of the part of the normal energy that is lost, of all energy, at 80 angles of Gauss and Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    angle = (1 + nodes) * math.pi / 4
    weight = weights * math.pi / 4 * np.sin(2 * angle)
    of = ("energy.initial", "energy.final", "tangential_restitution")
    found = collide_many(GRANULATION, relative_speed=10.0, angle=angle, engine="rosenbrock", of=of)
    assert (found.outcome.values > 0).all()
    e_n, first, last = (found[name].values for name in ("restitution", *of[:2]))
    means = weight @ e_n, 1 - 2 * weight @ (e_n * np.cos(angle)) ** 2, 1 - weight @ last / (weight @ first)
    assert means == pytest.approx((1.286290, -0.171621, 0.143859), abs=2e-3)
    assert weight @ found.tangential_restitution.values == pytest.approx(0.659371, abs=2e-3)


@pytest.mark.usefixtures("optimized")
def test_35_and_36_what_rigid_rotation_keeps() -> None:
    """Where all stick, in closed form; and those that part have its tangential restitution."""
    first, last = ends()
    a = bodies_of(GRANULATION).a
    stretch = (first / (4 * a)) ** 2  # squared sideways velocity of the centres, over that of the surfaces
    closed = 1 - stretch / (1 + stretch) * first**2 / (first**2 + 6.4 * a**2)
    assert closed == pytest.approx(0.6206806, rel=1e-6)
    assert mean(GRANULATION, "kinetic_energy_loss", 0.5) == pytest.approx(closed, rel=1e-9)
    assert first * last / (last**2 + 6.4 * a**2) == pytest.approx(0.66, abs=0.01)
