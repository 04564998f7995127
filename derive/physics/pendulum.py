"""Pendulum strings: forces from the potential of two equal spheres hung from pivots one diameter apart."""

from functools import cache

import sympy as sp

from ..vocabulary.quantities import a, beta, g, l_s, m, string_ratio
from .mechanics import without_sines

r = sp.Symbol("r", positive=True)  # distance between the centres
offset_squared = sp.Symbol("offset_squared", nonnegative=True)  # (d/a)^2, d: horizontal displacement of either sphere


def half_angles(expression: sp.Expr) -> sp.Expr:
    """The expression in terms of sin(beta/2) and cos(beta/2)."""
    half_beta = beta / 2
    by_half = {sp.sin(beta): 2 * sp.sin(half_beta) * sp.cos(half_beta), sp.cos(beta): 1 - 2 * sp.sin(half_beta) ** 2}
    return expression.subs(by_half)


@cache
def swing_squared() -> sp.Expr:
    """d^2, with d the horizontal displacement of either sphere from rest: half the change of the separation vector.

    It is 4a along the first axis at rest and (r, beta) in polar coordinates now. Written in r - 4a and
    sin(beta/2), because r^2 + 16 a^2 - 8 a r cos(beta) loses digits by cancellation at small displacements.
    """
    now = sp.Matrix([r * sp.cos(beta), r * sp.sin(beta)])
    rest = sp.Matrix([4 * a, 0])
    displacement = (now - rest) / 2
    cancellation_free = (r - 4 * a) ** 2 / 4 + 4 * a * r * sp.sin(beta / 2) ** 2
    half_angle = sp.cos(beta), 1 - 2 * sp.sin(beta / 2) ** 2
    if sp.expand(without_sines(displacement.dot(displacement), beta).subs(*half_angle) - cancellation_free) != 0:
        raise ArithmeticError("the swing is not what its cancellation-free form says")
    return cancellation_free


@cache
def height(small_angle: bool) -> sp.Expr:
    """Height, in units of a, gained by a pendulum of length l/a = string_ratio displaced horizontally by d."""
    exact = string_ratio - sp.sqrt(string_ratio**2 - offset_squared)
    return exact.series(offset_squared, 0, 2).removeO() if small_angle else exact


@cache
def rise(small_angle: bool) -> sp.Expr:
    """`height` rationalised, without cancellation at small displacements."""
    if small_angle:
        return height(True)
    conjugate = string_ratio + sp.sqrt(string_ratio**2 - offset_squared)
    return sp.expand(height(False) * conjugate) / conjugate


@cache
def potential(small_angle: bool) -> sp.Expr:
    """U_s(r, beta) in SI: two spheres, each of mass 2m, lifted by `rise`."""
    swung = {offset_squared: swing_squared() / a**2, string_ratio: l_s / a}
    return 4 * m * g * a * height(small_angle).subs(swung, simultaneous=True)
