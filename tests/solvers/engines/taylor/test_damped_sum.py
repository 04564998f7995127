"""The damped sum of creeping trajectories (solvers/engines/taylor/runtime/damped_sum.h): its table and its effect."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.engines.taylor import orders
from wetdoublet.solvers.engines.taylor.source import RUNTIME
from wetdoublet.solvers.host.compiler import compiler

HEADER = (RUNTIME / "damped_sum.h").read_text()
ROWS = {
    int(order): (tuple(Fraction(each) for each in row.split(",")), Fraction(reach))
    for row, order, reach in re.findall(r"\{([\d., ]+)\}, /\* (\d+): ([\d.]+) \*/", HEADER)
}


def test_all_orders_are_there():
    """The table has a row for every order that the runtime has, and these are more than the compiled ones."""
    assert set(ROWS) == {*range(orders.LEAST, orders.LARGEST + 1)}
    assert {order for _, order in orders.ORDERS} < set(ROWS)


@pytest.mark.parametrize("order", ROWS)
def test_a_decaying_mode_dies(order: int):
    """|R(z)| < 0.75 from z = 2.5 up to the row's z, where the series itself amplifies; in exact arithmetic."""
    factors, reach = ROWS[order]
    weights = [Fraction(1)] * (order - 2) + list(factors)
    # the last tenth printed may be rounded up, and the edge is steep
    for z in (Fraction(5, 2) + (reach - Fraction(1, 10) - Fraction(5, 2)) * k / 200 for k in range(201)):
        terms = [(-z) ** k / math.factorial(k) for k in range(order + 1)]
        assert abs(sum(w * term for w, term in zip(weights, terms, strict=True))) < 0.75
    assert abs(sum(terms)) > 10
    assert reach > 12


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_a_creeping_trajectory_takes_long_steps():
    """Past the saddle at 42.6 deg the tangential mode decays at a rate that is known in closed form: mean z beyond 6.

    At rest in the gap s the slip decays at (4/3)(x0/a)/St ln(2a/x) (1/4 + 5/16 2) or so, both arms of the couple; an
    undamped series is held to z < 5 all along.
    """
    scene = Scene.load("granulation")
    stokes, angle = 0.0662, math.radians(42.62)
    impacts = engine.KernelImpacts(scene, np.array([scene.speed_of(stokes)]), np.array([angle]), {})
    found = engine.run_kernel(impacts, 1e-8)
    assert found is not None
    assert found["outcome"][0] == 1
    aspect = 8 / 50
    rate = 4 / 3 * aspect / stokes * math.log(2 / (aspect * 0.85)) * (1 / 4 + 5 / 8)
    assert rate * found["time"][0] / found["steps"][0] > 6
