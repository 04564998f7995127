"""What can be kept of many collisions: results by name, with unit and meaning, and how a column of each is stored."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...generated.automaton import CRITERIA, OUTCOMES

Block = dict[str, np.ndarray]  # columns of results, by name
FAILED = -1
NONE = -1  # code of a reversal where no criterion was met
REVERSALS = tuple(CRITERIA)  # by code

QUANTITIES: dict[str, tuple[str, str]] = {
    "restitution": ("1", "normal restitution e_n"),
    "tangential_restitution": ("1", "tangential restitution r_f omega_f/(r_0 omega_0)"),
    "rotation": ("rad", "angle turned by the line of centres until separation"),
    "contact_time": ("s", "time from initial contact to separation"),
    "smallest_gap": ("m", "smallest gap until separation"),
}
"""What a regime map keeps unless it is told otherwise."""

TIMES = ("contact_time", "rotation", "until")
"""What needs the whole trajectory: none of it is then replaced by the slow manifold."""

RATES = ("final_spin", "final_spin_partner", "final_rotation_rate")
LEDGER: dict[str, tuple[str, str]] = {
    "energy.initial": ("J", "kinetic energy at initial contact"),
    "energy.final": ("J", "kinetic energy at the end"),
    "energy.normal_lubrication": ("J", "taken by the film along the line of centres"),
    "energy.tangential_lubrication": ("J", "taken by the shear"),
    "energy.capillary": ("J", "work against the bridge"),
    "energy.attraction": ("J", "work against van der Waals forces"),
    "energy.dry_contact": ("J", "lost in the rebounds"),
    "energy.dry_friction": ("J", "lost by friction of the dry contact"),
    "energy.strings": ("J", "gain of the strings' potential energy"),
    "energy.residual": ("J", "error of the integration: what the ledger leaves"),
    "angular_momentum_drift": ("1", "change of L over its size at initial contact"),
}
"""What takes an integration of the ledger; a term that a scene has not is NaN."""

INTEGRATED: dict[str, tuple[str, str]] = {
    **QUANTITIES,
    "slip_restitution": ("1", "relative velocity of the surfaces at the contact, after over before"),
    "final_spin": ("rad/s", "spin at separation, of the first sphere"),
    "final_spin_partner": ("rad/s", "spin of the partner at separation"),
    "final_rotation_rate": ("rad/s", "angular velocity of the line of centres at separation"),
    "until": ("s", "where the integration of a stick stopped"),
    "reversal": ("", "first rebound criterion met"),
    "steps": ("1", "steps that the engine took"),
    **LEDGER,
}
OF_IMPACT: dict[str, tuple[str, str]] = {
    "centrifugal": ("1", "centrifugal number m omega0^2/sigma"),
    "capillary": ("1", "capillary number"),
    "reynolds": ("1", "Reynolds number of the film"),
    "generalised_centrifugal": ("1", "generalised centrifugal number m omega0^2 a/F"),
}
"""Numbers that the impact alone decides."""

VALIDITY = "validity"
"""Name of the variable that says where the model leaves its range."""
ALWAYS = ("outcome", "certified", "reason")
MAPPED = (*INTEGRATED, *ALWAYS, VALIDITY)
RESULTS = (*MAPPED, *OF_IMPACT)


def empty(size: int, of: Sequence[str]) -> Block:
    """All columns of a result before anything is computed: outcome -2, reasons empty."""
    columns: Block = {"outcome": np.full(size, -2, np.int8), "certified": np.zeros(size, bool)}
    columns["reason"] = np.full(size, "", object)
    for name in dict.fromkeys(("restitution", *of)):
        if name == "reversal":
            columns[name] = np.full(size, NONE, np.int8)
        elif name == VALIDITY:
            columns[name] = np.zeros(size, np.int16)
        elif name not in ALWAYS:
            columns[name] = np.full(size, np.nan)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def attributes(name: str) -> dict[str, Any]:
    """Unit and meaning of a column; flags of a code."""
    unit, meaning = INTEGRATED[name] if name in INTEGRATED else OF_IMPACT[name]
    if name == "reversal":
        codes = np.arange(NONE, len(REVERSALS), dtype=np.int8)
        return {"long_name": meaning, "flag_values": codes, "flag_meanings": " ".join(("none", *REVERSALS))}
    return {"units": unit, "long_name": meaning}


def outcome_attributes(meaning: str = "outcome", none: str = "failed") -> dict[str, Any]:
    """CF flag attributes of an outcome variable; `none` is the word for -1."""
    return {
        "long_name": meaning,
        "flag_values": np.array([FAILED, 0, 1, 2], dtype=np.int8),
        "flag_meanings": f"{none} " + " ".join(name.replace("-", "_") for name in OUTCOMES),
    }
