"""Collisions by scipy's integrators, with the equations, events and rules of our engines.

`solve_ivp` is used as documented: terminal events with a direction, an analytic Jacobian for implicit methods, our
tolerances. Optimisations of an experienced user are included: functions with fixed arguments in memory, all guards of a
step in one call, one call of `solve_ivp` from event to event, and grazing minima searched afterwards on the steps taken
(as events of their own they double LSODA's time).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from casadi import SX, Function, densify, jacobian, jtimes, vertcat
from wetdoublet.solvers.engines.casadi.integrators import tolerance_for
from wetdoublet.solvers.host.casadi_calls import Buffered
from wetdoublet.solvers.model.dimensionless import Problem
from wetdoublet.solvers.model.phases import Flow, event_table, expressions

from .automaton import CERTIFIED, Automaton, Hit, proof_of, proving

IMPLICIT = ("LSODA", "Radau")  # methods that take a Jacobian
_TIGHTEST = 2.3e-14  # smallest relative tolerance that scipy accepts without a warning
_UNREACHABLE = -1e30  # a level that proves a stick
Rates = Callable[[float, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Equations:
    """A flow, its Jacobian and its events as CasADi functions of (variables, parameters).

    Arguments:
        events: names of the events, in order of precedence.
        dips: indices of guards that may become negative and return within a step; after all guards, `table` has minus
            the rate of each of these, which crosses zero at its minimum.
    """

    rates: Function
    jacobian: Function
    table: Function
    events: tuple[str, ...]
    dips: tuple[int, ...]


@lru_cache(maxsize=256)
def equations(flow: Flow) -> Equations:
    """The equations of a flow for an external integrator; the parameters are groups, motion and level."""
    parts = expressions(flow)
    motion, level = SX.sym("motion"), SX.sym("level")
    table = event_table(flow, motion)
    lasting = {row.name for row in flow.model.events if not row.dips}
    dips = tuple(k for k, name in enumerate(table) if name not in lasting)
    guards, functions = dict(table), [*table.values()]
    if proof_of(flow.model):
        guards[CERTIFIED] = proving(flow.choice)(parts.variables, flow.model.parameters) - level
    slopes = [-jtimes(functions[k], parts.variables, parts.rates) for k in dips]
    inputs = [parts.variables, vertcat(flow.model.parameters, motion, level)]
    return Equations(
        Function("rates", inputs, [parts.rates]),
        Function("jacobian", inputs, [densify(jacobian(parts.rates, parts.variables))]),
        Function("table", inputs, [densify(vertcat(*guards.values(), *slopes))]),
        tuple(guards),
        dips,
    )


class ScipyAutomaton(Automaton):
    """A collision by a method of `solve_ivp`."""

    def __init__(self, problem: Problem, rtol: float, method: str) -> None:
        super().__init__(problem, rtol)
        self.method = method
        tolerance = tolerance_for(self.rtol, "rosenbrock", problem.groups)
        relative = max(tolerance.relative, _TIGHTEST)
        self.options: dict[str, Any] = {"method": method, "rtol": relative, "atol": tolerance.absolute}

    def integrated(self, flow: Flow, span: float) -> Hit:
        """Integrate to the first event, or to the end of the span."""
        smooth, level = equations(flow), self.level(self.y)
        parameters = np.append(self.p, [self.phase.motion, _UNREACHABLE if level is None else level])
        rates, table, jacobian = (Buffered(each, (0, 1)) for each in (smooth.rates, smooth.table, smooth.jacobian))
        size = self.y.size

        def changes(_: float, y: np.ndarray) -> np.ndarray:
            return rates(y, parameters)

        def guards(y: np.ndarray) -> np.ndarray:
            return table(y, parameters)

        options: dict[str, Any] = {"events": _events(guards, len(smooth.events))}
        if self.method in IMPLICIT:
            options["jac"] = lambda _, y: jacobian(y, parameters).reshape(size, size, order="F")
        solution = self._solved(changes, 0.0, span, self.y, options)
        grazed = self._grazed(smooth, solution, changes, guards)
        if grazed is not None:
            return grazed
        for name, times, states in zip(smooth.events, solution.t_events, solution.y_events):
            if len(times):
                return Hit(name, float(times[-1]), states[-1])
        return Hit(None, float(solution.t[-1]), solution.y[:, -1])

    def _solved(self, rates: Rates, start: float, end: float, y: np.ndarray, more: dict[str, Any]) -> Any:
        from scipy.integrate import solve_ivp

        try:
            solution = solve_ivp(rates, (start, end), y, **self.options, **more)
        except (ArithmeticError, ValueError) as error:
            raise self.error(f"{self.method} failed ({error})") from None
        if solution.status < 0 or not np.isfinite(solution.y[:, -1]).all():
            raise self.error(f"{self.method} failed ({solution.message})")
        return solution

    def _grazed(
        self, flow: Equations, solution: Any, rates: Rates, guards: Callable[[np.ndarray], np.ndarray]
    ) -> Hit | None:
        """The first crossing hidden within a step, where a guard becomes negative and returns.

        A cubic through values and slopes at the ends shows candidates; there the step is integrated again and searched.
        """
        times, states = solution.t, solution.y
        values = np.array([guards(y) for y in states.T])
        hidden = []
        for position, index in enumerate(flow.dips):
            g, slope = values[:, index], -values[:, len(flow.events) + position]
            turns = np.flatnonzero((slope[:-1] < 0) & (slope[1:] > 0) & (g[:-1] > 0) & (g[1:] > 0))
            hidden += [(int(k), index) for k in turns if _lowest(g, slope, times, int(k)) < 0]
        for k, index in sorted(hidden):
            dense = self._solved(rates, times[k], times[k + 1], states[:, k], {"dense_output": True}).sol
            below = [t for t in np.linspace(times[k], times[k + 1], 65) if guards(dense(t))[index] < 0]
            if below:
                before, after = times[k], below[0]
                while before < (middle := 0.5 * (before + after)) < after:  # to machine precision
                    before, after = (before, middle) if guards(dense(middle))[index] < 0 else (middle, after)
                return Hit(flow.events[index], after, dense(after))
        return None


def _events(guards: Callable[[np.ndarray], np.ndarray], count: int) -> list[Callable[[float, np.ndarray], float]]:
    """Events for `solve_ivp`, terminal where a guard decreases through zero; all guards of a state in one call."""
    last: tuple[float, Any, list[float]] = (math.nan, None, [])

    def event(index: int) -> Callable[[float, np.ndarray], float]:
        def value(t: float, y: np.ndarray) -> float:
            nonlocal last
            if t != last[0] or y is not last[1]:  # a solver may change its array in place
                last = t, y, guards(y).tolist()
            return last[2][index]

        value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]  # as scipy reads them
        return value

    return [event(k) for k in range(count)]


def _lowest(g: np.ndarray, slope: np.ndarray, times: np.ndarray, k: int) -> float:
    """The smallest value of the cubic through both ends of step k."""
    from scipy.interpolate import CubicHermiteSpline

    cubic = CubicHermiteSpline(times[k : k + 2], g[k : k + 2], slope[k : k + 2])
    return float(cubic(np.linspace(times[k], times[k + 1], 33)).min())
