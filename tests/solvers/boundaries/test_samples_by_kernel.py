"""What boundaries ask of a trajectory: samples beside collisions one by one, margins beside scenes that just meet a
criterion.
"""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.boundaries.samples_by_kernel import SceneSampler

RTOL = 1e-9
# Angle, and a boundary at which a doublet begins to escape, from tests/data/boundaries.json to six digits.
LINES = {"granulation": (75.0, 0.0129581), "pendulum": (60.0, 0.9)}
PRESETS = ("granulation", pytest.param("pendulum", marks=pytest.mark.slow))


@pytest.mark.parametrize("name", PRESETS)
def test_margins(name: str):
    """With pressure and contact gap moved by the margin, a hundredth more or less, the criterion is met or missed.

    The largest pressure is taken at nine places of each step, which it is nearer to than to one part in a hundred.
    """
    angle = math.radians(LINES[name][0])
    tables = Scene.load(name).to_dict()
    for entry in ("youngs_modulus", "poisson_ratio"):
        del tables["particles"][entry]
    scene = Scene.from_dict(tables)
    stokes = LINES[name][1] * np.geomspace(1.1, 10, 12)  # faster ones are not slowed before they are close to touch
    seen = SceneSampler(scene, RTOL)(np.full(stokes.size, angle), stokes)
    assert ((seen["criterion"] > 0) == (seen["reversal"] >= 0)).all()
    given = scene.entries
    for aside, is_met in ((-0.01, True), (0.01, False)):
        factor = np.exp(seen["criterion"] + aside)
        vary = {
            "liquid.glass_transition_pressure": given["liquid.glass_transition_pressure"] * factor,
            "particles.roughness": given["particles.roughness"] / factor,
        }
        moved = collide_many(scene, stokes=stokes, angle=angle, vary=vary, of=("reversal",))
        assert ((moved.reversal.values >= 0) == is_met).all()
