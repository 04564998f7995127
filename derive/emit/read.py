"""Parsing of emitted modules: text to sympy expressions, without executing it."""

import ast
import operator
from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

_SIGNED = {
    "normal_velocity", "orbital_momentum", "spin", "orbital_rate", "slip", "log_volume", "log_scaled_gap", "decay",
    "offset", "tail",
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., sp.Expr]] = {
    "exp": sp.exp, "log": sp.log, "sqrt": sp.sqrt, "sin": sp.sin, "cos": sp.cos, "tan": sp.tan, "asin": sp.asin,
    "acos": sp.acos, "atan": sp.atan, "sinh": sp.sinh, "cosh": sp.cosh, "tanh": sp.tanh, "fabs": sp.Abs,
    "fmin": sp.Min, "fmax": sp.Max,
}  # fmt: skip
_OPERATORS: dict[type, Callable[[sp.Expr, sp.Expr], sp.Expr]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}  # fmt: skip


class ReadError(ValueError):
    """The text is not that of an emitted module; the message names the foreign construct."""


@dataclass(frozen=True)
class Read:
    """A function of an emitted module: named intermediates in order, and outputs (one under the function's name)."""

    name: str
    definitions: tuple[tuple[str, sp.Expr], ...]
    outputs: tuple[tuple[str, sp.Expr], ...]


def functions(text: str) -> tuple[Read, ...]:
    """Every function of an emitted law, structure or scaling module, but for guards; ReadError for other text."""
    try:
        tree = ast.parse(text)
    except SyntaxError as error:
        raise ReadError(f"line {error.lineno}: {error.msg}") from None
    return tuple(_function(node) for node in tree.body if isinstance(node, ast.FunctionDef) and not _guards(node))


def _guards(node: ast.FunctionDef) -> bool:
    """Whether a function has the guards of a law's kinks, which follow from the law."""
    return any(isinstance(statement, ast.Return) and isinstance(statement.value, ast.Tuple) for statement in node.body)


def _function(node: ast.FunctionDef) -> Read:
    definitions: list[tuple[str, sp.Expr]] = []
    outputs: list[tuple[str, sp.Expr]] = []
    for statement in node.body:
        if isinstance(statement, ast.Expr):
            continue  # docstring
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            if not isinstance(statement.value, ast.Subscript):  # a state or group assigned to its own name
                definitions.append((statement.targets[0].id, _expression(statement.value)))
        elif isinstance(statement, ast.Return) and isinstance(statement.value, ast.Dict):
            for key, value in zip(statement.value.keys, statement.value.values, strict=True):
                outputs.append((str(ast.literal_eval(key)) if key else "", _expression(value)))
        elif isinstance(statement, ast.Return) and statement.value is not None:
            outputs.append((node.name, _expression(statement.value)))
        else:
            raise ReadError(f"line {statement.lineno}: {type(statement).__name__}")
    if definitions and definitions[-1][0] == "result":  # a result of a law that is too long for the return statement
        return Read(node.name, tuple(definitions[:-1]), ((node.name, definitions[-1][1]),))
    return Read(node.name, tuple(definitions), tuple(outputs))


def _expression(node: ast.expr) -> sp.Expr:
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return sp.Rational(str(node.value))
    if isinstance(node, ast.Name):
        if node.id == "pi":
            return sp.pi
        return sp.Symbol(node.id, real=True) if node.id in _SIGNED else sp.Symbol(node.id, positive=True)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_expression(node.operand)
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _OPERATORS[type(node.op)](_expression(node.left), _expression(node.right))
    if isinstance(node, ast.Call):
        return _call(node)
    if isinstance(node, ast.IfExp):  # the side of a kink, where it is not fixed
        return _expression(node.orelse)
    raise ReadError(f"line {node.lineno}: {ast.unparse(node)}")


def _call(node: ast.Call) -> sp.Expr:
    name = ast.unparse(node.func)
    arguments = [_expression(argument) for argument in node.args]
    if name in _FUNCTIONS:
        return _FUNCTIONS[name](*arguments)
    if name.startswith("laws."):
        return sp.Function(name.removeprefix("laws."), real=True)(*arguments)
    raise ReadError(f"line {node.lineno}: {name}")
