"""Texts of the command line as values: lists, assignments, numbers, and ranges with units and angles in degrees.

An InputError without a field is about the option that is read.
"""

import math
import re
from collections.abc import Mapping, Sequence

from ..engines.settings import MOST, most_collisions
from ..errors import InputError, excerpt
from ..scene import units
from ..scene.fields import Field
from ..scene.schema import FIELDS

Range = tuple[float, float] | tuple[str, str]
"""Two ends in SI; texts where a plain number is something else than a quantity."""


def typed(entries: Mapping[str, str]) -> dict[str, str]:
    """Entries by dotted name, a bare angle in degrees."""
    return {name: with_degrees(FIELDS[name], value) if name in FIELDS else value for name, value in entries.items()}


def names(text: str) -> list[str]:
    """The names of a list NAME,NAME; InputError for a name that stands twice."""
    listed = [name.strip() for name in text.split(",") if name.strip()]
    if not listed:
        raise InputError("", text, "names, separated by commas", "names nothing")
    for name in listed:
        if listed.count(name) > 1:
            raise InputError("", text, "every name once", f"has {excerpt(name)} twice")
    return listed


def assignment(accepted: str, text: str, label: str = "") -> tuple[str, str]:
    """Name and text of NAME=TEXT; InputError for a text without the sign."""
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(label, text, accepted, "has no =")
    return name.strip(), value


def assigned(accepted: str, texts: Sequence[str], label: str = "") -> dict[str, str]:
    """The texts of a repeatable option NAME=TEXT, by name; InputError for a name that stands twice."""
    values: dict[str, str] = {}
    for text in texts:
        name, value = assignment(accepted, text, label)
        if name in values:
            raise InputError(label, text, accepted, "is given twice: every name once")
        values[name] = value
    return values


def share(accepted: str, text: str, label: str = "") -> float:
    """A part of the whole, as 0.01 or "1 %"; InputError for another text."""
    plain = text.strip().removesuffix("%")
    try:
        return float(plain) / (1 if plain == text.strip() else 100)
    except ValueError:
        raise InputError(label, text, accepted, "is no number") from None


def whole(text: str) -> int:
    """A whole number; InputError for another text."""
    try:
        return int(text)
    except ValueError:
        raise InputError("", text, "a whole number") from None


def numbers(impact: Mapping[str, str]) -> dict[str, float]:
    """The numbers (SI) of an impact's entries, each under the name of its option."""
    entries = {name: FIELDS[f"impact.{name}"] for name in impact}
    return {name: entry.number(with_degrees(entry, impact[name]), label=flag(name)) for name, entry in entries.items()}


def flag(name: str) -> str:
    """The option of a name."""
    return f"--{name.replace('_', '-')}"


def with_degrees(entry: Field, text: str) -> str:
    """An angle as it is typed: a bare number is in degrees."""
    return f"{text.strip()} deg" if entry.unit == "rad" and units.is_number(text) else text


def entry_range(entry: Field, text: str, label: str = "", *, most: int = MOST) -> list[float]:
    """The values (SI) of a range of an entry, evenly spaced or evenly in the logarithm; InputError for anything else.

    Arguments:
        text: `LO:HI:N` or `log:LO:HI:N`, both ends included, N = 1 only with LO = HI; or a single value. Either end may
            carry the unit; bare angles are in degrees.
        most: largest number of values.
    """
    form = f"LO:HI:N or log:LO:HI:N {_in_units(entry)}".rstrip()
    accepted = f"{form}, LO < HI and N >= 2 (or LO = HI and N = 1), or one value"
    parts = text.split(":")
    logarithmic = parts[0].strip() == "log"
    if logarithmic:
        parts = parts[1:]
    if len(parts) == 1 and not logarithmic and parts[0].strip():
        try:
            return [_ends(entry, parts[0], parts[0], label, text)[0]]
        except InputError as error:
            raise InputError(label, text, f"{error.accepted}, or a range LO:HI:N, log:LO:HI:N", error.problem) from None
    if len(parts) != 3 or not re.fullmatch(r"\s*[0-9]{1,30}\s*", parts[2], re.ASCII):
        raise InputError(label, text, accepted, "is not a range")
    low, high = _ends(entry, parts[0], parts[1], label, text)
    count = int(parts[2])
    if count > most:
        raise InputError(label, text, f"{accepted}, N at most {most}", "has too many values")
    if low > high or count < 1 or (count == 1) != (low == high):
        raise InputError(label, text, accepted, "is not a range")
    if logarithmic and low <= 0:
        raise InputError(label, text, accepted + ", LO > 0 for log", "has no logarithm")
    if count == 1:
        return [low]
    steps = (i / (count - 1) for i in range(1, count - 1))
    if logarithmic:
        log_low, log_high = math.log(low), math.log(high)
        inner = [math.exp(log_low + s * (log_high - log_low)) for s in steps]
    else:
        inner = [low + s * (high - low) for s in steps]
    return [low, *inner, high]  # the ends exactly as given, without rounding


