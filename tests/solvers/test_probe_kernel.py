"""What boundaries ask of a flight: the kernel's answers beside Rosenbrock's."""

from __future__ import annotations

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, probe
from wetdoublet.solvers.compiled import compiler
from wetdoublet.solvers.probe import Line

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
RTOL = 1e-9
# Angle, and a boundary at which a doublet begins to escape, from tests/data/boundaries.json to six digits.
LINES = {"granulation": (75.0, 0.0129581), "pendulum": (60.0, 0.9)}
PRESETS = tuple(LINES)


def lines(name: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Line, Line]:
    """The same line by the kernel and by Rosenbrock."""
    scene, angle = Scene.load(name), math.radians(LINES[name][0])
    kernel = Line(scene, angle, RTOL)
    assert kernel.kernel
    monkeypatch.setattr(probe, "knows", lambda _: False)
    other = Line(scene, angle, RTOL)
    assert not other.kernel
    return kernel, other


@pytest.mark.parametrize("name", PRESETS)
def test_the_approach(name: str, monkeypatch: pytest.MonkeyPatch):
    """The largest pressure of an approach, or its smallest gap, wherever in a step it lies, from where doublets escape
    on: below, Rosenbrock stops at a proof and the kernel does not.
    """
    kernel, other = lines(name, monkeypatch)
    for stokes in LINES[name][1] * np.geomspace(1.1, 100, 24):
        # tens of steps at RTOL each, and the pressure is 1/gap^2
        assert kernel.criterion(stokes) == pytest.approx(other.criterion(stokes), rel=0, abs=100 * RTOL)


@pytest.mark.parametrize("reversed_", [False, True])
@pytest.mark.parametrize("name", PRESETS)
def test_the_escape(name: str, reversed_: bool, monkeypatch: pytest.MonkeyPatch):
    """Whether a doublet separates, with the solids and without; its value has that sign."""
    kernel, other = lines(name, monkeypatch)
    for stokes in LINES[name][1] * np.geomspace(0.5, 30, 12):
        mine, theirs = (line.escape(stokes, reversed_) for line in (kernel, other))
        assert mine.separates == theirs.separates, stokes
        if mine.value is not None:
            assert (mine.value > 0) == mine.separates


@pytest.mark.parametrize("distance", [1e-3, 1e-5, 1e-7])
def test_creeping_past_the_saddle(distance: float, monkeypatch: pytest.MonkeyPatch):
    """Beside the boundary a flight that is cut short is decided as one that is flown to its end by Rosenbrock."""
    kernel, other = lines("granulation", monkeypatch)
    low, high = 0.0129580, 0.0129582
    for _ in range(40):  # the boundary by the kernel's own signs
        middle = math.sqrt(low * high)
        low, high = (low, middle) if kernel.escape(middle, False).separates else (middle, high)
    for side in (-1, 1):
        stokes = low * (1 + side * distance)
        assert kernel.escape(stokes, False).separates == other.escape(stokes, False).separates == (side > 0)


@pytest.mark.parametrize("name", PRESETS)
def test_scans(name: str, monkeypatch: pytest.MonkeyPatch):
    """Outcomes and first criteria of a scan in one call are those of single flights, and are counted alike."""
    kernel, other = lines(name, monkeypatch)
    grid = np.geomspace(1e-4, 100, 12).tolist()
    kernel.look(grid)
    assert kernel.collisions > 0
    before = kernel.collisions
    assert [kernel.outcome(stokes) for stokes in grid] == [other.outcome(stokes) for stokes in grid]
    assert [kernel.met(stokes) for stokes in grid] == [other.met(stokes) for stokes in grid]
    assert kernel.collisions == before == other.collisions


def test_what_is_handed_over(monkeypatch: pytest.MonkeyPatch):
    """A probe that the kernel hands over is Rosenbrock's."""
    kernel, other = lines("granulation", monkeypatch)
    monkeypatch.setattr(probe.by_kernel, "recorded", lambda *given, **more: None)
    assert kernel.outcome(0.02) == other.outcome(0.02)
    assert kernel.criterion(0.02) == other.criterion(0.02)
    assert kernel.escape(0.02, False) == other.escape(0.02, False)
