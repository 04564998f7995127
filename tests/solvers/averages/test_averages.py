"""Collision averages against sums over many collisions."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import Scene, collide_many, collide_pair, collision_averages
from wetdoublet.solvers.averages.dataset import table
from wetdoublet.solvers.averages.sizes import PROPORTIONAL, scene_of_sizes
from wetdoublet.solvers.averages.speeds import Speeds
from wetdoublet.solvers.collision.space.pairs import Bodies

from ...helpers.command import run

UNEQUAL = Scene.load("granulation").with_entries(
    {"partner.radius": "170 um", "partner.mass": "5.1e-8 kg", "bridge.volume": 0.02}
)
OF = ("outcome", "restitution", "tangential_restitution")
QUANTITIES = (
    "stick_probability", "rotate_probability", "bounce_probability", "restitution_all", "tangential_restitution_all",
    "restitution_separated", "tangential_restitution_separated",
)  # fmt: skip

pytestmark = pytest.mark.usefixtures("optimized")


def sums(
    scene: Scene | str, speed: np.ndarray | float, angle: np.ndarray, weight: np.ndarray | None = None
) -> np.ndarray:
    """Means of single collisions in the order of the averages."""
    found = collide_many(scene, relative_speed=speed, angle=angle, of=OF)
    apart = found.outcome.values > 0
    shares = [np.average(found.outcome.values == k, weights=weight) for k in range(3)]
    both = [np.average(np.where(apart, found[name].values, 0.0), weights=weight) for name in OF[1:]]
    return np.array([*shares, *both, *(each / (1 - shares[0]) for each in both)])


def averages(found: xr.Dataset) -> np.ndarray:
    return np.array([float(found[name]) for name in QUANTITIES])


def errors(found: xr.Dataset) -> np.ndarray:
    return np.array([float(found[f"{name}_error"]) for name in QUANTITIES])


def test_one_speed_is_the_mean_over_a_fine_grid_of_angles() -> None:
    """At a single relative speed the averages are sums over angles of the weight sin(2 theta)."""
    count = 5_000
    angle = (np.arange(count) + 0.5) / count * np.pi / 2
    found = collision_averages("granulation", speeds="1.5 m/s")
    assert averages(found) == pytest.approx(sums("granulation", 1.5, angle, np.sin(2 * angle)), abs=4 / count)
    assert 0.1 < float(found.stick_probability) < 0.9
    assert errors(found)[:5].max() < 1e-6


@pytest.mark.slow
def test_errors_are_not_larger_than_estimated() -> None:
    """A coarse quadrature differs from a finer one by less than it says, and by less than its tolerance."""
    table = ([1.0, 2.0], [1.0, 3.0])
    coarse, fine = (collision_averages(UNEQUAL, speeds=table, tolerance=to) for to in (1e-3, 1e-5))
    assert (np.abs(averages(coarse) - averages(fine)) <= errors(coarse) + errors(fine)).all()
    assert errors(coarse)[:5].max() <= 1.5e-3
    assert errors(fine)[:5].max() <= 1.5e-5


def test_a_matrix_has_the_averages_of_its_pairs() -> None:
    """The pair of 60 and 120 um, either way round, has those of a scene of that pair; densities are the scene's."""
    radii = [60e-6, 120e-6]
    found = collision_averages("granulation", speeds="2 m/s", radii=["60 um", "120 um"])
    assert found.stick_probability.dims == ("radius", "partner_radius")
    assert found.radius.values == pytest.approx(radii)
    pair = scene_of_sizes(Scene.load("granulation"), 60e-6, 120e-6, "fixed")
    assert pair.entries["particles.density"] == pytest.approx(1.04e-8 / (4 / 3 * np.pi * 1e-12))
    alone = averages(collision_averages(pair, speeds="2 m/s"))
    for i, j in ((0, 1), (1, 0)):
        assert averages(found.isel(radius=i, partner_radius=j)) == pytest.approx(alone, abs=1e-7)
    twice = averages(found.isel(radius=1, partner_radius=1))
    equal = scene_of_sizes(Scene.load("granulation"), 120e-6, 120e-6, "fixed")
    assert twice == pytest.approx(averages(collision_averages(equal, speeds="2 m/s")), abs=1e-7)


def test_films_are_fixed_or_grow_with_the_radii() -> None:
    """Proportional: the film and the roughness with the sum of both radii; a coating with its sphere's."""
    scene = Scene.load("granulation")
    grown = scene_of_sizes(scene, 200e-6, 400e-6, PROPORTIONAL)
    assert grown.liquid.film_thickness == pytest.approx(3 * scene.liquid.film_thickness)
    assert grown.particles.roughness == pytest.approx(3 * scene.particles.roughness)
    assert scene_of_sizes(scene, 200e-6, 400e-6, "fixed").liquid.film_thickness == scene.liquid.film_thickness
    entries = {name: value for name, value in scene.given if name != "liquid.film_thickness"}
    coated = Scene("", (*entries.items(), ("liquid.coating_thickness", "3 um")))
    grown = scene_of_sizes(coated, 200e-6, 400e-6, PROPORTIONAL)
    assert grown.entries["liquid.coating_thickness"] == pytest.approx(6e-6)
    assert grown.entries["partner.coating_thickness"] == pytest.approx(12e-6)


