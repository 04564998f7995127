"""The glass-transition pressure that gives a printed St* at theta0 = 0."""

from __future__ import annotations

import math

from ..errors import ComputationError
from ..scene.scene import Scene
from .desk import Desk, change_at

_ENTRY = "liquid.glass_transition_pressure"
_CLOSE = 1e-6  # relative tolerance in St


def printed_pressure(scene: Scene) -> float:
    """p_gt of a preset of the paper in Pa."""
    return float(scene.entries[_ENTRY])


def pressure_for(desk: Desk, scene: Scene, stokes: float) -> str:
    """Text of the p_gt at which head-on collisions bounce from `stokes` on, or of the reason of failure."""
    try:
        return f"{_pressure(desk, scene, stokes) / 1e6:.3g} MPa"
    except ComputationError:
        return "a pressure that could not be computed"


def _pressure(desk: Desk, scene: Scene, stokes: float) -> float:
    """p_gt in Pa, by the secant method in logarithms."""

    def reached(pressure: float) -> float:
        [line] = desk.lines(scene.with_entries({_ENTRY: pressure}), (0.0,))
        return math.log(change_at(line, "stick").stokes / stokes)

    pressure = printed_pressure(scene)
    before, here = math.log(pressure), math.log(pressure) + 0.05
    was, now = reached(math.exp(before)), reached(math.exp(here))
    while abs(now) > _CLOSE:
        before, here, was = here, here - now * (here - before) / (now - was), now
        now = reached(math.exp(here))
    return math.exp(here)
