"""What glass-transition pressure would give a printed St* at theta0 = 0."""

from __future__ import annotations

import math

from ..scene import Scene
from .desk import change_at

_ENTRY = "liquid.glass_transition_pressure"
_CLOSE = 1e-6  # relative, in St


def pressure_for(scene: Scene, stokes: float) -> float:
    """p_gt in Pa at which a head-on collision first bounces at `stokes`: secant in the logarithms."""
    from .. import boundary

    def reached(pressure: float) -> float:
        line = boundary(scene.with_entries({_ENTRY: pressure}), angle=0.0).changes[0]
        return math.log(change_at(line, "stick").stokes / stokes)

    pressure = scene.liquid.glass_transition_pressure
    before, here = math.log(pressure), math.log(pressure) + 0.05
    was, now = reached(math.exp(before)), reached(math.exp(here))
    while abs(now) > _CLOSE:
        before, here, was = here, here - now * (here - before) / (now - was), now
        now = reached(math.exp(here))
    return math.exp(here)
