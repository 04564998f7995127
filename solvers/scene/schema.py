"""All entries of a scene file: meaning, unit, range, and whether they are required."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Real

from ..errors import InputError, did_you_mean
from ..host.emitted import LAWS
from . import liquids, units

Raw = float | int | str
"""An entry as a scene keeps it: text with its unit, a choice, or a plain number."""
NEWTONIAN = "newtonian"
LIQUIDS: dict[str, tuple[str, ...]] = {
    "power-law": ("flow_index", "reference_rate", "plateau_rate"),
    "cross": ("flow_index", "relaxation_time", "infinite_shear_viscosity"),
    "carreau": ("flow_index", "relaxation_time", "infinite_shear_viscosity"),
    "herschel-bulkley": ("yield_stress", "flow_index", "reference_rate", "plateau_rate"),
}
"""Laws of liquids -> their entries beside the viscosity."""
FROM_COATING = "from coating"
"""Value of `bridge.volume` for a bridge whose liquid flows out of the coatings."""


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
LEAST_ANGLE = 1e-200  # rad; an impact at a smaller one is head-on: its rotation rate may underflow
WETTING_ANGLE = Range("from 0 deg to 90 deg", 0.0, math.pi / 2, low_open=False, high_open=False)


_IN_MODEL_FILES = {("model.arm", "surface"): "is a law of a model file (--model FILE.py), see docs/reference/models.md"}


@dataclass(frozen=True)
class Field:
    """One entry: a quantity (with `unit`), a plain number (without), a choice (with `choices`) or a `flag`.

    A flag is either true or absent.

    Arguments:
        gives: vocabulary name of the quantity that equals the entry times `factor`, if it differs from the entry's;
            empty if the quantity depends on other entries too (`quantities`).
        default: its number, SI, where its table is there without it.
        or_unit: the unit of what a plain number may be given as instead.
        words: what may stand in place of a number.
        by_name: a liquid at a temperature may stand in place of a number.
    """

    name: str
    what: str
    example: str
    range: Range = POSITIVE
    unit: str | None = None
    choices: tuple[str, ...] = ()
    required: bool = False
    flag: bool = False
    gives: str | None = None
    factor: float = 1.0
    default: float | None = None
    or_unit: str | None = None
    words: tuple[str, ...] = ()
    by_name: bool = False

    @cached_property
    def measured(self) -> Field:
        """The entry where it is given with `or_unit`."""
        unit = self.or_unit or ""
        what = f"{self.what} {self.range.text}, such as {self.example}, or {units.DIMENSIONS[unit]}"
        return replace(self, unit=unit, or_unit=None, what=what, example=f'"1e-13 {unit}"')

    @cached_property
    def quantity(self) -> str:
        """Vocabulary name of the entry's quantity; empty if the entry alone does not determine one."""
        if self.choices or self.flag:
            return ""
        return self.name.partition(".")[2] if self.gives is None else self.gives

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

    def read(self, raw: object, *, label: str | None = None, from_file: bool = False) -> float | str:
        """Return the SI number or the choice given by `raw`; InputError for an invalid value, or one outside the range.

        Arguments:
            raw: text with a unit, a number (SI), or a choice.
            label: name in the error, when it is not the field's own (an option).
            from_file: a quantity must be text with a unit, and a plain number must not be text.
        """
        label = label or self.name
        if self.flag:
            if raw is not True and (from_file or not isinstance(raw, str) or raw != "true"):
                raise InputError(label, raw, self.accepts)
            return "true"
        if self.choices:
            if not isinstance(raw, str) or raw not in self.choices:
                problem = "is not known" + did_you_mean(raw, self.choices)
                if isinstance(raw, str):
                    problem = _IN_MODEL_FILES.get((self.name, raw), problem)
                raise InputError(label, raw, self.accepts, problem)
            return raw
        if isinstance(raw, str) and raw.strip() in self.words:
            return raw.strip()
        if self.with_unit(raw):
            return self.measured.read(raw, label=label, from_file=from_file)
        value = self._number(raw, label, from_file)
        if not math.isfinite(value):
            raise InputError(label, raw, self.accepts, "is not finite")
        if not self.range.holds(value):
            if self.unit == "rad" and not isinstance(raw, str) and self.range.holds(math.radians(value)):
                problem = f'is out of range: plain numbers are radians, did you mean "{raw} deg"?'
                raise InputError(label, raw, self.accepts, problem)
            raise InputError(label, raw, self.accepts, "is out of range")
        return value

    def number(self, raw: object, *, label: str | None = None) -> float:
        """Return the SI number as `read` does, for a field that is no choice."""
        value = self.read(raw, label=label)
        if not isinstance(value, float):
            raise InputError(label or self.name, raw, self.accepts, "is not a number")
        return value

    def with_unit(self, raw: object) -> bool:
        """Whether a value that may be a plain number or a quantity is a quantity."""
        if not self.or_unit or isinstance(raw, Real):
            return False
        if isinstance(raw, str):
            return raw.strip() not in self.words and not units.is_number(raw)
        from .values import carries_unit  # imports numpy

        return carries_unit(raw)

    def _number(self, raw: object, label: str, from_file: bool) -> float:
        if isinstance(raw, str):
            if self.by_name and liquids.is_named(raw):
                return liquids.liquid(raw, label).viscosity
            if self.unit:
                return units.quantity(raw, self.unit, label, self.accepts)
            if from_file:
                raise InputError(label, raw, self.accepts, "is text, not a number")
            return units.number(raw, label, self.accepts)
        if not isinstance(raw, Real):
            from .values import scalar  # imports numpy

            raw = scalar(raw, self, label)
        if not isinstance(raw, Real) or isinstance(raw, bool):
            kind = "a number with its unit, as text" if self.unit else "a number"
            raise InputError(label, raw, self.accepts, f"is not {kind}")
        if self.unit and from_file:
            raise InputError(label, raw, self.accepts, "has no unit")
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


