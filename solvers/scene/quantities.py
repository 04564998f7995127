"""Quantities of the vocabulary from scene entries, as numbers, arrays or CasADi expressions.

The schema states which entries are quantities themselves (`Field.quantity`). Quantities that depend on several entries
are computed here: masses from densities, reduced quantities of a pair, films from coatings, volumes, the normal speed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ...generated import scaling
from ..errors import InputError
from .schema import FIELDS, FROM_COATING, KINDS, MEETING, Table, acting_defaults

_OWN = "custom."
SHADOW = "Shi & McCarthy 2008"
"""Source of the assumption that the coatings of the facing caps flow into the bridge: Powder Technology 184, 64."""
NO_GLASS = 1e60  # Pa: of a liquid that never turns solid; no film has such a pressure


@dataclass(frozen=True)
class Ways:
    """Meaning of the entries whose names leave it open.

    Arguments:
        wall: the partner is a wall.
        volume: `bridge.volume` is V/R^3 ("relative"), V in m^3 ("absolute"), or what flows out of the coatings.
    """

    wall: bool = False
    volume: Literal["relative", "absolute", "coating"] = "relative"

    @classmethod
    def of(cls, entries: Mapping[str, object]) -> Ways:
        """The meaning of a scene's entries, as stored."""
        volume, wall = entries.get("bridge.volume"), "partner.wall" in entries
        if not isinstance(volume, str):
            return cls(wall)
        return cls(wall, "coating" if volume == FROM_COATING else "absolute")


def quantities(entries: Mapping[str, Any], ways: Ways) -> dict[str, Any]:
    """Quantities by vocabulary name, SI, from entries in SI by dotted name; choices, flags and words are ignored."""
    entries = acting_defaults(entries) | dict(entries)
    result = _alone(entries)
    result |= {name.removeprefix(_OWN): value for name, value in entries.items() if name.startswith(_OWN)}
    result.setdefault("glass_transition_pressure", NO_GLASS)
    result.setdefault("impact_spin", 0.0)
    if not ways.wall:
        result.setdefault("impact_partner_spin", result["impact_spin"])
    if "friction" in result:
        result.setdefault("contact_tangential_restitution", 0.0)
    if "liquid.coating_thickness" in entries:
        result["film_thickness"] = initial_gap(entries)
    radius_ratio = mass_ratio = None if ways.wall else 1.0
    if not ways.wall and (other := partner_radius(entries)) is not None:
        radius_ratio = other / (2 * result["reduced_radius"])
        mass_ratio = partner_mass(entries) / (2 * result["reduced_mass"])
    if not ways.wall:
        result |= {"radius_ratio": radius_ratio, "mass_ratio": mass_ratio}
    radius = 2 * result["reduced_radius"]
    result["reduced_radius"] = result["reduced_radius"] * over_equal(radius_ratio)
    result["reduced_mass"] = result["reduced_mass"] * over_equal(mass_ratio)
    if ways.volume == "coating":
        result["volume"] = _from_coating(entries, radius, radius_ratio) / _cube(2 * result["reduced_radius"])
    elif ways.volume == "absolute":
        result["volume"] = result["volume"] / _cube(2 * result["reduced_radius"])
    if "partner.contact_angle" in entries and "contact_angle" in result:
        result["contact_angle"] = common_angle(result["contact_angle"], entries["partner.contact_angle"])
    if "impact.stokes" in entries:
        unit = scaling.stokes(result["reduced_radius"], result["reduced_mass"], result["viscosity"], 1.0)
        result["speed"] = entries["impact.stokes"] / unit
    elif "impact.relative_speed" in entries and "impact.angle" in entries:
        result["speed"] = normal_speed(entries["impact.relative_speed"], entries["impact.angle"])
    return result


def tables(values: Mapping[str, Any], ways: Ways) -> dict[str, Table | None]:
    """The tables of a scene by name, each with what its entries (SI) determine; None for one that is not there.

    Raises:
        InputError: radii, masses or a volume that are beyond a double.
    """
    derived = {f"particles.{name}": _alone(values)[name] for name in ("reduced_radius", "reduced_mass")}
    derived |= {"partner.radius": partner_radius(values), "partner.mass": partner_mass(values)}
    read = {name: FIELDS[name].read(value) for name, value in derived.items() if value is not None}
    si = {**values, **read, "liquid.film_thickness": initial_gap(values)}
    if "bridge.volume" in values and ways.volume != "relative":
        si["bridge.volume"] = _relative_volume(values, ways)
    here = {"model", "impact", *(name.partition(".")[0] for name in values)}
    return {name: kind.of(si) if name in here else None for name, kind in KINDS.items()}


def _relative_volume(values: Mapping[str, Any], ways: Ways) -> float:
    """V/R^3 of a volume that is given in m^3 or by coatings."""
    try:
        volume = float(quantities({k: v for k, v in values.items() if k not in MEETING}, ways)["volume"])
    except (OverflowError, ZeroDivisionError):
        volume = math.inf
    if not 0 < volume < math.inf:
        raise InputError("bridge.volume", values["bridge.volume"], FIELDS["bridge.volume"].accepts, "is too far off")
    return volume


