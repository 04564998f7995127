"""Columns of a table of measurements, from a CSV file, pandas, xarray or a mapping, with the units of their names."""

import csv
import io
import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..host import bounded
from .schema import MEETING
from .units import COMMON, is_number, spelling

_LARGEST = 20_000_000  # bytes of a file
_MOST_ROWS = 100_000
_HEADER = re.compile(r"\s*([^\[\]()]+?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])])?\s*")
_BLANKS = re.compile(r"\s+(?![\[(])(?![^\[(]*[\])])")  # between names, not before or in a unit
_BETWEEN = re.compile(r"\s*[,;\t]\s*|\s+")
_PLAIN = ("-", "–")  # in place of a unit, as spreadsheets write it
_UNNAMED = re.compile(r"|unnamed(: ?\d+)?|index|level_0|row|#", re.IGNORECASE)
DECIMAL_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?\s*")
_DECIMAL_POINT = re.compile(r"\s*[-+]?\d*\.\d+(?!\d*[.,]).*")  # no date 12.03.2026, no thousands 1.798,7


@dataclass(frozen=True)
class Column:
    """Cells of a column; `unit` is None where none is written, "%" for parts of the value that they belong to."""

    name: str
    unit: str | None
    cells: list[Any]


_IMPACTS = "a CSV file whose first line names the columns, such as speed [m/s],angle [deg],restitution,outcome"


def file_label(source: Any, label: str) -> str:
    """What names a table in messages: with the path of its file, if it is one."""
    return f"{label} {source}" if isinstance(source, (str, Path)) else label


def columns_of(source: Any, label: str, accepted: str = _IMPACTS) -> tuple[list[Column], list[int]]:
    """The columns of a source, and the line of each row where it is a file, else the number of the row.

    A first column without a name that numbers the rows, as a DataFrame writes its index, is left out.
    """
    columns, lines = _read(source, label, accepted)
    return without_index(columns, label), lines


def without_index(columns: list[Column], label: str) -> list[Column]:
    """Columns without a first one that has no name and numbers the rows; InputError for others without a name."""
    if columns and _UNNAMED.fullmatch(columns[0].name) and all(map(_is_whole, columns[0].cells)):
        columns = columns[1:]
    for column in columns:
        if not column.name:
            raise InputError(f"{label}, header", "", "names of columns, with their unit in brackets", "is no name")
    return columns


def _is_whole(cell: Any) -> bool:
    return re.fullmatch(r"\s*\d+(\.0*)?\s*", str(cell)) is not None


def _read(source: Any, label: str, accepted: str) -> tuple[list[Column], list[int]]:
    if hasattr(source, "data_vars"):  # xarray
        frame = source.to_dataframe().reset_index()
        units = {str(name): source[name].attrs.get("units") for name in (*source.data_vars, *source.coords)}
        for name in source.dims:
            if name in source.coords and np.array_equal(source[name].values, np.arange(source.sizes[name])):
                del units[str(name)]  # it numbers the rows
        cells = {str(name): frame[name].tolist() for name in frame.columns if str(name) in units}
        return _columns(cells, label, {name: unit for name, unit in units.items() if isinstance(unit, str)})
    if isinstance(source, Mapping):
        return _columns({str(name): _listed(data, f"{label}, column {name}") for name, data in source.items()}, label)
    if hasattr(source, "columns") and hasattr(source, "iloc"):  # pandas
        if not source.columns.is_unique:
            name = source.columns[source.columns.duplicated()][0]
            raise InputError(f"{label}, header", str(name), "each column once", "is given twice")
        table = source.astype(object).where(source.notna(), None)  # pandas has several kinds of missing cells
        return _columns({str(name): table[name].tolist() for name in table.columns}, label)
    if isinstance(source, (str, Path)):
        return columns_from_text(text_of(source, label, accepted), label, str(source), accepted)
    accepted = "a CSV file, a DataFrame, a Dataset, or a mapping of columns"
    raise InputError(label, type(source).__name__, accepted, "is none of these")


def _listed(values: Any, label: str) -> list[Any]:
    cells = values.tolist() if hasattr(values, "tolist") else values
    if isinstance(cells, (list, tuple)):
        return list(cells)
    raise InputError(label, values, "a list or a 1-D array", "is not a column")


def _columns(
    cells: Mapping[str, list[Any]], label: str, units: Mapping[str, str] | None = None
) -> tuple[list[Column], list[int]]:
    """Columns of cells; `units` overrides the unit in brackets behind a name."""
    lengths = {name: len(values) for name, values in cells.items()}
    if len(set(lengths.values())) > 1:
        name, length = max(lengths.items(), key=lambda item: item[1])
        raise InputError(f"{label}, column {name}", f"{length} values", "columns of one length", "differs in length")
    headers = ((name, *_header(name, label)) for name in cells)
    columns = [Column(key, (units or {}).get(name, unit), cells[name]) for name, key, unit in headers]
    return columns, list(range(1, max(lengths.values(), default=0) + 1))


