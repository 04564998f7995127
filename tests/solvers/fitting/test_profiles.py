"""Ends of intervals, of likelihoods whose profiles are known."""

import numpy as np
import pytest
from wetdoublet.solvers.fitting.free_entries import FreeEntries, FreeEntry
from wetdoublet.solvers.fitting.likelihood import Evaluation
from wetdoublet.solvers.fitting.optimise import DROP, Optimum
from wetdoublet.solvers.fitting.profiles import intervals

from tests.benchmarks.intervals import ends


class Product:
    """Two measurements: x y = 1 to a relative `narrow`, and x = 1 to `wide`."""

    size, constant = 2, np.zeros(2)

    def __init__(self, narrow: float, wide: float) -> None:
        self.narrow, self.wide = narrow, wide

    def refine(self, values, tolerance, at_least=False):
        """Nothing is integrated."""
        return False

    def __call__(self, values, resolution=None):
        x, y = values
        residuals = np.array([(x * y - 1) / self.narrow, (x - 1) / self.wide])
        slopes = np.array([[y / self.narrow, x / self.narrow], [1 / self.wide, 0.0]])
        rows, none = -(residuals**2) / 2, np.zeros(2)
        return Evaluation(rows, -residuals[:, None] * slopes, rows, none, none, {}, {})


@pytest.mark.parametrize("log", [True, False])
@pytest.mark.parametrize(("narrow", "wide"), [(0.003, 0.1), (0.01, 1.0), (0.1, 0.3), (0.1, 1.0)])
def test_ends_on_a_curved_ridge(narrow: float, wide: float, log: bool):
    """The other entry follows the ridge: the ends are those of the level line, in closed form."""
    free = FreeEntries(tuple(FreeEntry(name, 1.0, log, 0.05, 20.0) for name in ("x", "y")))
    best = Optimum(free.inner(np.ones(2)), 0.0)
    _, ends = intervals(Product(narrow, wide), free, best)
    turn = np.linspace(0, 2 * np.pi, 400_001)
    x = 1 + wide * np.sqrt(2 * DROP) * np.cos(turn)
    with np.errstate(divide="ignore"):
        y = (1 + narrow * np.sqrt(2 * DROP) * np.sin(turn)) / x
    inside = (x > 0.05) & (x < 20) & (y > 0.05) & (y < 20)
    level = np.array([x[inside], y[inside]])
    for k, both in enumerate(ends):
        for end, edge in zip(both, (level[k].min(), level[k].max()), strict=True):
            at_bound = edge < 0.0501 or edge > 19.9
            assert end.open == at_bound
            drop = 0.02 * (level[k].max() - level[k].min())  # the root of twice the drop is met to 1 %
            assert free.values(end.inner)[k] == pytest.approx(edge, abs=drop)


@pytest.mark.slow
@pytest.mark.usefixtures("optimized")
def test_rows_have_the_lines_that_they_need_at_the_ends():
    """Two rows need 21 lines at an end, and 3 where the information matrix has it: the end stood 2.9 % off."""
    errors = [
        abs(error) for *_, error, _ in ends(range(316, 317))
    ]  # of the half width, beside a ten times finer integral
    assert len(errors) == 4
    assert max(errors) < 0.01


class Valleys(Product):
    """x = 1 to 0.05 (1 + y), where y is 1 or, half a unit of the logarithm less likely, 5."""

    size, constant = 3, np.zeros(3)

    def __call__(self, values, resolution=None):
        x, y = values
        wide = 0.05 * (1 + y)
        residuals = np.array([(y - 1) * (y - 5) / self.narrow, (x - 1) / wide, (y - 1) / 4])
        slopes = np.array([[0.0, (2 * y - 6) / self.narrow], [1 / wide, (1 - x) / wide**2 / 20], [0.0, 0.25]])
        rows, none = -(residuals**2) / 2, np.zeros(3)
        return Evaluation(rows, -residuals[:, None] * slopes, rows, none, none, {}, {})


def test_an_end_lies_in_the_valley_that_goes_farther():
    """The most likely y is 1; the interval of x is that along the y of the start, which is 5."""
    free = FreeEntries(tuple(FreeEntry(name, start, False, 0.05, 20.0) for name, start in (("x", 1.0), ("y", 5.0))))
    _, (ends, _) = intervals(Valleys(0.2, 0.0), free, Optimum(free.inner(np.ones(2)), 0.0))
    half = 0.3 * np.sqrt(2 * (DROP - 0.5))
    assert [free.values(end.inner)[0] for end in ends] == pytest.approx([1 - half, 1 + half], abs=0.02)