def test_a_pair_that_is_impossible_is_marked() -> None:
    """Spheres too small for a bridge across the film have a reason; the others are computed."""
    found = collision_averages("granulation", speeds="1 m/s", radii=["1 um", "100 um"], tolerance=1e-3)
    assert np.isnan(found.stick_probability.values).tolist() == [[True, True], [True, False]]
    assert "bridge.volume" in str(found.reason.values[0, 0])


@pytest.mark.slow
def test_shares_beside_undecided_collisions_are_not_known(tmp_path: Path) -> None:
    """A jump that creates energy without declaring it is an error: of those that leave the film, not of all sticks."""
    text = 'event("kick", guard=1.5*x0 - x, where="opening beyond the film", jump={u: 3*u})\n'
    (tmp_path / "kick.py").write_text("from wetdoublet.derive.user import *\n" + text)
    scene = Scene.load("granulation", model=tmp_path / "kick.py")
    found = collision_averages(scene, speeds="1 m/s", tolerance=1e-2)
    assert "no engine completes" in str(found.reason.values)
    assert np.isnan([found[name] for name in ("stick_probability", "rotate_probability", "bounce_probability")]).all()


@pytest.mark.slow
def test_an_interrupted_matrix_goes_on(tmp_path: Path) -> None:
    """Finished pairs are kept and not computed again; the result is that of workers on all cores."""
    radii = np.geomspace(60e-6, 120e-6, 8)
    resume, seen = tmp_path / "averages.nc", list[int]()

    def interrupt(done: int, total: int) -> None:
        assert total == 36
        if done:
            raise KeyboardInterrupt

    asked = {"speeds": 2.0, "radii": radii, "tolerance": 1e-2}
    with pytest.raises(KeyboardInterrupt):
        collision_averages("granulation", **asked, progress=interrupt, resume=resume)
    found = collision_averages("granulation", **asked, progress=lambda done, _: seen.append(done), resume=resume)
    assert seen == [32, 36]
    assert found.identical(collision_averages("granulation", **asked))


def test_the_command_writes_both_formats(tmp_path: Path) -> None:
    """CSV and NetCDF of the same request hold the same numbers."""
    wanted = ("averages", "granulation", "--speeds", "1.5 m/s", "--tolerance", "1e-2")
    for suffix in ("csv", "nc"):
        done = run(*wanted, "-o", tmp_path / f"averages.{suffix}")
        assert done.exit_code == 0, done.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["averages.csv", "averages.nc"]
    with (tmp_path / "averages.csv").open(newline="") as file:
        [row] = csv.DictReader(file)
    with xr.open_dataset(tmp_path / "averages.nc", engine="h5netcdf") as data:
        assert [float(row[name]) for name in QUANTITIES] == averages(data).tolist()
    done = run("averages", "granulation", "--speeds", "1 m")
    assert done.exit_code == 2
    assert "--speeds" in done.output


@pytest.mark.slow
def test_energies_and_rates_are_those_of_random_pairs_of_a_gas() -> None:
    """Spheres with Maxwellian velocities and spins, met by flux, by `collide_pair`: within four standard errors.

    The model's sideways velocity is that of touching surfaces, so that isotropic ones are stretched by the film.
    """
    scene = UNEQUAL.with_entries({"impact.spin": 2000.0, "impact.partner_spin": -500.0})
    count, rng, deviation, bodies = 20_000, np.random.default_rng(7), 0.8, Bodies.of(UNEQUAL)
    normal = rng.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    relative = deviation * (rng.normal(size=(count, 3)) - rng.normal(size=(count, 3)))
    opening = (relative * normal).sum(axis=1)
    relative[opening > 0] *= -1  # as many as there would be, without those that part
    speed = np.abs(opening)
    sideways = relative + speed[:, None] * normal
    axis = np.cross(normal, sideways)
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    contact, film = sum(bodies.radius), scene.liquid.film_thickness
    velocities = np.zeros((count, 2, 3))
    velocities[:, 1] = (1 + film / contact) * sideways - speed[:, None] * normal
    spins = np.array([2000.0, -500.0])[:, None] * axis[:, None]
    after = collide_pair(scene, normal, velocities, spins)
    inertia, sticks = np.array(bodies.inertia), after.outcome.values == 0
    orbital = bodies.reduced_mass * (contact + film) ** 2
    before, apart = (
        0.5 * (inertia * (each**2).sum(axis=2)).sum(axis=1) for each in (spins, np.nan_to_num(after.spins.values))
    )
    together = 0.5 * (orbital + inertia.sum()) * (np.nan_to_num(after.angular_velocity.values) ** 2).sum(axis=1)
    gained = np.where(sticks, together, apart) - before
    moving, parted = (
        0.5 * bodies.reduced_mass * (np.diff(each, axis=1)[:, 0] ** 2).sum(axis=1)
        for each in (velocities, np.nan_to_num(after.velocities.values))
    )
    lost = moving - np.where(sticks, 0.0, parted) - gained
    rows = {
        "kinetic_energy_loss": (speed * lost, speed * moving),
        "normal_dissipation": (speed * (1 - after.restitution.values**2) * speed**2, speed * speed**2),
        "energy_into_rotation": (speed * gained, speed * 0.5 * bodies.reduced_mass * (relative**2).sum(axis=1)),
        "stick_probability": (speed * sticks, speed),
        "collision_rate": (2 * np.pi * (contact + film) ** 2 * speed, np.ones(count)),
    }
    found = collision_averages(scene, speeds=f"maxwell:{deviation} m/s", tolerance=1e-4)
    for name, (above, below) in rows.items():
        ratio = above.mean() / below.mean()
        error = (above - ratio * below).std() / below.mean() / np.sqrt(count)
        assert float(found[name]) == pytest.approx(ratio, abs=4 * error), name
        assert error < 0.02 * abs(ratio)


