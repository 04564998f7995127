"""The likelihood of impacts beside a Monte Carlo mean, and its gradient beside differences."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from wetdoublet.generated.automaton import LAST_ANSWER
from wetdoublet.solvers import Scene, collide_many, log_likelihood
from wetdoublet.solvers.boundaries import experiment
from wetdoublet.solvers.engines.taylor.call import KernelImpacts, run_kernel
from wetdoublet.solvers.fitting.likelihood import KNEE, Likelihood, limit
from wetdoublet.solvers.fitting.measurements import Measurements
from wetdoublet.solvers.fitting.scatter import EXACT, Resolution

FINE = Resolution(7, 12, 256, 21, False, 1e-10)

pytestmark = pytest.mark.usefixtures("optimized")


def impacts(scene: Scene, stokes: list[float], degrees: list[float], outcome: list[int], restitution: list[float]):
    speed = np.array(stokes) / scene.stokes_per_speed
    return Measurements(
        speed, np.radians(degrees), 0.03 * speed, np.full(speed.size, 0.02), np.array(outcome, dtype=np.int8),
        {"restitution": (np.array(restitution), np.full(speed.size, 0.03))},
    )  # fmt: skip


PENDULUM = (
    [1.36, 1.5, 0.42, 1.45, 2.5], [20.0, 60.0, 60.0, 60.0, 40.0], [0, 2, 1, 1, -1], [np.nan, 0.3, 0.08, 0.19, 0.5],
)  # fmt: skip


@pytest.mark.slow
def test_likelihood_is_the_mean_over_the_scatter():
    """Of each row the likelihood is the mean over drawn impacts of outcome times density."""
    scene = Scene.load("pendulum")
    data = impacts(scene, *PENDULUM)
    likelihood = Likelihood(scene, ("liquid.viscosity",), data)
    likelihood.aim(np.array([12.0]))
    found = likelihood(np.array([12.0]), FINE)
    random, count = np.random.default_rng(0), 20_000
    for row in range(data.size):
        speed = data.speed[row] + data.speed_sd[row] * random.standard_normal(count)
        angle = data.angle[row] + data.angle_sd[row] * random.standard_normal(count)
        drawn = collide_many(scene, speed=speed, angle=angle)
        agrees = data.allowed[row][drawn.outcome.values]
        density = agrees.astype(float)
        measured, sd = (each[row] for each in data.observed["restitution"])
        if data.separated[row]:
            misfit = (measured - drawn.restitution.values) / sd
            density = density * np.exp(-(misfit**2) / 2) / (sd * np.sqrt(2 * np.pi))
        error = density.std() / np.sqrt(count) / density.mean()
        assert found.plain[row] == pytest.approx(np.log(density.mean()), abs=5 * error + 1e-4)
        assert found.probability[row] == pytest.approx(agrees.mean(), abs=0.02)


@pytest.mark.parametrize(
    ("name", "table"),
    [("pendulum", PENDULUM), ("granulation", ([0.05, 0.117, 0.2], [45.0, 45.0, 60.0], [1, 2, 2], [0.25, 0.6, 0.9]))],
)
@pytest.mark.slow
def test_gradient_is_that_of_differences(name: str, table: tuple):
    """The gradient agrees with differences, also where outcomes change within the scatter."""
    scene = Scene.load(name)
    names = ("liquid.viscosity", "liquid.film_thickness", "liquid.glass_transition_pressure")
    likelihood = Likelihood(scene, names, impacts(scene, *table), 3e-10)
    values = np.array([scene.entries[name] for name in names])
    likelihood.aim(values)
    exact = likelihood(values, EXACT).scores * values
    step = 2e-4
    for k in range(len(names)):
        near = []
        for parts in (-2, -1, 1, 2):
            moved = values.copy()
            moved[k] *= np.exp(parts * step)
            near.append(likelihood(moved, EXACT).rows)
        slope = (8 * (near[2] - near[1]) - (near[3] - near[0])) / (12 * step)
        scale = np.abs(exact).max(axis=1)
        np.testing.assert_allclose(exact[:, k] / scale, slope / scale, atol=1e-6)


@pytest.mark.parametrize("sd", [3e-3, 5e-4, 1e-4])
def test_precise_results_leave_the_impact_that_has_them(sd: float):
    """The likelihood of exact e_n and e_t is the density of the scatter there over their Jacobian, however exact.

    The next term is of the order of the square of what they leave of the scatter.
    """
    scene, degrees, wide, step = Scene.load("lactose-pvp"), [55.0, 57.0, 63.0], 0.02, 1e-5
    speed, angle = np.array([9.0, 17.0, 14.0]) / scene.stokes_per_speed, np.radians(degrees)
    moves = step * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])[:, :, None]
    names = ("restitution", "tangential_restitution")
    found = collide_many(scene, speed=speed * (1 + wide * moves[:, 0]), angle=angle + wide * moves[:, 1], of=names,
                         rtol=1e-12)  # fmt: skip
    values = np.stack([found[name].values for name in names])
    jacobian = np.stack([values[:, 1] - values[:, 2], values[:, 3] - values[:, 4]]) / (2 * step)
    expected = -np.log(2 * np.pi) - np.log(np.abs(np.linalg.det(jacobian.transpose(2, 0, 1))))
    observed = {name: (each[0], np.full(3, sd)) for name, each in zip(names, values, strict=True)}
    data = Measurements(speed, angle, wide * speed, np.full(3, wide), np.full(3, -1, np.int8), observed)
    likelihood, value = Likelihood(scene, ("liquid.viscosity",), data), np.array([scene.entries["liquid.viscosity"]])
    likelihood.aim(value)
    left = sd * np.linalg.norm(np.linalg.inv(jacobian.transpose(2, 0, 1)), axis=(1, 2))
    np.testing.assert_array_less(np.abs(likelihood(value).plain - expected), left**2 + 0.05)


def test_lines_cross_a_change_where_a_result_is_steep_along_it():
    """The likelihood is that of many lines along the speeds, as the change of outcome depends on the speed alone."""
    scene, value = Scene.load("granulation"), np.array([2.4258])
    speed = np.array([0.088]) / scene.stokes_per_speed
    data = Measurements(
        speed, np.radians([60.32]), 0.0305 * speed, np.radians([1.189]), np.array([2], np.int8),
        {"restitution": (np.array([0.8943]), np.array([0.0361]))},
    )  # fmt: skip
    likelihood = Likelihood(scene, ("liquid.viscosity",), data)
    many = likelihood(value, Resolution(lines=31, nodes=16)).plain[0]  # along the speeds, before lines are turned
    likelihood.aim(value)
    assert likelihood(value).plain[0] == pytest.approx(many, abs=0.02)


def test_a_row_beyond_the_scatter_has_a_gradient():
    """An outcome far from any that the scatter allows has a finite log-likelihood, and a gradient with its sign."""
    scene = Scene.load("granulation")
    data = impacts(scene, [0.08], [0.0], [2], [np.nan])
    likelihood = Likelihood(scene, ("liquid.viscosity",), data)
    rows = [likelihood(np.array([value])) for value in (2.0, 1.9)]
    assert rows[0].plain[0] < -KNEE
    slope = (rows[0].rows[0] - rows[1].rows[0]) / 0.1
    assert rows[0].scores[0, 0] == pytest.approx(slope, rel=0.1)


def test_limit_is_smooth_and_monotonic():
    """The heavy tail joins the plain log-likelihood with its slope."""
    rows = np.array([-1.0, -KNEE, -KNEE - 1e-6, -100.0, -1e4])
    limited, slope = limit(rows)
    assert (np.diff(limited) < 0).all()
    assert (slope > 0).all()
    np.testing.assert_allclose(slope[:3], 1.0, atol=1e-6)


def test_rows_of_other_viscosity_are_those_of_such_a_scene():
    """A column of an entry gives each row the likelihood that it has in a scene with that entry."""
    scene = Scene.load("pendulum")
    data = impacts(scene, [1.5, 1.5], [60.0, 60.0], [2, 2], [0.3, 0.3])
    varied = replace(data, columns={"liquid.viscosity": np.array([12.0, 13.0])})
    names, values = ("liquid.film_thickness",), np.array([420e-6])
    together = Likelihood(scene, names, varied)(values).rows
    thicker = scene.with_entries({"liquid.viscosity": "13 Pa s"})
    alone = [Likelihood(one, names, data.subset(np.array([0])))(values).rows[0] for one in (scene, thicker)]
    np.testing.assert_allclose(together, alone, rtol=1e-9)


def test_a_rare_outcome_does_not_hide_what_was_measured():
    """A restitution counts also where its outcome is rare: the log-likelihood has no step at a probability of 1e-4."""
    seen = {"speed": [0.169], "angle [deg]": [24.0], "liquid.viscosity": [3.0], "restitution": [0.25], "outcome": ["B"]}
    density = log_likelihood("pendulum", seen, "liquid.film_thickness")
    common, rare = (density([height])[0] for height in (356.5e-6, 358e-6))
    assert abs(common - rare) < 0.1


def test_undecided_collisions_are_reported(monkeypatch: pytest.MonkeyPatch):
    """Where the budget of steps ends before some collisions do, their share of the scatter is that of drawn impacts."""
    few = partial(run_kernel, budget=30)
    monkeypatch.setattr(experiment, "run_kernel", few)
    scene = Scene.load("granulation")
    speed, angle, scatter = np.array([scene.speed_of(0.0317)]), np.array([1.0]), 0.01
    data = Measurements(speed, angle, scatter * np.ones(1), np.zeros(1), np.zeros(1, np.int8), {})
    likelihood = Likelihood(scene, ("particles.dry_restitution",), data)
    result = likelihood(np.array([0.99]), Resolution(grid=101))
    at = scatter * (np.arange(200) + 0.5 - 100) / 25  # within four standard deviations
    drawn = few(KernelImpacts(scene, speed + at, np.full(200, 1.0), {}), 1e-9, jumps=2)
    weight = np.exp(-((at / scatter) ** 2) / 2)
    share = weight[drawn["status"] > LAST_ANSWER].sum() / weight.sum()
    assert 0.01 < share < 0.99
    assert result.undecided[0] == pytest.approx(share, abs=0.03)
    assert result.probability[0] + result.undecided[0] <= 1 + 1e-9


def test_an_entry_of_zero_has_a_slope():
    """A contact angle that starts at 0 has steps of its own size for its differences."""
    seen = {"stokes": [0.05], "angle [deg]": [45.0], "outcome": ["SRS"]}
    density = log_likelihood("granulation", seen, "bridge.contact_angle")
    (low, slope), (high, _) = density([0.0]), density([1e-2])
    assert slope["bridge.contact_angle"] == pytest.approx((high - low) / 1e-2, rel=0.1, abs=0.1)
