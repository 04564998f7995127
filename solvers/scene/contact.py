"""The gap of solid contact: the largest of the gaps at which a rebound criterion is met."""

from collections.abc import Mapping
from typing import Any

from ...generated import scaling
from ...generated.automaton import CRITERIA
from .schema import FIELDS

GAPS = {word: row.limit for word, row in CRITERIA.items() if row.contact}
"""Word of a rebound criterion with a fixed gap -> name of that gap's group."""
NEVER_MET = dict(row.removed_by for row in CRITERIA.values() if row.removed_by is not None)
"""Quantities that disable the rebound criteria, SI."""
ENTRIES = {
    word: next(name for name, field in FIELDS.items() if field.quantity == row.removed_by[0])
    for word, row in CRITERIA.items()
    if row.removed_by is not None
}
"""Word of such a criterion -> entry of a scene that removes it."""
AT_ANY_SPEED = tuple(word for word, group in GAPS.items() if "speed" not in scaling.ARGUMENTS[group])
"""Criteria whose gap is that of the scene, however fast the impact."""
TIE = "tie of " + " and ".join(CRITERIA[word].name for word in reversed(GAPS))
"""Boundary at which two criteria are met at the same gap."""


def never_touching(quantities: Mapping[str, Any]) -> Any:
    """Whether no criterion is met at a gap, by quantities (SI); elementwise for arrays."""
    never: Any = True
    for name, value in NEVER_MET.items():
        never = never & (quantities.get(name, value) == value)
    return never


def gap_at_any_speed(word: str, quantities: Mapping[str, Any]) -> Any:
    """Gap of a criterion of AT_ANY_SPEED over x0, from quantities (SI)."""
    group = GAPS[word]
    return getattr(scaling, group)(*(quantities[name] for name in scaling.ARGUMENTS[group]))


def contact_gap(groups: Mapping[str, float]) -> float:
    """Gap of solid contact, over x0."""
    return max(groups[name] for name in GAPS.values())


def contact_word(groups: Mapping[str, float]) -> str:
    """Word that reports a contact: the first criterion whose gap is the largest and positive, else the last."""
    *first, last = GAPS
    contact = contact_gap(groups)
    return next((word for word in first if groups[GAPS[word]] == contact > 0), last)
