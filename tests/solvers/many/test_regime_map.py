"""Regime maps: the grid and its file, failures, progress, the character map and the picture."""

import csv
import re

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import Scene, collide_many, regime_map
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.many import compute
from wetdoublet.solvers.many.blocks import blocks
from wetdoublet.solvers.many.plot_map import draw_map
from wetdoublet.solvers.many.regime_map import write
from wetdoublet.solvers.results import BY_DEFAULT

from ...helpers.command import run

STOKES, ANGLE = np.geomspace(0.02, 0.3, 4), np.radians([10.0, 60.0, 80.0])
UNLUCKY = ["--stokes", "0.1:0.3:2", "--angle", "10:80:3", "--engine", "rosenbrock"]


@pytest.fixture(scope="module")
def data():
    """A map whose viscosity varies as well."""
    return regime_map("granulation", stokes=STOKES, angle=ANGLE, vary={"liquid.viscosity": [1.0, 2.0]})


@pytest.fixture
def unlucky(monkeypatch):
    """Let the collisions of one Stokes number, 0.1, fail."""
    real = compute.integrated

    def integrated(problem, *rest):
        if abs(problem.groups["stokes"] - 0.1) < 1e-12:
            raise ComputationError("no luck", advice="none")
        return real(problem, *rest)

    monkeypatch.setattr(compute, "integrated", integrated)


def test_the_grid(data):
    """Dimensions are angle, Stokes number and what varies; every cell is the collision of its coordinates."""
    assert dict(data.sizes) == {"angle": 3, "stokes": 4, "liquid.viscosity": 2}
    for i, j, k in np.ndindex(3, 4, 2):
        cell = data.isel({"angle": i, "stokes": j, "liquid.viscosity": k})
        one = collide_many(
            "granulation",
            stokes=STOKES[j],
            angle=ANGLE[i],
            vary={"liquid.viscosity": [1.0, 2.0][k]},
            of=tuple(BY_DEFAULT),
        )
        for name in ("outcome", "certified", "reason", *BY_DEFAULT):
            np.testing.assert_array_equal(cell[name].values, one[name].values[0])
    sticks = data.outcome == 0
    assert bool((data.restitution.where(sticks, 0.0) == 0).all())
    assert np.isnan(data.contact_time.values[sticks.values]).all()


def test_coordinates(data):
    """Axes carry units; speed goes with the Stokes number, and Ce = m omega0^2/sigma is there with a bridge only."""
    assert data.angle.attrs["units"] == "rad"
    assert data.stokes.attrs["units"] == "1"
    assert data["liquid.viscosity"].attrs["units"] == "Pa s"
    assert data.speed.attrs["units"] == "m/s"
    scene = Scene.load("granulation").with_entries({"liquid.viscosity": 1.0})
    speed = scene.speed_of(STOKES[3])
    assert float(data.speed[3, 0]) == pytest.approx(speed, rel=1e-14)
    a, m = scene.particles.reduced_radius, scene.particles.reduced_mass
    expected = m * (speed * np.tan(ANGLE[1]) / (4 * a)) ** 2 / scene.bridge.surface_tension
    assert float(data.centrifugal[1, 3, 0]) == pytest.approx(expected, rel=1e-12)
    plain = regime_map("granulation-dry-bridge", speed=[0.5, 1.0], angle=1.0)
    assert dict(plain.sizes) == {"angle": 1, "speed": 2}
    assert "centrifugal" not in plain.coords
    assert plain.stokes.dims == ("speed",)


def test_file_round_trip(data, tmp_path):
    """A NetCDF4 file reads back as it was, with CF flags, and with the whole scene to compute it again."""
    path = tmp_path / "a map.nc"
    write(data, path)
    assert [each.name for each in tmp_path.iterdir()] == ["a map.nc"]
    with xr.open_dataset(path) as back:
        xr.testing.assert_identical(back.load(), data)
        assert back.outcome.dtype == np.int8
        assert back.outcome.attrs["flag_values"].tolist() == [-1, 0, 1, 2]
        assert back.outcome.attrs["flag_meanings"].split() == ["failed", "stick", "stick_rotate_separate", "bounce"]
        assert Scene.from_toml(back.attrs["scene"]) == Scene.load("granulation")
        assert (back.attrs["rtol"], back.attrs["engine"]) == (1e-9, data.attrs["engine"])
        assert back.attrs["version"]


def test_failures_are_marked_counted_and_told(unlucky, tmp_path):
    """A point that fails is -1 with its reason, the rest go on, one line says how many and why, and the exit is 0."""
    file = tmp_path / "map.nc"
    result = run("map", "granulation", *UNLUCKY, "-o", file)
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "3 of 6 collisions failed: 3 x no luck; none\n"
    with xr.open_dataset(file) as back:
        assert back.outcome.values.tolist() == [[-1, 2]] * 3
        assert set(back.reason.values[:, 0]) == {"no luck; none"}
        assert set(back.reason.values[:, 1]) == {""}


