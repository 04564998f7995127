"""Van der Waals attraction, integrated over the bodies (Hamaker) and over the gap (Derjaguin)."""

from functools import cache

import sympy as sp

from ..vocabulary.quantities import A_H, a, x

_h = sp.Symbol("h", positive=True)


def _beyond(density: sp.Expr, variable: sp.Symbol, first: sp.Expr) -> sp.Expr:
    """Integral from `first` to infinity, by an antiderivative: Meijer's functions take ten times longer."""
    return sp.integrate(density, (variable, first, sp.oo), meijerg=False)


@cache
def flat_pressure() -> sp.Expr:
    """Attraction of two half-spaces per unit area, A/(6 pi h^3): the pair potential -C/d^6 summed over all pairs.

    A = pi^2 C rho^2, rho the number density of either body.
    """
    strength, density, depth, squared = sp.symbols("C rho z d_squared", positive=True)
    # over a plane of the other body: d^2 = s^2 + z^2, so 2 s ds = d(d^2)
    on_one = _beyond(-strength * density * sp.pi / squared**3, squared, depth**2)
    by_depth = _beyond(on_one, depth, depth)  # a volume element at `depth` and a half-space
    per_area = _beyond(density * by_depth, depth, _h)
    return per_area.diff(_h).subs(strength, A_H / (sp.pi * density) ** 2)


@cache
def van_der_waals_force() -> sp.Expr:
    """F_w = A a/(6 x^2) of nearly touching spheres: the attraction of half-spaces integrated over h = x + s^2/(2a).

    With 2 pi s ds = 2 pi a dh. Without retardation or cut-off: valid for gaps well below the radius and above atomic
    distances.
    """
    return _beyond(flat_pressure() * 2 * sp.pi * a, _h, x)


@cache
def van_der_waals_potential() -> sp.Expr:
    """W_w(x) = -A a/(6 x): the potential of `van_der_waals_force`, zero at infinite separation."""
    return -_beyond(van_der_waals_force(), x, x)
