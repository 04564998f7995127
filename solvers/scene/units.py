"""Numbers with units, converted to SI floats of a required dimension.

Common spellings are in a table of exact decimal factors, so that a preset does not import pint (0.4 s) and its numbers
are correctly rounded. Other units are converted by pint, which also checks the dimension; the results are cached.
Pint's own cache is not used, because it unpickles files from an unchecked folder.
"""

from __future__ import annotations

import json
import math
import re
from decimal import Context, Decimal
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

from ..errors import InputError, did_you_mean, nearest

if TYPE_CHECKING:
    import pint

Powers = dict[str, float]

DIMENSIONS = {
    "m": "a length",
    "kg": "a mass",
    "s": "a time",
    "rad": "an angle",
    "m^3": "a volume",
    "m/s": "a speed",
    "m/s^2": "an acceleration",
    "kg/m^3": "a density",
    "Pa": "a pressure",
    "Pa s": "a viscosity",
    "N/m": "a surface tension",
    "J": "an energy",
    "rad/s": "an angular velocity",
}
"""SI unit that names a dimension here -> that dimension in words."""

_WORDS = {
    **DIMENSIONS,
    "": "a plain number",
    "m^2": "an area",
    "1/s": "a frequency",
    "N": "a force",
    "W": "a power",
    "kg m/s": "a momentum",
    "m^2/s": "a kinematic viscosity",
    "kg/s": "a mass per time",
    "kg m^2": "a moment of inertia",
    "K": "a temperature",
    "A": "an electric current",
    "C": "an electric charge",
    "V": "a voltage",
}
"""SI unit as pint reads it -> what it measures, for errors."""

_DEGREE = "0.0174532925199432957692369076848861271344287188854172545609719144017100911460344944"  # pi/180

