"""A user's law by every emitted form, with its slopes, at the states that every doublet passes."""

import cmath
import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import sympy as sp
from casadi import SX, Function, densify, jacobian, vertcat

from ..emit.casadi.modules import law_module
from ..emit.casadi.printer import EmissionError
from ..emit.taylor.law_header import COMPARED, law_header, moves
from ..emit.taylor.law_slopes import slope_program, slopes_header
from ..emit.taylor.program import Operation, Program
from ..physics.law import Law, LawFunction
from ..user.structures import UserModel
from ..vocabulary.quantities import normal_velocity
from .base import Check

# Initial contact, rest, the turn, the smallest gaps, rupture (gaps over R are fractions of the rupture distance), and
# places between
PASSED: Mapping[str, tuple[float, ...]] = {
    "gap": (1e-6, 0.37, 1.0), "distance": (4.0, 4.37, 6.0), "approach": (0.0, 0.41, 1.0),
    "normal_velocity": (-1.0, 0.0, 0.41), "aspect": (0.05, 0.16), "volume": (0.1,), "contact_angle": (0.0, 0.5),
    "offset_squared": (0.0, 1.0), "string_ratio": (20.0,), "gap_over_radius": (1e-6, 0.37, 1.0),
}  # fmt: skip
_EQUAL = 1e-7  # between forms, of the larger of a value and the largest of its kind
_FAINT = 1e-30  # a normal velocity beside zero
_Values = Callable[[Mapping[sp.Symbol, float]], list[float]]
Samples = Callable[[LawFunction, Mapping[str, tuple[float, ...]]], Iterator[dict[sp.Symbol, float]]]


def emission(model: UserModel, law: Law, written: Law, label: str, samples: Samples) -> Check:
    """The check of one law; `samples` gives values of a function's arguments."""
    name, statement = f"emission: {label}", "every engine has the law and its slopes, finite and the same"
    groups = {group.symbol for group in model.groups}
    try:
        law_header(law, groups)
        slopes_header(law, groups)
        module: dict[str, Any] = {}
        exec(compile(law_module(law), law.module, "exec"), module)  # our own text
        count = 0
        for function, exact in zip(law.functions, written.functions, strict=True):
            if not function.arguments or function.for_proof:  # nothing follows these along a trajectory
                continue
            if (law.slot, function.name) == ("film", "resistance") and (wrong := _at_rest(exact, samples)):
                return Check(name, statement, False, wrong)
            by_casadi = _by_casadi(function, module[function.name])
            moved = moves(function.arguments, groups)
            moving = tuple(a for a, does in zip(function.arguments, moved, strict=True) if does)
            by_kernel = _by_kernel(function, moving) if moving and (law.slot, function.name) not in COMPARED else None
            for at in samples(function, PASSED):
                count += 1
                values = by_casadi(at)
                if wrong := _different(values, by_kernel(at) if by_kernel else values, function):
                    where = ", ".join(f"{symbol.name} = {value:.3g}" for symbol, value in at.items())
                    return Check(name, statement, False, f"{wrong} at {where}")
    except EmissionError as error:
        return Check(name, statement, False, f"{error}: write it by other functions")
    return Check(name, statement, True, f"{count} states")


def _at_rest(exact: LawFunction, samples: Samples) -> str:
    """What is wrong with a film whose force does not vanish, or change its sign, with the velocity; "" if nothing."""
    if normal_velocity not in exact.arguments:
        return ""
    named = list(exact.definitions)
    resistance = sp.lambdify(exact.arguments, exact.result, modules=["math"], cse=lambda result: (named, result))

    def force(at: Mapping[sp.Symbol, float], velocity: float) -> float:
        try:
            return float(velocity * resistance(*({**at, normal_velocity: velocity}.values())))
        except (ArithmeticError, ValueError, TypeError):
            return math.nan

    for at in samples(exact, {**PASSED, "normal_velocity": (0.0,)}):
        here, size = force(at, _FAINT) + force(at, -_FAINT), abs(force(at, 1.0)) + abs(force(at, -1.0))
        if math.isfinite(here) and abs(here) > 1e-6 * size:
            return "the film's force does not vanish at rest: what acts there is an attraction's or a bridge's law"
    return ""


