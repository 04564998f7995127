"""The numbers of `docs/explanation/surprises.md`, by row, and beside each an integrator of its own or a closed form."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from wetdoublet.solvers import (
    Scene,
    boundary,
    collide,
    collide_many,
    collide_pair,
    collision_averages,
    critical,
    sensitivities,
)

from ..helpers.scanned import Arrival, N, Outcome, Scan, W, X, scan_of
from ..helpers.two_bodies import bodies_of

pytestmark = pytest.mark.slow  # many collisions by an integrator in Python
GRANULATION, PENDULUM = Scene.load("granulation"), Scene.load("pendulum")
WALL = GRANULATION.with_entries({"partner.wall": True})
LIQUID = GRANULATION.with_entries({"liquid.glass_transition_pressure": "1 PPa"})
STEEP = math.radians(60)
BESIDE = 1e-4  # of a head-on critical speed, where outcomes on both sides are looked at


def at(scene: Scene, angle: float = 0.0) -> float:
    """The relative speed up to which a scene sticks, which an independent integrator confirms on both sides."""
    speed = critical(scene, angle=angle).rows[0].relative_speed
    assert speed is not None
    if scene.pendulum is None:
        beside = 1e-2 if angle else BESIDE  # a doublet nearer to its boundary turns for hundreds of times
        below, above = (alone(scene, k * speed * math.cos(angle), angle).outcome for k in (1 - beside, 1 + beside))
        assert below == "stick" != above
    return speed


def alone(scene: Scene, speed: float, angle: float = 0.0, **spins: float) -> Outcome:
    """The collision by the independent integrator."""
    spinning = {f"impact.{name}": value for name, value in spins.items()}
    impact = scene.with_impact(speed=speed, angle=angle).with_entries(spinning)
    scan = scan_of(impact, 1e-10, accuracy=1e-9)  # at 1e-11 a doublet that turns for long takes ten times the steps
    scan.most *= 10  # of steps: a doublet turns for long
    return scan.run()


def turning(scene: Scene, end: Outcome) -> float:
    """The rate at which the line of centres turns in the end, rad/s."""
    return end.across / (bodies_of(scene).contact + end.state[X])


def stokes(scene: Scene, angle: float) -> list[float]:
    """Where the outcome changes along the line of an angle."""
    return [change.stokes for change in boundary(scene, angle=angle).changes[0]]


def elasticity(scene: Scene, entry: str) -> float:
    """Of the head-on critical speed."""
    return float(critical(scene, angle=0.0, wrt=[entry]).rows[0].elasticity[entry])


def partner(scene: Scene, radius: float, mass: float) -> Scene:
    """Beside a sphere of so many times the radius and mass."""
    one = scene.particles
    return scene.with_entries(
        {"partner.radius": 2 * radius * one.reduced_radius, "partner.mass": 2 * mass * one.reduced_mass}
    )


def mean(scene: Scene | str, name: str, speeds: float | str, tolerance: float = 1e-6) -> float:
    return float(collision_averages(scene, speeds=speeds, tolerance=tolerance)[name])


def rows(text: str) -> list[int]:
    """The numbers of the table's rows of a page."""
    return sorted(int(line.split("|")[1]) for line in text.splitlines() if line.startswith("| ") and line[2].isdigit())


def test_the_page_has_every_row_and_its_command() -> None:
    text = (Path(__file__).parents[2] / "docs/explanation/surprises.md").read_text(encoding="utf-8")
    labels = {int(row) for label in re.findall(r"  # ([\d, ]+)$", text, re.MULTILINE) for row in label.split(",")}
    assert rows(text) == list(range(1, 37))
    assert labels == set(range(1, 37))


# ---- head-on


def test_1_a_thicker_liquid_sticks_less() -> None:
    expected = {0.1: 1.932081, 0.5608: 2.704629, 2.0: 2.090142, 8.0: 0.859622}
    for viscosity, speed in expected.items():
        assert at(GRANULATION.with_entries({"liquid.viscosity": viscosity})) == pytest.approx(speed, rel=1e-5)
    assert elasticity(GRANULATION, "liquid.viscosity") == pytest.approx(-0.433846, rel=1e-4)
    assert elasticity(LIQUID, "liquid.viscosity") == pytest.approx(0.436657, rel=1e-4)


