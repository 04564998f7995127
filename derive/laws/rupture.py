"""Where a doublet comes apart: the bridge's rupture distance, or the film's surface."""

from __future__ import annotations

import sympy as sp

from ..quantities import R, contact_angle, volume, x0

SOURCE = "Lian, Thornton & Adams, J. Colloid Interface Sci. 161, 138 (1993)"


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge (SOURCE), x0 without."""
    return R * volume ** sp.Rational(1, 3) * (1 + contact_angle / 2) if bridge else x0