COMMON: dict[str, tuple[str, Decimal]] = {
    unit: (si, Decimal(factor))
    for si, units in {
        "m": {"m": "1", "dm": "1e-1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "nm": "1e-9"},
        "kg": {"kg": "1", "g": "1e-3", "mg": "1e-6", "ug": "1e-9", "ng": "1e-12"},
        "s": {"s": "1", "ms": "1e-3", "us": "1e-6"},
        "rad": {"rad": "1", "mrad": "1e-3", "deg": _DEGREE, "degree": _DEGREE, "degrees": _DEGREE},
        "m^3": {"m^3": "1", "dm^3": "1e-3", "cm^3": "1e-6", "mm^3": "1e-9", "um^3": "1e-18", "nm^3": "1e-27"}
        | {"l": "1e-3", "L": "1e-3", "ml": "1e-6", "mL": "1e-6", "ul": "1e-9", "uL": "1e-9"}
        | {"nl": "1e-12", "nL": "1e-12", "pl": "1e-15", "pL": "1e-15", "fl": "1e-18", "fL": "1e-18"},
        "m/s": {"m/s": "1", "cm/s": "1e-2", "mm/s": "1e-3", "um/s": "1e-6", "m s^-1": "1"},
        "rad/s": {"rad/s": "1", "krad/s": "1e3", "mrad/s": "1e-3", "deg/s": _DEGREE, "1/s": "1", "s^-1": "1"},
        "m/s^2": {"m/s^2": "1", "cm/s^2": "1e-2", "m s^-2": "1"},
        "kg/m^3": {"kg/m^3": "1", "g/cm^3": "1e3", "g/m^3": "1e-3"}
        | {"kg m^-3": "1", "g cm^-3": "1e3", "g/ml": "1e3", "g/mL": "1e3", "kg/l": "1e3", "kg/L": "1e3"},
        "Pa": {"Pa": "1", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9", "bar": "1e5", "N/m^2": "1"},
        "Pa s": {"Pa s": "1", "mPa s": "1e-3", "kPa s": "1e3", "cP": "1e-3", "P": "1e-1"}
        | {"N s/m^2": "1", "mN s/m^2": "1e-3", "N s m^-2": "1"},
        "J": {"J": "1", "mJ": "1e-3", "uJ": "1e-6", "nJ": "1e-9", "aJ": "1e-18", "zJ": "1e-21"},
        "N/m": {"N/m": "1", "mN/m": "1e-3", "J/m^2": "1", "dyn/cm": "1e-3", "mJ/m^2": "1e-3"}
        | {"N m^-1": "1", "mN m^-1": "1e-3"},
    }.items()
    for unit, factor in units.items()
}
"""Unit as spelt (after `spelling`) -> SI unit that names its dimension, exact factor."""

_LETTERS = (("µ", "u"), ("μ", "u"), ("°", "deg"), ("⁻", "-"), ("¹", "^1"), ("²", "^2"), ("³", "^3"), ("**", "^"),
            ("-^", "^-"), ("\\u00B5", "u"))  # fmt: skip # the last as Tracker escapes it
_JOINED = {"mPas": "mPa s", "Pas": "Pa s", "Ns/m^2": "N s/m^2", "mNs/m^2": "mN s/m^2"}
_LONGEST = 200  # most characters of a number and of a unit
_EXACT = Context(prec=_LONGEST + 100)  # the product of factor and text is then rounded only once, to a double
_NUMBER = r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|nan|inf(?:inity)?)"
_QUANTITY = re.compile(rf"({_NUMBER})(.*)", re.IGNORECASE | re.DOTALL)
# The syntax passed to pint: names, products, quotients and small integer powers. No other numbers, because
# m^9^9^9 would take unbounded time.
# Possessive quantifiers (++) prevent backtracking, which is exponential for a long word.
_UNIT = re.compile(r"(?:[^\W\d_]\w*+(?:\^-?[0-9]{1,2})?+|\)(?:\^-?[0-9]{1,2})?+|[\s*/(]|1(?=\s*/))++")

_MISREAD = tuple(
    (re.compile(rf"[a-z]?(?:{words})"), meant)
    for words, meant in (
        ("grs?|grains?", "for pint a grain of 65 mg; a gram is g"),
        ("px|pixels?|css_pixels?", "a pixel, of which only a scale makes a length: --scale, scale="),
        ("mils?", "for pint an angle of 1/64000 turn; a micrometre is um, 0.001 inch is thou"),
        ("cps|counts_per_second", "for pint counts per second; a centipoise is cP, a frequency in Hz"),
    )
)  # words that pint reads as another unit than people mean


def number(text: str, field: str, accepted: str) -> float:
    """Return the plain number in `text`; InputError naming `field` if it is none (nan and inf pass)."""
    if not is_number(text):
        raise InputError(field, text, accepted, "is not a number")
    return float(text)


def is_number(text: str) -> bool:
    """Whether a text is a plain number."""
    return len(text) <= _LONGEST and re.fullmatch(_NUMBER, text.strip(), re.IGNORECASE) is not None


def is_ratio(unit: str) -> bool:
    """Whether a unit, as another library writes it, is that of a plain number: none, or one like percent."""
    unit = spelling(unit)
    if unit in ("", "1", "dimensionless"):
        return True
    try:
        return unit not in COMMON and bool(_UNIT.fullmatch(unit)) and not _judged(unit)[1]
    except Exception:  # noqa: BLE001 # whatever pint raises for undefined names, bad syntax, offsets
        return False


def unit_of(text: str) -> str:
    """The unit of a number that carries one, as it is written; empty if it is no such number."""
    match = _QUANTITY.fullmatch(text.strip()) if len(text) <= _LONGEST else None
    return match[2].strip() if match else ""


def quantity(text: str, si: str, field: str, accepted: str) -> float:
    """Read a number with its unit.

    Arguments:
        text: such as `"50 um"`; the space may be left out.
        si: the unit of the result, coherent SI.
        field: name of the entry or option, for the error.
        accepted: description of accepted values, for the error.

    Returns:
        the value in `si`, finite; correctly rounded for the units of `COMMON`.

    Raises:
        InputError: no number, not finite, or a unit that is missing, unknown or of another dimension.
    """
    match = _QUANTITY.fullmatch(text.strip()) if len(text) <= _LONGEST else None
    if match is None:
        raise InputError(field, text, accepted, "is not a number with its unit")
    digits, unit = match[1], spelling(match[2])
    size = float(digits)
    if not math.isfinite(size):
        raise InputError(field, text, accepted, "is not finite")
    if not unit:
        raise InputError(field, text, accepted, "has no unit")
    if re.match(r",\d", unit):
        raise InputError(field, text, accepted, "has a comma in place of a decimal point")
    if re.search(r"\^[a-z]", si):  # an exponent that is a number of the scene, which no other unit can be converted by
        if unit != si:
            raise InputError(field, text, accepted, f"is not in {si}")
        value = size
    elif unit in COMMON and (si in DIMENSIONS or COMMON[unit][0] == si):  # 1/s is also that of a user's rate
        dimension, factor = COMMON[unit]
        if dimension != si:
            raise InputError(field, text, accepted, f"is {DIMENSIONS[dimension]}, not {_demanded(si)}")
        value = float(_EXACT.multiply(Decimal(digits), factor)) if size else 0.0
    else:
        value = size * _pint_factor(unit, si, text, field, accepted)
    if not math.isfinite(value):
        raise InputError(field, text, accepted, "is not finite")
    return value


def factor(unit: str, si: str | None, field: str, accepted: str, value: object) -> float:
    """Return the factor from `unit`, the unit of another library's value, to `si`.

    Arguments:
        unit: spelling of the other library.
        si: the unit of the result; None for a dimensionless number.
        value: the value with this unit, for the error.

    Raises:
        InputError: a unit that is unknown, or of another dimension. Dimensionless units are accepted as radians.
    """
    unit = spelling(unit)
    plain = unit in ("", "1", "dimensionless")
    if plain and si in (None, "rad"):
        return 1.0
    if unit in COMMON and COMMON[unit][0] == si:
        return float(COMMON[unit][1])
    return _pint_factor("dimensionless" if plain else unit, si or "dimensionless", value, field, accepted)


@lru_cache(maxsize=256)
def spelling(unit: str) -> str:
    """Return the canonical spelling of a unit (`Pa·s`, `Pa*s` -> `Pa s`; `µm` -> `um`)."""
    for letter, ours in _LETTERS:
        unit = unit.replace(letter, ours)
    unit = re.sub(r"\brev\b", "revolution", unit)  # which pint does not know
    unit = re.sub(r"\s*([/^])\s*", r"\1", unit)
    unit = re.sub(r"(?<=[A-Za-z])\.(?=[A-Za-z])", " ", unit)  # Pa.s
    unit = re.sub(r"(?<![\w^])([A-Za-z]+)(-?[1-9])(?!\w)", r"\1^\2", unit)  # cm3, m-3
    unit = " ".join(re.sub(r"[*·⋅]", " ", unit).split())
    return _JOINED.get(unit, unit)


def _pint_factor(unit: str, si: str, value: object, field: str, accepted: str) -> float:
    """Return the factor from `unit` to `si` by pint; InputError for an unknown unit or another dimension."""
    if ":" in unit:
        raise InputError(field, value, accepted, "is a range, where one value is asked")
    for word in re.findall(r"[^\W\d]+", unit):
        for misread, meant in _MISREAD:
            if misread.fullmatch(word):
                raise InputError(field, value, accepted, f'has the unit "{word}", {meant}')
    try:
        if not _UNIT.fullmatch(unit):
            raise ValueError(unit)  # noqa: TRY301 # as pint would
        size, root, zero = _judged(unit)
        our_size, ours, _ = _judged(si)
    except Exception:  # noqa: BLE001 # as above
        names = [name for name, (kind, _) in COMMON.items() if kind == si]
        hint = did_you_mean(unit, names) if nearest(unit, names) else did_you_mean(unit, COMMON)
        raise InputError(field, value, accepted, f'has the unknown unit "{unit}"{hint}') from None
    # Compare root units, not dimensionality: for pint both an angle and a percentage are dimensionless.
    if root != ours:
        raise InputError(field, value, accepted, f"is {_in_words(root)}, not {_demanded(si)}")
    if zero:  # units with an offset, such as degrees Celsius or decibels
        raise InputError(field, value, accepted, f'has the unit "{unit}", whose zero is not zero')
    return float(size / our_size)


def _demanded(si: str) -> str:
    """Return in words the quantity measured in a coherent SI unit, of the table or a user's model."""
    return DIMENSIONS[si] if si in DIMENSIONS else _in_words(_judged(si)[1])


def _in_words(powers: Powers) -> str:
    """Return in words the quantity of a product of pint's root units: `a force`, or a power product of SI units."""
    named = next((words for si, words in _WORDS.items() if _judged(si)[1] == powers), None)
    if named:
        return named
    si = {"gram": "kg", "meter": "m", "second": "s", "ampere": "A", "kelvin": "K", "mole": "mol", "radian": "rad"}
    parts = [si.get(name, name) + (f"^{power:g}" if power != 1 else "") for name, power in powers.items()]
    return f"in {' '.join(parts)}"


@cache
def _judged(unit: str) -> tuple[float, Powers, float]:
    """Return a unit's factor to pint's root units, their powers, and the value of its zero in them.

    Raises what pint raises if it is unknown. Pint's root unit of mass is the gram; the radian is a root unit.
    """
    import hashlib
    from importlib.metadata import version

    from ..host.user_cache import fetch

    content = json.dumps(["pint", version("pint"), unit, "zero"])

    def ask_pint() -> bytes:
        registry = _registry()
        size: Any
        parsed = registry.parse_units(unit)
        size, root = registry.get_root_units(parsed)
        zero = float(registry.Quantity(0.0, parsed).to_root_units().magnitude)
        return json.dumps([float(size), dict(registry.Quantity(1, root).unit_items()), zero]).encode()

    size, powers, zero = json.loads(fetch(f"unit-{hashlib.sha256(content.encode()).hexdigest()[:32]}.json", ask_pint))
    return size, powers, zero


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint

    return pint.UnitRegistry()
