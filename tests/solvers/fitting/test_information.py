"""The information of planned impacts: what the likelihood of a fit, or a closed form, says it is."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm
from wetdoublet.solvers import Scene, boundary, collide_many
from wetdoublet.solvers.fitting.information import information
from wetdoublet.solvers.fitting.likelihood import Likelihood
from wetdoublet.solvers.fitting.measurements import UNKNOWN, Measurements
from wetdoublet.solvers.fitting.scatter import Resolution

NOISE = 0.03

pytestmark = pytest.mark.usefixtures("optimized")


def planned(scene: Scene, stokes: list[float], degrees: list[float], speed_sd: float, angle_sd: float) -> Measurements:
    """Impacts with restitution to be measured, scatter relative and in degrees."""
    speed, size = np.array(stokes) / scene.stokes_per_speed, len(stokes)
    return Measurements(
        speed, np.radians(degrees), speed_sd * speed, np.full(size, np.radians(angle_sd)), np.full(size, UNKNOWN),
        {"restitution": (np.full(size, np.nan), np.full(size, NOISE))},
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("preset", "stokes", "degrees", "names"),
    [
        ("granulation", 0.12, 45.0, ("liquid.film_thickness", "liquid.viscosity"))  # bounce or stick-rotate-separate
    ],
)
def test_information_is_the_covariance_of_the_score(
    preset: str, stokes: float, degrees: float, names: tuple[str, ...]
) -> None:
    """Summed over the outcomes, and over a fine grid of measured restitutions, by the likelihood of the fit itself."""
    scene = Scene.load(preset)
    plan = planned(scene, [stokes], [degrees], 0.03, 0.5)
    values = np.array([scene.entries[name] for name in names])
    step = NOISE  # sums over normal distributions are their integrals to 1e-8
    seen = np.arange(-5 * NOISE, 1.6, step)
    rows = plan.subset(np.zeros(1 + 2 * seen.size, int))
    measured = np.concatenate([[np.nan], seen, seen])
    outcome = np.concatenate([[0], np.full(seen.size, 1), np.full(seen.size, 2)])
    data = replace(rows, outcome=outcome, observed={"restitution": (measured, rows.observed["restitution"][1])})
    likelihood = Likelihood(scene, names, data)
    likelihood.direction[:] = 0.0  # along the speeds
    found = likelihood(values, Resolution(lines=15, points=256, approximate=False))
    assert found is not None
    weight = np.exp(found.plain) * np.where(outcome == 0, 1.0, step)
    score = found.scores * values
    assert weight.sum() == pytest.approx(1, abs=1e-4)
    expected = (score * weight[:, None]).T @ score
    told = information(scene, names, values, plan)[0][0] * np.outer(values, values)
    assert told == pytest.approx(expected, rel=0.02, abs=0.01 * np.trace(expected) / 2)


def test_an_outcome_tells_what_the_boundary_says() -> None:
    """Head-on, with scatter in the speed alone: p = Phi((v - v*)/sd), and p'^2/(p (1 - p)) is known in closed form."""
    scene, name = Scene.load("granulation"), "liquid.viscosity"
    mu = float(scene.entries[name])

    def critical(viscosity: float) -> float:
        changed = scene.with_si({name: viscosity})
        [line] = boundary(changed, angle=[0.0]).changes
        return line[0].stokes / changed.stokes_per_speed

    h = 1e-4 * mu
    rate, middle = (critical(mu + h) - critical(mu - h)) / (2 * h), critical(mu)
    plan = planned(scene, [0.112, 0.118], [0.0, 0.0], 0.03, 0.0)
    z = (plan.speed - middle) / plan.speed_sd
    expected = (norm.pdf(z) / plan.speed_sd * rate) ** 2 / (norm.cdf(z) * norm.sf(z))
    alone, probability = information(scene, (name,), np.array([mu]), replace(plan, observed={}))
    assert alone[:, 0, 0] == pytest.approx(expected, rel=1e-3)
    assert probability[:, 2] == pytest.approx(norm.cdf(z), abs=1e-5)
    assert (information(scene, (name,), np.array([mu]), plan)[0] > alone).all()


def test_far_from_a_boundary_restitution_tells_its_derivative() -> None:
    """Scatter much smaller than the noise: the information is (de_n/dp)^2/(noise^2 + spread^2)."""
    from wetdoublet.solvers import sensitivities

    scene, name = Scene.load("pendulum"), "liquid.film_thickness"
    plan = planned(scene, [2.5], [20.0], 1e-4, 0.0)
    slope = sensitivities(scene, ["restitution"], [name], speed=float(plan.speed[0]), angle=float(plan.angle[0]))
    [[[found]]], _ = information(scene, (name,), np.array([scene.entries[name]]), plan)
    assert found == pytest.approx((slope.gradient["restitution"][name] / NOISE) ** 2, rel=1e-3)


@pytest.mark.slow
def test_a_restitution_beside_the_outcome_tells_no_less() -> None:
    """Total less outcome has no negative eigenvalue, also where all three outcomes meet and integrals are uncertain."""
    scene = Scene.load("granulation")
    names = ("liquid.viscosity", "bridge.volume")
    values = np.array([scene.entries[name] for name in names])
    plan = planned(scene, [0.11, 0.115], [24.0, 24.0], 0.03, 1.5)
    (total, probability), (alone, _) = (
        information(scene, names, values, each) for each in (plan, replace(plan, observed={}))
    )
    assert ((probability > 1e-3).sum(axis=1) == 3).any()
    scale = np.einsum("cii->c", total * np.outer(values, values))
    assert (np.linalg.eigvalsh((total - alone) * np.outer(values, values)).min(axis=1) >= -1e-9 * scale).all()


def test_gaps_of_a_density_are_no_information() -> None:
    """Head-on, noise far below the spread: what is told agrees with a density on a much finer grid of speeds."""
    scene = Scene.load("granulation")
    name = "liquid.viscosity"
    value = float(scene.entries[name])
    plan = planned(scene, [0.25], [0.0], 0.06, 0.0)
    plan = replace(plan, observed={"restitution": (plan.observed["restitution"][0], np.array([2e-4]))})
    found = information(scene, (name,), np.array([value]), plan)[0][0, 0, 0] * value**2
    z = np.linspace(-5, 5, 20001)
    speed, h = plan.speed[0] + plan.speed_sd[0] * z, 1e-4
    low, mid, high = (
        collide_many(scene.with_si({name: value * (1 + k * h)}), speed=speed, angle=0.0)["restitution"].values
        for k in (-1, 0, 1)
    )
    rate, slope = np.gradient(mid, z), (high - low) / (2 * h)
    moved = -slope / rate  # where an impact of the same restitution lies, as restitution rises with speed
    score = -z * moved + np.gradient(moved, z)
    expected = float(np.trapezoid(score**2 * norm.pdf(z), z))
    assert 0.9 * expected < found < 1.001 * expected
