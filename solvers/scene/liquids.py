"""Viscosities of liquids by name, mass fraction in water and temperature: "glycerol 85 %, 25 degC".

CoolProp has equations of pure liquids and Melinder's of solutions in water, `chemicals` the tables of Perry and of the
VDI, and aqueous glycerol is Cheng's formula. Where two of them have a liquid, the second is the check of the first.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from ..errors import InputError, did_you_mean

ACCEPTED = 'a liquid at a temperature, such as "glycerol 85 %, 25 degC" (mass fraction in water) or "water, 20 degC"'
AGREED = 0.05
"""Part by which two sources may differ: the largest error that any of them claims."""
_ZERO = 273.15  # K
_ATMOSPHERE = 101325.0  # Pa
_NAMED = re.compile(r"(?P<what>.+),\s*(?P<number>[+-]?\d+\.?\d*)\s*(?:°|deg)?\s*(?P<unit>[CFK])\s*")
_PART = re.compile(
    r"(?P<number>(?:(?<=\s)-)?\d+\.?\d*)\s*(?P<kind>(?:wt|w/w|mass|vol|v/v|mol)?)\.?\s*-?\s*%\s*(?:\(?w/w\)?|by mass)?"
)
_ALIASES = {"glycerine": "glycerol", "glycerin": "glycerol", "ethanediol": "ethylene glycol", "eg": "ethylene glycol"}
_SOLUTIONS = {
    "glycerol": "MGL", "ethylene glycol": "MEG", "propylene glycol": "MPG", "ethanol": "MEA", "methanol": "MMA",
    "sodium chloride": "MNA", "calcium chloride": "MCA", "potassium carbonate": "MKC",
}  # fmt: skip
_POLYMER = re.compile(r"poly|p[ev][gpa]\b|pdms|dimethicone|.*\bgum\b")
_NUMBERS = {
    "water": "7732-18-5", "glycerol": "56-81-5", "ethylene glycol": "107-21-1", "propylene glycol": "57-55-6",
    "ethanol": "64-17-5", "methanol": "67-56-1",
}  # fmt: skip
"""CAS numbers that are known without the table of all names, which takes seconds to read."""


@dataclass(frozen=True)
class Value:
    """A viscosity (Pa s) with its source and the range for which that gives it."""

    viscosity: float
    source: str
    range: str


@dataclass(frozen=True)
class Liquid:
    """A liquid at a temperature, by one source or several, the first of which is taken."""

    text: str
    values: tuple[Value, ...]

    @property
    def viscosity(self) -> float:
        return self.values[0].viscosity

    @property
    def origin(self) -> str:
        """Source, range and number."""
        first = self.values[0]
        return f"{first.viscosity:.4g} Pa s, {first.source}, {first.range}"

    @property
    def remarks(self) -> tuple[str, ...]:
        """A sentence for each other source that differs by more than either claims."""
        first = self.values[0]
        apart = ((other, abs(math.log(other.viscosity / first.viscosity))) for other in self.values[1:])
        return tuple(
            f'liquid.viscosity = "{self.text}" is {first.viscosity:.4g} Pa s by {first.source} and '
            f"{other.viscosity:.4g} Pa s by {other.source}: they differ by {share:.0%}"
            for other, share in apart
            if share > AGREED
        )


def is_named(text: object) -> bool:
    """Whether a text is meant as a liquid at a temperature, not as a number with its unit."""
    return isinstance(text, str) and "," in text and re.search(r"[^\W\d]{3}", text.rpartition(",")[0]) is not None


@lru_cache(maxsize=256)
def liquid(text: str, label: str = "liquid.viscosity") -> Liquid:
    """The liquid that a text names.

    Raises:
        InputError: no such liquid, a fraction or temperature outside every source's range, or a missing extra.
    """
    read = _NAMED.fullmatch(text)
    if read is None:
        raise InputError(label, text, ACCEPTED, "names no liquid at a temperature")
    degrees = float(read["number"])
    kelvin = degrees if read["unit"] == "K" else _ZERO + (degrees if read["unit"] == "C" else (degrees - 32) / 1.8)
    name, fraction = _named(read["what"], text, label)
    values: list[Value] = []
    refused: list[str] = []
    solid = ""  # a source in which it melts above its boiling point
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of how `chemicals` reads its tables, and at the edges of CoolProp's
        sources = list(_sources(name, fraction, text, label))
    for source, low, high, value, at in sources:
        if low >= high:
            solid = source
            continue
        span = f"{low - _ZERO:.4g} to {high - _ZERO:.4g} degC{at}"
        if low <= kelvin <= high and math.isfinite(number := value(kelvin)):
            values.append(Value(number, source, span))
        else:
            refused.append(f"{span} ({source})")
    if not values:
        unknown = f"is no liquid at atmospheric pressure ({solid})" if solid else _unknown(name)
        problem = f"is known at {'; '.join(refused)} only" if refused else unknown
        raise InputError(label, text, ACCEPTED, problem)
    return Liquid(text.strip(), tuple(values))


def _unknown(name: str) -> str:
    """What is wrong with a name that no source has."""
    words, _, last = name.rpartition(" ")
    if last.replace(".", "", 1).isdigit():
        return f'has a number without a unit: "{words} {last} %" is a mass fraction in water'
    if name in _SOLUTIONS:
        return f'is a solution, which needs its mass fraction, as in "{name} 20 %"'
    return "is a liquid whose viscosity no source has" + did_you_mean(name, {*_SOLUTIONS, *_NUMBERS, *_ALIASES})


def _named(what: str, text: str, label: str) -> tuple[str, float | None]:
    """Name and mass fraction in water; None of a pure liquid."""
    share = _PART.search(what)
    name = re.sub(r"\s*(?:\bin\b|[-/+]|)\s*water\s*$", "", _PART.sub(" ", what), flags=re.IGNORECASE) if share else what
    name = " ".join(name.replace("aqueous", "").split()).lower() or "water"
    name = _ALIASES.get(name, name)
    if share is None:
        return name, None
    if share["kind"] in ("vol", "v/v", "mol"):
        by = "amount" if share["kind"] == "mol" else "volume"
        raise InputError(label, text, ACCEPTED, f"is a fraction by {by}, not by mass")
    fraction = float(share["number"]) / 100
    if not 0 <= fraction <= 1:
        raise InputError(label, text, "a mass fraction of 0 to 100 %", "is no such fraction")
    return name, None if fraction == 1 else fraction


_Source = tuple[str, float, float, Callable[[float], float], str]
"""Its name, the range of temperature (K), the viscosity (Pa s), and what else it is said of."""


def _sources(name: str, fraction: float | None, text: str, label: str) -> Iterator[_Source]:
    library, tables = _extra(text, label)
    if name == "glycerol":
        share = 1.0 if fraction is None else fraction
        yield "Cheng 2008", _ZERO, _ZERO + 100, lambda kelvin: cheng(share, kelvin - _ZERO), ", 0 to 100 %"
    if fraction is not None and name not in _SOLUTIONS:
        problem = "is not known in water" + did_you_mean(name, _SOLUTIONS)
        raise InputError(label, text, f"one of {', '.join(_SOLUTIONS)}, or a pure liquid", problem)
    if fraction is not None:
        yield from _solution(library, name, fraction, text, label)
    else:
        yield from _pure(library, tables, name)


def _extra(text: str, label: str) -> tuple[Any, Any]:
    try:
        import chemicals
        from CoolProp import CoolProp
    except ImportError:
        accepted = "pip install 'wetdoublet[liquids]', or a viscosity with its unit, \"0.08 Pa s\""
        raise InputError(label, text, accepted, "names a liquid, for which an extra is needed") from None
    return CoolProp, chemicals


def _solution(library: Any, name: str, fraction: float, text: str, label: str) -> Iterator[_Source]:
    """Melinder's equations of solutions in water."""
    code = _SOLUTIONS[name]
    state = library.AbstractState("INCOMP", code)
    least, most = state.keyed_output(library.ifraction_min), state.keyed_output(library.ifraction_max)
    if not least <= fraction <= most:
        if name == "glycerol":
            return  # Cheng's formula goes on
        problem = f"is known from {least:.0%} to {most:.0%} only (CoolProp, Melinder 2010)"
        raise InputError(label, text, ACCEPTED, problem)
    state.set_mass_fractions([fraction])
    low = max(state.trivial_keyed_output(library.iT_min), state.keyed_output(library.iT_freeze))
    fluid = f"INCOMP::{code}[{fraction!r}]"
    source = f"CoolProp {library.get_global_param_string('version')} (Melinder 2010)"
    high, parts = state.trivial_keyed_output(library.iT_max), f", {least:.0%} to {most:.0%}"
    yield source, low, high, lambda kelvin: float(library.PropsSI("V", "T", kelvin, "P", _ATMOSPHERE, fluid)), parts


