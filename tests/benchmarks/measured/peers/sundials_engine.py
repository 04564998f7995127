"""Collisions by scikit-sundae's CVODE, with rates, Jacobian and events compiled by numba from the emitted equations.

CVODE's own root finding ends a trajectory at its events; grazing minima are looked for as by scipy's methods. The
functions are straight-line code, compiled once for a flow.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi
import numpy as np
from casadi import Function
from wetdoublet.solvers.engines.casadi.integrators import EventHit
from wetdoublet.solvers.engines.casadi.locate import EventSequence
from wetdoublet.solvers.model.model import Model
from wetdoublet.solvers.verify.stress.scipy_engine import Equations, ScipyLocator

_WORDS = {
    "ADD": "{0} + {1}", "SUB": "{0} - {1}", "MUL": "{0} * {1}", "DIV": "{0} / {1}", "NEG": "-{0}", "EXP": "exp({0})",
    "LOG": "log({0})", "POW": "{0} ** {1}", "CONSTPOW": "{0} ** {1}", "SQRT": "sqrt({0})", "SQ": "{0} * {0}",
    "TWICE": "2.0 * {0}", "SIN": "sin({0})", "COS": "cos({0})", "TAN": "tan({0})", "INV": "1.0 / {0}",
    "FMIN": "min({0}, {1})", "FMAX": "max({0}, {1})", "LT": "(1.0 if {0} < {1} else 0.0)",
    "EQ": "(1.0 if {0} == {1} else 0.0)", "NE": "(1.0 if {0} != {1} else 0.0)",
    "LE": "(1.0 if {0} <= {1} else 0.0)", "AND": "(1.0 if {0} != 0.0 and {1} != 0.0 else 0.0)",
    "OR": "(1.0 if {0} != 0.0 or {1} != 0.0 else 0.0)",
    "NOT": "(1.0 if {0} == 0.0 else 0.0)", "IF_ELSE_ZERO": "{1} if {0} != 0.0 else 0.0", "FABS": "abs({0})",
}  # fmt: skip
_OPERATIONS = {getattr(casadi, f"OP_{name}"): text for name, text in _WORDS.items()}


def source(function: Function, name: str, matrix: bool = False) -> str:
    """Straight-line Python of a CasADi function (y, p) -> column, as name(y, p, out).

    Arguments:
        matrix: the column is a dense square matrix by columns, `out` one of two dimensions.
    """
    lines = [f"def {name}(y, p, out):"]
    rows = function.size1_out(0)
    for k in range(function.n_instructions()):
        op, o, i = function.instruction_id(k), function.instruction_output(k), function.instruction_input(k)
        if op == casadi.OP_CONST:
            lines.append(f"    w{o[0]} = {function.instruction_constant(k)!r}")
        elif op == casadi.OP_INPUT:
            lines.append(f"    w{o[0]} = {'yp'[i[0]]}[{i[1]}]")
        elif op == casadi.OP_OUTPUT:
            where = f"{o[1] % rows}, {o[1] // rows}" if matrix else str(o[1])
            lines.append(f"    out[{where}] = w{i[0]}")
        else:
            lines.append(f"    w{o[0]} = " + _OPERATIONS[op].format(*(f"w{each}" for each in i)))
    return "\n".join(lines)


@dataclass(frozen=True)
class Compiled:
    """Rates, Jacobian and event table of a flow as machine code."""

    rates: Any
    jacobian: Any
    table: Any


@lru_cache(maxsize=64)
def compiled(found: Equations) -> Compiled:
    """Compile a flow's functions; some seconds."""
    import math

    import numba

    space: dict[str, Any] = {name: getattr(math, name) for name in ("exp", "log", "sqrt", "sin", "cos", "tan")}
    parts = {"rates": found.rates, "jacobian": found.jacobian, "table": found.table}
    for name, function in parts.items():
        exec(source(function, name, matrix=name == "jacobian"), space)  # the text is our own
    return Compiled(*(numba.njit(space[name]) for name in parts))


class Sundae(ScipyLocator):
    """A trajectory by CVODE; rules, phases and proofs are those of our own engines."""

    def __init__(self, model: Model, groups: dict[str, float], rtol: float) -> None:
        super().__init__(model, groups, rtol, "CVODE")

    def _solved(self, found: Equations, span: float, level: float) -> EventHit:
        """Integrate to the first event, or to the end of the span."""
        from sksundae.cvode import CVODE

        code, parameters = compiled(found), np.append(self.p, [self.phase.motion, level])
        count = len(found.events)
        values = np.zeros(count + len(found.dips))

        def events(_: float, y: np.ndarray, out: np.ndarray) -> None:
            code.table(y, parameters, values)
            out[:] = values[:count]

        def rates(_: float, y: np.ndarray, out: np.ndarray) -> None:
            code.rates(y, parameters, out)

        def jacobian(_: float, y: np.ndarray, __: np.ndarray, out: np.ndarray) -> None:
            code.jacobian(y, parameters, out)

        terminal: Any = events
        terminal.terminal, terminal.direction = [True] * count, [-1] * count
        options = {"rtol": self.options["rtol"], "atol": self.options["atol"], "max_num_steps": 100_000}
        solver = CVODE(rates, jacfn=jacobian, eventsfn=terminal, num_events=count, **options)
        solution = solver.solve(np.array([0.0, span]), self.y)
        if solution.status < 0 or not np.isfinite(solution.y[-1]).all():
            raise self._error(f"CVODE failed ({solution.message})", "")
        met = _met(solution, count)
        if met is None:
            return EventHit(None, float(solution.t[-1]), np.array(solution.y[-1]), False)
        return EventHit(found.events[met], float(solution.t[-1]), np.array(solution.y[-1]), False)


def _met(solution: Any, count: int) -> int | None:
    """The event that ended it, by precedence."""
    if solution.i_events is None or not len(solution.i_events):
        return None
    hit = np.asarray(solution.i_events)[-1]
    return next((k for k in range(count) if hit[k]), None)


def locate_by_scipy(model: Model, groups: dict[str, float], rtol: float) -> EventSequence:
    """The trajectory of a collision. ComputationError if it does not come to an end."""
    return Sundae(model, groups, rtol).run()
