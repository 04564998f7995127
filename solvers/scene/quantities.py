"""Quantities of the vocabulary from scene entries, as numbers, arrays or CasADi expressions.

The schema states which entries are quantities themselves (`Field.quantity`). Quantities that depend on several entries
are computed here: masses from densities, reduced quantities of a pair, the speed from a Stokes number.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ...generated import scaling
from .schema import FIELDS

_OWN = "custom."


def quantities(entries: Mapping[str, Any], wall: bool = False) -> dict[str, Any]:
    """Quantities by vocabulary name, SI.

    Arguments:
        entries: by dotted name, SI; choices and flags are ignored.
        wall: True if the partner is a wall.
    """
    found = {
        FIELDS[name].quantity: FIELDS[name].factor * value if FIELDS[name].factor != 1 else value
        for name, value in entries.items()
        if name in FIELDS and FIELDS[name].quantity
    }
    found |= {name.removeprefix(_OWN): value for name, value in entries.items() if name.startswith(_OWN)}
    found |= sphere(entries)
    radius_ratio, mass_ratio = _ratios(found, entries, wall)
    if not wall:
        found |= {"radius_ratio": radius_ratio, "mass_ratio": mass_ratio}
    found["reduced_radius"] = found["reduced_radius"] * shared(radius_ratio)
    found["reduced_mass"] = found["reduced_mass"] * shared(mass_ratio)
    if "impact.stokes" in entries:
        unit = scaling.stokes(found["reduced_radius"], found["reduced_mass"], found["viscosity"], 1.0)
        found["speed"] = entries["impact.stokes"] / unit
    return found


def sphere(entries: Mapping[str, Any]) -> dict[str, Any]:
    """Half the radius (m) and half the mass (kg) of the first sphere, from radius, mass or density."""
    found = {}
    for name in ("particles.reduced_radius", "particles.radius", "particles.reduced_mass", "particles.mass"):
        if name in entries:
            found[FIELDS[name].quantity] = FIELDS[name].factor * entries[name]
    if "particles.density" in entries:
        found["reduced_mass"] = _mass(2 * found["reduced_radius"], entries["particles.density"]) / 2
    return found


def partner_mass(entries: Mapping[str, Any]) -> Any:
    """Mass of the other sphere, kg; None for a wall."""
    if "partner.density" in entries:
        return _mass(entries["partner.radius"], entries["partner.density"])
    return entries.get("partner.mass")


def shared(ratio: Any) -> Any:
    """A reduced quantity of a pair relative to two equal spheres: exactly 1 for ratio 1; 2 for a wall (ratio None)."""
    return 2.0 if ratio is None else 2 * ratio / (1 + ratio)


def _ratios(found: Mapping[str, Any], entries: Mapping[str, Any], wall: bool) -> tuple[Any, Any]:
    """R_2/R_1 and M_2/M_1; None for a wall."""
    if wall:
        return None, None
    if "partner.radius" not in entries:
        return 1.0, 1.0
    return (
        entries["partner.radius"] / (2 * found["reduced_radius"]),
        partner_mass(entries) / (2 * found["reduced_mass"]),
    )


def _mass(radius: Any, density: Any) -> Any:
    return 4 / 3 * math.pi * radius * radius * radius * density  # yields inf instead of OverflowError
