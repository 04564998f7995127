"""Every event that a phase could end on, watched along an engine's own solution of the phase."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from casadi import SX, Function, densify, jtimes, vertcat

from ...host.thread_caches import own_cache
from ...model.phases import Flow, event_table, expressions

# Parts of a phase at which its events are looked at, denser towards its ends, where the fast transients are.
_EVENLY = np.linspace(0, 1, 33)
POINTS = _EVENLY**3 * (10 - 15 * _EVENLY + 6 * _EVENLY**2)
_FINER, _LOOKS = 34, 3  # points within an interval that may hold a minimum, and how often it is narrowed down
_LOW = 0.2  # of the largest value in the phase: minima below are looked at
_ERRORS = 1e2  # tolerances of the engine by which a guard may be negative
# Least sizes, in x0 or v0, of guards that are a gap or a velocity; others have that of their largest value.
_LEAST = {"turning": 1e-3, "contact": 1e-3, "film_edge": 1.0, "tangential_edge": 1.0, "rupture": 1.0}
_MET = ("glass", "contact", "half_turn", "unwinding")  # a stick does not end just there unless this is its event
_SHORT = 1e-15  # in x0/v0: a phase no longer than the rounding of a gap
_ROUNDED = 1e-15  # of a guard's terms: glass met within rounding of initial contact, slip that ends at once

Solution = Callable[[np.ndarray], np.ndarray]
"""Parts of a phase's duration, increasing, from 0 to 1 -> states as columns."""


@dataclass(frozen=True)
class Crossing:
    """An event whose guard is negative inside a phase: name, fraction of the duration, and the guard over its size."""

    event: str
    fraction: float
    value: float


@own_cache(512)
def guards(flow: Flow) -> tuple[Function, tuple[str, ...]]:
    """Function (states, groups and motion) -> guards and their rates, and the names of their events."""
    parts, motion = expressions(flow), SX.sym("motion")
    table = event_table(flow, motion)
    values = vertcat(*table.values()) if table else SX(0, 1)
    rates = jtimes(values, parts.variables, parts.rates) if table else SX(0, 1)
    inputs = [parts.variables, vertcat(flow.model.parameters, motion)]
    return Function("guards", inputs, [densify(values), densify(rates)]), tuple(table)


def first_crossing(
    flow: Flow,
    parameters: np.ndarray,
    duration: float,
    states: np.ndarray,
    solution: Solution,
    rtol: float,
    landed: str | None,
) -> Crossing | None:
    """The first event that happens inside a phase, by more than the engine's error; None if the phase is as recorded.

    Guards are looked at in `POINTS`, and in the minima between these, which their slopes show: each is narrowed down,
    so that a graze is seen at a millionth of the guard's size.

    Arguments:
        parameters: groups, then the direction of motion.
        states: the solution at `POINTS`, as columns.
        solution: the same at any increasing parts.
        rtol: tolerance of the engine.
        landed: the event that ends the phase; None if nothing does, so that guards count at its end as well.
    """
    function, names = guards(flow)
    if not names or duration <= _SHORT:
        return None
    values, rates = (result.full() for result in function(states, parameters))
    rates *= duration
    crossings = []
    for k, name in enumerate(names):
        size = _size(name, values[k])
        limit = -_error(name, values[k], states, rtol)
        if landed is None and name in _MET and values[k][-1] < -limit:
            crossings.append(Crossing(name, 1.0, float(values[k][-1]) / size))
        inner = slice(1, None if landed is None else -1)
        below = np.flatnonzero(values[k][inner] < limit)
        if below.size:
            at = 1 + int(below[0])
            crossings.append(Crossing(name, _root(POINTS, values[k], at), float(values[k][at]) / size))
            continue
        for at in _low_minima(POINTS, values[k], rates[k], _LOW * size):

            def guard(parts: np.ndarray, k: int = k) -> tuple[np.ndarray, np.ndarray]:
                inside, slopes = (result.full() for result in function(solution(parts), parameters))
                return inside[k], slopes[k] * duration

            dip = _narrowed(guard, POINTS[at], POINTS[at + 1], limit)
            if dip is not None:
                crossings.append(Crossing(name, dip[0], dip[1] / size))
                break
    return min(crossings, key=lambda crossing: crossing.fraction, default=None)


def is_met(flow: Flow, parameters: np.ndarray, states: np.ndarray, event: str, rtol: float) -> bool:
    """True if the last of a phase's states lies on an event's surface, to the error of an engine of this tolerance."""
    function, names = guards(flow)
    if event not in names:
        return False
    values = function(states, parameters)[0].full()[names.index(event)]
    return bool(abs(values[-1]) <= _error(event, values, states, rtol))


def _error(name: str, values: np.ndarray, states: np.ndarray, rtol: float) -> float:
    """How far a guard of an engine's solution may be off: by its tolerance, or the rounding of its terms."""
    terms = 1.0 if name in _LEAST else max(1.0, float(np.abs(states).max()))
    return max(_ERRORS * rtol * _size(name, values), _ROUNDED * terms)


def _size(name: str, values: np.ndarray) -> float:
    """The size of an event's guard in a phase, by which its values are judged."""
    return max(float(np.abs(values).max()), _LEAST.get(name, 0.0))


def _root(parts: np.ndarray, values: np.ndarray, after: int) -> float:
    """The part at which a guard vanishes on the line through the points around it."""
    before, low, high = parts[after - 1], values[after], values[after - 1]
    return float(before + (parts[after] - before) * (high / (high - low) if high > 0 else 0.0))


def _low_minima(parts: np.ndarray, values: np.ndarray, rates: np.ndarray, low: float) -> np.ndarray:
    """Intervals in which the cubic through values and slopes has a minimum below `low`."""
    dips = np.flatnonzero((rates[:-1] < 0) & (rates[1:] > 0))
    step = np.diff(parts)[dips]
    first, last = values[dips], values[dips + 1]
    slope, end = rates[dips] * step, rates[dips + 1] * step
    cubic, square = 2 * (first - last) + slope + end, 3 * (last - first) - 2 * slope - end
    root = np.sqrt(np.maximum(square**2 - 3 * cubic * slope, 0.0))
    with np.errstate(all="ignore"):
        at = np.where(np.abs(cubic) > 1e-14 * np.abs(square), (root - square) / (3 * cubic), -slope / (2 * square))
    at = np.clip(np.nan_to_num(at, nan=0.5), 0.0, 1.0)
    least = ((cubic * at + square) * at + slope) * at + first
    intervals: np.ndarray = dips[least < low]
    return intervals


def _narrowed(
    guard: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], start: float, end: float, limit: float
) -> tuple[float, float] | None:
    """Place and value of a guard's minimum below the limit within an interval; None if there is none."""
    for _ in range(_LOOKS):
        parts = np.linspace(start, end, _FINER)
        values, rates = guard(parts)
        at = 1 + int(np.argmin(values[1:-1]))
        if values[at] < limit:
            return float(parts[at]), float(values[at])
        turning = np.flatnonzero((rates[:-1] < 0) & (rates[1:] > 0))
        if not turning.size:
            return None
        nearest = turning[np.argmin(values[turning])]
        start, end = float(parts[nearest]), float(parts[nearest + 1])
    return None
