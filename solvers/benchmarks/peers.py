"""Collisions by scipy's integrators: the same equations, events, stop rule and certificate as our engines.

`solve_ivp` is used as its documentation asks: terminal events with a direction, an analytic Jacobian for the implicit
methods, tolerances per component as ours. What a practised user would add is here as well: all event functions in one
call a step, remembered for the other events; one call from event to event instead of stretches.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import ComputationError
from ..integrators import Stop, tolerance
from ..locate import Locate, Path, Step
from ..model import Model
from ..phases import Watch
from .bound import Callback, Equations, bound, equations

PEERS = ("LSODA", "Radau")
_SPANS = (1e4, 1e8, 1e16)  # x0/v0: a flight is given up after their sum
_UNREACHABLE = -1e30


class _Table:
    """All event functions of a step, evaluated once."""

    def __init__(self, evaluate: Callback) -> None:
        self._evaluate = evaluate
        self._time, self._y = math.nan, np.zeros(0)
        self._values: list[float] = []

    def at(self, t: float, y: np.ndarray) -> list[float]:
        if t != self._time or y is not self._y:
            self._values = self._evaluate(t, y).tolist()
            self._time, self._y = t, y
        return self._values

    def event(self, index: int, terminal: bool) -> Callable[[float, np.ndarray], float]:
        """The function of one event as `solve_ivp` takes it."""

        def value(t: float, y: np.ndarray) -> float:
            return self.at(t, y)[index]

        value.terminal, value.direction = terminal, -1.0  # type: ignore[attr-defined]  # as scipy wants it
        return value


class Flight(Locate):
    """A collision by one of scipy's methods; rules, phases and proofs are inherited.

    Arguments:
        method: a method of `solve_ivp`.
    """

    def __init__(self, model: Model, groups: dict[str, float], rtol: float, method: str) -> None:
        super().__init__(model, groups, rtol)
        self.method = method
        self.tolerance = tolerance(rtol, "rosenbrock", groups)
        self.evaluations = 0

    def _fly(self) -> bool:
        """As `Locate._fly`, with one long call where that goes by stretches."""
        found, flown = equations(self._flow(), self.watch), 0.0
        for span in _SPANS:
            level = self.proof.level(self.y, self.phase) if self.watch.certificate else None
            stop = self._solved(found, span, _UNREACHABLE if level is None else level)
            flown += stop.time
            self.path.time += stop.time
            self.y = self.path.y = stop.y
            self.path.smallest_gap = min(self.path.smallest_gap, float(self.y[0]))
            if stop.event not in (None, "certified"):
                return self._act(str(stop.event), flown)
            if self._proved():
                self._stop(Step(self.phase, flown, None, ()))
                self.path.certified = self.proof.theorem
                return True
        raise self._error(f"no event within {flown:.3g} x0/v0", "try a smaller rtol")

    def _solved(self, found: Equations, span: float, level: float) -> Stop:
        """Integrate to the first event, or to the end of the span."""
        from scipy.integrate import solve_ivp

        parameters = np.append(self.p, [self.phase.motion, level])
        table = _Table(bound(found.table, parameters))
        events = [table.event(k, terminal=True) for k in range(len(found.events))]
        events += [table.event(len(found.events) + k, terminal=False) for k in range(len(found.dips))]
        options: dict[str, Any] = {"rtol": self.tolerance.relative, "atol": self.tolerance.absolute}
        if self.method in PEERS:
            options["jac"] = bound(found.jacobian, parameters)
        rates = bound(found.rates, parameters)
        try:
            solution = solve_ivp(rates, (0.0, span), self.y, self.method, events=events, **options)
        except (ArithmeticError, ValueError) as error:
            raise self._error(f"{self.method} failed ({error})", "") from None
        self.evaluations += int(solution.nfev)
        if solution.status < 0 or not np.isfinite(solution.y[:, -1]).all():
            raise self._error(f"{self.method} failed ({solution.message})", "")
        grazed = self._grazed(found, solution, table)
        if grazed is not None:
            return grazed
        for name, times, states in zip(found.events, solution.t_events, solution.y_events, strict=False):
            if len(times):
                return Stop(name, float(times[-1]), states[-1].copy(), False)
        return Stop(None, float(solution.t[-1]), solution.y[:, -1].copy(), False)

    def _grazed(self, found: Equations, solution: Any, table: _Table) -> Stop | None:
        """The first minimum below zero that the signs at the ends of steps do not show, bisected to its crossing."""
        from scipy.integrate import solve_ivp

        below: list[tuple[float, int]] = []
        for k, index in enumerate(found.dips):
            times, states = solution.t_events[len(found.events) + k], solution.y_events[len(found.events) + k]
            below += [(float(t), index) for t, y in zip(times, states) if table.at(math.nan, y)[index] < 0]
        if not below:
            return None
        last, index = min(below)
        parameters = np.append(self.p, [self.phase.motion, _UNREACHABLE])
        dense = solve_ivp(
            bound(found.rates, parameters),
            (0.0, last),
            self.y,
            self.method,
            dense_output=True,
            rtol=self.tolerance.relative,
            atol=self.tolerance.absolute,
        ).sol
        before, after = 0.0, last
        while after - before > 4e-16 * last:
            middle = 0.5 * (before + after)
            if not before < middle < after:
                break
            before, after = (before, middle) if table.at(math.nan, dense(middle))[index] < 0 else (middle, after)
        return Stop(found.events[index], after, dense(after), True)


def fly(model: Model, groups: dict[str, float], rtol: float, method: str) -> Path:
    """The flight of a collision by a scipy method. ComputationError if it does not come to an end."""
    return Flight(model, groups, rtol, method).run()


__all__ = ["PEERS", "ComputationError", "Flight", "Watch", "fly"]