def test_1_neither_does_a_gas() -> None:
    thicker, without = (scene.with_entries({"liquid.viscosity": 4.0}) for scene in (GRANULATION, LIQUID))
    shares = [mean(scene, "stick_probability", 2.0) for scene in (GRANULATION, thicker, without)]
    assert shares == pytest.approx([0.202152, 0.0, 0.198172], rel=1e-4)


def test_critical_says_that_its_line_has_a_maximum() -> None:
    """Over viscosity; not over what moves the speed one way, nor over what does nothing to it, nor of all entries."""
    names = ["liquid.viscosity", "particles.reduced_radius", "particles.roughness", "particles.dry_restitution"]
    [one] = critical(GRANULATION, angle=0.0, wrt=names[:1]).rows
    [text] = one.sentences
    assert text.startswith("over liquid.viscosity it has a maximum, 2.705 m/s (relative speed) at 0.5")
    assert float(text.split(" at ")[1].removesuffix(" Pa s")) == pytest.approx(0.5608, rel=0.01)
    assert critical(GRANULATION, angle=0.0, wrt="all").rows[0].sentences == ()
    assert (
        critical("lactose-pvp", angle=0.0, wrt=["liquid.viscosity", "bridge.surface_tension"]).rows[0].sentences == ()
    )
    [one] = critical(GRANULATION, angle=0.0, wrt=["particles.roughness", "particles.dry_restitution"]).rows
    assert one.sentences == ()


def test_7_dry_restitution_does_nothing() -> None:
    numbers = {e: stokes(GRANULATION.with_entries({"particles.dry_restitution": e}), 0.0)[0] for e in (0.99, 0.61, 0.5)}
    assert numbers[0.99] == pytest.approx(0.11532089, rel=1e-7)
    assert numbers[0.61] == pytest.approx(numbers[0.99], rel=1e-9)
    assert numbers[0.5] / numbers[0.99] - 1 == pytest.approx(0.0043288, rel=1e-3)
    film = Scene.load("granulation-dry-bridge")
    escapes = [stokes(film.with_entries({"particles.dry_restitution": e}), 0.0)[0] for e in (0.99, 0.396, 0.38)]
    assert escapes[1] == pytest.approx(escapes[0], rel=1e-9)
    assert escapes[2] > escapes[0] * (1 + 1e-6)


@pytest.mark.parametrize(("name", "viscosity", "tension"), [
    ("glass-beads-water", 0.02723, 0.4864), ("lactose-pvp", 0.05599, 0.4720),
])  # fmt: skip
def test_10_surface_tension_decides(name: str, viscosity: float, tension: float) -> None:
    scene = Scene.load(name)
    for entry, expected in (("liquid.viscosity", viscosity), ("bridge.surface_tension", tension)):
        assert elasticity(scene, entry) == pytest.approx(expected, rel=1e-3)
        value = float(scene.entries[entry])
        lower, higher = (at(scene.with_entries({entry: value * k})) for k in (0.9, 1.1))
        assert math.log(higher / lower) / math.log(1.1 / 0.9) == pytest.approx(expected, rel=0.01)


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
    for scene, expected in ((GRANULATION, -0.0017056), (WALL, -0.0024590)):
        assert elasticity(scene, "bridge.surface_tension") == pytest.approx(expected, rel=1e-3)
        tension = 0.025
        strong = scene.with_entries({"bridge.surface_tension": 3 * tension})
        speed = math.sqrt(at(scene) * critical(strong, angle=0.0).rows[0].speed)
        assert alone(scene, speed).outcome == "stick"
        assert alone(strong, speed).outcome == "bounce"


def test_17_asperities_change_nothing_until_they_are_met() -> None:
    speeds = [at(GRANULATION.with_entries({"particles.roughness": x})) for x in (2e-7, 4e-6, 6e-6)]
    assert speeds == pytest.approx([2.090142, 2.090142, 0.533979], rel=1e-6)
    assert collide(GRANULATION, speed=speeds[0] * (1 + 1e-7), angle=0.0).smallest_gap == pytest.approx(
        4.74e-6, rel=0.01
    )


