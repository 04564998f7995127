"""Texts of the emitted modules: laws, structures, scaling."""

import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from ...equations.model import Model
from ...physics.forces import FILM, SHEAR
from ...physics.law import RANGES, Law, LawFunction, needed
from ...physics.scaling import first_rates, group_definitions, impact_groups, scale_definitions
from ...physics.slots import MIDGAP, place_of
from ...vocabulary.quantities import (
    VOCABULARY,
    gap,
    obliquity,
    obliquity_pair,
    obliquity_space,
    obliquity_wall,
    rate_scale,
)
from ..provenance import Own, describe, digest, header, law_digest, model_digest
from .printer import Printer

_WIDTH = 110
_INDENT = "    "


def law_module(law: Law) -> str:
    """Text of a law's module: its functions of dimensionless arguments."""
    printer = Printer()
    body: list[str] = []
    for function in law.functions:
        definitions, _ = needed([function.result], function.definitions)
        arguments = ", ".join(f"{argument.name}: Any" for argument in function.arguments)
        sides = {side: f"sides[{k}] if sides else " for k, (_, side) in enumerate(function.kinks)}
        more = ", sides: Any = None" if sides else ""
        body += ["", f"def {function.name}({arguments}{more}) -> Any:"]
        count = _operations([function.result, *(expression for _, expression in definitions)])
        body += _docstring(f"{function.doc}\n\nTotal operations: {count}", _INDENT)
        for symbol, expression in definitions:
            body += _assignment(symbol.name, expression, printer, sides.get(symbol, ""))
        lines = [*_assignment("result", function.result, printer), f"{_INDENT}return result"]
        body += [f"{_INDENT}return {printer(function.result)}"] if len(lines) == 2 else lines
        body.append("")
        if function.kinks:
            body += _kinks(function, arguments, printer)
    doc = f"{law.slot} law `{law.name}`: {law.meaning}.\n\nSource: {law.source}."
    falls = any(formula.falls and formula.name in ("force", "log_factor") for formula in law.functions)  # with the gap
    counts = {function.name: len(function.kinks) for function in law.functions if function.kinks}
    kinks = ["", f"KINKS = {counts}".replace("'", '"'), ""] if counts else []
    body = [*_validity(law), *(["", "FALLS = True", ""] if falls else []), *kinks, *body]
    return _module(header(law_digest(law)), doc, ["from typing import Any", "", *_casadi(printer)], body)


def features(law: Law) -> tuple[str, ...]:
    """What rules and engines must know of a law: names of functions that not every law of the slot has, and properties.

    "spread": the rim follows the bridge's volume; "rim": it vanishes where the film ends at initial contact;
    "balanced": the lever arm at which the film exerts no torque on the doublet.
    """
    words = [function.name for function in law.functions if not place_of(law.slot, function.name).required]
    words += ["spread"] * law.spread
    if law.slot == "shear":
        words += ["rim"] * (law["edge"].result == 1)
    if law.slot == "glass":
        words += ["rim"] * (law["pressure"].result.subs(gap, 1) == 0)
    if law.slot == "arm":
        words += ["balanced"] * (sp.expand(law["lever"].result - MIDGAP["arm"]["lever"].result) == 0)
    return tuple(words)


def _kinks(function: LawFunction, arguments: str, printer: Printer) -> list[str]:
    """What vanishes at a law's kinks, in the order of its `sides`."""
    guards = [kink for kink, _ in function.kinks]
    lines = ["", f"def {function.name}_kinks({arguments}) -> tuple[Any, ...]:"]
    lines += _docstring(f"Guards of the kinks of {function.name}, each zero at one.", _INDENT)
    for symbol, expression in needed(guards, function.definitions)[0]:
        lines += _assignment(symbol.name, expression, printer)
    return [*lines, f"{_INDENT}return ({', '.join(kink.name for kink in guards)},)", ""]


def _validity(law: Law) -> list[str]:
    """The constant VALIDITY of a law: quantity to (least, largest), None for no known bound."""
    intervals = dict(law.validity)
    if not intervals:
        return []
    lines = ["", "VALIDITY: dict[str, tuple[float | None, float | None]] = {"]
    for quantity in RANGES:
        bounds = ", ".join("None" if x is None else repr(float(x)) for x in intervals.get(quantity, (None, None)))
        lines.append(f'{_INDENT}"{quantity}": ({bounds}),')
    return [*lines, "}", f'VALIDITY_SOURCE = "{law.source}"', ""]


