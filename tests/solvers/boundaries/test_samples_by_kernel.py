"""What boundaries ask of a trajectory: the kernel's answers beside Rosenbrock's."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.boundaries.line import Line
from wetdoublet.solvers.boundaries.scene_sampler import SceneSampler
from wetdoublet.solvers.host.compiler import compiler

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
RTOL = 1e-9
# Angle, and a boundary at which a doublet begins to escape, from tests/data/boundaries.json to six digits.
LINES = {"granulation": (75.0, 0.0129581), "pendulum": (60.0, 0.9)}
PRESETS = ("granulation", pytest.param("pendulum", marks=pytest.mark.slow))


@pytest.mark.parametrize("name", PRESETS)
def test_collisions_looked_at(name: str):
    """Outcome, first criterion, restitution and contact time of a scan in one call are those of single collisions."""
    scene, angle = Scene.load(name), math.radians(LINES[name][0])
    stokes = np.geomspace(1e-4, 100, 24)
    angles = np.full(stokes.size, angle)
    kernel, other = (SceneSampler(scene, RTOL)(angles, stokes), SceneSampler(scene, RTOL, kernel=False)(angles, stokes))
    for field in ("stokes", "outcome", "reversal"):
        assert kernel[field].tolist() == other[field].tolist()
    separates = kernel["outcome"] > 0
    assert separates.any() and not separates.all()
    for field in ("restitution", "time"):
        assert kernel[field][separates] == pytest.approx(other[field][separates], rel=1e-6)  # 1e-9 by its conditioning


@pytest.mark.parametrize("name", PRESETS)
def test_margins(name: str):
    """The margin of the rebound criteria is the one of the approach alone, and positive where one was met.

    Its maximum is taken at nine places of each step, which it is nearer to than to one part in a hundred.
    """
    scene, angle = Scene.load(name), math.radians(LINES[name][0])
    line = Line(scene, angle, RTOL)
    stokes = LINES[name][1] * np.geomspace(1.1, 100, 12)
    seen = SceneSampler(scene, RTOL)(np.full(stokes.size, angle), stokes)
    assert ((seen["criterion"] > 0) == (seen["reversal"] >= 0)).all()
    assert seen["criterion"] == pytest.approx([line.criterion(one) for one in stokes], abs=0.01)
