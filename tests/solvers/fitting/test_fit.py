"""Fits of synthetic impacts."""

import json
from dataclasses import replace

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, fit, log_likelihood
from wetdoublet.solvers.fitting.free_entries import COMBINED, IDENTIFIED, NOT_AT_ALL, ONE_SIDE
from wetdoublet.solvers.fitting.measurements import UNKNOWN, Measurements

from tests.helpers.command import run
from tests.helpers.synthetic import drawn

VISCOSITY, FILM, ROUGHNESS = "liquid.viscosity", "liquid.film_thickness", "particles.roughness"

pytestmark = pytest.mark.usefixtures("optimized")


def plan(scene: Scene, rows: int, stokes: tuple[float, float], seed: int = 0) -> Measurements:
    random = np.random.default_rng(seed)
    speed = np.exp(random.uniform(*np.log(stokes), rows)) / scene.stokes_per_speed
    return Measurements(
        speed, random.uniform(0.2, 1.2, rows), 0.02 * speed, np.full(rows, 0.01), np.full(rows, UNKNOWN),
        {"restitution": (np.ones(rows), np.full(rows, 0.02))},
    )  # fmt: skip


@pytest.fixture(scope="module")
def pendulum():
    """A fit of a pendulum's viscosity and roughness, its data, and the counts that it reported."""
    first, steps = Scene.load("pendulum"), []
    true = first.with_entries({VISCOSITY: "14 Pa s"})
    data = drawn(true, plan(true, 8, (0.5, 4.0)), 3)
    return fit(first, data, [VISCOSITY, ROUGHNESS], starts=0, progress=lambda *step: steps.append(step)), data, steps


@pytest.mark.slow
def test_estimates_verdicts_and_intervals(pendulum):
    """The interval of what the data tell holds the truth; a roughness behind the glass criterion is bounded above.

    At the estimates the log-likelihood is stationary, at an end of the interval 1.92 below the maximum.
    """
    found, data, steps = pendulum
    viscosity, roughness = found.estimates[VISCOSITY], found.estimates[ROUGHNESS]
    assert viscosity.verdict == IDENTIFIED
    assert viscosity.low < 14 < viscosity.high
    assert (roughness.verdict, roughness.low) == (ONE_SIDE, None)
    assert roughness.high > 1e-6
    density = log_likelihood(found.scene, data, [VISCOSITY, ROUGHNESS])
    best = {name: each.value for name, each in found.estimates.items()}
    top = density(best)[0]
    for end in (viscosity.low, viscosity.high):
        assert density(best | {VISCOSITY: end})[0] == pytest.approx(top - 1.92, abs=0.15)
    assert abs(found.log_density(best)[1][VISCOSITY] * 14) < 2.0  # of a curvature of some thousand
    done = [each for each, _ in steps]
    assert (done, done[0], len(set(steps[-1]))) == (sorted(done), 0, 1)


@pytest.mark.slow
def test_what_it_writes_and_draws(pendulum, tmp_path):
    """The scene that is written has the estimates, the intervals as comments.

    In the picture the profile of the likelihood is 1.92 below its maximum where the interval ends.
    """
    found, *_ = pendulum
    found.write(tmp_path / "fitted.toml")
    estimate = found.estimates[VISCOSITY]
    assert Scene.load(tmp_path / "fitted.toml").entries[VISCOSITY] == pytest.approx(estimate.value, rel=1e-5)
    assert "# fitted: 95 %" in (tmp_path / "fitted.toml").read_text()
    drawn = found.plot().axes
    (axes,) = [each for each in drawn if each.get_xlabel() == "viscosity (Pa s)"]
    x, y = axes.lines[0].get_data()
    assert np.interp([estimate.low, estimate.high], x, y) == pytest.approx(-1.92, abs=0.3)
    (axes,) = [each for each in drawn if each.get_ylabel() == "restitution $e_n$"]
    assert axes.collections[0].get_paths()  # the band of the interval
    curves = [line for line in axes.lines if line.get_label().endswith("°")]
    assert curves and all(np.isnan(line.get_ydata()).any() for line in curves)  # broken where the outcome changes


def test_an_entry_without_influence_is_not_identifiable():
    """The roughness does not move the outcome of slow impacts that the film stops: nothing is told of it."""
    data = {"stokes": [0.02, 0.02], "angle": [0.0, 0.0], "angle_sd": [0.0, 0.0], "outcome": ["stick", "stick"]}
    found = fit("granulation-dry-bridge", data, "particles.dry_restitution")
    assert not found.rows.contradicted
    assert found.estimates["particles.dry_restitution"].verdict == NOT_AT_ALL


@pytest.mark.slow
def test_a_known_combination():
    """Where nothing but viscosity resists inertia the data tell viscosity over mass, and neither alone."""
    mass = "particles.reduced_mass"
    glass, tension, modulus = "liquid.glass_transition_pressure", "bridge.surface_tension", "particles.youngs_modulus"
    alone = {glass: "1e18 Pa", tension: "1e-12 N/m", modulus: "1e21 Pa"}
    scene = Scene.load("granulation").with_entries(alone)
    head_on = replace(plan(scene, 4, (5.0, 9.0)), angle=np.zeros(4), angle_sd=np.zeros(4))
    found = fit(scene, drawn(scene, head_on, 4), [VISCOSITY, mass], starts=0)
    assert {each.verdict for each in found.estimates.values()} == {COMBINED}
    (sentence,) = found.combinations
    assert sentence.startswith(f"The data fix {VISCOSITY} / {mass} to")
    assert sentence.endswith("; neither alone.")