def _casadi(printer: Printer) -> list[str]:
    return [f"from casadi import {', '.join(sorted(printer.imports))}"] if printer.imports else []


def structure_module(model: Model, additions: Own | None = None, shared: Mapping[str, str] | None = None) -> str:
    """Text of a structure's module: states, groups, slots, and its functions.

    Arguments:
        additions: a user's groups.
        shared: the structure that defines a function, by its text (`shared.homes`); the others import it.
    """
    printer = Printer()
    functions = [formula for formula in model.functions if not formula.certificate]
    body: list[str] = ["", "Values = Mapping[str, Any]", ""]
    for constant, names in (
        ("STATES", [s.name for s in model.states]),
        ("GROUPS", [s.name for s in model.groups]),
        ("SLOTS", list(model.slots)),
        ("FUNCTIONS", [f.name for f in functions]),
        ("REGIONAL", [f.name for f in functions if f.regional]),
    ):
        body += _listed(f"{constant} = {_tuple(names)}", f"{constant} =", [f'"{name}"' for name in names])
    body += [f'DIGEST = "{model_digest(model)}"', ""]
    elsewhere: dict[str, list[str]] = {}
    for function in functions:
        defined = function_lines(model, function.name, trial := Printer())
        home = (shared or {}).get("\n".join(defined), model.structure.name)
        if home != model.structure.name:
            elsewhere.setdefault(home, []).append(function.name)
        else:
            body += defined
            printer.imports |= trial.imports
    imports = ["from collections.abc import Mapping", "from typing import Any", "", *_casadi(printer)]
    for home, names in sorted(elsewhere.items()):
        start = f"from .{home} import"
        imports += _listed(f"{start} {', '.join(sorted(names))}", start, sorted(names))
    return _module(header(model_digest(model)), describe(model, additions or {}), imports, body)


def _listed(line: str, start: str, words: Sequence[str]) -> list[str]:
    """A line with a list of words, or `start` and the list over several lines in brackets."""
    if len(line) <= _WIDTH:
        return [line]
    inside = textwrap.wrap(", ".join(words) + ",", _WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT)
    return [f"{start} (", *inside, ")"]


def _tuple(names: Sequence[str]) -> str:
    listed = ", ".join(f'"{name}"' for name in names)
    return f"({listed},)" if len(names) == 1 else f"({listed})"


def function_lines(model: Model, name: str, printer: Printer) -> list[str]:
    """Lines of one function of a structure's module; `printer` records the CasADi names that it needs."""
    function = model[name]
    definitions, used = needed([expression for _, expression in function.outputs], model.definitions)
    region = [flag.name for flag in (FILM, SHEAR)] if function.regional else []
    flags = "".join(f", {flag}: int = 1" for flag in region)
    flags += "".join(f", {symbol.name}: Any = 0" for symbol in function.further)
    lines = ["", f"def {name}(state: Values, groups: Values, laws: Any{flags}) -> dict[str, Any]:"]
    count = _operations([*(e for _, e in function.outputs), *(e for _, e in definitions)])
    doc = function.doc
    if region:
        doc += "\n\nRegion: film is 1 inside the film, shear 1 inside the tangential edge, else 0."
    lines += _docstring(f"{doc}\n\nTotal operations: {count}", _INDENT)
    defined = {symbol for symbol, _ in definitions}
    lines += [f'{_INDENT}{s.name} = state["{s.name}"]' for s in model.states if s in used and s not in defined]
    lines += [f'{_INDENT}{s.name} = groups["{s.name}"]' for s in model.groups if s in used]
    for symbol, expression in definitions:
        lines += _assignment(symbol.name, expression, printer)
    lines.append(f"{_INDENT}return {{")
    lines += [f'{_INDENT * 2}"{key}": {printer(expression)},' for key, expression in function.outputs]
    return [*lines, f"{_INDENT}}}", ""]


def scaling_digest() -> str:
    """Digest of the groups and scales."""
    return digest(*(term for pair in _scaling().items() for term in pair))


def _scaling() -> dict[sp.Symbol, sp.Expr]:
    sideways = {obliquity: "", obliquity_pair: "pair", obliquity_wall: "wall", obliquity_space: "space"}
    first = {group: impact_groups(partner)[obliquity] for group, partner in sideways.items()}
    return group_definitions() | scale_definitions() | first | first_rates(rate_scale)


