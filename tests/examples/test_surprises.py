"""The numbers of `docs/explanation/surprises.md`, by row."""

import math
import re
from pathlib import Path

import pytest
from wetdoublet.solvers import Scene, boundary, collide, collision_averages, critical

from ..helpers.scanned import Outcome, scan_of

pytestmark = pytest.mark.slow  # many collisions by an integrator in Python
GRANULATION, PENDULUM = Scene.load("granulation"), Scene.load("pendulum")
WALL = GRANULATION.with_entries({"partner.wall": True})
LIQUID = GRANULATION.with_entries({"liquid.glass_transition_pressure": "1 PPa"})
BACKSPIN = GRANULATION.with_entries({"impact.spin": -2e4})
STEEP = math.radians(60)
BESIDE = 1e-4  # of a head-on critical speed, where outcomes on both sides are looked at
PLAIN = 2.090142  # the head-on critical relative speed of GRANULATION, m/s
VISCOSITY, TENSION, FILM = "liquid.viscosity", "bridge.surface_tension", "liquid.film_thickness"
BEADS = Scene.load("glass-beads-water")
ROUGH = BEADS.with_entries({"particles.friction": 0.3, "model.contact_friction": "all"})


def alone(scene: Scene, speed: float, angle: float = 0.0) -> Outcome:
    """The collision by the independent integrator."""
    impact = scene.with_impact(speed=speed, angle=angle)
    scan = scan_of(impact, 1e-10, accuracy=1e-9)  # at 1e-11 a doublet that turns for long takes ten times the steps
    scan.most *= 10  # of steps: a doublet turns for long
    return scan.run()


def at(scene: Scene, angle: float = 0.0) -> float:
    """The relative speed up to which a scene sticks."""
    return float(critical(scene, angle=angle).rows[0].relative_speed)


def stokes(scene: Scene, angle: float) -> list[float]:
    """Where the outcome changes along the line of an angle."""
    return [change.stokes for change in boundary(scene, angle=angle).changes[0]]


def partner(scene: Scene, radius: float, mass: float) -> Scene:
    """Beside a sphere of so many times the radius and mass."""
    one = scene.particles
    entries = {"partner.radius": 2 * radius * one.reduced_radius, "partner.mass": 2 * mass * one.reduced_mass}
    return scene.with_entries(entries)


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


# ---- tables: critical speeds, their elasticities, collisions, means

CRITICAL = [  # row, scene, entries, relative speed, its accuracy
    *((1, GRANULATION, {VISCOSITY: mu}, speed, 1e-5)
      for mu, speed in ((0.1, 1.932081), (0.5608, 2.704629), (2.0, PLAIN), (8.0, 0.859622))),
    *((17, GRANULATION, {"particles.roughness": gap}, speed, 1e-6)
      for gap, speed in ((2e-7, PLAIN), (4e-6, PLAIN), (6e-6, 0.533979))),
    *((19, GRANULATION, {FILM: film}, speed, 1e-3) for film, speed in ((2.3e-6, 0.336), (16e-6, 5.169087))),
    (19, GRANULATION, {"liquid.glass_transition_pressure": "80 MPa"}, 5.169087, 0.01),
    (20, GRANULATION, {"particles.reduced_mass": 10.4e-9}, 0.8040036 * PLAIN, 1e-6),
    (22, GRANULATION, {"particles.reduced_radius": 1e-4, "particles.reduced_mass": 4.16e-8}, 0.4999 * PLAIN, 1e-5),
    (24, WALL, {}, 0.683763 * PLAIN, 1e-5), (25, LIQUID, {"partner.wall": True}, 1.158389 * 28.49221, 1e-5),
    *((29, partner(scene, ratio, ratio**3), {}, speed, 1e-5)
      for scene, speeds in ((GRANULATION, (PLAIN, 1.694273, 1.545757, 1.491948)),
                            (LIQUID, (28.49221, 25.19115, 28.62964, 30.64789)))
      for ratio, speed in zip((1.0, 2.0, 5.0, 10.0), speeds)),
]  # fmt: skip
CONFIRMED = (3, 6, 8, 11, 12, 13, 15, 19)  # of these, one of each kind, by the independent integrator


@pytest.mark.parametrize("k", range(len(CRITICAL)), ids=[f"{row[0]}-{k}" for k, row in enumerate(CRITICAL)])
def test_head_on_critical_speeds(k: int) -> None:
    """Rows 1, 17, 19, 20, 22, 24, 25, 29; another integrator sticks below and parts above."""
    _, scene, entries, expected, accuracy = CRITICAL[k]
    scene = scene.with_entries(entries)
    speed = at(scene)
    assert speed == pytest.approx(expected, rel=accuracy)
    if k in CONFIRMED:
        below, above = (alone(scene, side * speed) for side in (1 - BESIDE, 1 + BESIDE))
        assert below.outcome == "stick" != above.outcome


