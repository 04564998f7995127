"""Films as trackers and people leave them: lost frames, shared times, bent paths, other names and units."""

import math
import re

import numpy as np
import pint
import pytest
from wetdoublet.solvers import InputError, Scene, tracks

from tests.helpers.films import PIXEL, RATE, bounce, drawn, lossy, pushed, read

NAMES = ("lactose-pvp", "granulation", "glass-beads-water", "pellet-coating")


film = pytest.fixture(scope="module")(bounce)


def draw(k: int, *, stick: bool = False, noise: float | None = None):
    """A scene and a film of it, of which the k-th step is clear of the noise; its diameter in pixels."""
    scene, random = Scene.load(NAMES[k % 4]), np.random.default_rng([43, k])
    shot = drawn(scene, random, stick=stick, noise=noise)
    return scene, shot, 2 * scene.particles.reduced_radius * (1 + scene.radius_ratio) / shot["scale"]


@pytest.mark.parametrize("lost", [[9], [9, 10, 11], [60], [3, 11, 58]])
def test_lost_frames_are_counted_and_placed(film: dict[str, np.ndarray], lost: list[int]) -> None:
    """Before and after the impact the motion jumps by whole steps where frames are lost; the sentence says where."""
    with pytest.raises(InputError) as error:
        read(lossy(film, lost))
    first = min(lost) - 1
    together = sum(1 for k, each in enumerate(lost) if each == lost[0] + k)
    assert f"{together} lost after frame {first}" in str(error.value)
    assert "along the motion as across it" in str(error.value)


def test_films_without_fault_are_given_within_their_deviations() -> None:
    """Films drawn at random, a third sticks: no alarm among 48, and errors have variance 1."""
    errors = []
    for k in range(48):
        scene, shot, _ = draw(k, stick=k % 3 == 0)
        found = tracks(shot["film"], scene, rate=shot["rate"], scale=shot["scale"])
        assert not any("displaces" in each for each in found.remarks), k
        assert (found.columns["outcome"] == ["stick"]) == (k % 3 == 0)
        names = [each for each in ("speed", "restitution") if each in found.columns]  # none after nearly a stick
        errors += [(found.columns[each][0] - shot[each]) / found.columns[f"{each}_sd"][0] for each in names]
    assert len(errors) >= 78
    assert abs(np.mean(errors)) < 4 / math.sqrt(len(errors))
    assert abs(np.std(errors) - 1) < 4 / math.sqrt(2 * len(errors))