def scaling_module() -> str:
    """Text of the module with the groups as functions of SI quantities, and the quantities that each takes."""
    meanings = {name: (quantity.unit, quantity.meaning) for name, quantity in VOCABULARY.items()}
    return groups_module(_scaling(), meanings, scaling_digest(), _GROUPS_DOC)


_GROUPS_DOC = (
    "Dimensionless groups, as ratios of the model's terms, and scales from SI quantities.\n\n"
    "Each is a function of floats or CasADi expressions; ARGUMENTS has the names of its arguments, in order."
)


def groups_module(definitions: Mapping[sp.Symbol, sp.Expr], meanings: Own, source: str, doc: str) -> str:
    """Text of a module with groups as functions of quantities; `meanings` maps their names to (unit, meaning)."""
    printer = Printer()
    body: list[str] = ["", "ARGUMENTS: dict[str, tuple[str, ...]] = {"]
    arguments = {
        group.name: tuple(name for name in meanings if name in {s.name for s in expression.free_symbols})
        for group, expression in definitions.items()
    }
    for name, wanted in arguments.items():
        body.append(f'{_INDENT}"{name}": {_tuple(wanted)},')
    body += ["}", ""]
    for group, expression in definitions.items():
        names = arguments[group.name]
        body += ["", f"def {group.name}({', '.join(f'{name}: Any' for name in names)}) -> Any:"]
        units = "\n".join(f"- {name} [{meanings[name][0]}]: {meanings[name][1]}" for name in names)
        unit, meaning = meanings[group.name]
        body += _docstring(f"{meaning} [{unit}].\n\n{units}", _INDENT)
        body += [f"{_INDENT}return {printer(expression)}", ""]
    return _module(header(source), doc, ["from typing import Any", "", *_casadi(printer)], body)


def _docstring(text: str, indent: str = "") -> list[str]:
    """Lines of a docstring; its first paragraph is the first line."""
    paragraphs = text.strip("\n").split("\n")
    wrapped: list[str] = []
    for paragraph in paragraphs:
        hanging = "  " if paragraph.startswith(("- ", "  ")) else ""
        wrapped += textwrap.wrap(
            paragraph, _WIDTH - len(indent), subsequent_indent=hanging, break_long_words=False, break_on_hyphens=False
        ) or [""]
    if len(wrapped) == 1 and len(wrapped[0]) + len(indent) + 6 <= _WIDTH:
        return [f'{indent}"""{wrapped[0]}"""']
    return [f'{indent}"""{wrapped[0]}', *(f"{indent}{line}" if line else "" for line in wrapped[1:]), f'{indent}"""']


def _assignment(name: str, expression: sp.Expr, printer: Printer, unless: str = "") -> list[str]:
    """`name = expression`, with a sum too long for one line broken at its terms; `unless` stands in front of it."""
    line = f"{_INDENT}{name} = {unless}{printer(expression)}"
    if len(line) <= _WIDTH:
        return [line]
    if not isinstance(expression, sp.Add):
        return [f"{_INDENT}{name} = (", f"{_INDENT * 2}{printer(expression)}", f"{_INDENT})"]
    lines = [f"{_INDENT}{name} = ("]
    for position, term in enumerate(expression.as_ordered_terms()):
        negative = term.could_extract_minus_sign()
        body = printer(-term if negative else term)
        sign = "-" if negative else ("+" if position else "")
        lines.append(f"{_INDENT * 2}{sign}{' ' if sign else ''}{body}")
    return [*lines, f"{_INDENT})"]


def _operations(expressions: Iterable[sp.Expr]) -> int:
    """Number of arithmetic operations and function calls in the expressions."""
    return sum(int(sp.count_ops(expression)) for expression in expressions)


def _module(header: str, doc: str, imports: Sequence[str], body: Sequence[str]) -> str:
    """Text of a module."""
    lines = [f"# {line}" for line in header.splitlines()]
    lines += [*_docstring(doc), "", "from __future__ import annotations", ""]
    if imports:
        lines += [*imports]
    text = "\n".join([*lines, "", *body]).rstrip() + "\n"
    return re.sub(r"\n{4,}", "\n\n\n", text)
