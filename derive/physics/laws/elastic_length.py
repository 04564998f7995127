"""Gaps at which the solids make an approach rebound: elastic length and roughness (the glass criterion is a law)."""

from __future__ import annotations

import sympy as sp

from ...vocabulary.quantities import E, a, mu, nu, v0
from .references import RAGER, SERAYSSOL

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