def test_a_contradicting_row_is_named():
    """A stick among fast bounces is named, and does not move the estimate."""
    scene = Scene.load("pendulum")
    data = drawn(scene, plan(scene, 8, (2.0, 6.0)), 1)
    fast, (values, sd) = int(np.argmax(data.speed)), data.observed["restitution"]
    data.outcome[fast], values[fast] = 0, np.nan
    found = fit(scene, replace(data, observed={"restitution": (values, sd)}), VISCOSITY, starts=0)
    assert any(f"row {fast + 1}" in remark for remark in found.remarks)
    assert found.estimates[VISCOSITY].low < 12 < found.estimates[VISCOSITY].high


@pytest.mark.slow
def test_data_that_contradict_the_model_identify_nothing(tmp_path):
    """By the command, with JSON: where half of the impacts contradict the model, the first remark says so."""
    data = tmp_path / "odd.csv"
    data.write_text("stokes,angle [deg],outcome\n0.01,10,B\n0.02,10,B\n5,10,S\n10,10,S\n")
    found = run("fit", "granulation", data, "--free", VISCOSITY, "--json")
    assert found.exit_code == 0, found.output
    told = json.loads(found.stdout)
    assert told["remarks"][0].startswith("At least half of the impacts contradict the model")
    estimate = told["estimates"][VISCOSITY]
    assert (estimate["verdict"], estimate["low"], estimate["high"], told["points"]) == (NOT_AT_ALL, None, None, 4)
    assert told["remarks"][0] in found.stderr


def test_estimates_at_the_edge_of_what_is_possible_are_written(tmp_path):
    """A film as thick as the bridge allows is a scene that can be read again."""
    data = {"stokes": [1.0, 2.0], "angle": [0.4, 0.4], "contact_time": [1e-3, 1e-3], "outcome": ["B", "B"]}
    found = fit("granulation", data, FILM, starts=0)
    found.write(tmp_path / "fitted.toml")
    again = Scene.load(tmp_path / "fitted.toml")
    assert again.entries[FILM] == pytest.approx(found.estimates[FILM].value, rel=1e-5)


def test_a_prior_closes_an_interval():
    """With a prior an entry that the data do not tell has the prior's interval."""
    data = {"stokes": [0.02, 0.02], "angle": [0.0, 0.0], "outcome": ["stick", "stick"]}
    result = fit("granulation", data, VISCOSITY, prior={VISCOSITY: "2 Pa s +- 10 %"})
    assert any(remark.startswith("All impacts stick") for remark in result.remarks)
    found = result.estimates[VISCOSITY]
    assert np.log(found.high / found.low) == pytest.approx(2 * 1.96 * 0.1, rel=0.03)


def test_a_row_without_a_scene_is_named():
    """A film thinner than the roughness is named by its row and column."""
    data = {"stokes": [0.1, 0.1], "angle": [0.5, 0.5], "outcome": ["S", "S"], FILM: [8e-6, 1e-7]}
    with pytest.raises(InputError, match="row 2, column liquid.film_thickness"):
        fit("granulation", data, VISCOSITY)


@pytest.mark.slow
def test_one_stick_bounds_and_does_not_identify():
    """A stick at some viscosity is none at a lower one, nor at a much higher: ends are closed, flat between."""
    seen = {"stokes": [1.2], "angle": [0.3], "outcome": ["stick"]}
    found = fit("pendulum", seen, [VISCOSITY])
    estimate = found.estimates[VISCOSITY]
    assert estimate.verdict == NOT_AT_ALL
    density = log_likelihood("pendulum", seen, [VISCOSITY])
    heights = [density([part * estimate.value])[0] for part in (1.0, 1.5, 2.0)]
    assert estimate.low < estimate.value < 2.0 * estimate.value < estimate.high
    assert heights == pytest.approx([0.0] * 3, abs=1e-6)
    prior = fit("pendulum", seen, [VISCOSITY], prior={VISCOSITY: "12 Pa s +- 10 %"})
    assert prior.estimates[VISCOSITY].verdict == IDENTIFIED


@pytest.mark.slow
def test_a_profile_that_flattens_just_below_its_drop_is_open():
    """Elastic rebounds of thin liquid tell no lower end: from 1e-2 of the estimate on, its profile stays below 1.92."""
    seen = {
        "relative_speed": [0.236817] * 3 + [1.0] * 3 + [0.489801] * 2,
        "relative_speed_sd": [0.00237] * 3 + [0.01] * 3 + [0.0049] * 2, "angle": np.radians([0.0] * 6 + [70.0] * 2),
        "angle_sd": np.radians([1.0] * 8), "outcome": ["stick", "bounce", "stick", *["bounce"] * 5],
        "restitution": [np.nan, 0.0285, np.nan, 0.9198, 0.9113, 0.9215, 0.7129, 0.7217], "restitution_sd": [0.02] * 8,
    }  # fmt: skip
    result = fit("glass-beads-water", seen, [VISCOSITY, "particles.dry_restitution"], starts=0)
    estimate = result.estimates[VISCOSITY]
    assert (estimate.low, estimate.verdict) == (None, ONE_SIDE)
