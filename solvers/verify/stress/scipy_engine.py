"""Collisions by scipy's integrators, with the same equations, events, stopping rule and certificates as our engines.

`solve_ivp` is used as documented: terminal events with a direction, an analytic Jacobian for implicit methods, our
tolerances. Optimisations of an experienced user are included: parameters bound once, all guards of a step in one call,
one call of `solve_ivp` from event to event, and grazing minima searched afterwards on the steps taken (as events of
their own they double LSODA's time).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...engines.casadi.integrators import EventHit, tolerance_for
from ...engines.casadi.locate import EventLocator, EventSequence
from ...model.model import Model
from .numpy_equations import Bound, Equations, equations

IMPLICIT = ("LSODA", "Radau")  # methods that take a Jacobian
_SPANS = (1e4, 1e8, 1e16)  # x0/v0; a trajectory fails after their sum
_TIGHTEST = 2.3e-14  # smallest relative tolerance that scipy accepts without a warning
_UNREACHABLE = -1e30  # a certificate's level


class _Table:
    """All guard functions of a step, evaluated once."""

    def __init__(self, evaluate: Bound) -> None:
        self.evaluate = evaluate
        self._time, self._y = math.nan, np.zeros(0)
        self._values: list[float] = []

    def event(self, index: int) -> Callable[[float, np.ndarray], float]:
        """One event for `solve_ivp`, terminal where its guard decreases through zero."""

        def value(t: float, y: np.ndarray) -> float:
            if t != self._time or y is not self._y:
                self._values = self.evaluate(t, y).tolist()
                self._time, self._y = t, y
            return self._values[index]

        value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]  # how scipy wants it said
        return value


class ScipyLocator(EventLocator):
    """A locator with a scipy method; rules, phases and certificates are those of our engines.

    Arguments:
        method: a method of `solve_ivp`.
    """

    def __init__(self, model: Model, groups: dict[str, float], rtol: float, method: str) -> None:
        super().__init__(model, groups, rtol)
        self.method = method
        tolerance = tolerance_for(rtol, "rosenbrock", groups)
        self.options: dict[str, Any] = {
            "method": method,
            "rtol": max(tolerance.relative, _TIGHTEST),
            "atol": tolerance.absolute,
        }

    def _run_phase(self) -> bool:
        """Integrate a phase as `EventLocator._run_phase` does, with few long calls instead of short intervals."""
        found, elapsed = equations(self._flow(), self.watch), 0.0
        for span in _SPANS:
            level = self.proof.level(self.y, self.phase) if self.watch.certificate else None
            stop = self._solved(found, span, _UNREACHABLE if level is None else level)
            elapsed += stop.time
            self.path.time += stop.time
            self.y = self.path.y = stop.y
            self.path.smallest_gap = min(self.path.smallest_gap, float(self.y[0]))
            if stop.event is not None and stop.event != "certified":
                return self._happens(stop.event, elapsed)
            if self._proved(elapsed):
                return True
        raise self._error(f"no event within {elapsed:.3g} x0/v0", "try a smaller rtol")

    def _solved(self, found: Equations, span: float, level: float) -> EventHit:
        """Integrate to the first event, or to the end of the span."""
        parameters = np.append(self.p, [self.phase.motion, level])
        table = _Table(Bound(found.table, parameters))
        rates = Bound(found.rates, parameters)
        options: dict[str, Any] = {"events": [table.event(k) for k in range(len(found.events))]}
        if self.method in IMPLICIT:
            options["jac"] = Bound(found.jacobian, parameters)
        solution = self._integrated(rates, 0.0, span, self.y, options)
        grazed = self._grazed(found, solution, rates, table.evaluate)
        if grazed is not None:
            return grazed
        for name, times, states in zip(found.events, solution.t_events, solution.y_events):
            if len(times):
                return EventHit(name, float(times[-1]), states[-1].copy(), False)
        return EventHit(None, float(solution.t[-1]), solution.y[:, -1].copy(), False)

    def _integrated(self, rates: Bound, start: float, end: float, y: np.ndarray, more: dict[str, Any]) -> Any:
        from scipy.integrate import solve_ivp

        try:
            solution = solve_ivp(rates, (start, end), y, **self.options, **more)
        except (ArithmeticError, ValueError) as error:
            raise self._error(f"{self.method} failed ({error})", "") from None
        if solution.status < 0 or not np.isfinite(solution.y[:, -1]).all():
            raise self._error(f"{self.method} failed ({solution.message})", "")
        return solution

    def _grazed(self, found: Equations, solution: Any, rates: Bound, table: Bound) -> EventHit | None:
        """The first crossing hidden within a step, where a guard becomes negative and returns.

        A cubic through values and slopes at the ends shows candidates; there the step is integrated again and searched.
        """
        times, states = solution.t, solution.y
        values = np.array([table(0.0, y) for y in states.T])
        hidden = []
        for position, index in enumerate(found.dips):
            g, slope = values[:, index], -values[:, len(found.events) + position]
            turns = np.flatnonzero((slope[:-1] < 0) & (slope[1:] > 0) & (g[:-1] > 0) & (g[1:] > 0))
            hidden += [(int(k), index) for k in turns if _lowest(g, slope, times, int(k)) < 0]
        for k, index in sorted(hidden):
            dense = self._integrated(rates, times[k], times[k + 1], states[:, k], {"dense_output": True}).sol
            trials = np.linspace(times[k], times[k + 1], 65)
            below = [t for t in trials if table(0.0, dense(t))[index] < 0]
            if below:
                time = _bisected(lambda t: bool(table(0.0, dense(t))[index] < 0), times[k], below[0])  # noqa: B023 # used at once
                return EventHit(found.events[index], time, dense(time), True)
        return None


def _lowest(g: np.ndarray, slope: np.ndarray, times: np.ndarray, k: int) -> float:
    """The smallest value of the cubic through both ends of step k."""
    s, h = np.linspace(0, 1, 33), times[k + 1] - times[k]
    cubic = (
        (1 + 2 * s) * (1 - s) ** 2 * g[k]
        + s * (1 - s) ** 2 * h * slope[k]
        + s**2 * (3 - 2 * s) * g[k + 1]
        + s**2 * (s - 1) * h * slope[k + 1]
    )
    return float(cubic.min())


def _bisected(below: Callable[[float], bool], before: float, after: float) -> float:
    """Time at which `below` becomes true, to machine precision."""
    while before < (middle := 0.5 * (before + after)) < after:
        before, after = (before, middle) if below(middle) else (middle, after)
    return after


def locate_by_scipy(model: Model, groups: dict[str, float], rtol: float, method: str) -> EventSequence:
    """The trajectory of a collision by a scipy method. ComputationError if it does not reach an end."""
    return ScipyLocator(model, groups, rtol, method).run()
