"""Layout of emitted C: comments, functions, loops over coefficients."""

from __future__ import annotations

import textwrap

_WIDTH = 110


def each_term(line: str) -> str:
    """A loop over k with one statement, for a series whose operands are completely known."""
    return line if line.startswith("/*") else f"EACH_TERM({line})"


def comment(text: str) -> list[str]:
    """A C comment, wrapped."""
    lines: list[str] = []
    for paragraph in text.strip().split("\n"):
        lines += textwrap.wrap(paragraph, _WIDTH - 3, break_long_words=False, break_on_hyphens=False) or [""]
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return [f"/* {lines[0]}", *(f" * {line}".rstrip() for line in lines[1:-1]), f" * {lines[-1]} */"]


def function(head: str, body: list[str]) -> list[str]:
    """A C function; long heads are broken at arguments, long statements at operators."""
    lines = textwrap.wrap(head, _WIDTH, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    lines.append("{")
    for line in body:
        if line.startswith("#"):
            lines.append(line)
            continue
        lines += textwrap.wrap(
            line, _WIDTH, initial_indent="    ", subsequent_indent="        ", break_long_words=False,
            break_on_hyphens=False,
        )  # fmt: skip
    return [*lines, "}"]
