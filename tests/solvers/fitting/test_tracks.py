"""Tracked centres become impacts: films of the toolkit's own trajectories, in which the truth is known."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from wetdoublet.solvers import InputError, Scene, collide, tracks
from wetdoublet.solvers.fitting.data_table import read_data

from tests.helpers.command import run
from tests.helpers.films import filmed

NAMES = ("speed", "angle", "restitution", "tangential_restitution", "contact_time", "rotation")
PIXEL = 2e-6


def film_of(name: str, stokes: float, angle: float, noise: float, seed: int, per_diameter: float = 30.0):
    """A film, its rate, the scene and the collision; the pair approaches by a diameter in so many frames."""
    scene = Scene.load(name)
    one = collide(scene, stokes=stokes, angle=math.radians(angle), trajectory=True)
    rate = per_diameter * one.speed / (4 * scene.particles.reduced_radius)
    return filmed(scene, one, rate, PIXEL, noise, np.random.default_rng(seed)), rate, scene, one


@pytest.mark.parametrize(
    ("name", "stokes", "angle"), [("granulation", 0.2, 30), ("granulation", 0.03, 60), ("lactose-pvp", 12, 40)]
)
def test_without_noise_it_is_the_collision(name: str, stokes: float, angle: float) -> None:
    """Speed, angle, e_n, e_t, contact time and rotation of a bounce, and of a doublet that turns more than once."""
    film, rate, scene, one = film_of(name, stokes, angle, 0.0, 1)
    found = tracks(film, scene, rate=rate, scale="2 um").columns
    for each in NAMES:
        assert found[each][0] == pytest.approx(getattr(one, each), rel=1e-6)
    assert found["outcome"] == [""]


def test_the_scale_is_uncertain() -> None:
    """The uncertainty of the scale counts as much as another scale changes the results."""
    film, rate, scene, _ = film_of("lactose-pvp", 12, 40, 0.0, 1)
    found = tracks(film, scene, rate=rate, scale=PIXEL, scale_sd=0.01).columns
    exact, larger = (tracks(film, scene, rate=rate, scale=k * PIXEL).columns for k in (1, 1.001))
    for each in ("speed", "angle", "restitution"):
        assert found[f"{each}_sd"][0] == pytest.approx(10 * abs(larger[each][0] - exact[each][0]), rel=0.02)


def test_a_stick_and_a_head_on_impact_are_said() -> None:
    """Together to the end of the film is a stick; head-on within the noise has no e_t and no sense of rotation."""
    film, rate, scene, _ = film_of("glass-beads-water", 20, 20, 0.2, 1)
    stuck = tracks(film, scene, rate=rate, scale=PIXEL)
    assert stuck.columns["outcome"] == ["stick"]
    assert "restitution" not in stuck.columns
    assert "taken for a stick" in stuck.remarks[0]
    film, rate, scene, one = film_of("granulation", 0.2, 0, 0.2, 1)
    straight = tracks(film, scene, rate=rate, scale=PIXEL)
    assert "tangential_restitution" not in straight.columns
    assert straight.columns["restitution"][0] == pytest.approx(one.restitution, abs=0.03)
    assert "head-on within its uncertainty" in straight.remarks[0]


def test_the_command_writes_what_fit_reads(tmp_path: Path) -> None:
    """Films in one file: a row for each, with the numbers of `tracks`."""
    film, rate, scene, _ = film_of("lactose-pvp", 12, 40, 0.2, 1)
    pd.concat([pd.DataFrame({"impact": label, **film}) for label in "ab"]).to_csv(tmp_path / "films.csv", index=False)
    words = ("tracks", tmp_path / "films.csv", "lactose-pvp", "--rate", rate, "--scale", "2 um")
    assert run(*words, "-o", tmp_path / "impacts.csv").exit_code == 0
    found = tracks(film, scene, rate=rate, scale=PIXEL).columns
    assert json.loads(run(*words, "--json").stdout)["speed"] == pytest.approx(2 * list(found["speed"]))
    data = read_data(tmp_path / "impacts.csv", scene)
    assert data.relative
    assert data.speed == pytest.approx(2 * list(found["relative_speed"]), rel=1e-5)


def test_a_film_that_ends_before_contact_is_left_out() -> None:
    """It is no stick: alone it is refused, beside another film it is named and the other one is given."""
    film, rate, scene, _ = film_of("granulation", 0.2, 30, 0.2, 1)
    distance = np.hypot(film["x2"] - film["x1"], film["y2"] - film["y1"])
    end = int(np.argmin(distance)) - 3
    short = {name: values[:end] for name, values in film.items()}
    with pytest.raises(InputError, match="before the films meet"):
        tracks(short, scene, rate=rate, scale=PIXEL)
    labels = ["whole"] * distance.size + ["short"] * end
    both = {name: np.concatenate([film[name], short[name]]) for name in film} | {"impact": labels}
    found = tracks(both, scene, rate=rate, scale=PIXEL)
    assert found.labels == ("whole",)
    assert len(found.columns["speed"]) == 1
    assert any("left out" in each and "impact short" in each for each in found.remarks)


def test_a_frame_that_is_tracked_wrongly_is_named() -> None:
    """20 px beside its line, which would widen every uncertainty; so are contacts that would take no time."""
    film, rate, scene, _ = film_of("granulation", 0.2, 30, 0.2, 1)
    stray = film | {"y2": np.array(film["y2"])}
    stray["y2"][5] += 20
    with pytest.raises(InputError, match="off its line"):
        tracks(stray, scene, rate=rate, scale=PIXEL)
    with pytest.raises(InputError, match="is the scale or the"):
        tracks(film, scene, rate=rate, scale=3 * PIXEL)
    with pytest.raises(InputError, match="row 1, column x1"):
        tracks(film | {"x1": ["lost", *film["x1"][1:]]}, scene, rate=rate, scale=PIXEL)


def test_exchanged_spheres_are_named() -> None:
    """They show as a jump; a frame that is missing and counted does not matter."""
    film, rate, scene, _ = film_of("lactose-pvp", 12, 40, 0.2, 1)
    fewer = {name: np.delete(values, 11) for name, values in film.items()}
    assert tracks(fewer, scene, rate=rate, scale=PIXEL).labels == ("1",)
    late = np.arange(film["frame"].size) > 60
    for one, two in (("x1", "x2"), ("y1", "y2")):
        film |= {one: np.where(late, film[two], film[one]), two: np.where(late, film[one], film[two])}
    with pytest.raises(InputError, match="exchanged"):
        tracks(film, scene, rate=rate, scale=PIXEL)


def test_what_is_wrong_is_named() -> None:
    """No scale, no rate, a missing column, too short a film, two that pass each other, a wall."""
    film, rate, scene, _ = film_of("granulation", 0.2, 30, 0.2, 1)
    late = {name: values[23:] for name, values in film.items()}
    past = film | {"y2": film["y2"] + 1e3, "x2": film["x2"] + 1e3}
    for wrong, settings, words in (
        ({name: values for name, values in film.items() if name != "y2"}, {}, "has no y2"),
        (late, {"rate": rate, "scale": PIXEL}, "at least 4 frames before the impact"),
        (past, {"rate": rate, "scale": PIXEL}, "pass each other"),
    ):
        with pytest.raises(InputError) as error:
            tracks(wrong, scene, **settings)
        assert words in str(error.value).replace('"', "")
    with pytest.raises(InputError, match="strings"):
        tracks(film, "pendulum", rate=rate, scale=PIXEL)


def test_turns_that_cannot_be_counted_are_left_out() -> None:
    """A doublet filmed too slowly turns by more than 90 deg between frames: no rotation is given, and it is said."""
    film, rate, scene, _ = film_of("granulation", 0.03, 60, 0.0, 1, per_diameter=0.3)
    found = tracks(film, scene, rate=rate, scale=PIXEL)
    assert "rotation" not in found.columns
    assert "turns cannot be counted" in found.remarks[0]


def test_spheres_that_would_overlap_are_said() -> None:
    """Positions that are too small by a fifth have the centres nearer than solids touch; true ones have not."""
    film, rate, scene, _ = film_of("lactose-pvp", 12, 40, 0.2, 1)
    said = {share: " ".join(tracks(film, scene, rate=rate, scale=share * PIXEL).remarks) for share in (0.8, 1.0)}
    assert "distance is least at" in said[0.8]
    assert "is least" not in said[1.0]
