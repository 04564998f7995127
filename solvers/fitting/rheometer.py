"""Shear rates and viscosities of a flow curve, from what rheometers export.

A line names the columns, with units in brackets, behind "in", or in the next line; lines before it are its header. The
text may be UTF-16 (RheoCompass), have blocks of steps (TRIOS) and decimal commas.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..scene import units
from ..scene.columns import DECIMAL_COMMA, text_of

_ACCEPTED = "a CSV file with columns such as shear rate [1/s] and viscosity [mPa s], or shear stress [Pa]"
_COLUMNS = {
    "rate": (
        r"shear[ _-]?rate|strain[ _-]?rate|scherrate|schergeschwindigkeit|taux de cisaillement|gamma[ _]?dot|γ̇|gp|d",
        "rad/s",
    ),
    "viscosity": (r"(?:shear |dynamic |apparent |scher)?[ _]?visco(?:sity|sité)|(?:scher)?viskosität|eta|η", "Pa s"),
    "stress": (r"(?:shear)?[ _-]?stress|schubspannung|contrainte(?: de cisaillement)?|tau|τ|σ", "Pa"),
}
_HEAD = re.compile(r"\s*(?P<name>.*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])]|\bin (?P<plain>\S+))?\s*")
_SPELT = {"1/sec": "1/s", "sec^-1": "1/s", "sec-1": "1/s", "s-1": "1/s"}
_PER_MINUTE = re.compile(r"1/min|min\^?-1", re.IGNORECASE)
_TURNS = re.compile(r"[km]?hz|rpm|rev/min|u/min|r/min", re.IGNORECASE)
_APART = 0.05  # part by which a stress may differ from rate times viscosity: more than any export rounds


def flow_curve_of(source: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Shear rates (1/s) and viscosities (Pa s), as they were measured one after another.

    Raises:
        InputError: no such file, no such columns or units, or a number that is not positive.
    """
    rows = [_cells(line) for line in text_of(source, "CURVE.csv", _ACCEPTED).splitlines()]
    heads = ((k, names) for k, row in enumerate(rows) if "rate" in (names := _named(row)) and len(names) > 1)
    line, places = next(heads, (0, {}))
    if not places:
        raise InputError("CURVE.csv", str(source), _ACCEPTED, "has no line that names a shear rate and a viscosity")
    factors, first = {}, line + 1
    for kind, place in places.items():
        unit = _parts(rows[line][place])[1]
        while not unit and first < len(rows) and not _numbers(rows[first], places):
            below = rows[first][place] if place < len(rows[first]) else ""
            unit = _parts(below)[1] or below.strip()
            first += 0 if unit else 1
        factors[kind] = _factor(unit, kind, f"CURVE.csv {source}, {rows[line][place].strip()}")
    values = [numbers for row in rows[line + 1 :] if (numbers := _numbers(row, places))]
    if len(values) < 3:
        raise InputError("CURVE.csv", str(source), "three rates at least", f"has {len(values)} rows of numbers")
    table = {kind: np.array([row[kind] for row in values]) * factors[kind] for kind in places}
    if len(table) == 3:
        with np.errstate(all="ignore"):
            product = table["rate"] * table["viscosity"]
            parts = np.abs(table["stress"] / product - 1)
        if (parts > _APART).any():
            row = int(np.argmax(parts > _APART))
            accepted = f"shear rate times viscosity, {product[row]:.4g} Pa, to {_APART:.0%}"
            problem = f"of row {row + 1} contradicts the viscosity: is a unit wrong?"
            raise InputError(f"CURVE.csv {source}, stress", float(table["stress"][row]), accepted, problem)
    viscosity = table["viscosity"] if "viscosity" in table else table["stress"] / table["rate"]
    for kind, column in (("shear rate", table["rate"]), ("viscosity", viscosity)):
        wrong = np.flatnonzero(~(np.isfinite(column) & (column > 0)))
        if wrong.size:
            row = int(wrong[0])
            raise InputError(f"CURVE.csv {source}, {kind}", float(column[row]), "a number > 0", f"of row {row + 1}")
    return table["rate"], viscosity


def _cells(line: str) -> list[str]:
    if re.match(r"\s*[-+.,\d]", line):
        line = re.sub(r"\s#.*", "", line)  # a remark behind numbers
    separator = next(mark for mark in "\t;," if mark in line or mark == ",")
    cells = next(csv.reader([line], delimiter=separator), [])
    if separator != ",":
        cells = [cell.replace(",", ".") if DECIMAL_COMMA.fullmatch(cell) else cell for cell in cells]
    return cells


def _named(row: list[str]) -> dict[str, int]:
    """The columns that a line names, by what they are; the first of each."""
    places: dict[str, int] = {}
    for place, cell in enumerate(row):
        name = _parts(cell)[0].lower()
        for kind, (pattern, _) in _COLUMNS.items():
            if re.fullmatch(pattern, name):
                places.setdefault(kind, place)
    return places


def _parts(cell: str) -> tuple[str, str]:
    match = _HEAD.fullmatch(cell)
    assert match is not None
    return match["name"].strip(), (match["unit"] or match["plain"] or "").strip()


def _factor(unit: str, kind: str, label: str) -> float:
    wanted = _COLUMNS[kind][1]
    if not unit:
        accepted = f"a unit behind the name, as [{'1/s' if kind == 'rate' else wanted}]"
        raise InputError(label, None, accepted, "has no unit")
    spelt = units.spelling(unit)
    if kind == "rate" and _PER_MINUTE.fullmatch(spelt):
        return 1 / 60
    if kind == "rate" and _TURNS.fullmatch(spelt):
        problem = "is a frequency or a speed of rotation, which the geometry of the rheometer makes a shear rate"
        raise InputError(label, unit, "a shear rate in 1/s or 1/min", problem)
    spelt = _SPELT.get(spelt.lower(), spelt)
    return units.factor(spelt, wanted, label, _ACCEPTED, unit)


def _numbers(row: list[str], places: dict[str, int]) -> dict[str, float]:
    """The numbers of a row; none where one is missing."""
    cells = {kind: row[place] if place < len(row) else "" for kind, place in places.items()}
    whole = all(units.is_number(cell) for cell in cells.values())
    return {kind: float(cell) for kind, cell in cells.items()} if whole else {}
