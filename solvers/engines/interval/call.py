"""One call of the enclosing engine."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from .build import RESULTS, TERMS, Engine, Why

_ALIGNED = 64  # bytes
Range = tuple[float, float]


REASONS = {
    Why.TOO_MANY_STEPS: "the budget of steps is spent",
    Why.STEP_TOO_SMALL: "the steps become too small",
    Why.GRAZE: "too near a boundary: an event is barely met or missed",
    Why.ORDER: "too near a boundary: two events at nearly the same instant",
    Why.START: "too near a boundary: a criterion is barely met at initial contact",
    Why.TOO_WIDE: "the set of trajectories becomes too wide",
    Why.TOO_MANY_REBOUNDS: "the budget of rebounds is spent",
    Why.CHATTER: "it comes to rest in contact, and may be released",
}
"""What is said of a collision that is not proved."""


class Settings(NamedTuple):
    """How a collision is enclosed.

    Arguments:
        order: of the series.
        steps: most steps.
        funnels: bounds over the gap, which prove the outcome, not the last digits: 0 none; 1 once the pair opens, and
            for a box where it is slow and turns; 2 on the approach, too.
        tolerance: of the remainder of a step.
        widest: the widest set that is followed, in units of the states.
        panel: relative width of the panels of these bounds; for a box at least this, and up to PANEL with its width.
        expected: the outcome to look for, as in `Enclosure`, so that nothing else is tried; 0 for any.
    """

    order: int
    steps: int
    funnels: int
    tolerance: float
    widest: float = 0.5
    panel: float = 0.01
    expected: int = 0


SHARP = Settings(14, 900, 0, 1e-13)  # what takes longer is proved with bounds over the gap, to fewer digits
OUTCOME = Settings(16, 20000, 1, 1e-15, panel=0.004)
BOX = Settings(8, 200, 2, 1e-9)
PANEL = 0.08  # bounds over wider panels lose more than they save (maps of 12 x 12 cells of granulation)


class Enclosure(NamedTuple):
    """What the engine has proved; `outcome` is 0 for nothing, then as in the report: stick, separation, bounce.

    Arguments:
        spread: the moving quantity that spread the set most, by number; -1 if none did.
    """

    outcome: int
    why: Why
    steps: int
    rebounds: int
    restitution: Range
    smallest_gap: float
    panels: int
    spread: int


_EXCHANGED = {"impact_spin": "impact_partner_spin", "impact_partner_spin": "impact_spin"}


def _inverse(low: float, high: float) -> Range:
    return math.nextafter(1 / high, 0.0), math.nextafter(1 / low, math.inf)


def enclose(engine: Engine, ranges: Mapping[str, Range], moving: tuple[str, ...], settings: Settings) -> Enclosure:
    """Enclose all collisions whose quantities lie in ranges.

    The spin that the angular momentum gives is that of the partner. Of unequal spheres that with less inertia comes
    first: the other states then grow with each other, and bounds over the gap lose little.

    Arguments:
        ranges: low and high of each quantity, SI; a quantity that is left out is absent.
        moving: quantities that are followed with derivatives, as many as the engine has parameters.
    """
    assert settings.order + 2 <= TERMS
    names = engine.quantities
    if "mass_ratio" in names and ranges["mass_ratio"][0] * ranges["radius_ratio"][0] ** 2 < 1:
        names = tuple(_EXCHANGED.get(name, name) for name in names)
        ranges = {**ranges, **{name: _inverse(*ranges[name]) for name in ("radius_ratio", "mass_ratio")}}
    pairs = np.array([ranges.get(name, (np.nan, np.nan)) for name in names])
    if moving:
        width = max(abs(ranges[name][1] - ranges[name][0]) / max(map(abs, ranges[name])) for name in moving)
        settings = settings._replace(panel=min(max(width, settings.panel), PANEL))
    columns = np.array([moving.index(name) if name in moving else -1 for name in names], np.int32)
    result, numbers = np.empty(RESULTS), np.array(settings, float)
    room = getattr(engine.rooms, "room", None)  # of this thread
    if room is None:
        room = engine.rooms.room = ctypes.create_string_buffer(engine.room + _ALIGNED)
    place = -(-ctypes.addressof(room) // _ALIGNED) * _ALIGNED
    data = (pairs.ctypes.data, columns.ctypes.data, numbers.ctypes.data, place, result.ctypes.data)
    engine.library.interval_prove(*data)
    outcome, why, steps, rebounds, _, low, high, gap, panels, spread = result.tolist()
    counts = (int(panels), int(spread))
    return Enclosure(int(outcome), Why(int(why)), int(steps), int(rebounds), (low + 0.0, high), gap, *counts)  # no -0.0
