"""Where an approach rebounds: the film pressure on the axis reaches the glass transition, or the solids deform."""

from __future__ import annotations

from functools import cache

import sympy as sp

from ...vocabulary.quantities import E, a, gap, glass_number, mu, nu, u, v0, x, x0
from .base import Law, LawFunction
from .film import axis_pressure
from .references import CRADLE, RAGER, SERAYSSOL

approach = sp.Symbol("approach", real=True)  # -u/v0, positive while closing


@cache
def _film_corrected() -> sp.Expr:
    """Axis pressure over 3 mu a v0/x0^2, zero at the rim of the film."""
    scale = 3 * mu * a / x0**2
    return sp.factor(sp.simplify(axis_pressure() / scale).subs({x: gap * x0, u: -approach}, simultaneous=True))


@cache
def _literal() -> sp.Expr:
    """Axis pressure of a film of unlimited extent, i.e. in the limit x0 -> infinity: 3 mu a |u|/x^2."""
    unbounded = sp.limit(axis_pressure(), x0, sp.oo)
    return sp.simplify((unbounded * x0**2 / (3 * mu * a)).subs({x: gap * x0, u: -approach}, simultaneous=True))


def _reach(pressure: sp.Expr) -> sp.Expr:
    """The largest gap at which an approach meets the criterion; the pressure decreases with the gap."""
    fast = sp.Symbol("approach", positive=True)
    (farthest,) = (root for root in sp.solve(pressure.subs(approach, fast) - glass_number, gap) if root.is_positive)
    return sp.simplify(farthest).subs(fast, approach)


def _law(name: str, pressure: sp.Expr, meaning: str) -> Law:
    functions = (
        LawFunction("pressure", (gap, approach), pressure, "Film pressure on the axis over 3 mu a v0/x0^2."),
        LawFunction(
            "reach",
            (approach, glass_number),
            _reach(pressure),
            "Gap at which this approach speed meets the criterion.",
            for_proof=True,
        ),
    )
    return Law(
        "glass",
        name,
        meaning,
        f"{CRADLE.short}; derived from the film pressure",
        functions,
        references=(CRADLE,),
    )


GLASSES = (
    _law("literal", _literal(), "3 mu a |u|/x^2 as published: can fire at initial contact"),
    _law("film-corrected", _film_corrected(), "with the film's rim, 1/x^2 - 1/x0^2: zero at initial contact"),
)


ELASTIC = (RAGER, SERAYSSOL)  # publications of the elastic length


def elastic_compliance() -> sp.Expr:
    """theta_e = 2 (1 - nu^2)/(pi E) of two equal spheres (1/Pa): the sum of (1 - nu_i^2)/(pi E_i)."""
    one = (1 - nu**2) / (sp.pi * E)
    return one + one


def elastic_length() -> sp.Expr:
    """x_r = (3 pi theta_e mu a^(3/2) v0/sqrt 2)^(2/5): gap at which elastic deformation stops the approach.

    From Davis, Rager & Good 2002, after Davis, Serayssol & Hinch 1986.
    """
    return (3 * sp.pi * elastic_compliance() * mu * a ** sp.Rational(3, 2) * v0 / sp.sqrt(2)) ** sp.Rational(2, 5)
