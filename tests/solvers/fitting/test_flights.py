"""What is measured in free flight needs no film thickness, and the model flies on to the same lines."""

import math

import numpy as np
import pandas as pd
import pytest
from wetdoublet.solvers import InputError, Scene, collide, fit, tracks
from wetdoublet.solvers.fitting.data_table import read_data
from wetdoublet.solvers.fitting.flights import FLIGHT
from wetdoublet.solvers.fitting.measurements import rows_of

from tests.helpers.films import filmed

PIXEL, GUESSES, FILM = 2e-6, (0.8, 1.2), "liquid.coating_thickness"


def shot(scene: Scene, stokes: float, angle: float, noise: float, seed: int = 1):
    """A film, its rate and the collision; the pair approaches by a diameter in 30 frames."""
    one = collide(scene, stokes=stokes, angle=math.radians(angle), trajectory=True)
    rate = 30 * one.speed / (2 * scene.particles.reduced_radius * (1 + scene.radius_ratio))
    return filmed(scene, one, rate, PIXEL, noise, np.random.default_rng(seed), frames=60), rate, one


def guessed(scene: Scene, factor: float) -> Scene:
    """The scene with another film."""
    name = FILM if FILM in scene.entries else "liquid.film_thickness"
    return scene.with_entries({name: factor * float(dict(scene.si)[name])})


def scenes():
    unequal = Scene.load("lactose-pvp").with_entries({"partner.radius": "120 um", "partner.density": 1500})
    return [("lactose-pvp", 12, 40), ("granulation", 0.03, 60), ("granulation", 0.2, 0), (unequal, 12, 30)]


@pytest.mark.parametrize(("scene", "stokes", "angle"), scenes())
def test_the_lines_are_the_same_whatever_the_film(scene, stokes: float, angle: float) -> None:
    """Without noise; and the true scene's collision, flown on from the line of approach, leaves on the other line."""
    scene = Scene.load(scene)
    film, rate, _ = shot(scene, stokes, angle, 0.0)
    expected = None
    for factor in GUESSES:
        columns = tracks(film, guessed(scene, factor), rate=rate, scale=PIXEL, noise=0.001).columns
        values = np.array([columns[name][0] for name in FLIGHT])
        expected = values if expected is None else expected
        np.testing.assert_allclose(values, expected, rtol=1e-6, atol=1e-9)
        data = read_data(columns, guessed(scene, factor))
        there = rows_of(scene, (), data, 1e-10).unchecked(np.zeros(0))
        left = there.plain(tuple(FLIGHT)[2:], np.zeros(1, int), data.normal_speed, data.angle)
        np.testing.assert_allclose(left[:, 0], expected[2:], rtol=1e-5, atol=1e-9)


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_errors_depend_on_each_other_as_is_said() -> None:
    """Over 100 films, given the errors of speed and impact parameter, the others' are normal and independent.

    The mean of 100 deviates has a standard error of 0.1, their standard deviation 0.07, a correlation 0.1: four each.
    """
    scene = Scene.load("lactose-pvp")
    _, rate, one = shot(scene, 12, 40, 0.2)
    columns = [tracks(shot(scene, 12, 40, 0.2, seed)[0], guessed(scene, 1.2), rate=rate, scale=PIXEL).columns
               for seed in range(100)]  # fmt: skip
    data = read_data(pd.concat([pd.DataFrame(each) for each in columns], ignore_index=True), scene)
    solids = 4 * scene.particles.reduced_radius
    touch = solids + scene.liquid.film_thickness
    along = one.speed * math.tan(one.angle) * touch / solids
    speed = math.hypot(one.speed, along)
    angle = np.arcsin(touch * along / speed / data.flights.reach)
    names = tuple(data.observed)
    there = rows_of(scene, (), data, 1e-9).unchecked(np.zeros(0))
    expected = there.plain(names, np.arange(100), speed * np.cos(angle), angle)
    errors = [(data.speed - speed) / data.speed_sd, (data.angle - angle) / data.angle_sd]
    errors += [(data.observed[name][0] - each) / data.observed[name][1] for name, each in zip(names, expected)]
    assert np.abs(np.mean(errors, axis=1)).max() < 4 * 0.1
    assert np.abs(np.std(errors, axis=1) - 1).max() < 4 * 0.07
    assert np.abs(np.corrcoef(errors) - np.eye(6)).max() < 4 * 0.1


