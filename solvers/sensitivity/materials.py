"""Materials in a table, one scene a row."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..errors import InputError, did_you_mean
from ..scene.columns import columns_of, file_label, row_name
from ..scene.entry_rules import check_entries
from ..scene.scene import Scene
from ..scene.schema import FIELDS, MEETING
from ..scene.user_model import Package, fields
from ..scene.user_model_source import open_package

_SD = "_sd"
_BARE = {name.rpartition(".")[2]: name for name in reversed(FIELDS)}
_OF_IMPACT = {name.removeprefix("impact."): name for name in MEETING}  # as tables of measurements have them
_TABLE = "a CSV file whose first line names the columns, such as particles.diameter [um],liquid.viscosity [mPa s]"


@dataclass(frozen=True)
class Material:
    """A scene with its name in the table, standard deviations of its entries by dotted name, and a remark if any."""

    label: str
    scene: Scene
    uncertainty: Mapping[str, Any] = field(default_factory=dict)
    remark: str = ""


def materials_of(
    source: Any, changes: Mapping[str, Any] | None = None, model: str | Path | Package | None = None
) -> list[Material]:
    """The materials of a table, or the one that a scene is; a list of them is returned as it is.

    Arguments:
        source: a Scene, a path or a preset's name; or a CSV file, a DataFrame or a mapping of columns. Columns are
            entries by dotted name with their unit in brackets, as `particles.diameter [um]`; in Python plain numbers
            are SI where none is written. `NAME_sd` is the entry's standard deviation, with a unit or in %. A column
            `scene` names the scene file or preset that a row changes. Other columns without dot and unit are the row's
            name.
        changes: entries that all materials share, in place of the table's.
        model: a user's model, whose quantities may be columns, as `custom.yield_stress [Pa]`.

    Raises:
        InputError: an unknown entry, or a row that makes no scene.
    """
    if isinstance(source, list):
        return source
    is_table = Path(source).suffix.lower() == ".csv" if isinstance(source, (str, Path)) else hasattr(source, "keys")
    if not is_table:
        scene = Scene.load(source, model)
        return [Material(scene.name, scene.with_entries(changes) if changes else scene)]
    package = None if model is None else open_package(model, "model")
    declared = fields(package)
    columns, lines = columns_of(source, "materials", _TABLE)
    columns = [replace(column, name=_OF_IMPACT.get(column.name, column.name)) for column in columns]
    table = file_label(source, "materials")
    if not lines:
        raise InputError(table, None, "at least one row", "has no rows")
    for column in columns:
        name = column.name.removesuffix(_SD)
        if name not in declared and ("." in name or name in _BARE or column.unit):
            meant = f", did you mean {_BARE[name]}?" if name in _BARE else did_you_mean(name, [*declared, *_BARE])
            accepted = "entries of a scene by dotted name, and names of the rows without unit"
            raise InputError(f"{table}, header", column.name, accepted, f"is unknown{meant}")
        if name in declared and declared[name].unit and column.unit is None and isinstance(source, (str, Path)):
            accepted = f"the unit in brackets, such as {name} [{declared[name].unit}]"
            raise InputError(f"{table}, header", column.name, accepted, "has no unit")
    rows = []
    for k, line in enumerate(lines):
        cells = {column.name: _cell(column.unit, column.cells[k]) for column in columns}
        entries = {name: value for name, value in cells.items() if name in declared and value is not None}
        spread = {name.removesuffix(_SD): value for name, value in cells.items() if name.endswith(_SD) and value}
        names = [str(value) for name, value in cells.items() if "." not in name and name != "scene" and value]
        label = ", ".join(names) or row_name(k + 1, line)
        try:
            scene = _scene(cells.get("scene"), entries, package).with_entries(changes or {})
        except InputError as error:
            where = f"{table}, {label}{f' (line {line})' * bool(names)}, {error.field}"
            raise InputError(where, error.value, error.accepted, error.problem) from None
        empty = ", ".join(name for name, value in cells.items() if name in declared and value is None)
        remark = f"empty in the table and left as in {cells.get('scene') or 'a scene without it'}: {empty}"
        rows.append(Material(label, scene, spread, remark if empty else ""))
    return rows


def _scene(base: Any, entries: Mapping[str, Any], package: Package | None) -> Scene:
    if base:
        return Scene.load(str(base), package).with_entries(entries)
    if package is not None:
        check_entries(entries, package)
        entries = {**entries, **package.chosen(entries)}
    tables: dict[str, dict[str, Any]] = {}
    for name, value in entries.items():
        table, _, key = name.partition(".")
        tables.setdefault(table, {})[key] = value
    return Scene.from_dict(tables, package=package)


def _cell(unit: str | None, cell: Any) -> Any:
    """A cell with its column's unit; None for an empty one."""
    if cell is None or cell != cell or (isinstance(cell, str) and not cell.strip()):
        return None
    text = cell.strip() if isinstance(cell, str) else cell
    if unit:
        return f"{text} {unit}"
    try:
        return float(text)
    except ValueError:
        return text
