"""Initial conditions: initial contact at x = x0, impact with normal speed v0 at angle theta0, spheres that may spin."""

from __future__ import annotations

import sympy as sp

from ...vocabulary.quantities import a, beta, impact_spin, omega, theta0, u, v0, x, x0, xi


def initial_rate() -> sp.Expr:
    """omega0: the tangential speed v0 tan(theta0) over the centre distance, taken as 4a as in the paper."""
    return v0 * sp.tan(theta0) / (4 * a)


def start_values() -> dict[sp.Symbol, sp.Expr]:
    """SI initial values of x, u, omega, xi and beta."""
    return {x: x0, u: -v0, omega: initial_rate(), xi: impact_spin, beta: sp.Integer(0)}