def test_derivatives_are_those_of_differences() -> None:
    """By the film, the viscosity, speed and angle, of a flight whose film differs from the guess's."""
    scene = Scene.load("lactose-pvp")
    film, rate, _ = shot(scene, 12, 40, 0.2)
    data = read_data(tracks(film, guessed(scene, 1.2), rate=rate, scale=PIXEL).columns, scene)
    free, names, row = (FILM, "liquid.viscosity"), tuple(data.observed), np.zeros(1, int)
    rows = rows_of(scene, free, data, 1e-12)
    values, at = np.array([dict(scene.si)[name] for name in free]), (data.normal_speed, data.angle)
    found = rows.at(values).results(names, row, *at)

    def difference(step: np.ndarray, speed: float = 0.0, angle: float = 0.0) -> np.ndarray:
        sides = [rows.at(values + k * step).plain(names, row, at[0] + k * speed, at[1] + k * angle) for k in (1, -1)]
        return (sides[0] - sides[1])[:, 0] / 2

    for k in (0, 1):
        step = 1e-5 * values * np.eye(2)[k]
        np.testing.assert_allclose(found.free[:, 0, k] * step[k], difference(step), rtol=2e-4)
    np.testing.assert_allclose(found.speed[:, 0] * 1e-5, difference(0 * values, speed=1e-5), rtol=2e-4)
    np.testing.assert_allclose(found.angle[:, 0] * 1e-5, difference(0 * values, angle=1e-5), rtol=2e-4)


def films(scene: Scene, count: int, seed: int) -> pd.DataFrame:
    random, parts = np.random.default_rng(seed), []
    for label in range(count):
        one = collide(scene, stokes=random.uniform(6, 14), angle=random.uniform(0.3, 0.9), trajectory=True)
        parts.append(pd.DataFrame({"impact": label, **filmed(scene, one, 2e5, PIXEL, 0.2, random, frames=40)}))
    return pd.concat(parts)


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_a_fit_finds_the_film_that_was_guessed_wrong() -> None:
    """Film and viscosity of six films, from guesses 20 % to either side: within their intervals, and the same."""
    scene = Scene.load("lactose-pvp")
    shots, ends = films(scene, 6, 6), []
    for factor in (0.8, 1.2):
        guess = guessed(scene, factor).with_entries({"liquid.viscosity": "10 mPa s"})
        columns = tracks(shots, guess, rate=2e5, scale=PIXEL).columns
        found = fit(guess, columns, ["liquid.viscosity", FILM], starts=0)
        for name, each in found.estimates.items():
            assert each.low < dict(scene.si)[name] < each.high
        assert not [each for each in found.remarks if "uncertain" in each or "contradict" in each]
        assert found.estimates[FILM].high / found.estimates[FILM].low < 1.2
        ends.append(found.estimates)
    for name in ends[0]:
        one, other = (each[name] for each in ends)
        assert abs(one.value - other.value) < 0.5 * (one.high - one.low) / 2


def test_what_is_missing_of_a_flight_is_named() -> None:
    """A line without its deviation, correlations that are none."""
    scene = Scene.load("lactose-pvp")
    film, rate, _ = shot(scene, 12, 40, 0.2)
    columns = tracks(film, scene, rate=rate, scale=PIXEL).columns
    for wrong, words in (
        ({"impact_parameter_sd": None}, "impact_parameter"), ({"turn_sd": None}, "turn"),
        ({"correlation": ["0 0 0"]}, "15 numbers"), ({"correlation": ["0.99 -0.99 0.99" + " 0" * 12]}, "definite"),
    ):  # fmt: skip
        changed = {name: each for name, each in (columns | wrong).items() if each is not None}
        with pytest.raises(InputError, match=words):
            read_data(changed, scene)
