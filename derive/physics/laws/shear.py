"""Tangential lubrication: Couette shear of the film between surfaces that slide past each other.

Two equal spheres sliding in opposite directions do not change the film pressure (to first order the gap changes on
neither side), so the shear stress is mu U/h and only its integral is needed. The logarithm is cut off where the film or
the sphere ends. This outer thickness is ambiguous, hence two laws.
"""

from functools import cache

import sympy as sp

from ...vocabulary.quantities import a, aspect, gap, mu, omega, x, x0, xi
from .base import Law, LawFunction
from .references import ONEILL, Reference

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


def _law(name: str, outer: sp.Expr, meaning: str, source: str, references: tuple[Reference, ...] = ()) -> Law:
    edge = sp.simplify((outer / x0).subs(x0, aspect * a))
    doc = "Tangential force over 8 pi mu a^2 (omega - xi), inside its edge."
    functions = (
        LawFunction("log_factor", (gap, aspect), log_factor(outer), doc, falls=True),
        LawFunction("edge", (aspect,), edge, "Gap (in film thicknesses) beyond which there is no tangential force."),
    )
    return Law("shear", name, meaning, source, functions, references=references)


_IMMERSED = "leading logarithm of nearly touching, fully immersed spheres: cut off at the sphere radius 2a"
_FILM = "leading logarithm cut off at the rim of the film, x0"
SHEARS = (
    _law("immersed", 2 * a, _IMMERSED, f"{ONEILL.short}, without its constant term", (ONEILL,)),
    _law("film", x0, _FILM, "Couette shear integrated over the wetted disc"),
)
