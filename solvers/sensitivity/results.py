"""The differentiable results of a collision by name, and the requirements of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..host.arguments import check_names


@dataclass(frozen=True)
class Quantity:
    """A differentiable result of a collision.

    Arguments:
        scale: conversion of the dimensionless value to SI ("length", "time", "rate", "energy"); None if dimensionless.
        extra: name of its quadrature, if it is an integral over the trajectory.
        odd: True if it changes sign with the impact angle, and so depends on it head-on.
    """

    name: str
    unit: str
    scale: str | None = None
    extra: str | None = None
    odd: bool = False


_ALL = (
    Quantity("restitution", "1"),
    Quantity("tangential_restitution", "1"),
    Quantity("slip_restitution", "1"),
    Quantity("rotation", "rad", extra="rotation", odd=True),
    Quantity("contact_time", "s", "time"),
    Quantity("smallest_gap", "m", "length"),
    Quantity("final_spin", "rad/s", "rate", odd=True),
    Quantity("final_spin_partner", "rad/s", "rate", odd=True),
    Quantity("final_rotation_rate", "rad/s", "rate", odd=True),
    Quantity("energy.initial", "J", "energy"),
    Quantity("energy.final", "J", "energy"),
    Quantity("energy.normal_lubrication", "J", "energy", "normal_lubrication"),
    Quantity("energy.tangential_lubrication", "J", "energy", "tangential_lubrication"),
    Quantity("energy.capillary", "J", "energy", "capillary"),
    Quantity("energy.attraction", "J", "energy", "attraction"),
    Quantity("energy.dry_contact", "J", "energy"),
    Quantity("energy.dry_friction", "J", "energy", "dry_friction"),
    Quantity("energy.strings", "J", "energy"),
    Quantity("energy.residual", "J", "energy"),
)
Row = Mapping[str, float | None]
"""A number for each parameter; None where it is not defined."""
DIFFERENTIATED = {quantity.name: quantity for quantity in _ALL}
LEDGER = tuple(name for name in DIFFERENTIATED if name.startswith("energy."))
SPENT = (*LEDGER[2:-1],)
"""Terms that the ledger takes from the initial energy, beside the final one."""


def check_quantities(of: Sequence[str] | str, label: str = "of") -> tuple[str, ...]:
    """The requested quantities; InputError with the nearest name for an unknown one."""
    return check_names(of, tuple(DIFFERENTIATED), label, "names no quantity")


def computed(of: Sequence[str]) -> tuple[str, ...]:
    """The quantities to compute for these; the residual requires all terms of the ledger."""
    names = [name for one in of for name in (LEDGER[:-1] if one == "energy.residual" else (one,))]
    return tuple(dict.fromkeys(names))
