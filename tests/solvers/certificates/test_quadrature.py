"""Works of attractions that have kinks and jumps, as the laws of a user may."""

import numpy as np
import pytest
from wetdoublet.solvers.certificates.quadrature import panels

EDGES = np.linspace(0.1, 3.0, 50)


@pytest.mark.parametrize("place", [0.5, 1.2345, 2.9])
def test_kinks_and_jumps_are_integrated_to_their_place(place: float) -> None:
    """A force that ends at a gap with or without a step: a triangle's and two rectangles' area; panel by panel, too."""
    ramp = panels(lambda gaps: np.maximum(place - gaps, 0.0), EDGES)
    assert ramp.sum() == pytest.approx((place - 0.1) ** 2 / 2, rel=1e-7)  # 1e-6 of one panel of 49
    assert np.all(ramp[EDGES[:-1] >= place] == 0.0)
    step = panels(lambda gaps: np.where(gaps < place, 1.0, 0.2), EDGES)
    assert step.sum() == pytest.approx(place - 0.1 + 0.2 * (3.0 - place), rel=1e-7)


def test_a_smooth_force_is_evaluated_once() -> None:
    """Twelve points a panel, to rounding: the integral of cos is sin; rounding noise is no kink."""
    points = []

    def force(gaps: np.ndarray) -> np.ndarray:
        points.append(gaps.size)
        return np.cos(gaps) + 1e-16 * np.sin(1e9 * gaps)

    assert np.cumsum(panels(force, EDGES)) == pytest.approx(np.sin(EDGES[1:]) - np.sin(0.1), abs=1e-14)
    assert points == [12 * 49]
