"""Measurements from a CSV file, a pandas DataFrame, an xarray Dataset or a mapping of columns; each cell is checked."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...generated import scaling
from ...generated.automaton import BOUNCE, OUTCOMES, ROTATE, STICK
from ..errors import InputError, did_you_mean
from ..scene import units
from ..scene.held import NAMES
from ..scene.quantities import quantities
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPEEDS
from .columns import Column, columns_of
from .measurements import OBSERVED, UNKNOWN, Measurements

_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+")
_MISSING = ("", "-", "na", "n/a", "nan", "null", "none")
_WORDS = {
    STICK: OUTCOMES.index(STICK), "sticks": OUTCOMES.index(STICK), "s": OUTCOMES.index(STICK),
    ROTATE: OUTCOMES.index(ROTATE), "srs": OUTCOMES.index(ROTATE),
    BOUNCE: OUTCOMES.index(BOUNCE), "bounces": OUTCOMES.index(BOUNCE), "b": OUTCOMES.index(BOUNCE),
}  # fmt: skip
_UNITS = {"restitution": "", "tangential_restitution": "", "contact_time": "s", "rotation": "rad"}
_IMPACT = {"speed": "m/s", "relative_speed": "m/s", "stokes": "", "angle": "rad"}
_SPREAD = {"speed_sd": "m/s", "relative_speed_sd": "m/s", "angle_sd": "rad"}
_OF_SPEED = ("speed_sd", "relative_speed_sd")
SPEED_SD, ANGLE_SD = 0.02, math.radians(1.0)
"""Scatter of single impacts where the data do not say it: of the speed, relative; of the angle."""
RESULT_SD = {"restitution": 0.02, "tangential_restitution": 0.02, "contact_time": 0.05, "rotation": math.radians(2.0)}
"""Standard deviation of measured results where the data do not say it; of the contact time relative."""
_NOISE = 5.0  # standard deviations by which a measured restitution may lie below 0
_WIDEST = 1 / 3  # relative scatter of a speed


def read_data(source: Any, scene: Scene, label: str = "data") -> Measurements:
    """Measured impacts, checked.

    Arguments:
        source: a CSV file whose first line names the columns with their units, or a DataFrame, Dataset or mapping of
            columns; in these plain numbers are SI and radians.
        scene: what the columns leave out.

    Columns: speed, relative_speed or stokes, and angle; speed_sd, angle_sd; outcome; restitution,
    tangential_restitution, contact_time, rotation, each with NAME_sd; entries of the scene by their dotted names.
    Standard deviations may be in %. Empty cells are missing. Restitution 0 without an outcome is a stick.

    Raises:
        InputError: an unknown column or unit, or a bad cell, named by row and column.
    """
    columns, lines = columns_of(source, label)
    table = _Table(columns, lines, scene, label)
    return table.measurements()


class _Table:
    def __init__(self, columns: list[Column], lines: list[int], scene: Scene, label: str) -> None:
        self.scene, self.label, self.lines = scene, label, lines
        self.size = len(lines)
        if not self.size:
            raise InputError(label, None, "at least one row", "has no rows")
        self.by_name: dict[str, Column] = {}
        for column in columns:
            self._check_name(column)
            self.by_name[column.name] = column
        self.remarks: list[str] = []

    def _check_name(self, column: Column) -> None:
        entries = [name for name in self.scene.fields if name not in MEETING and not self.scene.fields[name].choices]
        known = (*_IMPACT, *_SPREAD, "outcome", *OBSERVED, *(f"{name}_sd" for name in OBSERVED), *entries)
        if column.name not in known:
            simple = ", ".join((*_IMPACT, *_SPREAD, "outcome", *OBSERVED, *(f"{name}_sd" for name in OBSERVED)))
            accepted = f"{simple}, and entries of the scene by dotted name; notes are written after #"
            raise InputError(
                f"{self.label}, header", column.name, accepted, "is unknown" + did_you_mean(column.name, known)
            )
        if column.name in self.by_name:
            raise InputError(f"{self.label}, header", column.name, "each column once", "is given twice")
        if column.name in entries and column.name.partition(".")[0] not in {
            n.partition(".")[0] for n, _ in self.scene.si
        }:
            raise InputError(
                f"{self.label}, header", column.name, "entries of the scene's tables", "has no table there"
            )

    def _where(self, row: int, name: str) -> str:
        line = f" (line {self.lines[row]})" if self.lines[row] != row + 1 else ""
        return f"{self.label}, row {row + 1}{line}, column {name}"

    def _numbers(self, name: str, si: str, holds: Callable[[float], bool], words: str) -> np.ndarray:
        """A column in SI, NaN where a cell is missing; parts of one for a column in %."""
        column = self.by_name[name]
        parts = column.unit == "%"
        unit = "" if parts or column.unit is None else column.unit
        text_source = any(isinstance(cell, str) for cell in column.cells)
        if si and column.unit is None and text_source:
            raise InputError(
                f"{self.label}, header", name, f"the unit in brackets, such as {name} [{_shown(si)}]", "has no unit"
            )
        field = f"{self.label}, header"
        factor = (
            0.01
            if parts
            else units.factor(unit, si or None, field, f"{name} in {_shown(si)}", f"{name} [{unit}]")
            if (unit or si) and column.unit is not None
            else 1.0
        )
        found = np.full(self.size, np.nan)
        for row, cell in enumerate(column.cells):
            value = self._cell(cell, row, name, words)
            if value is None:
                continue
            found[row] = value * factor
            if not (math.isfinite(value) and (holds(found[row]))):
                raise InputError(self._where(row, name), cell, words, "is out of range")
        return found

    def _cell(self, cell: Any, row: int, name: str, words: str) -> float | None:
        if cell is None or (isinstance(cell, float) and math.isnan(cell)):
            return None
        if isinstance(cell, str):
            text = cell.strip()
            if text.lower() in _MISSING:
                return None
            if _DECIMAL_COMMA.fullmatch(text):
                raise InputError(self._where(row, name), text, "numbers with a decimal point", "has a decimal comma")
            return units.number(text, self._where(row, name), words)
        try:
            return float(cell)
        except (TypeError, ValueError, OverflowError):
            raise InputError(self._where(row, name), cell, words, "is not a number") from None

    def measurements(self) -> Measurements:
        angle = self._angle()
        columns = self._entries()
        speed, relative, of_speed = self._speed(angle, columns)
        speed_sd, angle_sd = self._scatter(speed, of_speed)
        outcome, observed = self._outcome(), self._observed()
        seen = observed.get("restitution")
        if seen is not None:
            outcome = np.where((outcome == UNKNOWN) & (seen[0] == 0), _WORDS[STICK], outcome)
            for row in np.flatnonzero((outcome == UNKNOWN) & (seen[0] < 0)).tolist():
                said = "an outcome beside a restitution below 0, which may be a stick's"
                raise InputError(self._where(row, "restitution"), float(seen[0][row]), said, "is noise about 0")
            for row in np.flatnonzero((outcome == _WORDS[STICK]) & (np.abs(seen[0]) > 0)).tolist():
                said = "a stick has restitution 0, or an empty cell"
                raise InputError(self._where(row, "restitution"), float(seen[0][row]), said, "contradicts the outcome")
        stuck = outcome == _WORDS[STICK]
        observed = {name: (np.where(stuck, np.nan, values), sd) for name, (values, sd) in observed.items()}
        told = outcome != UNKNOWN
        for values, _ in observed.values():
            told |= np.isfinite(values)
        labels = tuple(f"row {row + 1}" for row in range(self.size))
        made = Measurements(
            speed, angle, speed_sd, angle_sd, outcome.astype(np.int8), observed, columns, relative, (), labels
        )
        if not told.all():
            if not told.any():
                accepted = "outcome, restitution or another result in at least one row"
                raise InputError(self.label, None, accepted, "says nothing of any impact")
            left = ", ".join(labels[k] for k in np.flatnonzero(~told)[:8])
            self.remarks.append(f"Left out, for neither outcome nor result is given: {left}.")
            made = made.part(np.flatnonzero(told))
        return replace(made, remarks=tuple(self.remarks))

    def _angle(self) -> np.ndarray:
        if "angle" in self.by_name:
            found = self._numbers("angle", "rad", lambda v: 0 <= v < math.pi / 2, "an angle from 0 to below 90 deg")
            self._no_gaps(found, "angle")
            return found
        if self.scene.angle is None:
            raise InputError(self.label, None, "a column angle [deg], or an impact angle in the scene", "has no angle")
        self.remarks.append(f"Angles are the scene's, {math.degrees(self.scene.angle):.6g} deg.")
        return np.full(self.size, self.scene.angle)

    def _no_gaps(self, values: np.ndarray, name: str) -> None:
        for row in np.flatnonzero(np.isnan(values)).tolist():
            raise InputError(self._where(row, name), None, "a number in every row", "is empty")

    def _entries(self) -> dict[str, np.ndarray]:
        found = {}
        for name in self.by_name:
            if "." not in name:
                continue
            entry = self.scene.fields[name]
            values = self._numbers(name, entry.unit or "", entry.range.holds, entry.accepts)
            self._no_gaps(values, name)
            found[name] = values
        return found

    def _speed(self, angle: np.ndarray, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray, bool, str]:
        given = [name.removeprefix("impact.") for name in SPEEDS if name.removeprefix("impact.") in self.by_name]
        if len(given) > 1:
            accepted = "only one of speed, relative_speed, stokes"
            raise InputError(f"{self.label}, header", given[1], accepted, f"is given together with {given[0]}")
        if not given:
            if self.scene.speed is None:
                raise InputError(self.label, None, "a column speed [m/s], or a speed in the scene", "has no speed")
            self.remarks.append(f"Normal speeds are the scene's, {self.scene.speed:.6g} m/s.")
            return np.full(self.size, self.scene.speed), False, "speed"
        name = given[0]
        found = self._numbers(name, _IMPACT[name], lambda v: v > 0, "a number > 0")
        self._no_gaps(found, name)
        if name == "stokes":
            own: dict[str, Any] = {entry: value for entry, value in self.scene.si if entry not in MEETING}
            of = quantities(own | dict(columns), self.scene.ways)
            found = found / scaling.stokes(of["reduced_radius"], of["reduced_mass"], of["viscosity"], 1.0)
            self.remarks.append("Normal speeds are those of the Stokes numbers with the scene's own entries.")
        return np.broadcast_to(found, self.size).copy(), name == "relative_speed", name

    def _scatter(self, speed: np.ndarray, of_speed: str) -> tuple[np.ndarray, np.ndarray]:
        accepted = f"a standard deviation from 0 to below {_WIDEST:.2g} of the speed"
        name = next((each for each in _OF_SPEED if each in self.by_name), None)
        if name is not None:
            values = self._numbers(name, "m/s", lambda v: v >= 0, accepted)
            speed_sd = values * speed if self.by_name[name].unit == "%" else values
            for row in np.flatnonzero(speed_sd >= _WIDEST * speed).tolist():
                raise InputError(self._where(row, name), self.by_name[name].cells[row], accepted, "is out of range")
        else:
            speed_sd = np.full(self.size, np.nan)
        if np.isnan(speed_sd).any():
            self.remarks.append(f"Scatter of the {NAMES[of_speed]}, where it is not given: {100 * SPEED_SD:g} %.")
            speed_sd = np.where(np.isnan(speed_sd), SPEED_SD * speed, speed_sd)
        angle_sd = np.full(self.size, np.nan)
        if "angle_sd" in self.by_name:
            angle_sd = self._numbers(
                "angle_sd", "rad", lambda v: 0 <= v < 0.5, "a standard deviation from 0 to 0.5 rad"
            )
        if np.isnan(angle_sd).any():
            self.remarks.append(f"Scatter of the angle, where it is not given: {math.degrees(ANGLE_SD):.3g} deg.")
            angle_sd = np.where(np.isnan(angle_sd), ANGLE_SD, angle_sd)
        for row in np.flatnonzero((speed_sd == 0) & (angle_sd == 0)).tolist():
            accepted = "speed_sd or angle_sd above 0: an outcome without scatter has no likelihood"
            raise InputError(self._where(row, "angle_sd"), 0, accepted, "is 0, as speed_sd is")
        return speed_sd, angle_sd

    def _outcome(self) -> np.ndarray:
        found = np.full(self.size, UNKNOWN)
        if "outcome" not in self.by_name:
            return found
        for row, cell in enumerate(self.by_name["outcome"].cells):
            if cell is None or (isinstance(cell, float) and math.isnan(cell)):
                continue
            if isinstance(cell, str):
                word = cell.strip().lower().replace("_", "-").replace(" ", "-")
                if word in _MISSING:
                    continue
                code = _WORDS.get(word)
            else:
                code = int(cell) if not isinstance(cell, bool) and cell in range(len(OUTCOMES)) else None
            if code is None:
                accepted = f"{STICK}, {ROTATE}, {BOUNCE}, or an empty cell"
                raise InputError(
                    self._where(row, "outcome"), cell, accepted, "is not known" + did_you_mean(cell, _WORDS)
                )
            found[row] = code
        return found

    def _observed(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        found = {}
        for name in OBSERVED:
            if name not in self.by_name:
                if f"{name}_sd" in self.by_name:
                    raise InputError(
                        f"{self.label}, header", f"{name}_sd", f"a column {name} beside it", "stands alone"
                    )
                continue
            signed = name != "contact_time"
            words = "a number" if signed else "a number >= 0"
            values = self._numbers(name, _UNITS[name], _any if signed else _not_negative, words)
            sd = np.full(self.size, np.nan)
            if f"{name}_sd" in self.by_name:
                sd = self._numbers(f"{name}_sd", _UNITS[name], lambda v: v > 0, "a standard deviation > 0")
                if self.by_name[f"{name}_sd"].unit == "%":
                    sd = sd * np.abs(values)
            gap = np.isnan(sd) & np.isfinite(values)
            if gap.any():
                relative = name == "contact_time"
                default = RESULT_SD[name] * (np.abs(values) if relative else 1.0)
                shown = f"{100 * RESULT_SD[name]:g} %" if relative else f"{RESULT_SD[name]:.4g}"
                shown = f"{math.degrees(RESULT_SD[name]):.3g} deg" if _UNITS[name] == "rad" else shown
                self.remarks.append(f"Standard deviation of {name}, where it is not given: {shown}.")
                sd = np.where(np.isnan(sd), default, sd)
            for row in np.flatnonzero(~(sd > 0) & np.isfinite(values) & (values != 0)).tolist():
                raise InputError(self._where(row, f"{name}_sd"), float(sd[row]), "a standard deviation > 0")
            sd = np.where(sd > 0, sd, RESULT_SD[name])
            for row in np.flatnonzero(values < -_NOISE * sd).tolist() if name == "restitution" else ():
                accepted = f"a number >= 0, or below by up to {_NOISE:g} standard deviations of noise"
                raise InputError(self._where(row, name), float(values[row]), accepted, "is out of range")
            found[name] = values, sd
        return found


def _any(value: float) -> bool:
    return math.isfinite(value)


def _not_negative(value: float) -> bool:
    return value >= 0


def _shown(si: str) -> str:
    return {"rad": "deg", "": "1"}.get(si, si)
