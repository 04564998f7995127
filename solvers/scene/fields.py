"""What an entry of a scene, or a setting, accepts: its unit, range or choices, and how a value of it is read."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Real

from ..errors import InputError, did_you_mean
from . import liquids, units

Raw = float | int | str
"""An entry as a scene keeps it: text with its unit, a choice, or a plain number."""


@dataclass(frozen=True)
class Range:
    """The interval of accepted numbers (SI), and how messages say it. An end that is `open` does not belong to it."""

    text: str
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = True
    high_open: bool = True

    def holds(self, value: float) -> bool:
        """Whether a number lies in the interval; never for NaN."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below


POSITIVE = Range("> 0", 0.0)
NOT_NEGATIVE = Range(">= 0", 0.0, low_open=False)
PART = Range("> 0 and at most 1", 0.0, 1.0, high_open=False)
FRACTION = Range("from 0 to 1", 0.0, 1.0, low_open=False, high_open=False)
POISSON = Range("> -1 and <= 0.5", -1.0, 0.5, high_open=False)
ANY = Range("of either sign")
IMPACT_ANGLE = Range(">= 0 deg and < 90 deg", 0.0, math.pi / 2, low_open=False)
WETTING_ANGLE = Range("from 0 deg to 90 deg", 0.0, math.pi / 2, low_open=False, high_open=False)


_IN_MODEL_FILES = {("model.arm", "surface"): "is a law of a model file (--model FILE.py), see docs/reference/models.md"}


@dataclass(frozen=True)
class Field:
    """One entry: a quantity (with `unit`), a plain number (without), a choice (with `choices`) or a `flag`.

    A flag is either true or absent.

    Arguments:
        what: the accepted value in words, for messages.
        choices: what each means.
        slot: the slot whose laws the choices are.
        gives: vocabulary name of the quantity that equals the entry times `factor`, if it differs from the entry's;
            empty if the quantity depends on other entries too (`quantities`).
        default: what acts, SI or a choice, where its table is there without it.
        or_unit: the unit of what a plain number may be given as instead.
        words: what may stand in place of a number.
        by_name: a liquid at a temperature may stand in place of a number.
    """

    name: str
    what: str
    example: str
    range: Range = POSITIVE
    unit: str | None = None
    choices: Mapping[str, str] = dataclasses.field(default_factory=dict, hash=False)
    required: bool = False
    flag: bool = False
    gives: str | None = None
    factor: float = 1.0
    default: float | str | None = None
    or_unit: str | None = None
    words: tuple[str, ...] = ()
    by_name: bool = False
    slot: str = ""

    @cached_property
    def measured(self) -> Field:
        """The entry where it is given with `or_unit`."""
        unit = self.or_unit or ""
        what = f"{self.what} {self.range.text}, such as {self.example}, or {units.DIMENSIONS[unit]}"
        return dataclasses.replace(self, unit=unit, or_unit=None, what=what, example=f'"1e-13 {unit}"')

    @property
    def key(self) -> str:
        """Its name in its table."""
        return self.name.partition(".")[2]

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers, with a unit or without."""
        return not (self.choices or self.flag)

    @cached_property
    def quantity(self) -> str:
        """Vocabulary name of the entry's quantity; empty if the entry alone does not determine one."""
        if not self.numeric:
            return ""
        return self.key if self.gives is None else self.gives

    @property
    def accepts(self) -> str:
        """The accepted values, in words."""
        if self.flag:
            return f"true, for {self.what}, or no such entry"
        if self.choices:
            return "one of " + ", ".join(self.choices)
        with_unit = " with its unit" if self.unit else ""
        text = f"{self.what} {self.range.text}{with_unit}, such as {self.example}"
        if self.or_unit:
            text += f", or {units.DIMENSIONS[self.or_unit]} with its unit"
        if self.by_name:
            text += f", or {liquids.ACCEPTED}"
        return text + "".join(f', or "{word}"' for word in self.words)

    def refused(self, raw: object, label: str | None, problem: str) -> InputError:
        """The error for a value that is none of the entry's."""
        return InputError(self.name if label is None else label, raw, self.accepts, problem)

    def read(self, raw: object, *, label: str | None = None, from_file: bool = False) -> float | str:
        """Return the SI number or the choice given by `raw`; InputError for an invalid value, or one outside the range.

        Arguments:
            raw: text with a unit, a number (SI), or a choice.
            label: name in the error, when it is not the field's own (an option).
            from_file: a quantity must be text with a unit, and a plain number must not be text.
        """
        if self.flag:
            if raw is True or (not from_file and isinstance(raw, str) and raw == "true"):
                return "true"
            raise self.refused(raw, label, "")
        if self.choices:
            if isinstance(raw, str) and raw in self.choices:
                return raw
            in_files = _IN_MODEL_FILES.get((self.name, raw)) if isinstance(raw, str) else None
            raise self.refused(raw, label, in_files or "is not known" + did_you_mean(raw, self.choices))
        if isinstance(raw, str) and raw.strip() in self.words:
            return raw.strip()
        if self.with_unit(raw):
            return self.measured.read(raw, label=label, from_file=from_file)
        value = self._number(raw, self.name if label is None else label, from_file)
        if not math.isfinite(value):
            raise self.refused(raw, label, "is not finite")
        if self.range.holds(value):
            return value
        problem = "is out of range"
        if self.unit == "rad" and not isinstance(raw, str) and self.range.holds(math.radians(value)):
            problem += f': plain numbers are radians, did you mean "{raw} deg"?'
        raise self.refused(raw, label, problem)

    def number(self, raw: object, *, label: str | None = None) -> float:
        """Return the SI number as `read` does, for a field that is no choice."""
        value = self.read(raw, label=label)
        if not isinstance(value, float):
            raise self.refused(raw, label, "is not a number")
        return value

    def with_unit(self, raw: object) -> bool:
        """Whether a value that may be a plain number or a quantity is a quantity; no list is either."""
        if not self.or_unit or isinstance(raw, (Real, list, tuple)):
            return False
        if isinstance(raw, str):
            return raw.strip() not in self.words and not units.is_number(raw)
        from .values import carries_unit  # imports numpy

        return carries_unit(raw, self.name)

    def _number(self, raw: object, label: str, from_file: bool) -> float:
        if isinstance(raw, str):
            if self.by_name and liquids.is_named(raw):
                return liquids.liquid(raw, label).viscosity
            if self.unit:
                return units.quantity(raw, self.unit, label, self.accepts)
            if from_file:
                raise self.refused(raw, label, "is text, not a number")
            return units.number(raw, label, self.accepts)
        if not isinstance(raw, Real):
            from .values import scalar  # imports numpy

            raw = scalar(raw, self, label)
        if not isinstance(raw, Real) or isinstance(raw, bool):
            raise self.refused(raw, label, f"is not a number{' with its unit, as text' if self.unit else ''}")
        if self.unit and from_file:
            raise self.refused(raw, label, "has no unit")
        try:
            return float(raw)
        except OverflowError:
            return math.inf

    def canonical(self, raw: object) -> Raw:
        """Return a value accepted by `read` as a scene stores it: text as given, numbers as plain floats."""
        if self.flag:
            return True
        if isinstance(raw, str) and (self.unit or self.choices or raw.strip() in self.words):
            return raw.strip()
        if self.with_unit(raw):
            return raw.strip() if isinstance(raw, str) else f"{self.number(raw)!r} {self.or_unit}"
        return self.number(raw)
