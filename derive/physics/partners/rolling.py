"""Tangential lubrication of two unequal spheres, to leading logarithm, from Reynolds' equation.

In the frame that turns with the line of centres both spheres only spin, at xi_i - omega, and the gap keeps its shape
h = x + s^2/(2a). The sum of the surface velocities drags liquid along the narrowing gap and raises a pressure; their
difference shears the liquid. Each torque follows from the stress on its sphere; torques and lever arms give the force.
"""

from functools import cache

import sympy as sp

from ...vocabulary.quantities import a, mu, x

R_1, R_2 = sp.symbols("R_1 R_2", positive=True)
U_1, U_2 = sp.symbols("U_1 U_2", real=True)  # surface velocities at the gap, in the turning frame
X, Y = sp.symbols("X Y", real=True)
_h, _outer, _K = sp.symbols("h h_outer K")


@cache
def pressure_strength() -> sp.Expr:
    """K of the pressure p = K X/h^2 that solves Reynolds' equation div(h^3 grad p) = 6 mu (U_1 + U_2) dh/dX."""
    thickness = x + (X**2 + Y**2) / (2 * a)
    pressure = _K * X / thickness**2
    flux = [thickness**3 * pressure.diff(axis) for axis in (X, Y)]
    balance = sp.simplify(flux[0].diff(X) + flux[1].diff(Y) - 6 * mu * (U_1 + U_2) * thickness.diff(X))
    (strength,) = sp.solve(balance, _K)
    return strength


def _logarithm(integrand: sp.Expr) -> sp.Expr:
    """Coefficient of ln(h_outer/x) in the integral over the disc of an integrand in X and h (2 pi s ds = 2 pi a dh).

    X^2 averages to s^2/2 = a (h - x) over a ring.
    """
    averaged = sp.expand(integrand).subs(X**2, a * (_h - x))
    rings = sp.integrate(sp.expand(averaged * 2 * sp.pi * a), (_h, x, _outer))
    return -sp.expand(sp.expand_log(rings, force=True)).coeff(sp.log(x))


@cache
def stresses() -> tuple[sp.Expr, sp.Expr]:
    """Shear force on the surfaces of sphere 1 and 2 along X, over ln(h_outer/x).

    The velocity profile between the surfaces is linear plus the parabola due to the pressure gradient dp/dX.
    """
    gradient = _K / _h**2 - 2 * _K * X**2 / (a * _h**3)  # of K X/h^2, dh/dX = X/a
    couette = mu * (U_2 - U_1) / _h
    on_first = _logarithm(couette - _h * gradient / 2)
    on_second = _logarithm(-couette - _h * gradient / 2)
    return tuple(sp.factor(force.subs(_K, pressure_strength())) for force in (on_first, on_second))


@cache
def pressure_forces() -> tuple[sp.Expr, sp.Expr]:
    """Pressure force on sphere 1 and 2 along X, over ln(h_outer/x), from the slope -+X/R_i of the surfaces."""
    push = _logarithm(-_K * X**2 / _h**2).subs(_K, pressure_strength())
    return sp.factor(push / R_1), sp.factor(push / R_2)


@cache
def torque_matrix() -> sp.Matrix:
    """A_ij of the torques T_i = A_ij (omega - xi_j) ln(h_outer/x) on the two spheres, in R_1, R_2 and a.

    Sphere 1 touches at +R_1 along the line of centres, sphere 2 at -R_2.
    """
    slip = sp.symbols("slip_1 slip_2", real=True)  # omega - xi
    velocities = {U_1: -slip[0] * R_1, U_2: slip[1] * R_2}
    first, second = stresses()
    torques = [(R_1 * first).subs(velocities), (-R_2 * second).subs(velocities)]
    return sp.Matrix([[sp.factor(sp.expand(torque).coeff(rate)) for rate in slip] for torque in torques])


@cache
def force_on_second() -> sp.Matrix:
    """Row of coefficients of (omega - xi_j) in the tangential force that resists sliding, over ln(h_outer/x)."""
    slip = sp.symbols("slip_1 slip_2", real=True)
    velocities = {U_1: -slip[0] * R_1, U_2: slip[1] * R_2}
    total = -(stresses()[1] + pressure_forces()[1]).subs(velocities)
    return sp.Matrix([[sp.factor(sp.expand(total).coeff(rate)) for rate in slip]])