def test_18_film_and_glass_pressure_are_one_number() -> None:
    number = 1.2 * stokes(PENDULUM, 0.0)[0]
    names = ["liquid.film_thickness", "liquid.glass_transition_pressure"]
    found = sensitivities(PENDULUM, of=["restitution"], wrt=names, stokes=number, angle=0.0)
    slopes = [found.elasticity["restitution"][name] for name in names]
    assert slopes == pytest.approx([-2.9124, -1.4562], rel=1e-4)
    thick = PENDULUM.with_entries({"liquid.film_thickness": 840e-6, "liquid.glass_transition_pressure": 3e6})
    both = [collide(scene, stokes=number, angle=0.0).restitution for scene in (PENDULUM, thick)]
    assert both[1] == pytest.approx(both[0], rel=1e-4)  # strings


def test_19_twice_the_film_is_more_than_twice_the_speed() -> None:
    thickness = {x: at(GRANULATION.with_entries({"liquid.film_thickness": x})) for x in (1.5e-6, 2.3e-6, 8e-6, 16e-6)}
    assert thickness[16e-6] == pytest.approx(5.169087, rel=1e-6)
    assert thickness[2.3e-6] == pytest.approx(0.336, rel=1e-3)
    assert thickness[2.3e-6] < thickness[1.5e-6] < thickness[8e-6]
    glassy = {"liquid.glass_transition_pressure": "80 MPa"}
    assert at(GRANULATION.with_entries(glassy)) == pytest.approx(thickness[16e-6], rel=0.01)


def test_20_twice_the_mass_does_not_halve_it() -> None:
    heavy = at(GRANULATION.with_entries({"particles.reduced_mass": 10.4e-9}))
    assert heavy / at(GRANULATION) == pytest.approx(0.8040036, rel=1e-6)


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


# ---- at an angle


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


def test_collide_says_that_a_contact_is_not_instantaneous() -> None:
    """By the way that a particle of the relative speed travels meanwhile; a bounce, a stick and strings say nothing."""
    first = stokes(GRANULATION, STEEP)[0]
    near = collide(GRANULATION, stokes=1.01 * first, angle=STEEP)
    ways = near.contact_time * near.speed / 0.5 / 2e-4
    assert f"travels {ways:.3g} diameters meanwhile, 3.86 turns" in near.long_contact
    assert f"fill {100 / (12 * ways):.2g} % of the volume" in near.long_contact
    assert "not instantaneous" in str(near)
    assert near.validity == ()  # it is within the model
    for scene, number in ((GRANULATION, 0.3), (GRANULATION, 0.5 * first), (PENDULUM, 1.3)):
        other = collide(scene, stokes=number, angle="45 deg" if scene is PENDULUM else STEEP)
        assert other.long_contact == ""
        assert "not instantaneous" not in str(other)
    unequal = partner(GRANULATION, 1.5, 1.5**3)
    slow = collide(unequal, stokes=1.01 * stokes(unequal, STEEP)[0], angle=STEEP)
    assert f"travels {slow.contact_time * slow.speed / 0.5 / 2.5e-4:.3g} diameters" in slow.long_contact


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


def test_4_by_the_toolkit() -> None:
    for law, expected in (("immersed", 4.06318), ("film", 4.06054)):
        scene = GRANULATION.with_entries({"model.tangential": law})
        assert boundary(scene, angle=STEEP).changes[0][0].centrifugal == pytest.approx(expected, rel=1e-5)


def test_5_restitution_jumps() -> None:
    second = stokes(GRANULATION, STEEP)[1]
    for side, expected, accuracy in ((-1e-6, 0.737332, 1e-4), (1e-6, 0.867856, 3e-3)):
        assert collide(GRANULATION, stokes=second * (1 + side), angle=STEEP).restitution == pytest.approx(
            expected, rel=accuracy
        )
    for side in (-1e-3, 1e-3):
        found = collide(GRANULATION, stokes=second * (1 + side), angle=STEEP)
        end = alone(GRANULATION, found.speed, STEEP)
        assert end.restitution == pytest.approx(found.restitution, rel=1e-7)
    for degrees, expected in ((30, 0.157), (45, 0.269), (60, 0.460), (75, 0.978), (85, 2.947)):
        angle = math.radians(degrees)
        found = collide(GRANULATION, stokes=stokes(GRANULATION, angle)[0] * (1 + 1e-6), angle=angle)
        assert found.restitution == pytest.approx(expected, abs=6e-4)


