"""Probabilities of outcomes with the uncertainty of a fit, held against other ways to the same integral."""

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, Scene, collide_many, fit, log_likelihood

from tests.helpers.synthetic import drawn

from .test_fit import ROUGHNESS, VISCOSITY, plan


@pytest.mark.slow
def test_probabilities_are_those_of_the_posterior():
    """With one entry they are sums over a fine grid of its values, each weighted by its likelihood."""
    scene = Scene.load("pendulum")
    data = drawn(scene, plan(scene, 8, (0.5, 3.0)), 2)
    found = fit(scene, data, VISCOSITY, starts=0)
    speed, angle = np.geomspace(0.3, 1.0, 9), np.array([0.2, 0.8])
    share = found.predict(speed=speed, angle=angle)["probability"]
    assert share.sum("outcome").values == pytest.approx(1.0)
    estimate = found.estimates[VISCOSITY]
    values = np.geomspace(0.7 * estimate.low, 1.4 * estimate.high, 80)
    density = log_likelihood(found.scene, data, VISCOSITY)
    weight = np.exp(np.array([density([value])[0] for value in values]) - found.log_likelihood)
    grid = [each.ravel() for each in np.meshgrid(values, angle, speed, indexing="ij")]
    outcome = collide_many(scene, speed=grid[2], angle=grid[1], vary={VISCOSITY: grid[0]}).outcome.values
    sticks = np.tensordot(weight / weight.sum(), outcome.reshape(80, 2, 9) == 0, 1)
    assert 0.02 < sticks.mean() < 0.98
    # the standard error of a share of 200 draws is 0.035; quasi-random ones have less
    assert share.sel(outcome="stick").values == pytest.approx(sticks, abs=0.03)


def test_what_the_data_do_not_tell_is_not_predicted_in_silence():
    """A roughness that may lie anywhere below a bound is drawn within the range of the search, or refused."""
    found = fit("pendulum", {"stokes": [1.2], "angle": [0.3], "outcome": ["stick"]}, [VISCOSITY, ROUGHNESS], starts=0)
    try:
        data = found.predict(speed=[0.5], angle=[0.3])
    except ComputationError as error:
        assert "give priors" in str(error)
    else:
        assert 8 <= data.attrs["effective_draws"] <= 256