def _different(casadi: list[float], kernel: list[float], function: LawFunction) -> str:
    """What is wrong with the value and the slopes by two forms; "" if nothing."""
    for place, (first, other) in enumerate(zip(casadi, kernel, strict=True)):
        what = f"{function.name}'s slope by {function.arguments[place - 1].name}" if place else function.name
        for form, value in (("by CasADi", first), ("by the kernel's recurrences", other)):
            if not math.isfinite(value):
                return f"{what} {form} is no finite number"
        size = max(map(abs, casadi[1:] if place else casadi[:1]))
        if abs(first - other) > (100 if place else 1) * _EQUAL * max(size, 1.0):  # a branch not taken leaves rounding
            return f"{what} is {first:.6g} by CasADi and {other:.6g} by the kernel's recurrences"
    return ""


def _by_casadi(function: LawFunction, emitted: Callable[..., Any]) -> _Values:
    """Value and slopes of what is emitted for CasADi, by its own derivatives, by the values of the arguments."""
    arguments = [SX.sym(argument.name) for argument in function.arguments]
    value, given = SX(emitted(*arguments)), vertcat(*arguments)
    compiled = Function("form", [given], [densify(vertcat(value, jacobian(value, given).T))])
    return lambda at: [float(number) for number in compiled([*at.values()]).full()[:, 0]]


_STEPS = {
    "side": lambda value: math.copysign(1.0, complex(value).real),
    "half": lambda value: float(complex(value).real >= 0),
}


def _by_kernel(function: LawFunction, moving: tuple[sp.Symbol, ...]) -> _Values:
    """The same by the operations of the kernel's programs, at order zero."""
    value, result, program, slopes = slope_program(function, moving)
    lines = [*_lines(value), *_lines(program)]
    results = ", ".join(form if isinstance(form, str) else _text(form) for form in (result, *slopes.values()))
    names = ", ".join(argument.name for argument in function.arguments)
    space: dict[str, Any] = {"cmath": cmath, **_STEPS}
    exec("\n    ".join([f"def values({names}):", *lines, f"return [{results}]"]), space)  # our own text

    def values(at: Mapping[sp.Symbol, float]) -> list[float]:
        try:
            values = [complex(number) for number in space["values"](*at.values())]
        except (ArithmeticError, ValueError):
            return [math.nan] * (1 + len(at))
        return [number.real if number.imag == 0 else math.nan for number in values]

    return values


def _lines(program: Program) -> list[str]:
    named = [f"{symbol.name} = {_text(value)}" for symbol, value in program.named.items()]
    return [*named, *(f"{operation.name} = {_text(_expression(operation))}" for operation in program.operations)]


def _text(expression: sp.Expr) -> str:
    text = sp.pycode(expression, fully_qualified_modules=True, user_functions={name: name for name in _STEPS})
    return str(text).replace("math.", "cmath.")


def _expression(operation: Operation) -> sp.Expr:
    """An operation as an expression in its operands."""
    parts = [sp.Symbol(name) for name in operation.series]
    match operation.kind:
        case "linear":
            return sp.Add(*(f * term for f, term in zip(operation.factors, parts, strict=False)), operation.factors[-1])
        case "product":
            return operation.factors[0] * parts[0] * parts[1]
        case "quotient":
            return parts[0] / parts[1]
        case "power":
            return sp.Pow(parts[0], operation.factors[0], evaluate=False)
    functions = {"square": lambda a: a**2, "reciprocal": lambda a: 1 / a, "sqrt": sp.sqrt, "exp": sp.exp, "log": sp.log}
    functions |= {"sine": sp.sin, "cosine": sp.cos, "arctangent": sp.atan}
    functions |= {name: sp.Function(name) for name in _STEPS}
    result: sp.Expr = functions[operation.kind](parts[0])
    return result
