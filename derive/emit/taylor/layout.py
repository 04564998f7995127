"""Layout of emitted C: comments, functions, loops over coefficients."""

import textwrap
from collections.abc import Iterable

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


def documented(doc: str, head: str, body: list[str]) -> list[str]:
    """A C function under its comment, and an empty line."""
    return [*comment(doc), *function(head, body), ""]


def struct(name: str, fields: Iterable[str]) -> list[str]:
    """A C struct type; lines of the preprocessor among the fields stay at the margin."""
    return ["typedef struct {", *(f if f.startswith("#") else f"    {f}" for f in fields), f"}} {name};", ""]


def compiled_if(condition: str, lines: Iterable[str]) -> list[str]:
    """Lines under a condition of the preprocessor; nothing if there are none."""
    return [f"#if {condition}", *result, "#endif"] if (result := list(lines)) else []


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