def check_cells(ranges: Mapping[str, str], most: int) -> None:
    """Raise InputError if the product of the ranges' counts exceeds what a map can hold, before allocating any.

    Arguments:
        ranges: option -> its range; malformed ranges are ignored here and reported by `entry_range`.
        most: collisions in all.
    """
    cells, sizes = 1, []
    for label, text in ranges.items():
        if count := re.search(r":\s*([0-9]{1,9})\s*$", text, re.ASCII):
            cells *= max(1, int(count[1]))
            sizes.append(count[1])
            if cells > most >= int(count[1]):
                raise InputError(label, text, most_collisions(most), f"makes {' x '.join(sizes)} collisions")


def axes(impact: Mapping[str, str]) -> dict[str, list[float]]:
    """The values (SI) of the ranges of an impact's entries."""
    return {name: entry_range(FIELDS[f"impact.{name}"], text, flag(name)) for name, text in impact.items()}


def varied(entry: Field, text: str, label: str) -> list[float] | list[str]:
    """The values of a range of an entry; as text where a plain number is something else than a quantity."""
    if _measured(entry, text.removeprefix("log:").split(":")):
        return [f"{value!r} {entry.or_unit}" for value in entry_range(entry.measured, text, label)]
    return entry_range(entry, text, label)


def span(entry: Field, text: str, label: str = "") -> Range:
    """The two ends of LO:HI of an entry; as text where a plain number is something else than a quantity."""
    ends = text.split(":")
    measured = _measured(entry, ends)
    quantity = entry.measured if measured else entry
    accepted = f"{f'LO:HI {_in_units(quantity)}'.strip()}, with LO below HI"
    low, high = _ends(quantity, ends[0], ends[1], label, text) if len(ends) == 2 else (0.0, 0.0)
    if not low < high:
        raise InputError(label, text, accepted, "is not a range")
    return (f"{low!r} {entry.or_unit}", f"{high!r} {entry.or_unit}") if measured else (low, high)


def _measured(entry: Field, ends: Sequence[str]) -> bool:
    """True if the ends of a range carry the unit of an entry that may be a plain number instead."""
    return bool(entry.or_unit) and not all(units.is_number(end) for end in ends)


def _ends(entry: Field, low: str, high: str, label: str, text: str) -> tuple[float, float]:
    """Both ends of a range of an entry (SI): an end without a unit has that of the other.

    Arguments:
        text: the range as it is typed, for the error.
    """
    bare = [units.is_number(end) for end in (low, high)]
    if all(bare) and entry.unit and entry.unit != "rad":
        unit = units.unit_of(entry.example.strip('"'))
        ends = f"{low}:{high}" if ":" in text else low
        example = text.replace(ends, f"{ends.rstrip()} {unit}", 1).strip()
        raise InputError(label, text, f'a number with its unit, as "{example}"', "has no unit")
    if bare[0] != bare[1]:
        unit = units.unit_of(high if bare[0] else low)
        low, high = (f"{end.strip()} {unit}" if units.is_number(end) else end for end in (low, high))
    first, last = (entry.number(with_degrees(entry, end), label=label) for end in (low, high))
    return first, last


def _in_units(entry: Field) -> str:
    if entry.unit == "rad":
        return "in degrees, or with a unit"
    return "with a unit at either end" if entry.unit else ""
