"""CasADi integrators of a flow: one over a given duration, and one that stops at the first event.

Built once and cached; time is scaled so that every call runs over [0, 1] and the duration is a parameter.
"""

from __future__ import annotations

import contextlib
import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from casadi import SX, Function, fabs, if_else, integrator, jacobian, jtimes, vertcat

from ...host.buffered import Buffered
from ...host.captured_stderr import captured_stderr
from ...host.interrupts import check
from ...host.thread_caches import own_cache
from ...model.phases import Flow, WatchedEvents, event_table, expressions, mechanical_energy
from ..settings import STEPS, casadi_steps

_EXPECTED = "Event support is experimental"
_LOOSER = 1e3  # factor from a tolerance that an integrator cannot meet to the next one
_FLAT = 1e-12  # of a function per x0/v0: a smaller slope is rounding, whose changes of sign are no minima, at rest


class IntegrationFailed(Exception):
    """Failure of an integrator; the message is CasADi's last line."""


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Suppress CasADi's expected warning and its prints on a failure."""
    with captured_stderr() as printed:
        yield
    for line in printed.getvalue().splitlines():
        if line and _EXPECTED not in line:
            sys.stderr.write(line + "\n")


def _call(function: Function, x0: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Call an integrator, suppress its prints, and reduce its failure to one line."""
    check()
    with captured_stderr() as printed:
        try:
            result = _buffered(function)(x0, p)
        except (RuntimeError, SystemError) as error:
            # CasADi wraps an interrupt that arrives during a call; CVODES only prints it
            message = str(error) + printed.getvalue()
            if "KeyboardInterrupt" in message or isinstance(error.__cause__ or error.__context__, KeyboardInterrupt):
                raise KeyboardInterrupt from None
            check()
            raise IntegrationFailed(_reason(str(error))) from None
    if "KeyboardInterrupt" in printed.getvalue():  # an interrupt that CVODES reported as a failed step
        raise KeyboardInterrupt
    if not np.isfinite(result).all():
        raise IntegrationFailed("the state is not finite")
    return result.reshape(function.size_out(0), order="F")


@own_cache(1024)
def _buffered(function: Function) -> Buffered:
    return Buffered(function, (0, 2))  # x0 and p of an integrator


def _reason(message: str) -> str:
    last = message.strip().splitlines()[-1].strip()
    return last.split(": ", 1)[-1] if ".cpp:" in last or ".hpp:" in last else last


@dataclass(frozen=True)
class Tolerance:
    """Relative and absolute tolerance of an integrator, and its limit of steps."""

    relative: float
    absolute: float
    steps: int = STEPS

    def loosened(self, rtol: float) -> Tolerance | None:
        """A looser tolerance after one tightened for a grazing start fails; None if this is `rtol` already.

        Later states, or losses, may be so large that the tightened tolerance is below their rounding error.
        """
        if self.relative >= rtol:
            return None
        looser = min(self.relative * _LOOSER, rtol)
        return replace(self, relative=looser, absolute=self.absolute * looser / self.relative)

    @property
    def offset(self) -> float:
        """Initial value of quadratures: 1 if the absolute tolerance is too small to control one that starts at 0."""
        return 1.0 if self.absolute < 1e-4 * self.relative else 0.0

    def options(self, plugin: str, space: bool = False) -> dict[str, Any]:
        """The plugin's options; CVODES' steps, of a located trajectory, are cheaper than those of Rosenbrock."""
        options: dict[str, Any] = {
            "reltol": self.relative,
            "abstol": self.absolute,
            "max_num_steps": self.steps if plugin == "cvodes" else min(self.steps, casadi_steps(self.relative, space)),
        }
        return options | ({"quad_err_con": True} if plugin == "cvodes" else {})


# At a given tolerance the global error of CVODES is 20 to 600 times that of Rosenbrock (measured in docs/engineering),
# so it is given a tighter tolerance: rtol then means about the same for both.
_CVODES_SHARE, _TIGHTEST = 1 / 30, 1e-14


def tolerance_for(rtol: float, plugin: str, groups: Mapping[str, float]) -> Tolerance:
    """Tolerance of an integrator for results accurate to about `rtol`.

    The gap is controlled relative to x0, velocities relative to v0. Near grazing incidence the doublet turns within a
    tiny part of x0, which must be resolved (unless strings exert larger forces). At very small angles without bridge or
    strings, the doublet is opened by a force of tan^2(theta0) x0/a in v0^2/x0, which must exceed the absolute
    tolerance. Tolerances are rounded to whole decades, so that integrators can be shared.
    """
    steps = STEPS if plugin == "cvodes" else casadi_steps(rtol)  # by the requested tolerance, not by a tightened one
    centrifugal = groups["obliquity"] ** 2 * groups["aspect"] / 16
    absolute = 1e-3
    if "capillary" not in groups and "weight" not in groups and 0 < centrifugal < 1e-6:
        absolute = 10.0 ** max(4 * math.floor(math.log10(centrifugal) / 4) - 3, -200)
    if "weight" in groups:  # the least value of stiffness over string_ratio is 1
        centrifugal -= groups["weight"] * groups["aspect"] / groups["string_ratio"]
    if centrifugal > 1:
        rtol = max(rtol * 10.0 ** -math.ceil(math.log10(centrifugal)), min(rtol, _TIGHTEST))
    if plugin == "cvodes":
        rtol = max(rtol * _CVODES_SHARE, _TIGHTEST)
    return Tolerance(rtol, absolute * rtol, steps)


@dataclass(frozen=True)
class Plain:
    """A flow over a duration, without events. Call: (y, groups, duration) -> y at the end (or columns on a grid)."""

    function: Function
    plugin: str

    def __call__(self, y: np.ndarray, p: np.ndarray, duration: float) -> np.ndarray:
        result = _call(self.function, y, np.append(p, duration))
        return result.ravel() if result.shape[1] == 1 else result

    @property
    def steps(self) -> int:
        return _buffered(self.function).steps


@own_cache(512)
def plain(flow: Flow, plugin: str, tolerance: Tolerance, grid: tuple[float, ...] = (1.0,)) -> Plain:
    """The integrator of a flow; `grid` names fractions of the duration at which the solution is returned as well."""
    parts = expressions(flow)
    duration = SX.sym("duration")
    dae = {"x": parts.variables, "p": vertcat(flow.model.parameters, duration), "ode": duration * parts.rates}
    with quiet():
        return Plain(
            integrator("flow", plugin, dae, 0, list(grid), tolerance.options(plugin, flow.model.space)), plugin
        )


@dataclass(frozen=True)
class EventHit:
    """A stop of a locating integrator: event name (None: no event), time and state.

    `dipped` is true if the event's function had already been negative before: its first zero is then earlier.
    """

    event: str | None
    time: float
    y: np.ndarray
    dipped: bool


@dataclass(frozen=True)
class Locator:
    """Integrator of a flow to its first event, or to the end of the duration."""

    function: Function
    events: tuple[str, ...]
    dips: tuple[int, ...]
    values: Function  # event functions (y, parameters)
    energy: Function

    def __call__(self, y: np.ndarray, p: np.ndarray, duration: float, motion: int, level: float) -> EventHit:
        parameters = np.concatenate([p, [duration, motion, level]])
        riders = np.zeros(3 + len(self.dips))  # clock, active, number, minima passed
        riders[1] = 1.0
        result = _call(self.function, x0=np.concatenate([y, riders]), p=parameters).ravel()
        after, (time, _, number) = result[: y.size], result[y.size : y.size + 3]
        which = round(number) - 1
        if which < 0:
            return EventHit(None, duration, after, False)
        dipped = which >= len(self.events)
        index = self.dips[which - len(self.events)] if dipped else which
        return EventHit(self.events[index], float(time), after, dipped)

    @property
    def steps(self) -> int:
        """Number of steps in the last call; 0 for compiled integrators."""
        return _buffered(self.function).steps

    def value(self, event: str, y: np.ndarray, p: np.ndarray, motion: int, level: float) -> float:
        """The value of an event's function in a state."""
        column = self.values(y, np.concatenate([p, [1.0, motion, level]]))
        return float(column[self.events.index(event)])


@own_cache(256)
def locator(flow: Flow, watch: WatchedEvents, tolerance: Tolerance, machine_code: bool = False) -> Locator:
    """A Rosenbrock integrator that freezes at the first event.

    Clock, freeze flag and event number are additional states. CasADi checks signs at the ends of steps only, so a
    function that may become negative and positive again also stops the flow at its own minimum; the stop counts only if
    the function is negative there.

    Arguments:
        machine_code: compile it to C, which pays off beyond some hundred collisions.
    """
    parts, model = expressions(flow), flow.model
    duration, motion, level = SX.sym("duration"), SX.sym("motion"), SX.sym("level")
    table = event_table(flow, watch, motion, level)
    minima = [k for k, event in enumerate(table) if event.dips]
    falling = [event.function for event in table]
    clock, active, number = SX.sym("clock"), SX.sym("active"), SX.sym("number")
    # A minimum above zero is passed once per call: where a function varies slowly, its slope is dominated by rounding
    # and would stop the flow repeatedly.
    passed = SX.sym("passed", len(minima))
    slopes = [-jtimes(table[k].function, parts.variables, parts.rates) for k in minima]
    if flow.region.resting:  # functions may stay as they are
        slopes = [slope + _FLAT * fabs(table[k].function) for k, slope in zip(minima, slopes, strict=True)]
    turning = [if_else(passed[position] > 0, 1, slope) for position, slope in enumerate(slopes)]
    variables = vertcat(parts.variables, clock, active, number, passed)
    parameters = vertcat(model.parameters, duration, motion, level)
    index, time = SX.sym("index"), SX.sym("time")
    holds = SX(1)
    for position, event_index in enumerate(minima):
        holds = if_else(index == len(table) + position, table[event_index].function < 0, holds)
    passing = [if_else(index == len(table) + position, 1, passed[position]) for position in range(len(minima))]
    after = vertcat(parts.variables, clock, active * (1 - holds), if_else(holds, index + 1, number), *passing)
    none = SX(0, 1)
    transition = Function(
        "transition",
        [index, time, variables, none, parameters, none],
        [after, none],
        ["index", "t", "x", "z", "p", "u"],
        ["post_x", "post_z"],
    )
    dae = {
        "x": variables,
        "p": parameters,
        "ode": vertcat(active * duration * parts.rates, active * duration, SX.zeros(2 + len(minima))),
        "zero": vertcat(*falling, *turning),
    }
    options = tolerance.options("rosenbrock", model.space) | {
        "transition": transition,
        "event_tol": 1e-14,
        "max_event_iter": 40,
        "max_events": 10_000,
    }
    with quiet():
        function = integrator("locate", "rosenbrock", dae, 0, 1, options)
    if machine_code:
        from ...host.compiled import compiled

        function = compiled(function)
    return Locator(
        function,
        tuple(event.name for event in table),
        tuple(minima),
        Function("events", [parts.variables, parameters], [vertcat(*falling)]),
        Function("energy", [parts.variables, model.parameters], [mechanical_energy(flow)]),
    )


@own_cache(512)
def landing(flow: Flow, watch: WatchedEvents, event: str) -> Function:
    """One second-order Taylor step of a flow onto an event's surface: (y, parameters) -> (y*, dt, g(y*)).

    dt = -g/g' - g'' g^2/(2 g'^3), y* = y + f dt + f' dt^2/2. At a located event the step is nearly zero, but its
    derivative is the saltation; with the second-order terms its error is the square of the step.
    """
    parts, model = expressions(flow), flow.model
    motion, level = SX.sym("motion"), SX.sym("level")
    table = {each.name: each.function for each in event_table(flow, watch, motion, level)}
    y, rates, g = parts.variables, parts.rates, table[event]
    first = jtimes(g, y, rates)
    second = jtimes(first, y, rates)
    dt = -g / first - second * g**2 / (2 * first**3)
    landed = y + rates * dt + jacobian(rates, y) @ rates * dt**2 / 2
    parameters = vertcat(model.parameters, motion, level)
    on = Function("g", [y, parameters], [g])
    return Function("land", [y, parameters], [landed, dt, on(landed, parameters)])
