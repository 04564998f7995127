"""A scene as a table: every entry with its unit, what is a default or assumed, and what follows from them."""

import math
from collections.abc import Iterator
from textwrap import shorten

from .groups import System
from .schema import FIELDS, TABLES

_WIDTH = 100  # characters of a line
_VALUE = 16  # at least, of a value

Row = tuple[str, str, str]


def entries(scene: System) -> list[Row]:
    """Name, value and remark of every entry: those given, then the defaults that act."""
    assumed = dict(scene.comments)
    rows = [(name, _value(scene, name), assumed.get(name, "")) for name, _ in scene.given]
    return rows + [(name, value, "default") for name, value in _defaults(scene)]


def derived(scene: System) -> list[Row]:
    """What follows from the entries: the impact both ways, and the gap at which the two separate."""
    rows = [("film separates at" if scene.bridge is None else "bridge ruptures at", _si(scene.rupture_gap, "m"), "")]
    if scene.stokes is not None and scene.speed is not None:
        rows.append(("Stokes number", f"{scene.stokes:.5g}", ""))
        rows.append(("normal speed", _si(scene.speed, "m/s"), ""))
    return rows


def text(scene: System) -> str:
    """The table for a terminal."""
    blocks = [entries(scene), derived(scene)]
    name = max(len(row[0]) for rows in blocks for row in rows)
    value = max(_VALUE, *(len(row[1]) for rows in blocks for row in rows))
    lines = [scene.name or "unnamed scene"]
    for rows in blocks:
        lines.append("")
        lines += [_line(f"  {row[0]:<{name}}  {row[1]:<{value}}  ", row[2]) for row in rows]
    return "\n".join(lines)


def _line(entry: str, remark: str) -> str:
    return (entry + shorten(remark, max(_WIDTH - len(entry), 20), placeholder=" ...")).rstrip()


def _value(scene: System, name: str) -> str:
    raw, unit = dict(scene.given)[name], scene.fields[name].unit
    if isinstance(raw, str) or unit is None:
        return "true" if raw is True else str(raw)
    return f"{scene.entries[name]:.6g} {unit}"


def _defaults(scene: System) -> Iterator[tuple[str, str]]:
    given = dict(scene.given)
    for table in (scene.particles, scene.liquid, scene.bridge, scene.attraction, scene.pendulum, scene.model):
        for name in TABLES[table.name] if table else ():
            value, unit = FIELDS[name].default, FIELDS[name].unit
            if name not in given and value is not None and getattr(table, FIELDS[name].key) == value:
                yield name, f"{value:.6g} {unit or ''}".rstrip() if isinstance(value, float) else str(value)


def _si(value: float, unit: str) -> str:
    if not math.isfinite(value):
        return f"beyond a double ({unit})"
    return f"{value:.4g} {unit}"
