"""What boundaries ask of a trajectory: samples beside collisions one by one, margins beside scenes that just meet a
criterion.
"""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide, collide_many
from wetdoublet.solvers.boundaries.scene_sampler import SceneSampler

RTOL = 1e-9
# Angle, and a boundary at which a doublet begins to escape, from tests/data/boundaries.json to six digits.
LINES = {"granulation": (75.0, 0.0129581), "pendulum": (60.0, 0.9)}
PRESETS = ("granulation", pytest.param("pendulum", marks=pytest.mark.slow))


@pytest.mark.parametrize("name", PRESETS)
def test_collisions_looked_at(name: str):
    """Outcome, first criterion, restitution and contact time of a scan are those of collisions by Rosenbrock."""
    scene, angle = Scene.load(name), math.radians(LINES[name][0])
    stokes = np.geomspace(1e-4, 100, 24)
    seen = SceneSampler(scene, RTOL)(np.full(stokes.size, angle), stokes)
    others = [collide(scene, stokes=one, angle=angle, engine="rosenbrock", ledger=False) for one in stokes]
    words = ("stick", "stick-rotate-separate", "bounce")
    assert [words[k] for k in seen["outcome"]] == [one.outcome for one in others]
    assert [k >= 0 for k in seen["reversal"]] == [one.reversal is not None for one in others]
    separates = np.flatnonzero(seen["outcome"] > 0)
    assert 0 < separates.size < stokes.size
    times = seen["time"] * scene.liquid.film_thickness / (stokes / scene.stokes_per_speed)
    for k in separates.tolist():  # 1e-9 by the conditioning
        assert seen["restitution"][k] == pytest.approx(others[k].restitution, rel=1e-6)
        assert times[k] == pytest.approx(others[k].contact_time, rel=1e-6)


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