def _table(*fields: Field) -> dict[str, Field]:
    return {field.name: field for field in fields}


FIELDS: dict[str, Field] = _table(
    Field("particles.reduced_radius", "a reduced radius a = R/2", '"50 um"', unit="m"),
    Field("particles.radius", "a radius R", '"100 um"', unit="m", gives="reduced_radius", factor=0.5),
    Field("particles.diameter", "a diameter 2R", '"200 um"', unit="m", gives="reduced_radius", factor=0.25),
    Field("particles.reduced_mass", "a reduced mass m = M/2", '"5.2e-6 g"', unit="kg"),
    Field("particles.mass", "the mass M of one sphere", '"1.04e-5 g"', unit="kg", gives="reduced_mass", factor=0.5),
    Field("particles.density", "the density of the spheres", '"2500 kg/m^3"', unit="kg/m^3", gives=""),
    Field("particles.roughness", "a roughness", '"0.2 um"', NOT_NEGATIVE, unit="m", required=True),
    Field("particles.dry_restitution", "a number", "0.99", FRACTION, required=True),
    Field("particles.friction", "a Coulomb coefficient", "0.2", NOT_NEGATIVE),
    Field("particles.contact_tangential_restitution", "a number", "0.35", FRACTION),
    Field("particles.youngs_modulus", "a Young's modulus", '"70 GPa"', unit="Pa"),
    Field("particles.poisson_ratio", "a number", "0.2", POISSON),
    Field("liquid.viscosity", "a viscosity", '"2 Pa s"', unit="Pa s", required=True, by_name=True),
    Field("liquid.law", "a law", "newtonian", choices=(NEWTONIAN, *LIQUIDS)),
    Field("liquid.flow_index", "a number", "0.5", Range("> 0 and at most 2", 0.0, 2.0, high_open=False)),
    Field("liquid.relaxation_time", "a time", '"1 ms"', unit="s"),
    Field("liquid.infinite_shear_viscosity", "a viscosity", '"0.01 Pa s"', NOT_NEGATIVE, unit="Pa s", default=0.0),
    Field("liquid.yield_stress", "a stress", '"20 Pa"', unit="Pa"),
    Field("liquid.reference_rate", "a shear rate", '"1 1/s"', unit="rad/s", default=1.0),
    Field("liquid.plateau_rate", "a shear rate", '"0.1 1/s"', unit="rad/s", default=1.0),
    Field("liquid.measured_to", "a shear rate", '"1000 1/s"', unit="rad/s"),
    Field("liquid.film_thickness", "a film thickness, the gap at initial contact,", '"8 um"', unit="m"),
    Field("liquid.coating_thickness", "the coating on a sphere", '"4 um"', NOT_NEGATIVE, unit="m", gives=""),
    Field("liquid.glass_transition_pressure", "a pressure", '"20 MPa"', unit="Pa"),
    Field("liquid.density", "a density", '"1000 kg/m^3"', unit="kg/m^3"),
    Field("bridge.surface_tension", "a surface tension", '"0.025 N/m"', unit="N/m", required=True),
    Field("bridge.volume", "a number V/R^3", "0.1", required=True, or_unit="m^3", words=(FROM_COATING,)),
    Field("bridge.coating_fraction", "the part of the coating", "0.067", PART, gives=""),
    Field("bridge.contact_angle", "an angle", '"0 deg"', WETTING_ANGLE, unit="rad", default=0.0),
    Field("bridge.law", "a law", "mikami", choices=tuple(LAWS["bridge"])),
    Field("bridge.rupture", "a rupture distance", "common", choices=("common", "own")),
    Field("attraction.hamaker", "a Hamaker constant", '"1e-19 J"', NOT_NEGATIVE, unit="J", required=True),
    Field("partner.radius", "the radius R of the partner", '"200 um"', unit="m", gives=""),
    Field("partner.diameter", "the diameter 2R of the partner", '"400 um"', unit="m", gives="", factor=0.5),
    Field("partner.coating_thickness", "the coating on the partner", '"4 um"', NOT_NEGATIVE, unit="m", gives=""),
    Field("partner.mass", "the mass M of the partner", '"8.3e-5 g"', unit="kg", gives=""),
    Field("partner.density", "the density of the partner", '"2500 kg/m^3"', unit="kg/m^3", gives=""),
    Field("partner.contact_angle", "an angle", '"30 deg"', WETTING_ANGLE, unit="rad", gives=""),
    Field("partner.wall", "a wall", "true", flag=True),
    Field("pendulum.length", "a string length", '"0.5 m"', unit="m", required=True, gives="string_length"),
    Field("pendulum.gravity", "an acceleration", '"9.81 m/s^2"', unit="m/s^2", default=9.81),
    Field("pendulum.law", "a law", "exact", choices=tuple(LAWS["strings"])),
    Field("model.arm", "an arm", "midgap", choices=tuple(LAWS["arm"])),
    Field("model.tangential", "a logarithm", "immersed", choices=tuple(LAWS["shear"])),
    Field("model.glass", "a criterion", "literal", choices=tuple(LAWS["glass"])),
    Field("model.contact_friction", "what has friction", "solid", choices=("solid", "all")),
    Field("model.film", "a film", "finite", choices=tuple(LAWS["film"])),
    Field("impact.stokes", "a Stokes number", "0.03", gives=""),
    Field("impact.speed", "a normal approach speed", '"0.54 m/s"', unit="m/s"),
    Field("impact.relative_speed", "the magnitude of the relative velocity", '"1.08 m/s"', unit="m/s", gives=""),
    Field("impact.angle", "an impact angle", '"60 deg"', IMPACT_ANGLE, unit="rad"),
    Field("impact.spin", "a spin", '"200 rad/s"', ANY, unit="rad/s", gives="impact_spin", default=0.0),
    Field(
        "impact.partner_spin", "a spin of the partner", '"-50 rad/s"', ANY, unit="rad/s", gives="impact_partner_spin"
    ),
)
"""Dotted name -> what it is, in the order of the documentation."""

