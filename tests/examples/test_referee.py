"""The referee beside other codes: what it means in their words, and their own answers where they are installed."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
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


@pytest.mark.slow
@pytest.mark.parametrize(("host", "law"), [("yade", "lubrication"), ("lammps", "lubricate")])
def test_a_host_tends_to_its_law_and_the_parts_make_the_difference(host, law):
    """The host's own e_n comes to that of its differential equations as the time step falls; nothing is left over."""
    found, row = collided(host, law)
    assert abs(row["e_n: left at dt/4"]) < 1e-3
    assert abs(row["e_n: left at dt/4"]) <= abs(row["e_n: time step"]) + 1e-5
    parts = sum(row[f"e_n: {term}"] for term in found.terms)
    assert parts == pytest.approx(row["e_n_host"] - row["e_n_ours"], abs=1e-12)


def pair_at_rest(e_dry: float) -> dict[str, float | str]:
    """Two millimetre spheres in YADE's or LIGGGHTS's words, without a liquid that does anything."""
    return {
        "radius": 1e-3, "density": 2500.0, "friction": 0.0, "contact_time": 1e-5, "restitution": e_dry, "volume": 1e-14,
        "surface_tension": 0.0, "contact_angle_deg": 20.0, "bridge": "Willett_numeric", "cutoff": 6e-5,
    }  # fmt: skip


@pytest.mark.parametrize("e_dry", [0.97, 0.5, 0.15])
def test_a_contact_without_tension_has_the_dry_restitution(e_dry):
    """A linear damped contact, integrated until its force vanishes; `en` would be its restitution at no overlap."""
    import translate

    en = translate.uncut_restitution(e_dry)
    z = -math.log(en) / math.pi
    damping, stiffness = 2 * z, 1 + z**2  # in units of the frequency

    def pushes(_, y):
        return stiffness * y[0] + damping * y[1]

    pushes.terminal, pushes.direction = True, -1
    path = solve_ivp(lambda _, y: [y[1], -pushes(_, y)], (0, 4), [0, 1], events=pushes, rtol=1e-10, atol=1e-13)
    assert path.t_events[0].size
    assert -path.y[1, -1] == pytest.approx(e_dry, rel=1e-7)
    assert en < e_dry


def test_a_dry_restitution_that_yade_cannot_have_is_refused():
    """However strong its damping is, a contact without tension rebounds with more than exp(-2)."""
    import translate

    with pytest.raises(SystemExit, match=r"0\.1354 or more"):
        translate.uncut_restitution(0.13)


@pytest.mark.slow
@pytest.mark.parametrize("e_dry", [0.9, 0.5])
def test_yade_rebounds_with_the_dry_restitution(e_dry):
    """YADE itself, without surface tension."""
    import hosts
    import translate

    if hosts.command("yade") is None:
        pytest.skip(f"yade is not installed: {hosts.INSTALL['yade']}")
    parameters = pair_at_rest(translate.uncut_restitution(e_dry))
    job = {"law": "capillary", "parameters": parameters, "start": 6e-5, "end": 6e-5, "longest": 1e-3}
    (found,) = hosts.run("yade", job | {"collisions": [[1.0, 0.0, 2e-8]]})["found"]
    assert found["velocity"][0] == pytest.approx(e_dry, abs=2e-3)


@pytest.mark.parametrize("degrees", [0.0, 60.0])
def test_liggghts_has_the_contact_angle(degrees):
    """Half the product of both angles, in rad, is the scene's."""
    import translate

    scene = Scene.load(FOLDER / "beads-glycerol.toml").with_entries({"bridge.contact_angle": math.radians(degrees)})
    words = translate.liggghts_easo(scene, None, 1.0)
    assert math.radians(words.parameters["contact_angle"]) ** 2 / 2 == pytest.approx(math.radians(degrees))


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
