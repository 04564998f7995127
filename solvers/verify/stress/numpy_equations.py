"""The emitted equations as plain numpy callables, for solvers that are called from Python.

A CasADi function of (variables, parameters) with parameters set once takes 1 to 2 microseconds a call, without CasADi
matrices; straight-line Python code of the same expressions takes as long.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from casadi import SX, Function, densify, jacobian, jtimes, vertcat

from ...model.phases import Flow, WatchedEvents, event_table, expressions


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
def equations(flow: Flow, watch: WatchedEvents) -> Equations:
    """The equations of a flow for an external integrator; the parameters are groups, motion and level."""
    parts = expressions(flow)
    motion, level = SX.sym("motion"), SX.sym("level")
    table = event_table(flow, watch, motion, level)
    dips = tuple(k for k, event in enumerate(table) if event.dips)
    slopes = [-jtimes(table[k].function, parts.variables, parts.rates) for k in dips]
    inputs = [parts.variables, vertcat(flow.model.parameters, motion, level)]
    return Equations(
        Function("rates", inputs, [parts.rates]),
        Function("jacobian", inputs, [densify(jacobian(parts.rates, parts.variables))]),
        Function("table", inputs, [densify(vertcat(*(event.function for event in table), *slopes))]),
        tuple(event.name for event in table),
        dips,
    )


class Bound:
    """A function with fixed parameters, called as (t, y) -> array. Not thread-safe."""

    def __init__(self, function: Function, parameters: np.ndarray) -> None:
        self._argument, self._parameters = np.zeros(function.nnz_in(0)), np.array(parameters, dtype=float)
        self._result = np.zeros(function.nnz_out(0))
        self._shape = function.size_out(0) if function.size_out(0)[1] > 1 else (function.nnz_out(0),)
        buffer: Any  # the type stubs know only the pointer arguments
        buffer, self._evaluate = function.buffer()
        buffer.set_arg(0, self._argument.data)
        buffer.set_arg(1, self._parameters.data)
        buffer.set_res(0, self._result.data)
        self._buffer = buffer  # keeps the array alive, because the evaluation refers to its memory

    def __call__(self, _: float, y: np.ndarray) -> np.ndarray:
        self._argument[:] = y
        self._evaluate()
        return self._result.copy() if len(self._shape) == 1 else self._result.reshape(self._shape, order="F").copy()