def test_6_with_backspin_faster_can_stick() -> None:
    scene = GRANULATION.with_entries({"impact.spin": -2e4})
    assert stokes(scene, STEEP) == pytest.approx([0.0190840, 0.0756485, 0.118652], rel=1e-5)
    for spin, number, expected in ((-2e4, 0.015, -1.428594), (2e4, 0.06, 1.185495)):
        found = collide(GRANULATION.with_entries({"impact.spin": spin}), stokes=number, angle=STEEP)
        assert found.tangential_restitution == pytest.approx(expected, rel=1e-5)
        end = alone(GRANULATION, found.speed, STEEP, spin=spin, partner_spin=spin)
        assert turning(GRANULATION, end) == pytest.approx(found.final_rotation_rate, rel=1e-6)
    for number, outcome in ((0.0189, False), (0.0192, True), (0.0755, True), (0.0758, False)):
        end = alone(GRANULATION, GRANULATION.speed_of(number), STEEP, spin=-2e4, partner_spin=-2e4)
        assert (end.outcome == "stick") == outcome


def test_9_on_strings_the_boundary_is_a_speed() -> None:
    for entries, expected in (({"pendulum.length": 0.5}, 0.1046290), ({"pendulum.length": 2.0}, 0.0525433),
                              ({"liquid.viscosity": 48.0}, 0.105391)):  # fmt: skip
        assert critical(PENDULUM.with_entries(entries), angle=STEEP).rows[0].speed == pytest.approx(expected, rel=2e-4)


def test_11_the_ceiling_of_rebounds_without_glass() -> None:
    one, liquid = GRANULATION.particles, GRANULATION.liquid
    ceiling = (
        one.reduced_mass
        * liquid.film_thickness**2
        * 20e6
        / (18 * math.pi * liquid.viscosity**2 * one.reduced_radius**3)
    )
    assert ceiling == pytest.approx(0.2354078, rel=1e-6)
    for degrees in (82, 85):
        assert stokes(GRANULATION, math.radians(degrees))[-1] == pytest.approx(ceiling, rel=1e-8)
    corrected = GRANULATION.with_entries({"model.glass": "film-corrected"})
    assert stokes(corrected, math.radians(85))[-1] > 10 * ceiling


def test_12_more_liquid_sticks_better_and_slower_and_slower() -> None:
    numbers = [boundary(LIQUID.with_entries({"bridge.volume": v}), angle=math.radians(45)).changes[0][0].centrifugal
               for v in (0.01, 0.1, 1.0)]  # fmt: skip
    assert numbers == pytest.approx([2.89385, 4.12112, 4.43518], rel=1e-4)


def test_14_spheres_overspin() -> None:
    """Just below the ceiling, where e_t is least; rigid rotation of the same L would have more."""
    found = collide(GRANULATION, stokes=0.2354, angle="83 deg")
    assert found.tangential_restitution == pytest.approx(0.6448, rel=1e-3)
    assert found.slip_restitution == pytest.approx(-0.112, rel=5e-3)
    end = alone(GRANULATION, found.speed, found.angle)
    assert turning(GRANULATION, end) == pytest.approx(found.final_rotation_rate, rel=1e-7)
    body = bodies_of(GRANULATION)
    first, last = (body.contact + x for x in (body.film_thickness, body.rupture))
    rigid = first * last / (last**2 + 6.4 * body.a**2)
    assert found.tangential_restitution < rigid


def test_22_smaller_spheres_stick_to_hardly_higher_speeds() -> None:
    larger = GRANULATION.with_entries({"particles.reduced_radius": 1e-4, "particles.reduced_mass": 4.16e-8})
    for angle, expected in ((0.0, 0.499900), (STEEP, 0.761166)):
        assert at(larger, angle) / at(GRANULATION, angle) == pytest.approx(expected, rel=1e-5)


def test_23_a_graze_comes_off_along_the_line_of_centres() -> None:
    for degrees, expected in ((0, 0.989569), (89, 0.420424)):
        angle = math.radians(degrees)
        found = collide(GRANULATION, relative_speed=10.0, angle=angle)
        assert found.restitution * math.cos(angle) == pytest.approx(expected, rel=1e-5)
        assert alone(GRANULATION, found.speed, angle).restitution * math.cos(angle) == pytest.approx(expected, rel=1e-5)


# ---- walls, unequal spheres, friction, space


