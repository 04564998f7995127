"""The gap of solid contact: the largest of the gaps at which a rebound criterion is met."""

from __future__ import annotations

from collections.abc import Mapping

from ...generated.automaton import CRITERIA

GAPS = {word: row.limit for word, row in CRITERIA.items() if row.contact}
"""Word of a rebound criterion with a fixed gap -> name of that gap's group."""
NEVER_MET = dict(row.removed_by for row in CRITERIA.values() if row.removed_by is not None)
"""Quantities that disable the rebound criteria, SI."""


def contact_gap(groups: Mapping[str, float]) -> float:
    """Gap of solid contact, over x0."""
    return max(groups[name] for name in GAPS.values())


def contact_word(groups: Mapping[str, float]) -> str:
    """Word that reports a contact: the first criterion whose gap is the largest and positive, else the last."""
    *first, last = GAPS
    contact = contact_gap(groups)
    return next((word for word in first if groups[GAPS[word]] == contact > 0), last)
