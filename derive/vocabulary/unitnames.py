"""Coherent SI units written as text, such as `kg m^2/s`, and their dimensions."""

from __future__ import annotations

import re

from .dimensions import ENERGY, FORCE, LENGTH, MASS, ONE, PRESSURE, TIME, Dimension

UNITS: dict[str, Dimension] = {
    "1": ONE, "rad": ONE, "m": LENGTH, "kg": MASS, "s": TIME, "N": FORCE, "Pa": PRESSURE, "J": ENERGY,
    "W": ENERGY / TIME, "Hz": TIME**-1,
}  # fmt: skip
_FACTOR = re.compile(r"([A-Za-z1]+)(?:\^(-?\d{1,2}))?")


class UnitError(ValueError):
    """An unknown unit; the message names it."""


def dimension_of_unit(text: str) -> Dimension:
    """Dimension of a product or quotient of coherent SI units; UnitError names an unknown unit."""
    if not isinstance(text, str) or not text.strip():
        raise UnitError("is not a unit")
    result = ONE
    for place, part in enumerate(text.replace("**", "^").replace("*", " ").split("/")):
        factors = part.split()
        if not factors or (place and len(factors) > 1):
            raise UnitError('is not a unit (one factor behind each "/")')
        for factor in factors:
            found = _FACTOR.fullmatch(factor)
            if found is None or found[1] not in UNITS:
                raise UnitError(f"has the unknown unit {factor!r}")
            power = int(found[2] or 1) * (-1 if place else 1)
            result = result * UNITS[found[1]] ** power
    return result
