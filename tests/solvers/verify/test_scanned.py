"""The engines' event location against a search of the tests' own, which shares neither equations nor method."""

import math

import pytest
from wetdoublet.solvers import Scene, boundary, collide

from ...helpers.scanned import scan_of, scanned


@pytest.mark.parametrize(
    ("preset", "stokes", "degrees"),
    [
        ("granulation", 0.03, 60),
        ("granulation", 0.2, 0),
        ("granulation", 0.2, 75),
        ("granulation-dry-bridge", 0.03, 60),
        ("pendulum", 1.0, 45),
        ("pendulum", 1.3, 45),
        ("pendulum", 1.5, 0),
        ("pendulum", 1.5, 45),
    ],
)
def test_the_events_of_a_preset_are_those_of_a_dense_scan(preset: str, stokes: float, degrees: float) -> None:
    """Same events at the same times, and the same restitution; a stick's as far as both follow it."""
    scene = Scene.load(preset).with_entries({"impact.stokes": stokes, "impact.angle": math.radians(degrees)})
    found, expected = collide(scene, engine="rosenbrock"), scanned(scene)
    assert (found.outcome, found.reversal) == (expected.outcome, expected.reversal)
    assert found.restitution == pytest.approx(expected.restitution, rel=1e-7)
    both = min(len(found.events), len(expected.events))
    assert both
    assert [one.kind for one in found.events][:both] == [kind for kind, _ in expected.events][:both]
    times = [time for _, time in expected.events][:both]
    assert [one.time for one in found.events][:both] == pytest.approx(times, rel=1e-7)
    assert len(found.events) == len(expected.events) or found.outcome == "stick"


@pytest.mark.slow
def test_a_graze_is_where_a_dense_scan_has_it() -> None:
    """The Stokes number at which the film's pressure just reaches the glass transition, by bisection of scans."""
    scene = Scene.load("granulation").with_entries({"impact.angle": math.radians(45)})
    low, high = 0.1165, 0.1175
    for _ in range(20):
        middle = (low + high) / 2
        scan = scan_of(scene.with_impact(stokes=middle))
        scan.phase()
        low, high = (low, middle) if scan.result.reversal else (middle, high)
    changes = boundary(scene, angle=math.radians(45), stokes=(0.1, 0.13)).changes[0]
    assert [one.stokes for one in changes] == [pytest.approx(high, rel=1e-8)]
