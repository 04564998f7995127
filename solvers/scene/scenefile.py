"""Scene files: TOML text to entries and back, and the presets that ship with the package."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InputError, did_you_mean
from ..host import bounded
from . import units
from .fields import Raw
from .schema import FIELDS, TABLES
from .user_model import unknown
from .user_model_declared import TABLE

if TYPE_CHECKING:
    from .user_model import Package

OF_THE_PAPER = ("granulation", "pendulum", "granulation-dry-bridge")
PRESETS = (*OF_THE_PAPER, "glass-beads-water", "lactose-pvp", "pellet-coating")
_FOLDER = Path(__file__).with_name("presets")
_LARGEST = 200_000  # bytes; bounded because a file such as /dev/zero has no end
_HEADER = re.compile(r"\s*\[\s*([A-Za-z_]+)\s*\]")
_LINE = 200  # characters of a line that is looked at more closely
_BARE = re.compile(r"\s*([A-Za-z_]+)\s*=\s*([-+]?\d[^\"'#\[\]{}]*?)\s*(?:#.*)?")
_REMARK = re.compile(r"\s*([A-Za-z_]+)\s*=\s*(?:\"(?:[^\"\\\\]|\\\\.)*+\"|'[^']*+'|[^\"'#]*+)\s*#\s*(.*\S)")


def read_text(source: str | Path) -> tuple[str, str]:
    """Return the text of a preset (by name) or a file, and the name to use for it in errors."""
    if isinstance(source, str) and source in PRESETS:
        return _preset(source), source
    accepted = "a scene file (TOML) or a preset: " + ", ".join(PRESETS)
    if not isinstance(source, (str, os.PathLike)):
        raise InputError("scene", source, f"a Scene, {accepted}", "is not the name of a file")
    if isinstance(source, str) and not source.strip():  # Path("") would be the current folder
        raise InputError("scene", source, accepted, "is an empty name")
    absent = "is neither a file nor a preset"
    if isinstance(source, str) and not re.search(r"[/\\]|\.toml$", source) and not bounded.exists(source):
        beside = f"{source}.toml"
        absent += f", did you mean {beside}?" if bounded.exists(beside) else did_you_mean(source, PRESETS)
    content = bounded.read(os.fspath(source), _LARGEST, "scene", accepted, absent)
    try:
        return content.decode("utf-8-sig"), str(source)
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise InputError(f"{source}, line {line}", None, accepted, "is not UTF-8 text") from None


@cache
def _preset(name: str) -> str:
    return (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")


def template(name: str) -> str:
    """Return a scene to be filled in, with a comment on every entry: `scenes --new NAME`."""
    text = (_FOLDER / "template.toml").read_text(encoding="utf-8")
    return text.replace('name = "template"', f"name = {_text(name)}", 1)


def description(preset: str) -> str:
    """Return the description of a preset: the first comment of its file."""
    return read_text(preset)[0].partition("\n")[0].removeprefix("#").strip()


def parse(text: str, origin: str) -> dict[str, Any]:
    """Return the tables of TOML `text`; InputError with file and line if it is broken."""
    import tomllib

    if not isinstance(text, str):
        raise InputError(origin, text, "a scene in TOML", "is not text")
    if len(text) > _LARGEST:
        raise InputError(origin, None, "a scene in TOML", f"is larger than {_LARGEST} characters")
    if not text.strip():
        raise InputError(origin, None, "a scene in TOML, as `wetdoublet scenes NAME` prints one", "is empty")
    if bounded.too_deep(text):
        raise InputError(origin, None, "a scene in TOML: [TABLE] and KEY = VALUE", "is nested too deeply")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # TOMLDecodeError, integers of 5000 digits
        message = str(error)
        at = re.search(r"\s*\(at (?:line (\d+), column \d+|end of document)\)", message)
        lines = text.splitlines() or [""]
        line = int(at[1]) if at and at[1] else len(lines)
        problem = message[: at.start()] if at else message
        where = f"{origin}, line {line}" if at else origin
        value = lines[min(line, len(lines)) - 1].strip() if at else None
        accepted = _as_toml(value or "")
        raise InputError(where, value, accepted, f"is broken TOML ({' '.join(problem.split())})") from None


def _as_toml(line: str) -> str:
    """What is accepted in place of a line that is no TOML, such as `diameter = 2 mm` or `dry_restitution = 0,8`."""
    bare = _BARE.fullmatch(line)
    if bare is None or len(line) > _LINE:
        return "a scene in TOML"
    key, value = bare[1], bare[2].replace(",", ".")
    if units.is_number(bare[2]):
        return "a scene in TOML"  # what is wrong is not the number
    return f"{key} = {value}, with a point" if units.is_number(value) else f'text in quotes, {key} = "{value}"'


def remarks(text: str) -> dict[str, str]:
    """Return the comments behind the entries of valid TOML, each on its entry's line: dotted name -> comment."""
    result, table = {}, ""
    for line in text.splitlines():
        if header := _HEADER.match(line):
            table = header[1]
        elif comment := _REMARK.match(line):
            result[f"{table}.{comment[1]}"] = comment[2].strip()
    return result


def flatten(tables: Mapping[str, Any], package: Package | None = None) -> dict[str, Any]:
    """Return entries by dotted name, in the order of their tables, without `name`; InputError for a non-table."""
    entries: dict[str, Any] = {}
    for table, content in tables.items():
        if table == "name":
            continue
        if table not in (*TABLES, TABLE):
            homes = [f"[{home}]" for home in TABLES if f"{home}.{table}" in FIELDS]
            hint = f", belongs in {' or '.join(homes)}" if homes else did_you_mean(table, (*TABLES, "name"))
            raise InputError(str(table), content, "name, " + ", ".join(TABLES), "has an unknown name" + hint)
        if not isinstance(content, Mapping):
            raise InputError(table, content, f"a table [{table}]", "is not a table")
        if table == TABLE and not content and package is None:
            raise unknown(table, content, None)
        entries |= {f"{table}.{key}": value for key, value in content.items()}
    return entries


def write(name: str, entries: Mapping[str, Raw], comments: Mapping[str, str]) -> str:
    """Return a scene as TOML: units as given; SI units for plain numbers."""
    lines = [f"name = {_text(name)}"] if name else []
    table = ""
    for entry, value in entries.items():
        if entry.partition(".")[0] != table:
            table = entry.partition(".")[0]
            lines += ["", f"[{table}]"] if lines else [f"[{table}]"]
        comment = f"  # {comments[entry]}" if entry in comments else ""
        lines.append(f"{entry.partition('.')[2]} = {_value(entry, value)}{comment}")
    return "\n".join(lines) + "\n"


def written(entry: str, value: Raw) -> Raw:
    """Return a stored value as in a scene file: text with its unit, or a plain number."""
    unit = FIELDS[entry].unit if entry in FIELDS else None  # quantities of a user's model are stored with their units
    return f"{value!r} {unit}" if unit and not isinstance(value, str) else value


def _value(entry: str, value: Raw) -> str:
    value = written(entry, value)
    if isinstance(value, bool):
        return "true"
    return _text(value) if isinstance(value, str) else repr(value)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
