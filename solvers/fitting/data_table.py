"""Measured impacts from a table as people write it: names and units of columns, and every cell, are checked."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

import numpy as np

from ...generated import scaling
from ...generated.automaton import BOUNCE, OUTCOMES, ROTATE, STICK
from ..errors import InputError, did_you_mean, several
from ..scene import units
from ..scene.columns import DECIMAL_COMMA, Column, columns_of, file_label, row_name
from ..scene.held import NAMES
from ..scene.quantities import quantities
from ..scene.scene import Scene
from ..scene.schema import MEETING, SPEEDS
from .flights import ARRIVING, DEPARTING, FLIGHT, Flights
from .measurements import (
    ANGLE_SD,
    CORRELATION,
    OBSERVED,
    RESULT_SD,
    RESULTS,
    SPEED_SD,
    UNITS,
    UNKNOWN,
    Measurements,
)  # fmt: skip

_STICK = OUTCOMES.index(STICK)
_MISSING = ("", "-", "na", "n/a", "nan", "null", "none")
_ALIASES = {STICK: ("sticks", "s"), ROTATE: ("srs",), BOUNCE: ("bounces", "b")}
_WORDS = {word: OUTCOMES.index(name) for name, others in _ALIASES.items() for word in (name, *others)}
_IMPACT = {"speed": "m/s", "relative_speed": "m/s", "stokes": "", "angle": "rad"}
_SPREAD = ("speed_sd", "relative_speed_sd", "angle_sd")
_PLAIN = tuple(
    dict.fromkeys((*_IMPACT, *_SPREAD, "outcome", *RESULTS, *(f"{name}_sd" for name in RESULTS), CORRELATION))
)
_SPELT = {  # as people name columns, in small letters with underscores
    "speed": "v v_n vn velocity normal_speed normal_velocity impact_speed impact_velocity",
    "relative_speed": "v_rel vrel relative_velocity",
    "stokes": "st stokes_number st_n",
    "angle": "theta theta0 θ impact_angle angle_of_impact",
    "outcome": "result regime",
    "restitution": "e e_n en cor restitution_coefficient coefficient_of_restitution normal_restitution",
    "tangential_restitution": "e_t et",
    "contact_time": "t_c tc contact_duration",
    "rotation": "rotation_angle",
}
_CANONICAL = {word: name for name, words in _SPELT.items() for word in (name, *words.split())}
_EITHER = ("v", "velocity", "impact_speed", "impact_velocity")  # taken for the normal speed, often the magnitude
_DOTTED = re.compile(r"\w+\.\w+")  # no "Temp."
_SPREAD_WORDS = re.compile(r"(.*?)_*(sd|std|err|error|sigma|uncertainty)")
_MISSPELT = 0.75  # similarity to a known name from which an unknown column is refused and not left out
_NOISE = 5.0  # standard deviations by which a measured restitution may lie below 0
_WIDEST, _WIDEST_ANGLE = 1 / 3, 0.5  # relative scatter of a speed, that of an angle in rad


def read_data(source: Any, scene: Scene, label: str = "data") -> Measurements:
    """Measured impacts, checked.

    Arguments:
        source: a CSV file whose first line names the columns with their units, or a DataFrame, Dataset or mapping of
            columns; in these plain numbers are SI and radians. Measurements are returned as they are.
        scene: what the columns leave out.

    Columns, also as people name them (`v (mm/s)`, `COR`, `theta err`): speed, relative_speed or stokes, and angle;
    speed_sd, angle_sd; outcome; restitution, tangential_restitution, contact_time, rotation, each with NAME_sd; entries
    of the scene by their dotted names. FLIGHT, as `tracks` writes them, are used in place of speed, angle and results.
    Standard deviations may be in %. Empty cells are missing. Restitution 0 without
    an outcome is a stick. Other columns are not used, and named in a remark, unless they look like a misspelt name,
    or are in a unit of speed or angle where no column is the speed or the angle.

    Raises:
        InputError: an unknown column or unit, or a bad cell, named by row and column.
    """
    if isinstance(source, Measurements):
        return source
    return _Table(*columns_of(source, label), scene, file_label(source, label)).measurements()


class _Table:
    def __init__(self, columns: list[Column], lines: list[int], scene: Scene, label: str) -> None:
        self.scene, self.label, self.header, self.lines = scene, label, f"{label}, header", lines
        self.size = len(lines)
        if not self.size:
            raise InputError(label, None, "at least one row", "has no rows")
        self.by_name: dict[str, Column] = {}
        self.remarks: list[str] = []
        self.kind_unsaid = False
        self.unused: list[Column] = []
        for column in columns:
            name = _canonical(column.name)
            if self._is_known(name):
                self.by_name[name] = replace(column, name=name)
                if name != column.name:
                    self.kind_unsaid |= name == "speed" and _word(column.name) in _EITHER
                    meant = _MEANT.get("unsaid" if name == "speed" and self.kind_unsaid else name, name)
                    self.remarks.append(f'Column "{column.name}" is read as {meant}.')
            else:
                self.unused.append(column)
        if self.unused:
            self.remarks.append(f"Columns that are not used: {', '.join(item.name for item in self.unused)}.")

    def _is_known(self, name: str) -> bool:
        """Whether a column is used; InputError for a name that is close to a known one, and for a repeated one."""
        entries = [key for key in self.scene.fields if key not in MEETING and not self.scene.fields[key].choices]
        if name not in (*_PLAIN, *entries):
            dotted = _DOTTED.fullmatch(name)
            names = entries if dotted else [*_PLAIN, *_CANONICAL]
            if not dotted and not get_close_matches(name.lower(), names, cutoff=_MISSPELT):
                return False
            accepted = f"{', '.join(_PLAIN)}, and entries of the scene by dotted name"
            raise InputError(self.header, name, accepted, "is unknown" + did_you_mean(name, names))
        if name in self.by_name:
            raise InputError(self.header, name, "each column once", "is given twice")
        if name in entries and name.partition(".")[0] not in {entry.partition(".")[0] for entry, _ in self.scene.si}:
            raise InputError(self.header, name, "entries of the scene's tables", "has no table there")
        return True

    def _refuse_unused(self, kind: str) -> None:
        """InputError for an unused column in a unit of this kind, which no column is: its name is unknown."""
        for column in self.unused:
            if units.COMMON.get(units.spelling(column.unit or ""), ("", 0))[0] == _IMPACT[kind]:
                accepted = f'a column named {kind}, or "{column.name}" without its unit if it is another one'
                problem = f"is in {column.unit}, and no column is the {kind}"
                raise InputError(self.header, column.name, accepted, problem)

    def _where(self, row: int, name: str) -> str:
        return f"{self.label}, {row_name(row + 1, self.lines[row])}, column {name}"

    def _refuse(self, bad: np.ndarray, name: str, values: Any, accepted: str, problem: str = "") -> None:
        """Raise InputError for the first row of a mask."""
        for row in np.flatnonzero(bad).tolist():
            value = None if values is None else values[row]
            value = value.item() if isinstance(value, np.generic) else value
            raise InputError(self._where(row, name), value, accepted, *([problem] if problem else []))

    def _numbers(self, name: str, si: str, holds: Callable[[float], bool], words: str, gaps: bool = True) -> np.ndarray:
        """A column in SI; parts of one for a column in %.

        Arguments:
            holds: whether a number is accepted, and `words` for which are.
            gaps: cells may be missing; NaN there.
        """
        column, factor = self.by_name[name], 1.0
        unit = {"rad": "deg", "": "1"}.get(si, si)
        if si and column.unit is None and any(isinstance(cell, str) for cell in column.cells):
            raise InputError(self.header, name, f"the unit in brackets, such as {name} [{unit}]", "has no unit")
        if column.unit == "%":
            if si and not name.endswith("_sd"):
                raise InputError(self.header, f"{name} [%]", f"{name} in {unit}", "is a part of nothing")
            factor = 0.01
        elif column.unit is not None and (column.unit or si):
            written = f"{name} [{column.unit}]"
            factor = units.factor(column.unit, si or None, self.header, f"{name} in {unit}", written)
        numbers = np.full(self.size, np.nan)
        for row, cell in enumerate(column.cells):
            value = self._cell(cell, row, name, words)
            if value is not None:
                numbers[row] = value * factor
                if not (math.isfinite(value) and holds(numbers[row])):
                    problem = "is out of range"
                    if si == "rad" and column.unit is None and holds(math.radians(value)):
                        problem += f': plain numbers are radians, did you mean a column "{name} [deg]"?'
                    raise InputError(self._where(row, name), cell, words, problem)
        if not gaps:
            self._refuse(np.isnan(numbers), name, None, "a number in every row", "is empty")
        return numbers

    def _cell(self, cell: Any, row: int, name: str, words: str) -> float | None:
        if _is_missing(cell):
            return None
        if isinstance(cell, str):
            if DECIMAL_COMMA.fullmatch(cell):
                where = self._where(row, name)
                raise InputError(where, cell.strip(), "numbers with a decimal point", "has a decimal comma")
            return units.number(cell.strip(), self._where(row, name), words)
        try:
            return float(cell)
        except (TypeError, ValueError, OverflowError):
            raise InputError(self._where(row, name), cell, words, "is not a number") from None

    def measurements(self) -> Measurements:
        flown = "impact_parameter" in self.by_name
        if flown:
            unused = [name for name in ("speed", "stokes", "angle", *OBSERVED) if self.by_name.pop(name, None)]
            if unused:
                self.remarks.append(f"What was measured in free flight is used, not {', '.join(unused)}.")
        angle = np.zeros(self.size) if flown else self._angle()
        columns = {
            name: self._numbers(name, entry.unit or "", entry.range.holds, entry.accepts, gaps=False)
            for name in self.by_name
            if "." in name
            for entry in (self.scene.fields[name],)
        }
        speed, of_speed = self._speed(angle, columns)
        speed_sd, angle_sd = (np.ones(self.size),) * 2 if flown else self._scatter(speed, angle, of_speed)
        outcome, observed = self._outcome(), self._observed(DEPARTING if flown else OBSERVED)
        if "restitution" in observed:
            values = observed["restitution"][0]
            outcome = np.where((outcome == UNKNOWN) & (values == 0), _STICK, outcome)
            accepted = "an outcome beside a restitution below 0, which may be a stick's"
            self._refuse((outcome == UNKNOWN) & (values < 0), "restitution", values, accepted, "is noise about 0")
            accepted = "a stick has restitution 0, or an empty cell"
            self._refuse(
                (outcome == _STICK) & (np.abs(values) > 0), "restitution", values, accepted, "contradicts the outcome"
            )
        observed = {name: (np.where(outcome == _STICK, np.nan, values), sd) for name, (values, sd) in observed.items()}
        labels = tuple(row_name(k, line) for k, line in enumerate(self.lines, 1))
        data = Measurements(
            speed, angle, speed_sd, angle_sd, outcome.astype(np.int8), observed, columns, of_speed == "relative_speed",
            self.kind_unsaid, (), labels,
        )  # fmt: skip
        data = self._flown(data) if flown else data
        observation = data.measured | (outcome != UNKNOWN)
        if not observation.any():
            accepted = "outcome, restitution or another result in at least one row"
            raise InputError(self.label, None, accepted, "says nothing of any impact")
        if not observation.all():
            named = several([labels[k] for k in np.flatnonzero(~observation).tolist()])
            self.remarks.append(f"Left out, for neither outcome nor result is given: {named}.")
            data = data.subset(np.flatnonzero(observation))
        return replace(data, remarks=tuple(self.remarks))

    def _angle(self) -> np.ndarray:
        if "angle" in self.by_name:
            words = "an angle from 0 to below 90 deg"
            return self._numbers("angle", "rad", lambda v: 0 <= v < math.pi / 2, words, gaps=False)
        self._refuse_unused("angle")
        if self.scene.angle is None:
            raise InputError(self.label, None, "a column angle [deg], or an impact angle in the scene", "has no angle")
        self.remarks.append(f"Angles are the scene's, {math.degrees(self.scene.angle):.6g} deg.")
        return np.full(self.size, self.scene.angle)

    def _speed(self, angle: np.ndarray, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray, str]:
        """The speeds, and which they are: "speed", "relative_speed" or "stokes"."""
        names = [name.removeprefix("impact.") for name in SPEEDS if name.removeprefix("impact.") in self.by_name]
        if len(names) > 1:
            accepted = "only one of speed, relative_speed, stokes"
            raise InputError(self.header, names[1], accepted, f"is given together with {names[0]}")
        if not names:
            self._refuse_unused("speed")
            if self.scene.speed is None:
                raise InputError(self.label, None, "a column speed [m/s], or a speed in the scene", "has no speed")
            self.remarks.append(f"Normal speeds are the scene's, {self.scene.speed:.6g} m/s.")
            return np.full(self.size, self.scene.speed), "speed"
        [name] = names
        speed = self._numbers(name, _IMPACT[name], lambda v: v > 0, "a number > 0", gaps=False)
        if name == "stokes":
            entries: dict[str, Any] = {entry: value for entry, value in self.scene.si if entry not in MEETING}
            values = quantities(entries | dict(columns), self.scene.ways)
            radius, mass, viscosity = (values[quantity] for quantity in ("reduced_radius", "reduced_mass", "viscosity"))
            speed = speed / scaling.stokes(radius, mass, viscosity, 1.0)
            self.remarks.append("Normal speeds are those of the Stokes numbers with the scene's own entries.")
        return np.broadcast_to(speed, self.size).copy(), name

    def _scatter(self, speed: np.ndarray, angle: np.ndarray, of_speed: str) -> tuple[np.ndarray, np.ndarray]:
        speed_sd, angle_sd = np.full(self.size, np.nan), np.full(self.size, np.nan)
        for name in [column for column in _SPREAD[:2] if column in self.by_name][:1]:
            accepted = f"a standard deviation from 0 to below {_WIDEST:.2g} of the speed"
            values = self._numbers(name, "m/s", lambda v: v >= 0, accepted)
            speed_sd = values * speed if self.by_name[name].unit == "%" else values
            cells = self.by_name[name].cells
            self._refuse(speed_sd >= _WIDEST * speed, name, cells, accepted, "is out of range")
        if np.isnan(speed_sd).any():
            self.remarks.append(f"Scatter of the {NAMES[of_speed]}, where it is not given: {100 * SPEED_SD:g} %.")
            speed_sd = np.where(np.isnan(speed_sd), SPEED_SD * speed, speed_sd)
        if "angle_sd" in self.by_name:
            words, column = f"a standard deviation from 0 to {_WIDEST_ANGLE:g} rad", self.by_name["angle_sd"]
            if column.unit == "%":
                angle_sd = angle * self._numbers("angle_sd", "rad", lambda v: v >= 0, words)
                self._refuse(angle_sd >= _WIDEST_ANGLE, "angle_sd", column.cells, words, "of the angle is out of range")
            else:
                angle_sd = self._numbers("angle_sd", "rad", lambda v: 0 <= v < _WIDEST_ANGLE, words)
        if np.isnan(angle_sd).any():
            self.remarks.append(f"Scatter of the angle, where it is not given: {math.degrees(ANGLE_SD):.3g} deg.")
            angle_sd = np.where(np.isnan(angle_sd), ANGLE_SD, angle_sd)
        accepted = "speed_sd or angle_sd above 0: an outcome without scatter has no likelihood"
        self._refuse((speed_sd == 0) & (angle_sd == 0), "angle_sd", [0] * self.size, accepted, "is 0, as speed_sd is")
        return speed_sd, angle_sd

    def _outcome(self) -> np.ndarray:
        codes = np.full(self.size, UNKNOWN)
        for row, cell in enumerate(self.by_name["outcome"].cells if "outcome" in self.by_name else ()):
            if _is_missing(cell):
                continue
            if isinstance(cell, str):
                code = _WORDS.get(cell.strip().lower().replace("_", "-").replace(" ", "-"))
            else:
                code = int(cell) if not isinstance(cell, bool) and cell in range(len(OUTCOMES)) else None
            if code is None:
                accepted = f"{STICK}, {ROTATE}, {BOUNCE}, or an empty cell"
                problem = "is not known" + did_you_mean(cell, _WORDS)
                raise InputError(self._where(row, "outcome"), cell, accepted, problem)
            codes[row] = code
        return codes

    def _flown(self, data: Measurements) -> Measurements:
        """The data with their lines of free flight."""
        measured: dict[str, tuple[np.ndarray, np.ndarray]] = dict(data.observed)
        for name, unit in reversed(ARRIVING.items()):
            if not {name, f"{name}_sd"} <= self.by_name.keys():
                raise InputError(self.header, name, f"{name} and {name}_sd, as `tracks` writes them", "is missing")
            value, sd = (
                self._numbers(column, unit, lambda v: v >= 0, "a number >= 0", gaps=False)
                for column in (name, f"{name}_sd")
            )
            measured = {name: (value, sd)} | measured
        size, correlation = len(FLIGHT), np.tile(np.eye(len(FLIGHT)), (self.size, 1, 1))
        lower = np.tril_indices(size, -1)
        for row, cell in enumerate(self.by_name[CORRELATION].cells if CORRELATION in self.by_name else ()):
            if not _is_missing(cell):
                numbers = [units.number(word, self._where(row, CORRELATION), "numbers") for word in str(cell).split()]
                if len(numbers) != lower[0].size or not all(-1 <= number <= 1 for number in numbers):
                    accepted = f"{lower[0].size} numbers between -1 and 1, as `tracks` writes them"
                    raise InputError(self._where(row, CORRELATION), cell, accepted)
                correlation[row][lower] = numbers
                correlation[row] += np.tril(correlation[row], -1).T
        solids = 2 * self.scene.particles.reduced_radius * (1 + (self.scene.radius_ratio or 0.0))
        flights, sd = Flights.of(measured, correlation, solids + self.scene.liquid.film_thickness)
        angle = np.arcsin(flights.values[1] / flights.reach)
        return replace(
            data, speed=flights.values[0], speed_sd=sd[0], angle=angle, angle_sd=sd[1] / flights.reach / np.cos(angle),
            observed={name: (values, sd[k]) for k, (name, (values, _)) in enumerate(measured.items()) if k > 1},
            flights=flights, relative=True,
        )  # fmt: skip

    def _observed(self, names: Iterable[str]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        observed = {}
        for name in names:
            error, relative = f"{name}_sd", name == "contact_time"
            if name not in self.by_name:
                if error in self.by_name:
                    raise InputError(self.header, error, f"a column {name} beside it", "stands alone")
                continue
            if name in DEPARTING and error not in self.by_name:
                raise InputError(self.header, name, f"a column {error} beside it", "stands alone")
            words = "a number >= 0" if relative else "a number"
            values = self._numbers(name, UNITS[name], (lambda v: v >= 0) if relative else math.isfinite, words)
            sd = np.full(self.size, np.nan)
            if error in self.by_name:
                if self.by_name[name].unit == "%" and self.by_name[error].unit is None:
                    raise InputError(self.header, error, f"{error} [%]", f"has no unit beside {name} in %")
                sd = self._numbers(error, UNITS[name], lambda v: v > 0, "a standard deviation > 0")
                if self.by_name[name].unit == self.by_name[error].unit == "%":
                    self.remarks.append(f"Standard deviations of {name} are taken for per cent as it is, not of it.")
                elif self.by_name[error].unit == "%":
                    sd = sd * np.abs(values)
            if name in RESULT_SD and (np.isnan(sd) & np.isfinite(values)).any():
                text = f"{100 * RESULT_SD[name]:g} %" if relative else f"{RESULT_SD[name]:.4g}"
                text = f"{math.degrees(RESULT_SD[name]):.3g} deg" if UNITS[name] == "rad" else text
                self.remarks.append(f"Standard deviation of {name}, where it is not given: {text}.")
                sd = np.where(np.isnan(sd), RESULT_SD[name] * (np.abs(values) if relative else 1.0), sd)
            bad = ~(sd > 0) & np.isfinite(values) & (values != 0)
            self._refuse(bad, error, sd, "a standard deviation > 0")
            sd = np.where(sd > 0, sd, RESULT_SD.get(name, 1.0))
            if name == "restitution":
                accepted = f"a number >= 0, or below by up to {_NOISE:g} standard deviations of noise"
                self._refuse(values < -_NOISE * sd, name, values, accepted, "is out of range")
            observed[name] = values, sd
        return observed


def _canonical(text: str) -> str:
    """The name of a column as people write it: `v`, `COR`, `theta err`; a dotted name and an unknown one stay."""
    word = _word(text)
    if word in _CANONICAL or "." in word:
        return _CANONICAL.get(word, text)
    spread = _SPREAD_WORDS.fullmatch(word)
    return f"{_CANONICAL[spread[1]]}_sd" if spread and spread[1] in _CANONICAL else text


def _word(text: str) -> str:
    """In small letters with underscores."""
    return re.sub(r"[\s-]+", "_", text.strip().lower())


_MEANT = {
    "speed": "the normal speed",
    "unsaid": "the normal speed (name it relative_speed if it is the magnitude of the relative velocity)",
    "relative_speed": "the magnitude of the relative velocity",
}


def _is_missing(cell: Any) -> bool:
    nothing = cell is None or (isinstance(cell, float) and math.isnan(cell))
    return nothing or (isinstance(cell, str) and cell.strip().lower() in _MISSING)