def test_24_and_25_a_wall_lets_go_sooner_and_with_a_jump() -> None:
    sphere, wall = at(GRANULATION), at(WALL)
    assert wall / sphere == pytest.approx(0.683763, rel=1e-5)
    without = LIQUID.with_entries({"partner.wall": True})
    assert at(without) / at(LIQUID) == pytest.approx(1.158389, rel=1e-5)
    for scene, speed, expected in ((WALL, wall, 0.556198), (GRANULATION, sphere, 0.400298)):
        assert collide(scene, speed=speed * (1 + 1e-6), angle=0.0).restitution == pytest.approx(expected, rel=1e-3)
        start = alone(scene, speed * (1 + BESIDE))
        assert start.restitution == pytest.approx(expected, rel=0.05)  # it rises as a square root from there


def test_26_to_28_a_wall_stops_a_sphere_and_forgets_its_spin() -> None:
    speed, angle = at(WALL), math.radians(45)
    for factor, expected in ((1.5, 1.8529e-5), (3.0, 4.38091e-3)):
        found = collide(WALL, speed=factor * speed, angle=angle)
        assert found.tangential_restitution == pytest.approx(expected, rel=1e-4)
        end = alone(WALL, factor * speed, angle)
        assert end.across / (factor * speed) == pytest.approx(expected, rel=1e-4)
    spinning = collide(WALL.with_entries({"impact.spin": -2e4}), relative_speed=2.5, angle=angle)
    assert spinning.final_spin == pytest.approx(5.1535e-3, rel=1e-3)
    assert alone(WALL, spinning.speed, angle, spin=-2e4).spins[0] == pytest.approx(5.1535e-3, rel=1e-3)
    body, normal = bodies_of(WALL), 1.5 * speed
    gap = np.linspace(body.film_thickness, body.rupture, 20_001)
    work = np.trapezoid([body.pull(float(x)) for x in gap], gap)
    closed = math.sqrt(body.dry_restitution**2 - 2 * work / (body.m * normal**2))
    assert closed == pytest.approx(0.967236, abs=1e-6)
    for viscosity in (2.0, 3.0):
        thicker = WALL.with_entries({"liquid.viscosity": viscosity})
        assert collide(thicker, speed=normal, angle=angle).restitution == pytest.approx(closed, rel=1e-8)


def test_29_a_larger_partner_sticks_less() -> None:
    expected = {
        1.0: (2.090142, 28.49221),
        2.0: (1.694273, 25.19115),
        5.0: (1.545757, 28.62964),
        10.0: (1.491948, 30.64789),
    }
    for ratio, speeds in expected.items():
        found = [at(partner(scene, ratio, ratio**3)) for scene in (GRANULATION, LIQUID)]
        assert found == pytest.approx(speeds, rel=1e-5)


def test_30_the_light_sphere_does_not_spin_ten_times_as_fast() -> None:
    scene = partner(GRANULATION, 1.0, 10.0)
    found = collide(scene, stokes=0.3, angle=STEEP)
    assert found.final_spin / found.final_spin_partner == pytest.approx(2.37925, rel=1e-5)
    end = alone(scene, found.speed, STEEP)
    assert end.spins[0] / end.spins[1] == pytest.approx(2.37925, rel=1e-5)


def test_32_friction_makes_more_pairs_stick() -> None:
    smooth = Scene.load("glass-beads-water")
    rough = smooth.with_entries({"particles.friction": 0.3, "model.contact_friction": "all"})
    angles = np.arcsin(np.sqrt((np.arange(20) + 0.5) / 20))  # of equal share each
    for scene, expected in ((smooth, 0.505659), (rough, 0.564559)):
        assert mean(scene, "stick_probability", 0.3) == pytest.approx(expected, abs=2e-6)
        sticks = [alone(scene, 0.3 * math.cos(angle), angle).outcome == "stick" for angle in angles]
        assert np.mean(sticks) == pytest.approx(expected, abs=0.03)


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


# ---- a gas


