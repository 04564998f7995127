"""Differences of two models as text, Markdown or LaTeX."""

from __future__ import annotations

import math
from itertools import groupby
from typing import TYPE_CHECKING, Any

from ...generated.automaton import OUTCOMES
from .differences import Differences

if TYPE_CHECKING:
    from ...derive.emit.compare import Change

_SHORT = dict(zip(OUTCOMES, ("S", "SRS", "B"), strict=True))
_HEADS = ("angle (deg)", "St", "A", "e_n A", "B", "e_n B", "B - A")


def _typeset(expression: Any) -> str:
    """An expression in LaTeX."""
    from ...derive.emit.compare import typeset  # imports sympy

    return typeset(expression)


def as_text(differences: Differences) -> str:
    """The differences as plain text."""
    from ...derive.emit.compare import plain  # imports sympy

    lines = [f"A: {differences.names[0]}", f"B: {differences.names[1]}", ""]
    lines += ["no equation differs"] if not differences.changes else [f"{_count(differences)}:"]
    for equation, of_equation in groupby(differences.changes, key=lambda change: change.equation):
        lines += ["", equation]
        for change in of_equation:
            if change.kind == "changed":
                lines += [f"  changed  {plain(change.before)}", f"      to   {plain(change.after)}"]
            else:
                lines.append(f"  {change.kind:<8} {plain(_one(change))}")
    if differences.probes:
        rows = [_HEADS, *_rows(differences)]
        widths = [max(len(row[k]) for row in rows) for k in range(len(_HEADS))]
        lines += ["", *("  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths)).rstrip() for row in rows)]
        lines += ["", *_lines(differences)]
    return "\n".join(lines)


def as_markdown(differences: Differences) -> str:
    """The differences as Markdown, formulas between dollar signs."""
    lines = [f"# {differences.names[0]} and {differences.names[1]}", "", f"{_count(differences)}.", ""]
    if differences.changes:
        lines += ["| equation | term | A | B |", "|---|---|---|---|"]
    lines += [
        f"| {change.equation} | {change.kind} | {_math(change.before)} | {_math(change.after)} |"
        for change in differences.changes
    ]
    if differences.probes:
        lines += ["", f"| {' | '.join(_HEADS)} |", "|" + "---|" * len(_HEADS)]
        lines += [f"| {' | '.join(row)} |" for row in _rows(differences)]
        lines += ["", *(f"* {line}" for line in _lines(differences))]
    return "\n".join(lines)


def as_latex(differences: Differences) -> str:
    """The differences as a LaTeX document."""
    body = []
    for equation, of_equation in groupby(differences.changes, key=lambda change: change.equation):
        body += [rf"\paragraph{{{_tex(equation)}}}", r"\begin{align*}"]
        body.append(" \\\\\n".join(_aligned(change) for change in of_equation))
        body.append(r"\end{align*}")
    if differences.probes:
        body += [r"\begin{tabular}{rrlrlrr}", " & ".join(map(_tex, _HEADS)) + r" \\ \hline"]
        body += [" & ".join(map(_tex, row)) + r" \\" for row in _rows(differences)]
        body += [r"\end{tabular}", "", *(rf"{_tex(line)}\\" for line in _lines(differences))]
    head = [r"\documentclass[a4paper,10pt]{article}", r"\usepackage{amsmath}", r"\usepackage[margin=2cm]{geometry}"]
    title = rf"\section*{{{_tex(differences.names[0])} and {_tex(differences.names[1])}}}"
    return "\n".join([*head, r"\begin{document}", title, *body, r"\end{document}"])


def _count(differences: Differences) -> str:
    number = len({change.equation for change in differences.changes})
    return f"{number} equation{'s' if number != 1 else ''} differ{'s' if number == 1 else ''}"


def _one(change: Change) -> object:
    return change.after if change.before is None else change.before


def _math(expression: object) -> str:
    return "" if expression is None else f"${_typeset(expression)}$".replace("|", r"\vert ")


def _aligned(change: Change) -> str:
    if change.kind == "changed":
        return rf"  &\text{{changed}} & {_typeset(change.before)} &\;\to\; {_typeset(change.after)}"
    return rf"  &\text{{{change.kind}}} & {_typeset(_one(change))} &"


def _rows(differences: Differences) -> list[tuple[str, ...]]:
    rows = []
    for probe in differences.probes:
        cells = [f"{math.degrees(probe.angle):g}", f"{probe.stokes:.4g}"]
        for result in probe.results:
            cells += ["failed", "-"] if result is None else [_SHORT[result[0]], f"{result[1]:.6g}"]
        one, other = probe.results
        cells.append("-" if one is None or other is None else f"{other[1] - one[1]:.2g}")
        rows.append(tuple(cells))
    return rows


def _lines(differences: Differences) -> list[str]:
    """Lines for the changes of outcome along 45 deg on either side."""
    rows: list[str] = []
    sides = [{name: (stokes, ce) for name, stokes, ce in line} for line in differences.boundaries]
    for name in dict.fromkeys(name for side in sides for name in side):
        parts = []
        for label, side in zip("AB", sides):
            stokes, ce = side.get(name, (None, None))
            known = "none" if stokes is None else f"St* {stokes:.6g}" + ("" if ce is None else f", Ce* {ce:.5g}")
            parts.append(f"{label} {known}")
        rows.append(f"at 45 deg, {name}: {'; '.join(parts)}")
    return rows


def _tex(text: str) -> str:
    for sign, instead in (("_", r"\_"), ("&", r"\&"), ("%", r"\%"), ("->", r"$\to$")):
        text = text.replace(sign, instead)
    return text
