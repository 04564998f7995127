"""Differences of two models as text."""

from __future__ import annotations

import math
from itertools import groupby
from typing import TYPE_CHECKING

from ...generated.automaton import OUTCOMES
from ..formatting.markdown import aligned
from .differences import Differences

if TYPE_CHECKING:
    from ...derive.emit.compare import Change

_SHORT = dict(zip(OUTCOMES, ("S", "SRS", "B"), strict=True))
_HEADS = ("angle (deg)", "St", "A", "e_n A", "B", "e_n B", "B - A")


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
        lines += ["", *aligned([_HEADS, *_rows(differences)]), "", *_lines(differences)]
    return "\n".join(lines)


def _count(differences: Differences) -> str:
    number = len({change.equation for change in differences.changes})
    return f"{number} equation{'s' if number != 1 else ''} differ{'s' if number == 1 else ''}"


def _one(change: Change) -> object:
    return change.after if change.before is None else change.before


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