def over_angles(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Angles and weights of Gauss and Legendre for means over isotropic impacts."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    angle = (1 + nodes) * math.pi / 4
    return angle, weights * math.pi / 4 * np.sin(2 * angle)


def sums(scene: Scene, speed: float, count: int, engine: str) -> np.ndarray:
    """Means over angles: e_n, part of the normal energy lost, and of all energy, by another engine."""
    angle, weight = over_angles(count)
    found = collide_many(scene, relative_speed=speed, angle=angle, engine=engine, of=("energy.initial", "energy.final"))
    assert (found.outcome.values > 0).all()
    e_n, first, last = found.restitution.values, found["energy.initial"].values, found["energy.final"].values
    lost = 1 - weight @ last / (weight @ first)
    return np.array([weight @ e_n, 1 - 2 * weight @ (e_n * np.cos(angle)) ** 2, lost])


@pytest.mark.usefixtures("optimized")
def test_31_small_spheres_stick_to_large_ones() -> None:
    """Shares of a gas, and at one angle the critical speeds."""
    radii, angle = [5e-5, 2e-4], math.radians(45)
    found = collision_averages(GRANULATION, speeds="maxwell:0.5 m/s", radii=radii, tolerance=1e-4)
    expected = [0.68915, 0.99995, 0.99995, 0.24326]
    assert found.stick_probability.values.ravel() == pytest.approx(expected, abs=2e-4)
    speeds = []
    for one, other in ((0.5, 0.5), (0.5, 2.0), (2.0, 2.0)):
        own = {"particles.reduced_radius": one * 5e-5, "particles.reduced_mass": one**3 * 5.2e-9}
        other_sphere = {"partner.radius": other * 1e-4, "partner.mass": other**3 * 1.04e-8}
        speeds.append(at(GRANULATION.with_entries(own | other_sphere), angle))
    assert speeds[1] > 1.5 * max(speeds[0], speeds[2])


@pytest.mark.usefixtures("optimized")
def test_8_and_34_mean_restitution_above_one() -> None:
    names = "restitution_all", "normal_dissipation", "kinetic_energy_loss"
    fast = collision_averages("granulation", speeds=10.0)
    assert [float(fast[name]) for name in names] == pytest.approx([1.286290, -0.171621, 0.143859], rel=1e-5)
    assert [float(fast[name]) for name in names] == pytest.approx(sums(GRANULATION, 10.0, 80, "rosenbrock"), abs=2e-3)
    bare = Scene.load("granulation-dry-bridge")
    assert mean(bare, "restitution_all", 10.0) == pytest.approx(0.961917, rel=1e-5)
    assert mean(bare, "restitution_all", 10.0) == pytest.approx(sums(bare, 10.0, 80, "rosenbrock")[0], abs=2e-3)
    assert mean("granulation", "restitution_separated", 0.86) == pytest.approx(25.7413, rel=1e-4)


@pytest.mark.usefixtures("optimized")
def test_35_those_that_separate_lose_more() -> None:
    """Where all stick in closed form: what rigid rotation keeps. Elsewhere beside the ledgers of single collisions."""
    body = bodies_of(GRANULATION)
    r = body.contact + body.film_thickness
    stretch = (r / body.contact) ** 2  # squared sideways velocity of the centres, over that of the surfaces
    closed = 1 - stretch / (1 + stretch) * r**2 / (r**2 + 6.4 * body.a**2)
    assert closed == pytest.approx(0.6206806, rel=1e-6)
    assert mean("granulation", "kinetic_energy_loss", 0.5) == pytest.approx(closed, rel=1e-9)
    assert mean("granulation", "kinetic_energy_loss", 1.5) == pytest.approx(0.643072, rel=1e-5)
    assert mean("granulation", "stick_probability", 1.5) == pytest.approx(0.355, abs=1e-3)
    slow = mean("granulation", "kinetic_energy_loss", 100.0)
    assert slow == pytest.approx(0.0737544, rel=1e-5)
    assert slow == pytest.approx(sums(GRANULATION, 100.0, 400, "taylor")[2], rel=1e-3)


@pytest.mark.usefixtures("optimized")
def test_36_tangential_restitution_is_that_of_rigid_rotation() -> None:
    expected = {1.0: 0.667230, 3.0: 0.663123, 10.0: 0.659371}
    for speed, value in expected.items():
        assert mean("granulation", "tangential_restitution_separated", speed, 1e-5) == pytest.approx(value, abs=1e-5)
    body = bodies_of(GRANULATION)
    first, last = (body.contact + x for x in (body.film_thickness, body.rupture))
    assert first * last / (last**2 + 6.4 * body.a**2) == pytest.approx(0.66, abs=0.01)
    angle, weight = over_angles(80)
    found = collide_many(
        GRANULATION, relative_speed=10.0, angle=angle, engine="rosenbrock", of=("tangential_restitution",)
    )
    assert weight @ found.tangential_restitution.values == pytest.approx(expected[10.0], abs=2e-3)
