"""The reference of the scene file, from the schema: name, unit, range, default, meaning."""

from __future__ import annotations

import ast
import inspect
from itertools import pairwise

from wetdoublet.solvers.scene import schema
from wetdoublet.solvers.scene.fields import Field
from wetdoublet.solvers.scene.schema import ALTERNATIVES, FIELDS, KINDS, TABLES


def pages() -> dict[str, str]:
    """The tables of a scene as Markdown."""
    meanings = declared_meanings()
    return {"_emitted/scene-tables.md": "\n".join(_table(name, meanings) for name in TABLES)}


def declared_meanings() -> dict[str, str]:
    """Dotted name -> the text below the entry's declaration."""
    classes = (node for node in ast.parse(inspect.getsource(schema)).body if isinstance(node, ast.ClassDef))
    return {
        f"{kind.name.lower()}.{line.target.id}": " ".join(below.value.value.split())
        for kind in classes
        for line, below in pairwise(kind.body)
        if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name)
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant)
        if f"{kind.name.lower()}.{line.target.id}" in FIELDS
    }


def _table(name: str, meanings: dict[str, str]) -> str:
    lines = [f"## `[{name}]`", "", " ".join((inspect.getdoc(KINDS[name]) or "").split()), ""]
    for entry in TABLES[name]:
        lines += _entry(FIELDS[entry], meanings[entry].removesuffix("."))
    return "\n".join(lines)


def _entry(field: Field, meaning: str) -> list[str]:
    facts = [_kind(field)]
    if field.numeric:
        facts.append(field.range.text)
    others = [other for group in ALTERNATIVES if field.name in group for other in group if other != field.name]
    if field.required:
        facts.append("**required**")
    elif others:
        facts.append("or " + ", ".join(dict.fromkeys(f"`{FIELDS[other].key}`" for other in others)))
    if field.default is not None:
        default = {"contact_angle": "0 deg", "gravity": "9.81 m/s^2"}.get(field.key, field.default)
        facts.append(f"default `{default}`")
    lines = [f"`{field.key}`", f": {meaning}<br>{', '.join(facts)}", ""]
    lines += [f"  * `{choice}`: {meaning}" for choice, meaning in field.choices.items()]
    return [*lines, ""] if field.choices else lines


def _kind(field: Field) -> str:
    if field.flag:
        return "`true`"
    if field.choices:
        return "one of the following"
    if field.unit:
        return f"text with its unit ({field.unit if field.unit != 'rad' else 'angle'}), as `{field.example}`"
    return f"number, as `{field.example}`"
