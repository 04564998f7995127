"""CasADi integrators of a flow over a given duration, and the landing on an event at its end.

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
from casadi import SX, Function, integrator, jacobian, jtimes, vertcat

from ...host.casadi_calls import Buffered, captured_stderr
from ...host.interrupts import check
from ...host.thread_caches import own_cache
from ...model.phases import Flow, event_table, expressions
from ..settings import KERNEL_STEPS, casadi_steps

_EXPECTED = "Event support is experimental"
_LOOSER = 1e3  # factor from a tolerance that an integrator cannot meet to the next one


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


@contextlib.contextmanager
def failures() -> Iterator[None]:
    """Suppress prints of integrators that are called within; IntegrationFailed with one line where one fails."""
    check()
    with captured_stderr() as printed:
        try:
            yield
        except (RuntimeError, SystemError) as error:
            # CasADi wraps an interrupt that arrives during a call; CVODES only prints it
            message = str(error) + printed.getvalue()
            if "KeyboardInterrupt" in message or isinstance(error.__cause__ or error.__context__, KeyboardInterrupt):
                raise KeyboardInterrupt from None
            check()
            raise IntegrationFailed(_reason(str(error))) from None
    if "KeyboardInterrupt" in printed.getvalue():  # an interrupt that CVODES reported as a failed step
        raise KeyboardInterrupt


def _call(function: Function, x0: np.ndarray, p: np.ndarray) -> np.ndarray:
    with failures():
        result = _buffered(function)(x0, p)
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
    steps: int = KERNEL_STEPS

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
        """The plugin's options; a step of CVODES is cheaper than one of Rosenbrock, so that it may take more."""
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
    steps = (
        KERNEL_STEPS if plugin == "cvodes" else casadi_steps(rtol)
    )  # by the requested tolerance, not by a tightened one
    centrifugal = groups["obliquity"] ** 2 * groups["aspect"] / 16
    absolute = 1e-3
    if "capillary" not in groups and "weight" not in groups and 0 < centrifugal < 1e-4:
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

    def __call__(self, y: np.ndarray, p: np.ndarray, duration: float) -> np.ndarray:
        result = _call(self.function, y, np.append(p, duration))
        return result.ravel() if result.shape[1] == 1 else result

    @property
    def steps(self) -> int:
        return _buffered(self.function).steps


def plain(flow: Flow, plugin: str, tolerance: Tolerance, grid: tuple[float, ...] = (1.0,)) -> Plain:
    """The integrator of a flow; `grid` names fractions of the duration at which the solution is returned as well."""
    return _plain(replace(flow, edge_watched=False), plugin, tolerance, grid)  # whatever events are watched


@own_cache(512)
def _plain(flow: Flow, plugin: str, tolerance: Tolerance, grid: tuple[float, ...]) -> Plain:
    parts = expressions(flow)
    duration = SX.sym("duration")
    dae = {"x": parts.variables, "p": vertcat(flow.model.parameters, duration), "ode": duration * parts.rates}
    with quiet():
        return Plain(integrator("flow", plugin, dae, 0, list(grid), tolerance.options(plugin, flow.model.space)))


@own_cache(512)
def landing(flow: Flow, event: str) -> Function:
    """One second-order Taylor step of a flow onto an event's surface: (y, parameters) -> (y*, dt, g(y*)).

    dt = -g/g' - g'' g^2/(2 g'^3), y* = y + f dt + f' dt^2/2. Where the event is met the step is nearly zero, but its
    derivative is the saltation; with the second-order terms its error is the square of the step.
    """
    parts, model = expressions(flow), flow.model
    motion = SX.sym("motion")
    y, rates, g = parts.variables, parts.rates, event_table(flow, motion)[event]
    first = jtimes(g, y, rates)
    second = jtimes(first, y, rates)
    dt = -g / first - second * g**2 / (2 * first**3)
    landed = y + rates * dt + jacobian(rates, y) @ rates * dt**2 / 2
    parameters = vertcat(model.parameters, motion)
    on = Function("g", [y, parameters], [g])
    return Function("land", [y, parameters], [landed, dt, on(landed, parameters)])
