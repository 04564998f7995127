"""Designs: the search against theory, a design against random ones, what is refused, and the table to fill in."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Design, Scene, design
from wetdoublet.solvers.fitting.data_table import read_data
from wetdoublet.solvers.fitting.design_search import search
from wetdoublet.solvers.fitting.information import information

FREE = ["liquid.viscosity", "liquid.film_thickness"]
OVER = {"stokes": (0.06, 0.3), "angle": 0.0}

POLYMER = """
[particles]
diameter = "6 mm"
density = "1140 kg/m3"
roughness = "3 um"
dry_restitution = 0.85
[partner]
wall = true
[liquid]
viscosity = "100 mPa s"
film_thickness = "200 um"
"""


reported: list[tuple[int, int]] = []


@pytest.fixture(scope="module")
def found() -> Design:
    return design("granulation", FREE, OVER, 6, progress=lambda *step: reported.append(step))


def regression(points: np.ndarray) -> np.ndarray:
    """Information of a quadratic regression on the first coordinate."""
    x = np.stack([np.ones(len(points)), 2 * points[:, 0] - 1, (2 * points[:, 0] - 1) ** 2], axis=1)
    return x[:, :, None] * x[:, None, :]


def test_quadratic_regression_is_measured_at_its_ends_and_middle() -> None:
    """The D-optimal design of a quadratic on an interval has a third of its points at either end and the middle."""
    first = np.column_stack([np.linspace(0, 1, 8), np.zeros(8)])  # without the middle
    points, counts, _ = search(regression, 1e-9 * np.eye(3), 9, first, 1 / 7)
    assert points[:, 0] == pytest.approx([0, 0.5, 1], abs=0.02)
    assert counts.tolist() == [3, 3, 3]


@pytest.mark.slow
def test_a_design_beats_random_ones(found: Design) -> None:
    """The determinant of its information is larger than that of any of 20 random designs in the window."""
    scene = Scene.load("granulation")
    values = np.array([scene.entries[name] for name in FREE])
    random = np.random.default_rng(0)
    others = found.window.plan(np.column_stack([random.random(120), np.zeros(120)]))
    single = information(scene, tuple(FREE), values, others)[0] * np.outer(values, values)
    of_random = np.linalg.slogdet(1e-3 * np.eye(2) + single.reshape(20, 6, 2, 2).sum(axis=1))[1]
    own = information(scene, tuple(FREE), values, found.plan())[0].sum(axis=0) * np.outer(values, values)
    assert np.linalg.slogdet(own)[1] > of_random.max()
    assert found.size == 6


@pytest.mark.slow
def test_a_prior_is_known_before() -> None:
    """Without impacts an entry is known as its prior says, and better with them."""
    window = {"stokes": (0.06, 0.3), "angle": 0.0}
    made = design("granulation", FREE[:1], window, 2, prior={FREE[0]: "2 Pa s +- 10 %"})
    assert made.before[FREE[0]].sd == pytest.approx(0.1, rel=1e-3)
    assert made.expected[FREE[0]].sd < 0.1


@pytest.mark.slow
def test_the_table_is_what_a_fit_reads(found: Design, tmp_path: Path) -> None:
    """Filled in, it is read with the speeds, angles and scatter that were planned."""
    lines = found.to_csv().splitlines()
    filled = [lines[0], *(line.replace(",,,0.02", ",bounce,0.4,0.02") for line in lines[1:])]
    file = tmp_path / "plan.csv"
    file.write_text("\n".join(filled))
    data, plan = read_data(file, Scene.load("granulation")), found.plan()
    assert data.speed == pytest.approx(plan.speed, rel=1e-5)
    assert data.angle == pytest.approx(plan.angle, abs=1e-5)
    assert data.speed_sd == pytest.approx(plan.speed_sd, rel=1e-2)
    assert (data.outcome == 2).all()


@pytest.mark.slow
def test_the_table_shows_the_impacts(found: Design) -> None:
    """A row for each distinct impact, the expected intervals; progress came to its end."""
    done = [each for each, _ in reported]
    assert (done[0], done, done[-1]) == (0, sorted(done), reported[-1][1])
    text = str(found)
    assert text.startswith("6 impacts for liquid.viscosity, liquid.film_thickness")
    assert all(f"{each.stokes:.4g}" in text for each in found.impacts)
    assert (
        "Planned for liquid.viscosity = 2 Pa s, liquid.film_thickness = 8 um; scatter 2 % of the normal speed" in text
    )
    assert sum(each["count"] for each in found.to_dict()["impacts"]) == 6


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")  # from here on
def test_what_impacts_tell_in_combination_only_is_open() -> None:
    """Without a criterion of rebound beside roughness, viscosity and film make one group; a prior on one parts them."""
    scene = Scene.from_toml(POLYMER)
    asked: dict[str, Any] = {"free": FREE, "over": {"stokes": (3, 15), "angle": 0.0}, "n": 2}
    open_ = design(scene, **asked)
    assert [(each.low, each.high) for each in open_.expected.values()] == [(None, None)] * 2
    assert len(open_.combinations) == 1
    assert "neither alone" in str(open_)
    closed = design(scene, **asked, prior={FREE[1]: "200 um +- 10 %"})
    assert None not in (closed.expected[FREE[0]].low, closed.expected[FREE[0]].high)


@pytest.mark.slow
def test_a_picture_for_one_entry_shows_all_its_words() -> None:
    """No text of the narrowest picture reaches beyond its edges."""
    figure = design("granulation", FREE[:1], {"stokes": (0.06, 0.3), "angle": 0.0}, 2).plot()
    figure.draw_without_rendering()
    for words in figure.texts:
        extent = words.get_window_extent()
        assert 0 <= extent.x0 < extent.x1 <= figure.bbox.width, words.get_text()
