"""What the results of a collision are: one table, read by everything that computes, converts, stores or shows them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..generated.automaton import CRITERIA, OUTCOMES
from .host.arguments import check_names

FAILED = -1  # code of an outcome that no engine has decided
NONE = -1  # code of a reversal where no criterion was met
REVERSALS = tuple(CRITERIA)  # by code


@dataclass(frozen=True)
class Definition:
    """The definition of a result.

    Arguments:
        place: where the kernel's answer has it (`engines/taylor/layout.py`): a field, or its index in `shown`; of a
            term of the energy, the field of the ledger. None of what only has derivatives.
        scale: conversion of the dimensionless value to SI ("length", "time", "rate", "energy"); None if dimensionless.
        exists: for which collisions it is defined: all, those that have "separated", those that also had a tangential
            velocity of the centres ("sliding") or of the surfaces ("slipping"), or a "stick".
        odd: True if the mirror image of a collision has it with the other sign; it then depends on the angle head-on.
        jumps: how much of a trajectory the slow manifold may replace (`run_kernel`) where it is requested.
        mapped: a map has it unless told otherwise.
        derivative: "all" if every engine differentiates it, "casadi" if the kernel does not, "" if none does.
        integral: True if it is an integral over the trajectory.
        symbol: as shown behind its name.
        short: a term of the energy in a table for a person.
    """

    name: str
    unit: str
    meaning: str
    place: int | str | None = None
    scale: str | None = None
    exists: str = "all"
    odd: bool = False
    jumps: int = 2
    mapped: bool = False
    derivative: str = ""
    integral: bool = False
    symbol: str = ""
    short: str = ""

    @property
    def term(self) -> str:
        """The name in its own table: `capillary` of `energy.capillary`."""
        return self.name.rpartition(".")[2]

    @property
    def label(self) -> str:
        """Its name and symbol in words."""
        return f"{self.name.replace('_', ' ')} {self.symbol}".rstrip()


_COLLISION = (
    Definition("restitution", "1", "normal restitution e_n", 0, mapped=True, derivative="all", symbol="e_n"),
    Definition(
        "tangential_restitution", "1", "tangential restitution r_f omega_f/(r_0 omega_0)", 1, exists="sliding",
        mapped=True, derivative="all", symbol="e_t",
    ),
    Definition(
        "slip_restitution", "1", "relative velocity of the surfaces at the contact, after over before", "slip",
        exists="slipping", derivative="casadi",
    ),
    Definition(
        "rotation", "rad", "angle turned by the line of centres until separation", "turned", exists="separated",
        odd=True, jumps=0, mapped=True, derivative="all", integral=True,
    ),
    Definition(
        "contact_time", "s", "time from initial contact to separation", "time", "time", "separated", jumps=0,
        mapped=True, derivative="all",
    ),
    Definition(
        "smallest_gap", "m", "smallest gap until separation", "smallest_gap", "length", "separated", jumps=1,
        mapped=True, derivative="all",
    ),
    Definition(
        "final_spin", "rad/s", "spin at separation, of the first sphere", 3, "rate", "separated", odd=True,
        derivative="all",
    ),
    Definition(
        "final_spin_partner", "rad/s", "spin of the partner at separation", 4, "rate", "separated", odd=True,
        derivative="casadi",
    ),
    Definition(
        "final_rotation_rate", "rad/s", "angular velocity of the line of centres at separation", 2, "rate", "separated",
        odd=True, derivative="all",
    ),
    Definition("until", "s", "where the integration of a stick stopped", "time", "time", "stick", jumps=0),
    Definition("reversal", "", "first rebound criterion met", "reversal"),
    Definition("steps", "1", "steps that the engine took", "steps"),
)  # fmt: skip


def _energy(term: str, short: str, meaning: str, place: str | None, integral: bool = False) -> Definition:
    name = f"energy.{term}"
    return Definition(name, "J", meaning, place, "energy", derivative="casadi", integral=integral, short=short)


_ENERGY = (
    _energy("initial", "kinetic, initial", "kinetic energy at initial contact", "initial"),
    _energy("final", "kinetic, final", "kinetic energy at the end", "final"),
    _energy("normal_lubrication", "normal lubrication", "taken by the film along the line of centres", "normal", True),
    _energy("tangential_lubrication", "tangential lubrication", "taken by the shear", "tangential", True),
    _energy("capillary", "capillary work", "work against the bridge", "capillary", True),
    _energy("attraction", "van der Waals work", "work against van der Waals forces", "attraction", True),
    _energy("dry_contact", "dry contact", "lost in the rebounds", "dry"),
    _energy("dry_friction", "contact friction", "lost by friction of the dry contact", "friction", True),
    _energy("strings", "strings", "gain of the strings' potential energy", "lifted"),
    _energy("own_events", "declared events", "kinetic energy that declared events take", "own_events"),
    _energy("own_terms", "declared terms", "energy and work of a model's declared terms", "own_terms", True),
    _energy("residual", "residual", "error of the integration: what the ledger leaves", None),
)
_DRIFT = Definition("angular_momentum_drift", "1", "change of L over its size at initial contact", "momentum")
_OF_IMPACT = (
    Definition("centrifugal", "1", "centrifugal number m omega0^2/sigma"),
    Definition("capillary", "1", "capillary number"),
    Definition("reynolds", "1", "Reynolds number of the film"),
    Definition("generalised_centrifugal", "1", "generalised centrifugal number m omega0^2 a/F"),
)
_IMPACT = (
    Definition("stokes", "1", "Stokes number"),
    Definition("speed", "m/s", "normal approach speed"),
    Definition("relative_speed", "m/s", "magnitude of the relative velocity"),
    Definition("angle", "rad", "impact angle"),
)
DEFINITIONS = {row.name: row for row in (*_COLLISION, *_ENERGY, _DRIFT, *_OF_IMPACT, *_IMPACT)}

OF_SEPARATION = tuple(row.name for row in _COLLISION if row.derivative and row.place is not None)
"""What a pair that separates has; of a stick only the restitution, which is 0, is defined."""
TERMS = {row.term: row.place for row in _ENERGY if isinstance(row.place, str)}
"""Terms of the ledger, and the kernel's name for each."""
LEDGER = tuple(row.name for row in (*_ENERGY, _DRIFT))
"""What takes an integration of the ledger; a term that a scene has not is NaN."""
INTEGRATED = (*(row.name for row in _COLLISION if row.place is not None), *LEDGER)
OF_IMPACT = tuple(row.name for row in _OF_IMPACT)
"""Numbers that the impact alone decides."""
RATES = tuple(row.name for row in _COLLISION if row.scale == "rate")
IMPACT = tuple(row.name for row in _IMPACT)
BY_DEFAULT = tuple(row.name for row in _COLLISION if row.mapped)
"""What a regime map has unless it is told otherwise."""
VALIDITY = "validity"
"""Name of the variable that says where the model leaves its range."""
ALWAYS = ("outcome", "certified", "reason")
MAPPED = (*INTEGRATED, *ALWAYS, VALIDITY)
REQUESTED = (*MAPPED, *OF_IMPACT)
"""Names that `collide_many` accepts."""
DIFFERENTIATED = tuple(row.name for row in DEFINITIONS.values() if row.derivative)
TANGENTS = tuple(row.name for row in DEFINITIONS.values() if row.derivative == "all")
"""Results that the kernel differentiates."""
SPENT = tuple(row.name for row in _ENERGY[2:-1])
"""Terms that the ledger takes from the initial energy, beside the final one."""
UNITS = {row.name: row.unit for row in DEFINITIONS.values() if row.unit and row.name not in LEDGER[:-1]} | {
    "events": "s",
    "energy": "J",
    "rtol": "1",
}
"""Units of the values in a collision's JSON object, by key; for `events`, the unit of their times."""


def check_differentiated(of: Sequence[str] | str) -> tuple[str, ...]:
    """The requested results; InputError with the nearest name for one that has no derivative."""
    return check_names(of, DIFFERENTIATED, "of", "names no quantity")


def attributes(name: str) -> dict[str, Any]:
    """Unit and meaning of a column; flags of a code."""
    row = DEFINITIONS[name]
    if name == "reversal":
        codes = np.arange(NONE, len(REVERSALS), dtype=np.int8)
        return {"long_name": row.meaning, "flag_values": codes, "flag_meanings": " ".join(("none", *REVERSALS))}
    return {"units": row.unit, "long_name": row.meaning}


def outcome_attributes(meaning: str = "outcome", none: str = "failed") -> dict[str, Any]:
    """CF flag attributes of an outcome variable; `none` is the word for -1."""
    return {
        "long_name": meaning,
        "flag_values": np.array([FAILED, 0, 1, 2], dtype=np.int8),
        "flag_meanings": f"{none} " + " ".join(name.replace("-", "_") for name in OUTCOMES),
    }