def test_what_would_be_measured_wrong_is_refused(film: dict[str, np.ndarray]) -> None:
    """Two films under running numbers, a picture that is there twice in contact, a rate beside other times, depth."""
    both = {name: np.append(cells, cells + 500 * (name == "frame")) for name, cells in film.items()}
    middle = int(np.argmin(np.hypot(film["x2"] - film["x1"], film["y2"] - film["y1"])))
    twice = {name: np.insert(cells, middle, cells[middle]) for name, cells in film.items()}
    twice["frame"] = np.arange(twice["frame"].size)
    slow = {"time [s]": film["frame"] / 30} | {name: film[name] for name in ("x1", "y1", "x2", "y2")}
    tilted = film | {"z1": 0.5 * film["y1"], "z2": 0.5 * film["y2"]}
    for wrong, words in (
        (both, "meet again"), (twice, "same picture again"), (slow, "come at 30 1/s"), (tilted, "has a z"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=words):
            read(wrong)
    flat = film | {"z1": 0 * film["y1"], "z2": 0 * film["y2"]}
    assert read(flat).to_csv() == read(film).to_csv()


@pytest.mark.parametrize("digit", [1.0, 0.5, 1 / 3])
@pytest.mark.parametrize("times", [2, 3])
def test_centres_in_coarse_steps_may_repeat(digit: float, times: int) -> None:
    """Centres that move by one or two pixels are written alike in frames that follow each other: two pictures."""
    alike = 0
    for seed in range(6):
        shot = bounce(times * RATE, seed=seed)
        coarse = {name: np.round(cells / digit) * digit for name, cells in shot.items()} | {"frame": shot["frame"]}
        apart = [coarse["x2"] - coarse["x1"], coarse["y2"] - coarse["y1"]]
        alike += int((np.diff(apart) == 0).all(axis=0).sum())
        assert read(coarse, rate=times * RATE).columns["speed"] == pytest.approx([0.818], rel=0.02)
    assert alike > 0


@pytest.mark.parametrize("digit", [1.0, 0.5, 0.01, None])
@pytest.mark.parametrize("held", [False, True])
def test_pictures_that_are_there_twice_are_named(digit: float | None, held: bool) -> None:
    """Once, every fifth, or each; inserted, or in place of the next: no motion of several digits stops for a frame."""
    for seed in range(3):
        shot = bounce(seed=seed)
        if digit:
            shot = {name: np.round(cells / digit) * digit for name, cells in shot.items()} | {"frame": shot["frame"]}
        size = shot["frame"].size
        for which in ([9], range(2, size, 5), range(1, size, 2)):
            rows = np.arange(size)
            if held:
                rows[np.array(which[: None if which[-1] + 1 < size else -1]) + 1] -= 1
            else:
                rows = np.sort(np.append(rows, which))
            twice = {name: cells[rows] for name, cells in shot.items()} | {"frame": np.arange(rows.size)}
            with pytest.raises(InputError, match="same picture again after frame") as error:
                read(twice)
            after = int(re.search(r"after frame (\d+)", str(error.value))[1])
            assert rows[after] == rows[after + 1]


def test_films_in_one_table_have_their_own_clocks(film: dict[str, np.ndarray]) -> None:
    """One begins between two frames of the other: a rate beside the times is that of each, and not of both together."""
    places = {name: np.tile(film[name], 2) for name in ("x1", "y1", "x2", "y2")}
    times = np.concatenate([film["frame"] / RATE, (film["frame"] + 0.3) / RATE])
    both = {"impact": np.repeat([1, 2], film["frame"].size), "time [s]": times} | places
    found = read(both)
    np.testing.assert_allclose(found.columns["speed"], read(film).columns["speed"][0], rtol=1e-9)
    assert any("is not used" in remark for remark in found.remarks)
    with pytest.raises(InputError, match="come at 1.5e.05 1/s"):
        read(both, rate=30.0)


def test_a_tracker_that_pushes_near_discs_apart_is_noticed() -> None:
    """Centres displaced as trackpy displaces them: sticks stay sticks, speeds stay right, and it is said.

    Without the test of near frames the same speeds are off by many of their deviations.
    """
    errors, blind, said = [], [], 0
    for k in range(30):
        scene, shot, diameter = draw(k, stick=k % 3 != 0, noise=0.1)
        settings = {"rate": shot["rate"], "scale": shot["scale"]}
        bent = pushed(shot["film"], diameter)
        try:
            found = tracks(bent, scene, **settings)
        except InputError:
            continue  # too few frames away from contact
        said += any("displaces near discs" in each for each in found.remarks)
        assert (found.columns["outcome"] == ["stick"]) == (k % 3 != 0)
        assert k % 3 == 0 or any("look at the scale, the diameter and the tracker" in each for each in found.remarks)
        errors.append((found.columns["speed"][0] - shot["speed"]) / found.columns["speed_sd"][0])
        try:
            all_of_it = tracks(bent, scene, near=0, **settings)
        except InputError:
            continue
        blind.append((all_of_it.columns["speed"][0] - shot["speed"]) / all_of_it.columns["speed_sd"][0])
    assert len(errors) >= 25
    assert said >= 0.9 * len(errors)
    assert np.median(np.abs(errors)) < 1.2
    assert not blind or np.median(np.abs(blind)) > 3


def test_frames_near_contact_are_left_out(film: dict[str, np.ndarray]) -> None:
    """`near` makes the result independent of where near centres are; in m, with a unit or in pixels."""
    distance = np.hypot(film["x2"] - film["x1"], film["y2"] - film["y1"]) * PIXEL
    close = 0.98 + 0.02 * (distance >= 340e-6)  # of the distance
    moved = film | {name: film[f"{name[0]}1"] + close * (film[name] - film[f"{name[0]}1"]) for name in ("x2", "y2")}
    plain = read(film, noise=0.2).columns["speed"]
    expected = read(film, near=4e-5, noise=0.2).columns["speed"]
    assert expected != plain
    for near in (4e-5, "40 um", "20 px", pint.Quantity(0.04, "mm")):
        found = read(moved, near=near, noise=0.2)
        assert found.columns["speed"] == pytest.approx(expected, rel=1e-9)
        assert "are left out" in found.remarks[0]


def test_frames_and_times_that_are_shared_are_named(film: dict[str, np.ndarray]) -> None:
    """A row twice names its frame; a clock too coarse for the film names its times and what to give instead."""
    again = {name: np.append(values, values[3]) for name, values in film.items()}
    unknown = {"Zeit": film["frame"]} | {name: values for name, values in film.items() if name != "frame"}
    with pytest.raises(InputError, match='"Zeit, .*" has no time'):
        read(unknown)
    with pytest.raises(InputError, match="has frame 3 more than once"):
        read(again)
    lost = {name: np.append(np.delete(values, 9), values[3]) for name, values in film.items()}
    lost["frame"] = np.append(np.arange(film["frame"].size - 1), 3)
    with pytest.raises(InputError, match="frame 3 more than once.*1 lost after frame 8"):
        read(lost)
    clock = {"time [ms]": np.floor(film["frame"] / 150 * 10) / 10, **{n: film[n] for n in ("x1", "y1", "x2", "y2")}}
    with pytest.raises(InputError, match=r"time 0\.0 ms.*column frame and its rate"):
        read(clock)
    twice = {name: np.insert(values, 10, values[9]) for name, values in film.items()}
    with pytest.raises(InputError, match="the same picture again after frame 9"):
        read(twice | {"frame": np.arange(film["frame"].size + 1)})


def test_what_does_not_move_is_refused_without_a_warning(film: dict[str, np.ndarray]) -> None:
    """Centres at rest and numbers beyond any double are said, not divided by."""
    for wrong in (
        {name: values * 0 + k for k, (name, values) in enumerate(film.items())},
        film | {"x1": film["x1"] * 1e300},
    ):
        with pytest.raises(InputError):
            read(wrong | {"frame": film["frame"]})


def test_noise_carries_its_unit(film: dict[str, np.ndarray]) -> None:
    expected = read(film, noise=0.3).columns["speed_sd"]
    for noise in ("0.3 px", "0.6 um", "0.3", pint.Quantity(0.3, "px")):
        assert read(film, noise=noise).columns["speed_sd"] == pytest.approx(expected, rel=1e-12)
    for option, value in (("rate", "6 us"), ("rate", 0), ("scale", "2"), ("scale", "2 mil"), ("near", -1),
                          ("noise", "1 s")):  # fmt: skip
        with pytest.raises(InputError, match=f"^{option}: "):
            read(film, **{option: value})


def test_a_film_without_positions_is_refused(film: dict[str, np.ndarray]) -> None:
    """A table without rows, and one in which the tracker lost a sphere throughout."""
    for wrong in ({name: values[:0] for name, values in film.items()}, film | {"x1": film["x1"] * np.nan}):
        with pytest.raises(InputError, match="at least 4 frames"):
            read(wrong)


def test_rate_and_scale_carry_their_units(film: dict[str, np.ndarray]) -> None:
    expected = read(film).columns["speed"]
    for rate, scale in (("150 kHz", "2 um/px"), ("150 kfps", "500 px/mm"), ("150000 frames/s", "12700 dpi"),
                        (pint.Quantity(150, "kHz"), pint.Quantity(500, "px/mm")), (RATE, "1 mm = 500 px"),
                        (RATE, "500 pixels per mm"), (RATE, ".2 mm/100px"), (RATE, "500px = 1mm")):  # fmt: skip
        assert read(film, rate=rate, scale=scale).columns["speed"] == pytest.approx(expected, rel=1e-12)
    for option, value, problem in (
        ("rate", "150,000 fps", "comma"), ("scale", "1 mm = 0 px", "of a pixel"), ("scale", "5 px/1 s", "a time"),
        ("scale", "1 mm = -5 px", "of a pixel"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=f'^{option}: "{value}".*{problem}'):  # as it was typed
            read(film, **{option: value})


def test_columns_in_units_of_their_own_are_said(film: dict[str, np.ndarray]) -> None:
    """Each coordinate counts in its unit, and the remarks name all; a scale counts for those in pixels."""
    sizes = {"x1 [mm]": 1e-3, "y1 [mm]": 1e-3, "x2 [um]": 1e-6, "y2": PIXEL}
    mixed = {"frame": film["frame"]} | {name: film[name[:2]] * PIXEL / size for name, size in sizes.items()}
    found = read(mixed)
    assert found.columns["speed"] == pytest.approx(read(film).columns["speed"], rel=1e-9)
    assert any("positions in mm and um and px" in remark for remark in found.remarks)
    assert not any("is not used" in remark for remark in found.remarks)
