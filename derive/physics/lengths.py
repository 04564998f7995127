"""Published lengths of an impact that fill no slot: the rupture distance of any bridge, and the elastic length."""

import sympy as sp

from ..vocabulary.quantities import E, R, a, contact_angle, mu, nu, v0, volume, x0
from .references import LIAN, RAGER, SERAYSSOL

COMMON = (LIAN,)  # publication of the rupture distance, unless a law has its own
ELASTIC = (RAGER, SERAYSSOL)  # publications of the elastic length


def rupture_over_radius() -> sp.Expr:
    """V^(1/3) (1 + phi/2), from Lian, Thornton & Adams 1993."""
    return volume ** sp.Rational(1, 3) * (1 + contact_angle / 2)


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge, x0 without one."""
    return R * rupture_over_radius() if bridge else x0


def elastic_compliance() -> sp.Expr:
    """theta_e = 2 (1 - nu^2)/(pi E) of two equal spheres (1/Pa): the sum of (1 - nu_i^2)/(pi E_i)."""
    one = (1 - nu**2) / (sp.pi * E)
    return one + one


def elastic_length() -> sp.Expr:
    """x_r = (3 pi theta_e mu a^(3/2) v0/sqrt 2)^(2/5): gap at which elastic deformation stops the approach.

    From Davis, Rager & Good 2002, after Davis, Serayssol & Hinch 1986.
    """
    return (3 * sp.pi * elastic_compliance() * mu * a ** sp.Rational(3, 2) * v0 / sp.sqrt(2)) ** sp.Rational(2, 5)