def test_elasticities_of_critical_speeds() -> None:
    """Rows 1, 10 and 16."""
    beads, lactose = "glass-beads-water", "lactose-pvp"
    for scene, entry, expected in (
        (GRANULATION, VISCOSITY, -0.433846), (LIQUID, VISCOSITY, 0.436657), (GRANULATION, TENSION, -0.0017056),
        (WALL, TENSION, -0.0024590), (beads, VISCOSITY, 0.02723), (beads, TENSION, 0.4864),
        (lactose, VISCOSITY, 0.05599), (lactose, TENSION, 0.4720),
    ):  # fmt: skip
        [one] = critical(scene, angle=0.0, wrt=[entry]).rows
        assert one.elasticity[entry] == pytest.approx(expected, rel=1e-3), entry


COLLISIONS = [  # row, scene, impact, result, value, its accuracy
    *((6, BACKSPIN.with_entries({"impact.spin": spin}), {"stokes": number, "angle": STEEP}, "tangential_restitution",
       value, 1e-5) for spin, number, value in ((-2e4, 0.015, -1.428594), (2e4, 0.06, 1.185495))),
    (14, GRANULATION, {"stokes": 0.2354, "angle": "83 deg"}, "tangential_restitution", 0.6448, 1e-3),
    (14, GRANULATION, {"stokes": 0.2354, "angle": "83 deg"}, "slip_restitution", -0.112, 5e-3),
    (17, GRANULATION, {"speed": PLAIN * (1 + 1e-6), "angle": 0.0}, "smallest_gap", 4.74e-6, 0.01),
    *((23, GRANULATION, {"relative_speed": 10.0, "angle": math.radians(degrees)}, "restitution",
       value / math.cos(math.radians(degrees)), 1e-5) for degrees, value in ((0, 0.989569), (89, 0.420424))),
    *((26, WALL, {"speed": factor * 0.683763 * PLAIN, "angle": math.radians(45)}, "tangential_restitution", value, 1e-3)
      for factor, value in ((1.5, 1.8529e-5), (3.0, 4.38091e-3))),
    (27, WALL.with_entries({"impact.spin": -2e4}), {"relative_speed": 2.5, "angle": math.radians(45)}, "final_spin",
     5.1535e-3, 1e-3),
]  # fmt: skip


@pytest.mark.parametrize("row", COLLISIONS, ids=[f"{row[0]}-{k}" for k, row in enumerate(COLLISIONS)])
def test_results_of_collisions(row: tuple) -> None:
    _, scene, impact, name, expected, accuracy = row
    assert getattr(collide(scene, **impact), name) == pytest.approx(expected, rel=accuracy)


MEANS = [  # row, scene, mean, speed, value, its accuracy
    *((1, scene.with_entries({VISCOSITY: mu}), "stick_probability", 2.0, value, 2e-5)
      for scene, mu, value in ((GRANULATION, 2.0, 0.202152), (LIQUID, 4.0, 0.198172))),
    (1, GRANULATION.with_entries({VISCOSITY: 4.0}), "stick_probability", 2.0, 0.0, 1e-12),
    (8, GRANULATION, "restitution_all", 10.0, 1.286290, 1e-5),
    (8, GRANULATION, "restitution_separated", 0.86, 25.7413, 3e-3),
    (34, Scene.load("granulation-dry-bridge"), "restitution_all", 10.0, 0.961917, 1e-5),
    (34, GRANULATION, "normal_dissipation", 10.0, -0.171621, 2e-6),
    (34, GRANULATION, "kinetic_energy_loss", 10.0, 0.143859, 2e-6),
    (35, GRANULATION, "kinetic_energy_loss", 1.5, 0.643072, 1e-5),
    (35, GRANULATION, "stick_probability", 1.5, 0.355, 1e-3),
    (35, GRANULATION, "kinetic_energy_loss", 100.0, 0.0737544, 1e-6),
    *((36, GRANULATION, "tangential_restitution_separated", speed, value, 1e-5)
      for speed, value in ((1.0, 0.667230), (3.0, 0.663123), (10.0, 0.659371))),
    (32, BEADS, "stick_probability", 0.3, 0.505659, 2e-6), (32, ROUGH, "stick_probability", 0.3, 0.564559, 2e-6),
]  # fmt: skip


@pytest.mark.usefixtures("optimized")
@pytest.mark.parametrize("row", MEANS, ids=[f"{row[0]}-{k}" for k, row in enumerate(MEANS)])
def test_means_over_isotropic_impacts(row: tuple) -> None:
    number, scene, name, speed, expected, accuracy = row
    assert mean(scene, name, speed, 1e-5 if number == 36 else 1e-6) == pytest.approx(expected, abs=accuracy)


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
    unequal = partner(GRANULATION, 1.5, 1.5**3)
    slow = collide(unequal, stokes=1.01 * stokes(unequal, STEEP)[0], angle=STEEP)
    assert f"travels {slow.contact_time * slow.speed / 0.5 / 2.5e-4:.3g} diameters" in slow.long_contact


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