def text_of(source: str | Path, label: str, accepted: str = _IMPACTS) -> str:
    """The text of a file; InputError if it cannot be read."""
    content = bounded.read(source, _LARGEST, label, accepted)
    try:
        if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):  # "Unicode text" of Excel
            return content.decode("utf-16")
        with suppress(UnicodeDecodeError):
            return content.decode("utf-8-sig")
        return content.decode("ascii" if b"\0" in content else "cp1252")  # ° and µ of Excel and Fiji on Windows
    except UnicodeDecodeError:
        raise InputError(label, str(source), accepted, "is not UTF-8 text") from None


def columns_from_text(text: str, label: str, source: str, accepted: str = _IMPACTS) -> tuple[list[Column], list[int]]:
    """The columns of a CSV file's text, separated by commas, semicolons, tabs or blanks, and the line of each row."""
    data = _tabbed(_named([(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip(" \t,;")]))
    if not data:
        raise InputError(label, str(source), accepted, "has no line with names of columns")
    first = data[0][1]
    separator = max(",;\t", key=first.count)
    head, *rows = csv.reader(io.StringIO("\n".join(line for _, line in data)), delimiter=separator)
    while head and not head[-1].strip():
        head.pop()  # empty columns at the right, as spreadsheets leave them
    lines = [k for k, _ in data[1:]]
    if len(rows) != len(lines):
        raise InputError(label, str(source), accepted, "has a quoted cell that does not end on its line")
    if len(rows) > _MOST_ROWS:
        raise InputError(label, str(source), f"at most {_MOST_ROWS} rows", f"has {len(rows)} rows")
    columns = [Column(*_header(name, f"{label} {source}"), []) for name in head]
    if rows and all(column.unit is None for column in columns) and (units := _row_of_units(rows[0])):
        columns = [replace(column, unit=unit) for column, unit in zip_longest(columns, units[: len(columns)])]
        rows, lines = rows[1:], lines[1:]
    for k, (row, line) in enumerate(zip(rows, lines, strict=True), 1):
        cells = [cell.split("#")[0] if j == len(row) - 1 else cell for j, cell in enumerate(row)]
        if any(cell.strip() for cell in cells[len(head) :]):
            accepted = f"as many as the first line names: {len(head)} (# before a line that names none)"
            raise InputError(f"{label} {source}, {row_name(k, line)}", len(row), accepted, "cells are too many")
        cells += [""] * (len(head) - len(cells))
        for column, cell in zip(columns, cells):
            column.cells.append(cell)
    cells = [cell for column in columns for cell in column.cells]
    if separator != "," and not any(map(_DECIMAL_POINT.fullmatch, cells)):
        for column in columns:
            column.cells[:] = [c.replace(",", ".") if DECIMAL_COMMA.fullmatch(c) else c for c in column.cells]
    return columns, lines


def _named(lines: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Lines without comments; of a table that begins with numbers, the comment above that names them (numpy's)."""
    first = next((k for k, (_, line) in enumerate(lines) if line.lstrip()[0] != "#"), len(lines))
    data = [(number, line) for number, line in lines[first:] if line.lstrip()[0] != "#"]
    cells = _BETWEEN.split(data[0][1].strip()) if data else []
    if first == 0 or not data or not all(map(is_number, cells)):
        return data
    number, names = lines[first - 1][0], lines[first - 1][1].strip(" \t#")
    between = next((mark for mark in ",;\t" if mark in names), None)
    count = len(names.split(between) if between else _BLANKS.split(names))
    return [(number, names), *data] if count == len(cells) else data


def _tabbed(data: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Lines with tabs in place of blanks, where only these separate cells and all lines have as many."""
    names = _BLANKS.split(data[0][1].strip()) if data else []
    rows = [(number, line.partition("#")[0].split()) for number, line in data[1:]]
    if len(names) < 2 or any(mark in data[0][1] for mark in ',;\t"') or {len(row) for _, row in rows} != {len(names)}:
        return data
    return [(number, "\t".join(cells)) for number, cells in ((data[0][0], names), *rows)]


def _row_of_units(row: list[str]) -> list[str | None]:
    """The units of columns in a row below their names, as spreadsheets have them; none if it is data."""
    cells = [cell.strip().strip("[]()") for cell in row]
    units = [spelling(cell) in COMMON for cell in cells]
    if not all(unit or cell in ("", "%", *_PLAIN) for unit, cell in zip(units, cells)):
        return []
    if not any(unit and cell != "s" for unit, cell in zip(units, cells)):  # short for a stick
        return []
    return [None if not cell else "" if cell in _PLAIN else cell for cell in cells]


def row_name(row: int, line: int) -> str:
    """What names a row from 1 in messages, with its line in the file where that is another number."""
    return f"row {row} (line {line})" if row != line else f"row {row}"


def _header(text: str, label: str) -> tuple[str, str | None]:
    if not text.strip():
        return "", None
    match = _HEADER.fullmatch(text)
    if match is None:
        raise InputError(label, text, "names of columns, with their unit in brackets", "is no name of a column")
    name, unit = match[1].strip(), "" if match[2] in _PLAIN else match[2]
    return name.removeprefix("impact.") if name in MEETING else name, unit
