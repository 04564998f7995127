"""Surprises, by row of their page, in closed form or beside an integrator of their own."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide, collide_many, collide_pair, collision_averages, critical

from ..helpers.mechanics import N
from ..helpers.scanned import Outcome, scan_of
from ..helpers.two_bodies import bodies_of
from .test_surprises import GRANULATION, PENDULUM, STEEP, stokes

pytestmark = pytest.mark.slow  # many collisions by an integrator in Python
WALL = GRANULATION.with_entries({"partner.wall": True})
LIQUID = GRANULATION.with_entries({"liquid.glass_transition_pressure": "1 PPa"})
BACKSPIN = GRANULATION.with_entries({"impact.spin": -2e4})
BESIDE = 1e-4  # of a critical speed, where outcomes on both sides are looked at


def alone(scene: Scene, speed: float, angle: float = 0.0) -> Outcome:
    """The collision by the independent integrator."""
    impact = scene.with_impact(speed=speed, angle=angle)
    scan = scan_of(impact, 1e-10, accuracy=1e-9)  # at 1e-11 a doublet that turns for long takes ten times the steps
    scan.most *= 10  # of steps: a doublet turns for long
    return scan.run()


@pytest.mark.parametrize("scene", [GRANULATION, WALL, LIQUID.with_entries({"partner.wall": True})])
def test_head_on_critical_speeds(scene: Scene) -> None:
    """Rows 1, 24, 25: another integrator sticks below and parts above; from there e_n rises as a square root."""
    speed = critical(scene, angle=0.0).rows[0].speed
    below, above = (alone(scene, side * speed) for side in (1 - BESIDE, 1 + BESIDE))
    assert below.outcome == "stick" != above.outcome
    beside = collide(scene, speed=speed * (1 + BESIDE), angle=0.0).restitution
    assert above.restitution == pytest.approx(beside, rel=1e-3)


def loss(s: float) -> float:
    """What a film takes from x0 to s x0, in units of the Stokes number."""
    return math.log(1 / s) - 1.5 + 2 * s - s * s / 2


def test_15_glass_makes_e_n_larger_than_roughness_does() -> None:
    """In closed form: the gap at which the pressure is met, and the film's loss to there and back."""
    one, liquid = PENDULUM.particles, PENDULUM.liquid
    number = 1.1 * stokes(PENDULUM, 0.0)[0]
    scale = 3 * liquid.viscosity * one.reduced_radius * PENDULUM.speed_of(number) / liquid.film_thickness**2
    pressure = liquid.glass_transition_pressure
    gap = brentq(lambda s: scale * (1 - loss(s) / number) / s**2 - pressure, 0.12, 0.5)
    expected = one.dry_restitution * (1 - loss(gap) / number) - loss(gap) / number
    assert collide(PENDULUM, stokes=number, angle=0.0).restitution == pytest.approx(expected, rel=2e-4)  # strings
    taken = loss(one.roughness / liquid.film_thickness)
    least = (1 + 1 / one.dry_restitution) * taken
    rough = one.dry_restitution * (1 - taken / (1.1 * least)) - taken / (1.1 * least)
    assert rough == pytest.approx(0.0900, rel=1e-3)
    assert expected / rough == pytest.approx(2.5, rel=0.01)


def test_2_a_separation_lasts_a_thousand_times_longer() -> None:
    """One by the independent integrator; and shares of isotropic impacts."""
    first, second = stokes(GRANULATION, STEEP)
    near = collide(GRANULATION, stokes=1.01 * first, angle=STEEP)
    end = alone(GRANULATION, near.speed, STEEP)
    assert end.time == pytest.approx(near.contact_time, rel=1e-5)
    assert math.atan2(end.state[N + 1], end.state[N]) % math.tau == pytest.approx(near.rotation % math.tau, rel=1e-5)
    for number in (1.001 * second, 0.3):
        assert 6e-6 < collide(GRANULATION, stokes=number, angle=STEEP).contact_time < 30e-6
    angles = np.arcsin(np.sqrt((np.arange(4000) + 0.5) / 4000))
    found = collide_many(GRANULATION, relative_speed=1.0, angle=angles, of=("contact_time", "rotation"))
    apart = found.outcome.values > 0
    assert np.mean(found.contact_time.values[apart] > 1e-3) == pytest.approx(0.613, abs=2e-3)
    assert np.mean(found.rotation.values[apart] > math.tau) == pytest.approx(0.3405, abs=2e-3)


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


