"""Differences of two models as text."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...generated.automaton import OUTCOMES
from ..formatting.markdown import aligned
from ..scene.scenefile import written
from ..scene.schema import MEETING
from .differences import Differences, OnMap

_SHORT = dict(zip(OUTCOMES, ("S", "SRS", "B"), strict=True))
_HEADS = ("angle (deg)", "St", "A", "e_n A", "B", "e_n B", "B - A")


def as_text(differences: Differences) -> str:
    """The differences as plain text."""
    from ...derive.emit.compare import count, in_lines  # imports sympy

    changes = differences.changes
    names = [scene.name for scene in differences.scenes] or [""] * 2
    sides = zip("AB", differences.names, names, strict=True)
    lines = [f"{side}: {model}" + f", in the scene {name}" * (name not in model) for side, model, name in sides] + [""]
    lines += [count(changes) + (":" if changes else ""), *in_lines(changes)]
    if entries := list(_entries(differences)):
        lines += ["", "entries that differ:", "", *aligned([("entry", "A", "B"), *entries])]
    if differences.probes:
        lines += ["", *aligned([_HEADS, *_rows(differences)]), "", *_lines(differences)]
    if differences.on_map:
        lines += ["", _on_map(differences.on_map)]
    return "\n".join(lines)


def _entries(differences: Differences) -> Iterator[tuple[str, str, str]]:
    """Name and both values of entries that differ, as the scenes give them; impacts apart."""
    given = [dict(scene.given) for scene in differences.scenes]
    values = [scene.entries for scene in differences.scenes]
    for name in dict.fromkeys(name for side in values for name in side):
        first, other = (side.get(name) for side in values)
        if first != other and name not in MEETING:
            before, after = ("-" if name not in side else str(written(name, side[name])) for side in given)
            yield name, before, after


def _on_map(what: OnMap) -> str:
    low, high = map(math.degrees, what.angle)
    number = sum(count for *_, count in what.moved)
    text = "on the map St {:.4g} to {:.4g}, ".format(*what.stokes) + f"{low:g} to {high:g} deg, "
    text += f"{number} of {what.impacts} impacts change outcome"
    text += f" ({', '.join(f'{a} -> {b} {count}' for a, b, count in what.moved)})" * bool(number)
    if what.farthest and what.farthest[0]:
        off, stokes, angle = what.farthest
        at = f"at St {stokes:.4g}, {math.degrees(angle):.4g} deg"
        text += f";\nwhere they do not, e_n differs by at most {abs(off):.2g}, {at}"
    return text


def _rows(differences: Differences) -> list[tuple[str, ...]]:
    rows = []
    for probe in differences.probes:
        cells = [f"{math.degrees(probe.angle):g}", f"{probe.stokes:.4g}"]
        for result in probe.results:
            cells += ["failed", "-"] if result is None else [_SHORT[result[0]], f"{result[1]:.6g}"]
        before, other = probe.results
        cells.append("-" if before is None or other is None else f"{other[1] - before[1]:.2g}")
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
            critical = "none" if stokes is None else f"St* {stokes:.6g}" + ("" if ce is None else f", Ce* {ce:.5g}")
            parts.append(f"{label} {critical}")
        rows.append(f"at 45 deg, {name}: {'; '.join(parts)}")
    return rows
