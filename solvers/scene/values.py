"""Conversion of other libraries' numbers (masked arrays, quantities with units) to plain SI numbers.

Values that numpy would convert silently are refused: masked values, truth values, dates, complex numbers, text.
"""

import re
from numbers import Real
from typing import Any, Protocol

import numpy as np

from ..errors import InputError
from .units import factor, is_number, is_ratio


class Entry(Protocol):
    """The entry that numbers are given for: its unit, accepted values in words, and conversion of single values."""

    @property
    def unit(self) -> str | None: ...

    @property
    def accepts(self) -> str: ...

    def number(self, raw: object, *, label: str | None = None) -> float: ...


_DEEPEST = 8  # most levels of nested lists
_EXPONENT = re.compile(r"(?<=[A-Za-z])(-?[0-9]+)\b")  # exponents in CF notation: m s-1


def scalar(value: Any, entry: Entry, label: str) -> object:
    """Return a 0-D array or a quantity with its unit as a plain SI number; other values unchanged."""
    if isinstance(value, (str, Real)) or not _is_array(value):
        return value
    number = array(value, entry, label)
    if number.ndim:
        raise InputError(label, value, entry.accepts, "is not a single number")
    return float(number)


def array(values: Any, entry: Entry, label: str) -> np.ndarray:
    """Return numbers of any supported kind as an array of doubles in SI. Numbers of arrays are not checked for range.

    Arguments:
        values: a number, text with its unit, a sequence of these, an array, a pint quantity (or one of astropy or
            unyt), or a DataArray, whose attribute `units` is used.

    Raises:
        InputError: masked values, a unit of another dimension, or values that are not real numbers.
    """
    if isinstance(values, (list, tuple)):
        return _listed(values, entry, label, 1)
    if isinstance(values, (str, Real)):
        return np.asarray(entry.number(values, label=label))
    unit, bare = _unit(values)
    if isinstance(bare, (bytes, bytearray, memoryview)):
        raise InputError(label, values, "numbers (SI), or quantities with their units", "is no text and no number")
    if isinstance(bare, np.ma.MaskedArray) and np.ma.is_masked(bare):
        masked = f"{int(np.ma.getmaskarray(bare).sum())} of {bare.size} values are masked"
        raise InputError(label, None, "values without a mask: drop them, or fill them", masked)
    try:
        numbers = np.asarray(bare)
    except Exception:  # noqa: BLE001 # whatever another library's conversion raises
        numbers = np.asarray(None)
    if numbers.dtype.kind in "OU" and unit is None:
        flat = [entry.number(value, label=label) for value in numbers.ravel().tolist()]
        return np.array(flat, dtype=float).reshape(numbers.shape)
    if numbers.dtype.kind not in "fiu":
        problem = f"is of type {numbers.dtype}, not of real numbers" if _is_array(bare) else "is not a list of numbers"
        raise InputError(label, values, "numbers (SI), or quantities with their units", problem)
    with np.errstate(over="ignore"):  # values beyond a double's range become inf, which the caller refuses
        doubles = numbers.astype(float)
    return doubles if unit is None else doubles * factor(unit, entry.unit, label, entry.accepts, values)


def _listed(values: list[Any] | tuple[Any, ...], entry: Entry, label: str, level: int) -> np.ndarray:
    """An array of a sequence; members are converted one by one unless all are plain numbers."""
    if {*map(type, values)} <= {float, int}:
        try:
            return np.array(values, dtype=float)
        except OverflowError:  # a huge integer; reported below, member by member
            pass
    if level > _DEEPEST:
        raise InputError(label, values, "numbers (SI)", "is nested too deeply")

    def member(value: Any) -> np.ndarray | float:
        if isinstance(value, (list, tuple)):
            return _listed(value, entry, label, level + 1)
        return array(value, entry, label) if getattr(value, "ndim", 0) else entry.number(value, label=label)

    try:
        return np.array([member(value) for value in values], dtype=float)
    except InputError:
        raise
    except ValueError:
        raise InputError(label, values, "numbers (SI)", "is a list of lists of different lengths") from None


def with_unit(value: Any) -> Any:
    """A single quantity of another library as text with its unit; any other value unchanged."""
    unit, bare = _unit(value)
    return value if unit is None or np.size(bare) != 1 else f"{float(bare)!r} {unit}"


def _is_array(value: Any) -> bool:
    """True if a value is an array or has a unit; a class is neither."""
    return not isinstance(value, type) and (hasattr(value, "__array__") or _unit(value)[0] is not None)


def carries_unit(values: Any, label: str) -> bool:
    """Whether what is given as numbers is given with a unit; InputError for a list of both."""
    if isinstance(values, np.ndarray) and values.dtype.kind in "OU":
        values = values.tolist()
    if isinstance(values, (list, tuple)):
        kinds = {carries_unit(value, label) for value in values}
        if len(kinds) > 1:
            raise InputError(
                label, values, "quantities with their units, or plain numbers, not both", "is a list of both"
            )
        return kinds == {True}
    if isinstance(values, str):
        return not is_number(values)
    unit = _unit(values)[0]
    return unit is not None and not is_ratio(unit)


def _unit(value: Any) -> tuple[str | None, Any]:
    """The unit of a value as text (None without one), and the value without it."""
    if isinstance(value, (np.ndarray, np.generic)) and type(value).__module__.partition(".")[0] == "numpy":
        return None, value
    if hasattr(value, "data") and hasattr(value, "attrs"):  # xarray
        unit, bare = _unit(value.data)
        unit_of_array = value.attrs.get("units") if unit is None else unit
        return (_EXPONENT.sub(r"^\1", unit_of_array), bare) if isinstance(unit_of_array, str) else (None, bare)
    if hasattr(value, "units") and hasattr(value, "magnitude"):  # pint
        return f"{value.units:D}", value.magnitude
    for name in ("units", "unit"):  # unyt, astropy
        if hasattr(value, name) and hasattr(value, "value") and hasattr(value, "__array__"):
            return str(getattr(value, name)), value.value
    return None, value