def _pure(library: Any, tables: Any, name: str) -> Iterator[_Source]:
    """Equations of state with a viscosity, and tables, up to the boiling point."""
    fluid = name.replace(" ", "")
    try:
        low = max(library.PropsSI("Tmin", fluid), library.PropsSI("T_triple", fluid))
        boils = library.PropsSI("T", "P", _ATMOSPHERE, "Q", 0, fluid)
        library.PropsSI("V", "T", (low + boils) / 2, "P", _ATMOSPHERE, fluid)
    except ValueError:  # not among its fluids, or one without a viscosity
        pass
    else:
        source = f"CoolProp {library.get_global_param_string('version')}"
        yield source, low, boils, lambda kelvin: float(library.PropsSI("V", "T", kelvin, "P", _ATMOSPHERE, fluid)), ""
    if _POLYMER.match(name):  # which `chemicals` takes for its monomer
        return
    try:
        number = _NUMBERS.get(name) or tables.CAS_from_any(name)
    except ValueError:
        return
    melts, boils = tables.Tm(number) or 0.0, tables.Tb(number) or math.inf
    perry = tables.viscosity.mu_data_Perrys_8E_2_313
    if number in perry.index:
        row = perry.loc[number]
        constants = [float(row[column]) for column in ("C1", "C2", "C3", "C4", "C5")]
        low, high = max(float(row["Tmin"]), melts), min(float(row["Tmax"]), boils)
        source = f"Perry's handbook, 8th ed. ({row['Chemical'].strip()})"
        yield source, low, high, lambda kelvin: float(tables.dippr.EQ101(kelvin, *constants)), ""
    vdi = tables.viscosity.mu_data_VDI_PPDS_7
    if number in vdi.index:
        row = vdi.loc[number]
        values = [float(row[column]) for column in "ABCDE"]
        source = f"VDI heat atlas ({row['Chemical'].strip()})"
        yield source, melts, boils, lambda kelvin: float(tables.viscosity.PPDS9(kelvin, *values)), ""


def cheng(fraction: float, celsius: float) -> float:
    """Viscosity (Pa s) of glycerol in water, Cheng, Ind. Eng. Chem. Res. 47, 3285 (2008): 0 to 100 %, 0 to 100 degC."""
    water = 1.790e-3 * math.exp((-1230 - celsius) * celsius / (36100 + 360 * celsius))
    glycerol = 12.1 * math.exp((-1233 + celsius) * celsius / (9900 + 70 * celsius))
    a = 0.705 - 0.0017 * celsius
    b = (4.9 + 0.036 * celsius) * a**2.5
    curved = a * b * fraction * (1 - fraction) / (a * fraction + b * (1 - fraction))
    weight = 1 - fraction + curved
    return math.exp(weight * math.log(water) + (1 - weight) * math.log(glycerol))
