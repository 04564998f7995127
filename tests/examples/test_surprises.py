"""The numbers of `docs/explanation/surprises.md`, by row: the lines of the page, run, and closed forms."""

import ast
import math
import re
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import wetdoublet as wd
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, boundary, collide, collide_pair, collision_averages, critical

from ..helpers.two_bodies import bodies_of

pytestmark = pytest.mark.slow
PAGE = (Path(__file__).parents[2] / "docs/explanation/surprises.md").read_text(encoding="utf-8")
GRANULATION, PENDULUM = Scene.load("granulation"), Scene.load("pendulum")
WALL = GRANULATION.with_entries({"partner.wall": True})
STEEP = math.radians(60)
VISCOSITY, TENSION = "liquid.viscosity", "bridge.surface_tension"
EXPECTED = {
    "1": [1.93208, 2.70463, 2.09014, 0.859622, -0.433846, 0.436657, 0.202152, 0], "7": [0.11582, 0.115321, 0.115321],
    "10": [0.0272308, 0.486385], "15": [0.224462], "16": [-0.00170557, -0.00245902], "17": [2.09014, 2.09014, 0.533978],
    "18": [-2.91239, -1.45618], "19": [5.16909], "20": [0.804004], "21": [-0.223631, 0.00979764],
    "2": [0.00733835, 3.85644, 0.0644665, 33.7853, 0.086502, 45.3514], "3": [0.324255], "4": [4.06318, 4.06054],
    "5": [0, 0.46036, 0.737332, 0.867856], "6": [0.019084, 0.0756485, 0.118652], "9": [0.104629, 0.0525427],
    "11": [0.00675638, 0.235408, 0.00419014, 0.235408, 0.00419014, 3.01837], "12": [2.89385, 4.12112, 4.43518],
    "14": [0.644772], "22": [0.499899, 0.761169], "23": [0.989569, 0.420424], "24, 25": [0.683763, 0.400298, 0.556198],
    "26, 28": [0.967236, 1.8529e-05, 0.984358, 0.00438091], "27": [0.00515352],
    "29": [2.09014, 1.69427, 1.54576, 1.49195, 28.4922, 25.1912, 28.6296, 30.6479], "30": [2.37925],
    "31": [0.689153, 0.999949, 0.999949, 0.243259], "32": [0.505659, 0.564559], "13": [0.773675],
    "33": [33.6163, 0.940606], "8, 34": [1.28629, -0.171621, 0.143859, 0.961917],
    "35, 36": [0.620681, 0.643072, 0.0737544, 0.66723, 0.663123, 0.659371],
}  # fmt: skip
ACCURACY = {"2": 2e-3, "5": 3e-3}  # beside a saddle or a rim; others are as accurate as their digits


def numbers(value: Any) -> list[float]:
    """What a line of the page prints, as a list: restitutions of collisions, elasticities of critical speeds."""
    if isinstance(value, wd.Collision):
        return [value.restitution]
    if hasattr(value, "rows"):
        return [each for row in value.rows for each in row.elasticity.values()]
    if isinstance(value, wd.Sensitivities):
        return numbers(value.elasticity)
    if hasattr(value, "data_vars"):
        return [float(value[name]) for name in value.data_vars]
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return [each for part in value for each in numbers(part)]
    return [] if isinstance(value, str) else np.ravel(value).tolist()


@pytest.fixture(scope="module")
def printed() -> dict[str, list[float]]:
    """Label of a line -> the numbers that it gives; all lines of the page are run, one after another."""
    space, found = dict[str, Any](), defaultdict(list)
    for block in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL):
        lines = block.splitlines()
        for node in ast.parse(block).body:
            if label := re.search(r"  # ([\d, ]+)$", lines[node.end_lineno - 1]):
                found[label[1]] += numbers(eval(ast.unparse(node), space))
            else:
                exec(ast.unparse(node), space)
    return found


def rows(text: str) -> list[int]:
    """The numbers of the table's rows of a page."""
    return sorted(int(line.split("|")[1]) for line in text.splitlines() if line.startswith("| ") and line[2].isdigit())


def test_the_page_has_every_row_and_its_command(printed: dict[str, list[float]]) -> None:
    assert rows(PAGE) == list(range(1, 37))
    assert {int(row) for label in printed for row in label.split(",")} == set(range(1, 37))
    assert printed.keys() == EXPECTED.keys()


@pytest.mark.parametrize("label", EXPECTED)
def test_numbers_of_the_lines(label: str, printed: dict[str, list[float]]) -> None:
    assert printed[label] == pytest.approx(EXPECTED[label], rel=ACCURACY.get(label, 1e-4), abs=1e-12)


def stokes(scene: Scene, angle: float) -> list[float]:
    """Where the outcome changes along the line of an angle."""
    return [change.stokes for change in boundary(scene, angle=angle).changes[0]]


def test_critical_says_that_its_line_has_a_maximum() -> None:
    """Over viscosity; not over what moves the speed one way, nor over what does nothing to it, nor of all entries."""
    names = ["liquid.viscosity", "particles.reduced_radius", "particles.roughness", "particles.dry_restitution"]
    [one] = critical(GRANULATION, angle=0.0, wrt=names[:1]).rows
    [text] = one.sentences
    assert text.startswith("over liquid.viscosity it has a maximum, 2.705 m/s (relative speed) at 0.5")
    assert float(text.split(" at ")[1].removesuffix(" Pa s")) == pytest.approx(0.5608, rel=0.01)
    assert critical(GRANULATION, angle=0.0, wrt="all").rows[0].sentences == ()
    assert critical("lactose-pvp", angle=0.0, wrt=[VISCOSITY, TENSION]).rows[0].sentences == ()
    [one] = critical(GRANULATION, angle=0.0, wrt=["particles.roughness", "particles.dry_restitution"]).rows
    assert one.sentences == ()


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
    unequal = GRANULATION.with_entries({"partner.radius": 1.5e-4, "partner.mass": 1.5**3 * 1.04e-8})
    slow = collide(unequal, stokes=1.01 * stokes(unequal, STEEP)[0], angle=STEEP)
    assert f"travels {slow.contact_time * slow.speed / 0.5 / 2.5e-4:.3g} diameters" in slow.long_contact


# rows in closed form


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
