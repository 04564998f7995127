"""The emitted equations as plain numpy callables, for solvers that are called from Python.

A CasADi function of (variables, parameters) with its parameters set once: about 1 us a call, no matrices in between.
Straight-line Python code made of the same expressions takes as long.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from casadi import SX, Function, densify, jacobian, jtimes, vertcat

from ..phases import Flow, Watch, event_table, expressions

Callback = Callable[[float, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Equations:
    """A flow, its Jacobian and its events as CasADi functions of (variables, parameters).

    Arguments:
        events: names, in order of precedence.
        dips: indices of those that may fall below zero and return within a step; `table` gives, after all events,
            minus the rate of each of these, which falls through zero at its minimum.
    """

    rates: Function
    jacobian: Function
    table: Function
    events: tuple[str, ...]
    dips: tuple[int, ...]


@lru_cache(maxsize=256)
def equations(flow: Flow, watch: Watch) -> Equations:
    """What an integrator from elsewhere needs of a flow; parameters are the groups, motion and level."""
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


def bound(function: Function, parameters: np.ndarray) -> Callback:
    """`function` at fixed parameters as (t, y) -> array; not for several threads at once."""
    size, shape = function.nnz_in(0), function.size_out(0)
    argument, rest, result = np.zeros(size), parameters.copy(), np.zeros(function.nnz_out(0))
    buffer, evaluate = function.buffer()
    buffer.set_arg(0, memoryview(argument))
    buffer.set_arg(1, memoryview(rest))
    buffer.set_res(0, memoryview(result))
    if shape[1] == 1:

        def column(_: float, y: np.ndarray) -> np.ndarray:
            argument[:] = y
            evaluate()
            return result.copy()

        return column

    def matrix(_: float, y: np.ndarray) -> np.ndarray:
        argument[:] = y
        evaluate()
        return result.reshape(shape, order="F").copy()

    return matrix
