"""What can be differentiated: the results of a collision by name, and what each asks of the computation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import InputError
from ..host.arguments import check_names


@dataclass(frozen=True)
class Quantity:
    """A result of a collision.

    Arguments:
        scale: by which its dimensionless value comes to SI ("length", "time", "rate", "energy"); None: it has no unit.
        extra: what must be integrated along, if it has an integral of its own.
        odd: it changes sign with the impact angle, and so depends on it head-on.
    """

    name: str
    unit: str
    scale: str | None = None
    extra: str | None = None
    odd: bool = False


_ALL = (
    Quantity("restitution", "1"),
    Quantity("tangential_restitution", "1"),
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
    Quantity("energy.strings", "J", "energy"),
    Quantity("energy.residual", "J", "energy"),
)
QUANTITIES = {quantity.name: quantity for quantity in _ALL}
LEDGER = tuple(name for name in QUANTITIES if name.startswith("energy."))
SPENT = (*LEDGER[2:-1],)
"""Terms that the ledger takes from the initial energy, beside the final one."""


def check_quantities(of: Sequence[str] | str, label: str = "of") -> tuple[str, ...]:
    """The quantities asked for; InputError naming the nearest for one that there is not."""
    asked = check_names(of, tuple(QUANTITIES), label)
    if not asked:
        raise InputError(label, "", ", ".join(QUANTITIES), "names no quantity")
    return asked


def computed(of: Sequence[str]) -> tuple[str, ...]:
    """What must be computed for these: the residual stands for all terms of the ledger."""
    names = [name for one in of for name in (LEDGER[:-1] if one == "energy.residual" else (one,))]
    return tuple(dict.fromkeys(names))
