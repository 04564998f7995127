"""The reference of the scene file, from the schema: name, unit, range, default, meaning."""

from __future__ import annotations

from dataclasses import MISSING, fields

from meanings import CHOICES, ENTRIES
from meanings import TABLES as MEANING
from wetdoublet.solvers.scene import tables
from wetdoublet.solvers.scene.schema import ALTERNATIVES, FIELDS, TABLES, Field


def pages() -> dict[str, str]:
    """The tables of a scene as Markdown."""
    return {"_emitted/scene-tables.md": "\n".join(_table(name) for name in TABLES)}


def _table(name: str) -> str:
    lines = [f"## `[{name}]`", "", MEANING[name], ""]
    for entry in TABLES[name]:
        lines += _entry(FIELDS[entry])
    return "\n".join(lines)


def _entry(field: Field) -> list[str]:
    table, _, key = field.name.partition(".")
    facts = [_kind(field)]
    if not field.choices and not field.flag:
        facts.append(field.range.text)
    others = [other for group in ALTERNATIVES if field.name in group for other in group if other != field.name]
    if field.required:
        facts.append("**required**")
    elif others:
        alternatives = dict.fromkeys(f"`{other.partition('.')[2]}`" for other in others)
        facts.append("or " + ", ".join(alternatives))
    default = _default(table, key)
    if default is not None:
        facts.append(f"default `{default}`")
    lines = [f"`{key}`", f": {_sentence(ENTRIES[field.name])}<br>{', '.join(facts)}", ""]
    lines += [f"  * `{choice}`: {CHOICES[field.name][choice]}" for choice in field.choices]
    return [*lines, ""] if field.choices else lines


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:]


def _kind(field: Field) -> str:
    if field.flag:
        return "`true`"
    if field.choices:
        return "one of the following"
    if field.unit:
        return f"text with its unit ({field.unit if field.unit != 'rad' else 'angle'}), as `{field.example}`"
    return f"number, as `{field.example}`"


def _default(table: str, key: str) -> object:
    """The default of an entry, if it has one of its own."""
    kind = next(kind for kind in vars(tables).values() if getattr(kind, "name", None) == table)
    number = FIELDS[f"{table}.{key}"].default
    if number is not None:
        return {"contact_angle": "0 deg", "gravity": "9.81 m/s^2"}.get(key, number)
    for field in fields(kind):
        if field.name == key and field.default is not MISSING and field.default is not None:
            return field.default
    return None
