"""Where a doublet comes apart: the bridge's rupture distance (one for all, or a law's own), or the film's surface."""

from __future__ import annotations

import sympy as sp

from ...vocabulary.quantities import R, contact_angle, volume, x0
from .base import LawFunction
from .references import LIAN, MIKAMI, WILLETT, Reference

_THIRD = sp.Rational(1, 3)
_LIAN = volume**_THIRD * (1 + contact_angle / 2)


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge (Lian, Thornton & Adams 1993), x0 without."""
    return R * _LIAN if bridge else x0


COMMON = (LIAN,)  # where the rupture distance of every law is published, unless it has its own

# Rupture distances over R that go with a force law, where they are published, and what more there is to say
_OWN: dict[str, tuple[sp.Expr, Reference, str]] = {
    "willett": (
        (1 + contact_angle / 2) * (volume**_THIRD + volume ** (2 * _THIRD) / 10),
        WILLETT,
        "",
    ),
    "mikami": (
        (sp.Rational("0.62") * contact_angle + sp.Rational("0.99")) * volume ** sp.Rational("0.34"),
        MIKAMI,
        "",
    ),
    "lian": (_LIAN, LIAN, ", which Soulie et al. (2006) use"),
}


def own_rupture(author: str) -> LawFunction:
    """The rupture distance over R that goes with `author`'s force law."""
    distance, published, remark = _OWN[author]
    doc = f"Rupture distance over R that goes with this law.\n\nSource: {published.short}{remark}."
    return LawFunction("rupture_distance", (volume, contact_angle), distance, doc, references=(published,))