def test_beside_a_wall_energies_and_rates_are_sums() -> None:
    """A quarter of the mean speed meets the wall; sums over a fine grid of angles give the energies."""
    count, speed = 4_000, 1.5
    scene = Scene.load("granulation").with_entries({"partner.wall": True, "impact.spin": 3000.0})
    angle = (np.arange(count) + 0.5) / count * np.pi / 2
    each = collide_many(
        scene, relative_speed=speed, angle=angle, of=("outcome", "restitution", "tangential_restitution", "final_spin")
    )
    weight = np.sin(2 * angle)
    found = collision_averages(scene, speeds=speed)
    left = np.average((each.restitution.values * np.cos(angle)) ** 2, weights=weight)
    assert float(found.normal_dissipation) == pytest.approx(1 - 2 * left, abs=4 / count)
    sliding = np.average((np.nan_to_num(each.tangential_restitution.values) * np.sin(angle)) ** 2, weights=weight)
    spin = np.nan_to_num(each.final_spin.values)
    gained = 0.4 * (scene.reduced_radius / speed) ** 2 * (spin**2 - 3000.0**2)
    turning = np.average(gained, weights=weight)
    assert float(found.energy_into_rotation) == pytest.approx(turning, abs=4 / count)
    assert float(found.kinetic_energy_loss) == pytest.approx(1 - left - sliding - turning, abs=4 / count)
    assert float(found.collision_rate) == speed / 4


def test_speeds_have_moments() -> None:
    """Of a gas and of a table, against closed forms; a density at rest has no mean."""
    gas, table = Speeds.of("maxwell:0.3 m/s"), Speeds.of(([1.0, 3.0], [0.5, 0.5]))
    assert gas.moment(0) == pytest.approx(1, abs=1e-9)  # but for the share beyond its last knot
    assert table.moment(0) == pytest.approx(1, rel=1e-12)
    assert gas.mean == pytest.approx(4 * 0.3 / np.sqrt(np.pi), rel=1e-8)
    assert gas.moment(2) == pytest.approx(8 * 0.3**2, rel=1e-8)
    assert table.mean == pytest.approx(2 / np.log(3), rel=1e-12)
    assert table.moment(2) == pytest.approx(13 / 3, rel=1e-12)
    assert np.isnan(Speeds.of(([0.0, 1.0], [1.0, 0.0])).mean)
    assert Speeds.of(2.0).mean == 2.0


def test_a_table_of_speeds_has_their_unit(tmp_path: Path) -> None:
    """In mm/s they are a thousandth of what they are in m/s, which is taken where no unit is written."""
    table = tmp_path / "speeds.csv"
    for head, unit in (("relative_speed", 1.0), ("relative_speed [mm/s]", 1e-3)):
        table.write_text(f"{head},density\n1,0\n2,1\n")
        assert Speeds.of(table).knots == pytest.approx([unit, 2 * unit])


@pytest.mark.slow
def test_a_table_for_a_person_has_units_and_the_numbers() -> None:
    """Each column has a name and a unit; what is not defined is a dash; a line for each pair."""
    radii = ["50 um", "200 um"]
    found = collision_averages("granulation", speeds="1 m/s", radii=radii, tolerance=1e-3)
    lines = table(found).splitlines()
    assert lines[0] == "relative speed 1 m/s, all impact angles"
    assert all(head in lines[2] for head in ("radius (um)", "partner (um)", "e_n of all", "rate (m^3/s)"))
    pairs = [line.split() for line in lines[3:7]]
    assert [pair[:2] for pair in pairs] == [["50", "50"], ["50", "200"], ["200", "50"], ["200", "200"]]
    assert [float(pair[2]) for pair in pairs] == pytest.approx(found.stick_probability.values.ravel(), rel=1e-4)
    assert pairs[0][7:9] == ["-", "-"]  # e_n and e_t of those that separate: none does
