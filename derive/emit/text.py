"""Source text of emitted Python functions: docstrings, assignments in order, long sums broken at their terms."""

import re
import textwrap
from collections.abc import Iterable, Sequence

import sympy as sp

from .casadi.printer import Printer

WIDTH = 110
INDENT = "    "


def docstring(text: str, indent: str = "") -> list[str]:
    """Lines of a docstring; its first paragraph is the first line."""
    paragraphs = text.strip("\n").split("\n")
    wrapped: list[str] = []
    for paragraph in paragraphs:
        hanging = "  " if paragraph.startswith(("- ", "  ")) else ""
        wrapped += textwrap.wrap(
            paragraph, WIDTH - len(indent), subsequent_indent=hanging, break_long_words=False, break_on_hyphens=False
        ) or [""]
    if len(wrapped) == 1 and len(wrapped[0]) + len(indent) + 6 <= WIDTH:
        return [f'{indent}"""{wrapped[0]}"""']
    return [f'{indent}"""{wrapped[0]}', *(f"{indent}{line}" if line else "" for line in wrapped[1:]), f'{indent}"""']


def assignment(name: str, expression: sp.Expr, printer: Printer) -> list[str]:
    """`name = expression`, with a sum too long for one line broken at its terms."""
    line = f"{INDENT}{name} = {printer(expression)}"
    if len(line) <= WIDTH:
        return [line]
    if not isinstance(expression, sp.Add):
        return [f"{INDENT}{name} = (", f"{INDENT * 2}{printer(expression)}", f"{INDENT})"]
    lines = [f"{INDENT}{name} = ("]
    for position, term in enumerate(expression.as_ordered_terms()):
        negative = term.could_extract_minus_sign()
        body = printer(-term if negative else term)
        sign = "-" if negative else ("+" if position else "")
        lines.append(f"{INDENT * 2}{sign}{' ' if sign else ''}{body}")
    return [*lines, f"{INDENT})"]


def operations(expressions: Iterable[sp.Expr]) -> int:
    """Number of arithmetic operations and function calls in the expressions."""
    return sum(int(sp.count_ops(expression)) for expression in expressions)


def module(header: str, doc: str, imports: Sequence[str], body: Sequence[str]) -> str:
    """Text of a module."""
    lines = [f"# {line}" for line in header.splitlines()]
    lines += [*docstring(doc), "", "from __future__ import annotations", ""]
    if imports:
        lines += [*imports]
    text = "\n".join([*lines, "", *body]).rstrip() + "\n"
    return re.sub(r"\n{4,}", "\n\n\n", text)
