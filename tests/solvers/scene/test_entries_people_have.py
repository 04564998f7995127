"""Entries as people have them, each against the same scene written in the model's own quantities."""

from __future__ import annotations

import numpy as np
from wetdoublet.solvers import Scene, collide, collide_many

from ...helpers.entries import BASE, BRIDGE, refused, tables

ELASTIC = {"particles.youngs_modulus": "1 GPa", "particles.poisson_ratio": 0.3}


def scene(*parts, **without):
    """Return a scene of dotted entries."""
    entries = {}
    for part in parts:
        entries |= part
    return Scene.from_dict(tables(entries), from_file=True)


def test_without_a_glass_pressure_nothing_says_glass():
    """A liquid without glass-transition pressure collides as one that never reaches it, by either engine."""
    with_, without = (
        scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": "1e30 Pa"}),
        scene(BASE, BRIDGE, {"liquid.glass_transition_pressure": None}),
    )
    stokes, angle = np.geomspace(0.01, 5, 12), np.tile([0.0, 0.7, 1.3], 4)
    for engine in ("taylor", "rosenbrock"):
        one, other = (collide_many(each, stokes=stokes, angle=angle, engine=engine) for each in (with_, without))
        assert np.array_equal(one.restitution, other.restitution)
        assert np.array_equal(one.outcome, other.outcome)
    said = str(collide(without, stokes=3.0, angle=0.7))
    assert "roughness" in said
    assert "glass" not in said


def test_something_must_stop_the_approach():
    """Without glass criterion, roughness and elastic constants no criterion is left, which is refused."""
    smooth = {**BASE, "liquid.glass_transition_pressure": None, "particles.roughness": "0 um"}
    assert refused(smooth).field == "particles.roughness"
    assert scene(smooth, ELASTIC).liquid.glass_transition_pressure is None