TABLES: dict[str, tuple[str, ...]] = {
    table: tuple(name for name in FIELDS if name.startswith(table + "."))
    for table in ("particles", "partner", "liquid", "bridge", "attraction", "pendulum", "model", "impact")
}
"""Table -> dotted names of its entries."""

REQUIRED_TABLES = ("particles", "liquid")
ONE_OF_EACH = (*REQUIRED_TABLES, "partner")
"""Tables, where they are there, that need one of each of their alternatives."""

SPEEDS = ("impact.stokes", "impact.speed", "impact.relative_speed")
"""Entries that give the speed of an impact: one variable, at an angle."""

MEETING = (*SPEEDS, "impact.angle")
"""Entries that may differ from collision to collision; all others are common to a batch, spins included."""

SPINS = ("impact.spin", "impact.partner_spin")

ALTERNATIVES: tuple[tuple[str, ...], ...] = (
    ("particles.reduced_radius", "particles.radius", "particles.diameter"),
    ("particles.reduced_mass", "particles.mass", "particles.density"),
    ("liquid.film_thickness", "liquid.coating_thickness"),
    SPEEDS,
    ("partner.radius", "partner.diameter", "partner.wall"),
    ("partner.mass", "partner.density", "partner.wall"),
)
"""Entries of which one at most may be given."""

DEFAULTS: dict[str, float] = {name: field.default for name, field in FIELDS.items() if field.default is not None}
"""Dotted name -> number, SI, of what need not be given where its table is."""


def acting_defaults(entries: Iterable[str]) -> dict[str, float]:
    """The numbers of `DEFAULTS` that act beside these entries: of tables that are there, and of a law of liquids."""
    names = {*entries}
    tables = {name.partition(".")[0] for name in names} - ({"liquid"} if "liquid.flow_index" not in names else set())
    return {name: value for name, value in DEFAULTS.items() if name.partition(".")[0] in tables}


def unknown_entry(name: str, value: object) -> InputError:
    """Return the error for an unknown entry, with the nearest known one."""
    table, _, key = name.partition(".")
    here = TABLES.get(table, ())
    if here and not key:
        return InputError(name, value, ", ".join(here), "is given to a table, not to one of its entries")
    elsewhere = [entry for entry in FIELDS if entry.endswith("." + (key or table))]
    hint = f", did you mean {elsewhere[0]}?" if elsewhere else did_you_mean(name, here) or did_you_mean(name, FIELDS)
    accepted = ", ".join(here) if here else "entries TABLE.KEY of the tables " + ", ".join(TABLES)
    return InputError(name, value, accepted, "has an unknown name" + hint)
