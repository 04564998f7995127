"""Normal lubrication in a thin film, by integrating the film pressure over the wetted disc."""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..quantities import a, gap, mu, u, x, x0
from .base import Law, LawFunction

_h = sp.Symbol("h", positive=True)


@cache
def pressure() -> sp.Expr:
    """Film pressure p at local thickness h, from Reynolds' equation of an axisymmetric squeeze.

    (1/s) d/ds (s h^3/(12 mu) dp/ds) = u with h = x + s^2/(2a), so s ds = a dh; regular on the axis; p = 0 at the
    film's rim h = x0.
    """
    s, thickness = sp.Symbol("s", nonnegative=True), x + sp.Symbol("s", nonnegative=True) ** 2 / (2 * a)
    flux = sp.integrate(12 * mu * u * s, s)  # s h^3 dp/ds, zero on the axis
    slope_over_h = sp.simplify(flux / (s * _h**3) / thickness.diff(s))  # dp/dh = (dp/ds)/(dh/ds)
    rise = sp.integrate(slope_over_h, _h)
    return sp.simplify(rise - rise.subs(_h, x0))


@cache
def normal_force() -> sp.Expr:
    """F_n, positive against opening: minus the pressure integrated over the disc h < x0 (2 pi s ds = 2 pi a dh)."""
    return sp.factor(sp.integrate(-sp.expand(pressure()) * 2 * sp.pi * a, (_h, x, x0)))


@cache
def axis_pressure() -> sp.Expr:
    """Pressure on the axis, h = x: the largest in the film."""
    return sp.factor(pressure().subs(_h, x))


def _resistance() -> sp.Expr:
    viscous_scale = 6 * sp.pi * mu * a**2 * u / x0
    return sp.factor(sp.simplify(normal_force() / viscous_scale).subs(x, gap * x0))


def _stopping() -> sp.Expr:
    """Opening velocity that the film takes from here to its surface, over v0/St: the resistance's integral."""
    return sp.expand(sp.integrate(sp.expand(_resistance()), (gap, gap, 1)))


FILMS = (
    Law(
        slot="film",
        name="finite",
        meaning="Reynolds film of finite thickness, the same on approach and rebound (no cavitation)",
        source="Kantak & Davis, Powder Technol. 168, 42 (2006); derived: pressure integrated over the disc h < x0",
        functions=(
            LawFunction(
                name="resistance",
                arguments=(gap,),
                result=_resistance(),
                doc="Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1).",
            ),
            LawFunction(
                name="stopping",
                arguments=(gap,),
                result=_stopping(),
                doc="Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0.",
                for_proof=True,
            ),
        ),
    ),
)