def test_table(unlucky, tmp_path):
    """`-o FILE.csv` is a row a collision with units in the header; what failed has its reason and no numbers."""
    file = tmp_path / "map.csv"
    result = run("map", "granulation", *UNLUCKY, "-o", file)
    assert (result.exit_code, [path.name for path in tmp_path.iterdir()]) == (0, ["map.csv"])
    with file.open(newline="") as text:
        rows = list(csv.DictReader(text))
    assert [(row["outcome"], row["reason"]) for row in rows] == [("failed", "no luck; none"), ("bounce", "")] * 3
    assert rows[0]["restitution"] == rows[0]["contact_time [s]"] == ""
    whole = regime_map("granulation", stokes=[0.3], angle=np.radians([10, 45, 80]), engine="rosenbrock")
    for name in ("angle [rad]", "speed [m/s]", "centrifugal", "restitution", "contact_time [s]", "smallest_gap [m]"):
        expected = whole[name.partition(" ")[0]].broadcast_like(whole.outcome).values[:, 0]
        assert [float(row[name]) for row in rows[1::2]] == pytest.approx(expected, rel=1e-9), name


def test_character_map(unlucky):
    """Without -o and --plot a legible map of S, R, B and ! is printed, not wider than 88 columns."""
    result = run("map", "granulation", *UNLUCKY)
    assert result.exit_code == 0
    assert "     0.3  BBB" in result.stdout.splitlines()
    assert "     0.1  !!!" in result.stdout.splitlines()
    assert result.stdout.splitlines()[-1].split() == ["deg", "10", "to", "80"]
    large = run("map", "granulation", "--stokes", "0.1:0.3:40", "--angle", "10:80:2").stdout
    assert "\nshown: 32 of 40 rows\n" in large and len(re.findall(r"^ +[0-9.]+  [SRB!]{2}$", large, re.M)) == 32


@pytest.mark.parametrize("count", [2, 8, 12, 38, 60])
def test_the_axis_of_angles(count):
    """Each mark stands under the column of its angle, and both ends have one, or a line that is too short says both."""
    *rows, marks, labels = run(
        "map", "granulation", "--stokes", "0.1:0.3:2", "--angle", f"10:80:{count}"
    ).stdout.partition("\n\noutside")[0].rstrip().splitlines()  # fmt: skip
    first, angles = rows[-1].index(rows[-1].split()[1]), np.linspace(10, 80, count)
    if count == 2:
        assert labels.split() == ["deg", "10", "to", "80"]
        return
    columns = [mark.start() for mark in re.finditer(r"\|", marks)]
    assert columns[0] == first and columns[-1] == first + count - 1
    for column in columns:
        assert float(labels[column:].split()[0]) == pytest.approx(angles[column - first], abs=0.05)


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_pictures(data, unlucky, tmp_path):
    """Every kind of map is drawn with nothing clipped: two panels, small multiples, one row, one cell, failures."""
    scene = Scene.load("pendulum").with_entries({"name": "cost $5 " * 20, "model.glass": "film-corrected"})
    angles = np.radians([10.0, 40.0, 70.0])
    maps = {
        "varied": data,
        "pendulum": regime_map(scene, speed=[0.2, 0.5, 1.0], angle=angles),
        "failed": regime_map("granulation", stokes=[0.1], angle=angles, engine="rosenbrock"),
        "cell": regime_map("granulation", stokes=0.2, angle=0.0),
    }
    for name, each in maps.items():
        figure = draw_map(each)
        figure.draw_without_rendering()
        box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
        assert min(box.x0, box.y0) >= 0, name
        assert box.x1 <= width and box.y1 <= height, name
        words = " ".join(text.get_text() for axes in figure.axes for text in (axes.xaxis.label, axes.yaxis.label))
        assert "(deg)" in words, name
        assert (
            "failed" in str([t.get_text() for a in figure.axes if a.get_legend() for t in a.get_legend().texts])
        ) == (name == "failed")
    picture = tmp_path / "map.png"
    result = run("map", "granulation", "--stokes", "0.1:0.3:2", "--angle", "40:42:2", "--plot", picture)
    assert (result.exit_code, result.output) == (0, "")
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_relative_speed_is_an_axis():
    """Over relative speed and angle each collision has its own normal speed, which the map carries."""
    data = regime_map("granulation", relative_speed=[0.5, 1.0], angle=["0 deg", "60 deg"])
    assert data.outcome.dims == ("angle", "relative_speed")
    assert data.speed.values == pytest.approx(np.array([[0.5, 1.0], [0.25, 0.5]]), rel=1e-14)
    one = regime_map("granulation", speed=[0.25, 0.5], angle=["60 deg"])
    assert data.restitution.values[1] == pytest.approx(one.restitution.values[0], rel=1e-9, nan_ok=True)
    assert data.centrifugal.values[1] == pytest.approx(one.centrifugal.values[0], rel=1e-12)


@pytest.mark.parametrize("shape", [(1,), (100_003,), (300, 7), (5, 4000, 3, 2), (10_000, 10_000)])
@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_blocks_cover_a_map_once(shape, engine):
    """Every collision is in one block, and no block is larger than the kernel takes in one call."""
    cut = blocks(shape, engine)
    extents = [[part.stop - part.start for part in at] for at in cut]
    assert sum(map(np.prod, extents)) == np.prod(shape)
    assert max(map(np.prod, extents)) <= 65536
    if np.prod(shape) < 1e6:
        count = np.zeros(shape, int)
        for at in cut:
            count[at] += 1
        assert (count == 1).all()
