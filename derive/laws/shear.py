"""Tangential lubrication: Couette shear of the film between surfaces that slide past each other.

Two equal spheres sliding in opposite directions do not change the film pressure (to first order the gap changes on
neither side), so the shear stress is mu U/h and only its integral is needed. The logarithm is cut off where the film or
the sphere ends. This outer thickness is ambiguous, hence two laws.
"""

from functools import cache

import sympy as sp

from ..user import Reference, a, aspect, gap, law, mu, omega, x, x0, xi

ONEILL = Reference(
    "oneill1970asymmetrical", ("O'Neill, M. E.", "Majumdar, R."),
    "Asymmetrical slow viscous fluid motions caused by the translation or rotation of two spheres. Part I: The "
    "determination of exact solutions for any values of the ratio of radii and separation parameters",
    "Zeitschrift für angewandte Mathematik und Physik", "ZAMP", "21", "164–179", 1970,
)  # fmt: skip

_h, _outer = sp.symbols("h h_outer", positive=True)


@cache
def tangential_force() -> sp.Expr:
    """F_t = 8 pi mu a^2 (omega - xi) ln(h_outer/x), to leading logarithm.

    Sliding speed of the surfaces: r omega - 2 R xi = 4a (omega - xi) to leading order, which is the form that leaves
    no force in rigid rotation (O'Neill & Majumdar 1970, constant term removed as the paper does).
    """
    sliding = 4 * a * (omega - xi)
    logarithm = sp.logcombine(sp.integrate(1 / _h, (_h, x, _outer)))  # of h_outer/x, a pure number
    per_speed = 2 * sp.pi * a * mu * logarithm  # stress mu/h, on rings 2 pi s ds = 2 pi a dh
    return sliding * per_speed


@cache
def log_factor(outer: sp.Expr) -> sp.Expr:
    """F_t over 8 pi mu a^2 (omega - xi), i.e. ln(h_outer/x) in the dimensionless gap, for an outer thickness in SI."""
    factor = sp.expand(tangential_force() / (8 * sp.pi * mu * a**2 * (omega - xi)))
    scaled = sp.logcombine(sp.simplify(factor)).subs({_outer: outer, x: gap * x0}, simultaneous=True)
    return sp.simplify(scaled.subs(x0, aspect * a))


def _sliding(name: str, outer: sp.Expr, meaning: str, source: str | Reference, remark: str = "") -> None:
    edge = sp.simplify((outer / x0).subs(x0, aspect * a))
    factor = log_factor(outer)
    law("shear", name, meaning=meaning, source=source, remark=remark, log_factor=factor, edge=edge, falls=True)


_IMMERSED = "leading logarithm of nearly touching, fully immersed spheres: cut off at the sphere radius 2a"
_FILM = "leading logarithm cut off at the rim of the film, x0"
_sliding("immersed", 2 * a, _IMMERSED, ONEILL, ", without its constant term")
_sliding("film", x0, _FILM, "Couette shear integrated over the wetted disc")