def _alone(entries: Mapping[str, Any]) -> dict[str, Any]:
    """The quantities that an entry alone determines, and the mass of a density; sizes are those of the first sphere."""
    result = {
        FIELDS[name].quantity: FIELDS[name].factor * value if FIELDS[name].factor != 1 else value
        for name, value in entries.items()
        if name in FIELDS and FIELDS[name].quantity and not isinstance(value, str)
    }
    if "particles.density" in entries:
        result["reduced_mass"] = _mass(2 * result["reduced_radius"], entries["particles.density"]) / 2
    return result


def initial_gap(entries: Mapping[str, Any]) -> Any:
    """The gap at initial contact, m: as given, or the sum of both coatings; by default both are equally thick."""
    if "liquid.film_thickness" in entries:
        return entries["liquid.film_thickness"]
    coating = entries["liquid.coating_thickness"]
    return coating + entries.get("partner.coating_thickness", coating)


def partner_radius(entries: Mapping[str, Any]) -> Any:
    """Radius of the other sphere, m; None for a wall, and for equal spheres, which have no such entry."""
    for name in ("partner.radius", "partner.diameter"):
        if name in entries:
            return FIELDS[name].factor * entries[name]
    return None


def partner_mass(entries: Mapping[str, Any]) -> Any:
    """Mass of the other sphere, kg; None for a wall, and for equal spheres, which have no such entry."""
    if "partner.density" in entries:
        return _mass(partner_radius(entries), entries["partner.density"])
    return entries.get("partner.mass")


def common_angle(first: Any, second: Any) -> Any:
    """The contact angle whose cosine is the mean of two (rad); exactly that of both where they are equal.

    The attraction of a small bridge is 2 pi R sigma (cos phi_1 + cos phi_2): Orr, Scriven & Rivas, J. Fluid Mech. 67,
    723 (1975). With m the mean and d half the difference, cos phi = cos m cos d, so that sin((phi - m)/2) =
    cos m sin^2(d/2)/sin((phi + m)/2), which is nothing where d is.
    """
    mean, apart = (first + second) / 2, _called("sin", (first - second) / 4) ** 2
    raised = _called("cos", mean) * apart
    rough = 2 * _called("asin", _called("sqrt", _called("sin", mean / 2) ** 2 + raised))
    return mean + 2 * _called("asin", raised / (_called("sin", (rough + mean) / 2) + 1e-300))


def _called(name: str, value: Any) -> Any:
    """A function of numpy, also of CasADi's expressions."""
    if isinstance(value, float):
        return getattr(math, name)(value)
    if hasattr(value, "is_symbolic"):
        import casadi

        return getattr(casadi, name)(value)
    return getattr(np, name.replace("asin", "arcsin"))(value)


def normal_speed(relative: Any, angle: Any) -> Any:
    """The normal component of a relative velocity, m/s."""
    return relative * _called("cos", angle)


def over_equal(ratio: Any) -> Any:
    """A reduced quantity of a pair over that of two equal spheres: exactly 1 for ratio 1; 2 for a wall (ratio None)."""
    return 2.0 if ratio is None else 2 * ratio / (1 + ratio)


def coating_fraction(ratio: float | None) -> float:
    """The part of a sphere's coating that lies in the shadow of a partner `ratio` times its size (None: a wall).

    It flows into the bridge (`SHADOW`): of equal spheres (1 - sqrt(3)/2)/2 = 6.7 % each.
    """
    return 0.5 if ratio is None else float(_shadow(ratio))


def _shadow(ratio: Any) -> Any:
    """(1 - sqrt(1 - s^2))/2 with s = R_2/(R_1 + R_2), written without a difference of nearly equal numbers."""
    s = ratio / (1 + ratio)
    return s * s / (2 * (1 + (1 - s * s) ** 0.5))


def _from_coating(entries: Mapping[str, Any], radius: Any, ratio: Any) -> Any:
    """Volume of the bridge, m^3, that the coatings of both give."""
    coating = entries["liquid.coating_thickness"]
    other = entries.get("partner.coating_thickness", coating)
    fraction = entries.get("bridge.coating_fraction")
    if ratio is None:  # of a wall, the layer in the sphere's shadow
        return _shell(radius, coating) / 2 + math.pi * radius * radius * other
    parts = (_shadow(ratio), _shadow(1 / ratio)) if fraction is None else (fraction, fraction)
    return parts[0] * _shell(radius, coating) + parts[1] * _shell(ratio * radius, other)


def _shell(radius: Any, thickness: Any) -> Any:
    """Volume of a coating."""
    return 4 * math.pi * thickness * (radius * radius + radius * thickness + thickness * thickness / 3)


def _mass(radius: Any, density: Any) -> Any:
    return 4 / 3 * math.pi * radius * radius * radius * density  # yields inf instead of OverflowError


def _cube(length: Any) -> Any:
    return length * length * length
