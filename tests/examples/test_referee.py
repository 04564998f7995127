"""The referee beside other codes: what it means in their words, and their own answers where they are installed."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "referee"
ST, ANGLE = 1.0, math.radians(60)


@pytest.fixture(autouse=True)
def beside(monkeypatch):
    """The example's files import each other."""
    monkeypatch.syspath_prepend(str(FOLDER))
    yield
    for name in ("exact", "hosts", "one_number", "split", "translate"):
        sys.modules.pop(name, None)


def collided(host, law, scene="granulation"):
    """One collision in a host, and its row."""
    import hosts
    import split

    if hosts.command(host) is None:
        pytest.skip(f"{host} is not installed: {hosts.INSTALL[host]}")
    found = split.referee(Scene.load(scene), host, law, ST, ANGLE)
    return found, found.rows[0]


def test_the_law_of_lubrication_in_yade_is_ours_of_an_infinite_film():
    """As differential equations, with stiff spheres, without bridge and glass transition: the same restitutions."""
    import exact
    import translate

    scene = Scene.load("granulation-dry-bridge")
    words = translate.yade_lubrication(scene, None, 1.0)
    plain = scene.with_entries({"model.film": "infinite"})
    for _, change in words.physics:
        plain = translate.changed(plain, change)
    ours = collide_many(plain, stokes=ST, angle=ANGLE, of=["restitution", "tangential_restitution"])
    radius, speed = 2 * scene.reduced_radius, ST / scene.stokes_per_speed
    tangential = speed * math.tan(ANGLE) * (1 + words.end / (2 * radius))
    pair = exact.Pair(radius, scene.reduced_mass, speed, tangential)
    u, w = exact.collide("lubrication", words.parameters, pair, words.end, 1e-3)
    assert u / speed == pytest.approx(float(ours.restitution.squeeze()), rel=1e-3)
    assert w / tangential == pytest.approx(float(ours.tangential_restitution.squeeze()), rel=1e-2)


@pytest.mark.parametrize(("host", "law"), [("yade", "lubrication"), ("lammps", "lubricate")])
def test_a_host_tends_to_its_law_and_the_parts_make_the_difference(host, law):
    """The host's own e_n comes to that of its differential equations as the time step falls; nothing is left over."""
    found, row = collided(host, law)
    assert abs(row["e_n: left at dt/4"]) < 1e-3
    assert abs(row["e_n: left at dt/4"]) <= abs(row["e_n: time step"]) + 1e-5
    parts = sum(row[f"e_n: {term}"] for term in found.terms)
    assert parts == pytest.approx(row["e_n_host"] - row["e_n_ours"], abs=1e-12)


def test_damping_in_liggghts_follows_the_stokes_number_of_the_moment():
    """LIGGGHTS itself rebounds as the equation that the two numbers are fitted with, and not as its manual's law."""
    import hosts
    import one_number

    if hosts.command("liggghts") is None:
        pytest.skip(f"liggghts is not installed: {hosts.INSTALL['liggghts']}")
    radius, mass, mu, critical, most = 1e-4, 5.2e-9, 1.0, 0.115, 0.99
    speed = 5.0
    ratio = critical / (mass * speed / (6 * math.pi * mu * (radius / 2) ** 2))
    parameters = {
        "radius": radius, "density": 2 * mass / (4 / 3 * math.pi * radius**3), "youngs_modulus": 5e7,
        "poisson_ratio": 0.2, "viscosity": mu, "critical_stokes": critical, "maximum_restitution": most, "speed": speed,
    }  # fmt: skip
    job = {"law": "viscous", "parameters": parameters, "start": 1e-6, "end": 1e-6, "longest": 2e-5}
    (found,) = hosts.run("liggghts", job | {"collisions": [[speed, 0.0, 5e-9]]})["found"]
    assert found["velocity"][0] / speed == pytest.approx(one_number.rebound(ratio, most), abs=2e-3)
    assert abs(one_number.exponential(ratio, most) - found["velocity"][0] / speed) > 0.05


def test_without_viscosity_the_equation_has_the_maximum_restitution():
    """The damping is then constant, and its restitution known in closed form."""
    import one_number

    assert one_number.rebound(0.0, 0.8) == pytest.approx(0.8, abs=1e-5)


def test_the_error_of_a_fit_is_that_at_other_collisions():
    """The root mean square is met again at collisions drawn here."""
    import one_number

    scene = Scene.load(FOLDER / "beads-glycerol.toml")
    fit = one_number.fit(scene, "linear", (2.0, 50.0), 0.0, attack=2000)
    St = np.geomspace(2.0, 50.0, 400)
    error = one_number.linear(fit.critical_stokes / St, fit.maximum_restitution)
    error = error - collide_many(scene, stokes=St, angle=0.0).restitution.values
    assert math.sqrt(np.mean(error**2)) == pytest.approx(fit.rms, rel=0.1)
    assert np.max(np.abs(error)) < 1.02 * abs(fit.largest)
