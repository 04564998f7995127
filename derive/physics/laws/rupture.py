"""Gap at which a doublet separates: the rupture distance of the bridge (common, or a law's own), or the film's edge."""

from __future__ import annotations

import sympy as sp

from ...vocabulary.quantities import R, contact_angle, volume, x0
from .base import LawFunction
from .references import LIAN, MIKAMI, WILLETT, Reference

_THIRD = sp.Rational(1, 3)
_LIAN = volume**_THIRD * (1 + contact_angle / 2)


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge (Lian, Thornton & Adams 1993), x0 without one."""
    return R * _LIAN if bridge else x0


COMMON = (LIAN,)  # publication of the rupture distance, unless a law has its own

# Rupture distances over R published with a force law: distance, publication and a remark, by author
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
    """The rupture distance over R published with `author`'s force law."""
    distance, published, remark = _OWN[author]
    doc = f"Rupture distance over R that goes with this law.\n\nSource: {published.short}{remark}."
    return LawFunction("rupture_distance", (volume, contact_angle), distance, doc, references=(published,))