def test_5_restitution_jumps() -> None:
    for degrees, expected in ((30, 0.157), (45, 0.269), (60, 0.460), (75, 0.978), (85, 2.947)):
        angle = math.radians(degrees)
        found = collide(GRANULATION, stokes=stokes(GRANULATION, angle)[0] * (1 + 1e-6), angle=angle)
        assert found.restitution == pytest.approx(expected, abs=6e-4)


def test_6_with_backspin_faster_can_stick() -> None:
    for number, sticks in ((0.0189, False), (0.0192, True), (0.0755, True), (0.0758, False)):
        assert (alone(BACKSPIN, BACKSPIN.speed_of(number), STEEP).outcome == "stick") == sticks


def test_11_the_ceiling_of_rebounds_without_glass() -> None:
    one, liquid = GRANULATION.particles, GRANULATION.liquid
    ceiling = one.reduced_mass * liquid.film_thickness**2 * 20e6
    ceiling /= 18 * math.pi * liquid.viscosity**2 * one.reduced_radius**3
    assert stokes(GRANULATION, math.radians(85))[-1] == pytest.approx(ceiling, rel=1e-8)


def ends() -> tuple[float, float]:
    """Distances of the centres at initial contact and at rupture."""
    body = bodies_of(GRANULATION)
    return body.contact + body.film_thickness, body.contact + body.rupture


def test_14_rigid_rotation_would_overspin_less() -> None:
    """Just below the ceiling, where e_t is least, rigid rotation of the same L would have more."""
    first, last = ends()
    assert first * last / (last**2 + 6.4 * bodies_of(GRANULATION).a ** 2) > 0.6448 * (1 + 1e-3)


def test_28_a_wall_gives_back_what_the_bridge_leaves() -> None:
    """In closed form: the dry restitution, less the work of the bridge; whatever the viscosity."""
    speed, angle = critical(WALL, angle=0.0).rows[0].relative_speed, math.radians(45)
    body, normal = bodies_of(WALL), 1.5 * speed
    gap = np.linspace(body.film_thickness, body.rupture, 20_001)
    work = np.trapezoid([body.pull(float(x)) for x in gap], gap)
    closed = math.sqrt(body.dry_restitution**2 - 2 * work / (body.m * normal**2))
    assert closed == pytest.approx(0.967236, abs=1e-6)
    for viscosity in (2.0, 3.0):
        thicker = WALL.with_entries({"liquid.viscosity": viscosity})
        assert collide(thicker, speed=normal, angle=angle).restitution == pytest.approx(closed, rel=1e-8)


def test_13_twist_parts_a_stick() -> None:
    """In closed form: all of L in rigid rotation at the roughness, where the bridge just holds."""
    body, number = bodies_of(GRANULATION), 0.02
    omega = math.tan(STEEP) * GRANULATION.speed_of(number) / body.contact
    r = body.contact + body.roughness
    holds = (r**2 + 6.4 * body.a**2) * math.sqrt(body.m * body.pull(body.roughness) / r)
    orbital = body.m * (body.contact + body.film_thickness) ** 2 * omega
    closed = math.sqrt(holds**2 - orbital**2) / (2 * body.inertias[0]) / omega
    assert closed == pytest.approx(3.015, rel=5e-3)
    speed, outcomes = GRANULATION.speed_of(number), []
    for twist in (0.999 * 3.015 * omega, 1.001 * 3.015 * omega):
        velocities = ((0.0, 0.0, 0.0), (-speed, math.tan(STEEP) * 1.04 * speed, 0.0))
        outcomes.append(int(collide_pair(GRANULATION, [1, 0, 0], velocities, [(twist, 0.0, 0.0)] * 2).outcome))
    assert outcomes == [0, 2]


@pytest.mark.usefixtures("optimized")
def test_35_and_36_what_rigid_rotation_keeps() -> None:
    """Where all stick, in closed form; and those that part have its tangential restitution."""
    first, last = ends()
    a = bodies_of(GRANULATION).a
    stretch = (first / (4 * a)) ** 2  # squared sideways velocity of the centres, over that of the surfaces
    closed = 1 - stretch / (1 + stretch) * first**2 / (first**2 + 6.4 * a**2)
    assert closed == pytest.approx(0.6206806, rel=1e-6)
    assert float(collision_averages(GRANULATION, speeds=0.5).kinetic_energy_loss) == pytest.approx(closed, rel=1e-9)
    assert first * last / (last**2 + 6.4 * a**2) == pytest.approx(0.66, abs=0.01)
