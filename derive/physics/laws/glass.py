"""Where an approach rebounds: the film pressure on the axis reaches the glass transition, or the solids deform."""

import sympy as sp

from ...vocabulary.quantities import E, a, gap, glass_number, mu, nu, u, v0, x, x0
from .base import Law, LawFunction
from .film import axis_pressure
from .references import CRADLE, RAGER, SERAYSSOL

approach = sp.Symbol("approach", real=True)  # -u/v0, positive while closing


def _law(name: str, axis: sp.Expr, meaning: str) -> Law:
    """A criterion for a pressure on the axis, and the largest gap at which an approach meets it.

    The pressure decreases with the gap.
    """
    scaled = sp.simplify(axis * x0**2 / (3 * mu * a)).subs({x: gap * x0, u: -approach}, simultaneous=True)
    pressure, fast = sp.factor(sp.simplify(scaled)), sp.Symbol("approach", positive=True)
    (farthest,) = (root for root in sp.solve(pressure.subs(approach, fast) - glass_number, gap) if root.is_positive)
    reach, doc = sp.simplify(farthest).subs(fast, approach), "Gap at which this approach speed meets the criterion."
    functions = (
        LawFunction("pressure", (gap, approach), pressure, "Film pressure on the axis over 3 mu a v0/x0^2."),
        LawFunction("reach", (approach, glass_number), reach, doc, for_proof=True),
    )
    source = f"{CRADLE.short}; derived from the film pressure"
    return Law("glass", name, meaning, source, functions, references=(CRADLE,))


_UNBOUNDED = sp.limit(axis_pressure(), x0, sp.oo)  # 3 mu a |u|/x^2
GLASSES = (
    _law("literal", _UNBOUNDED, "3 mu a |u|/x^2 as published: can fire at initial contact"),
    _law("film-corrected", axis_pressure(), "with the film's rim, 1/x^2 - 1/x0^2: zero at initial contact"),
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
