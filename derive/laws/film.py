"""Normal lubrication force of a thin film: the film pressure integrated over the wetted disc."""

from functools import cache

import sympy as sp

from ..physics.references import RAGER
from ..physics.slots import FILM_FORCE, INSIDE
from ..user import Formula, R, Reference, V, a, aspect, gap, law, let, mu, u, x, x0

KANTAK = Reference(
    "kantak2006elastohydrodynamic", ("Kantak, A. A.", "Davis, R. H."),
    "Elastohydrodynamic theory for wet oblique collisions",
    "Powder Technology", "Powder Technol.", "168", "42–52", 2006,
)  # fmt: skip
BARNOCKY = Reference(
    "barnocky1988collision", ("Barnocky, G.", "Davis, R. H."),
    "Elastohydrodynamic collision and rebound of spheres: Experimental verification",
    "Physics of Fluids", "Phys. Fluids", "31", "1324–1329", 1988,
)  # fmt: skip
PITOIS = Reference(
    "pitois2000bridge", ("Pitois, O.", "Moucheront, P.", "Chateau, X."),
    "Liquid bridge between two moving spheres: an experimental study of viscosity effects",
    "Journal of Colloid and Interface Science", "J. Colloid Interface Sci.", "231", "26–31", 2000,
    "10.1006/jcis.2000.7096",
)  # fmt: skip

_h = sp.Symbol("h", positive=True)
_rim = sp.Symbol("rim", positive=True)


@cache
def pressure() -> sp.Expr:
    """Film pressure p at local thickness h, from Reynolds' equation for axisymmetric squeeze flow.

    (1/s) d/ds (s h^3/(12 mu) dp/ds) = u with h = x + s^2/(2a), so s ds = a dh; regular on the axis; p = 0 at the
    rim of the film, h = x0.
    """
    s, thickness = sp.Symbol("s", nonnegative=True), x + sp.Symbol("s", nonnegative=True) ** 2 / (2 * a)
    flux = sp.integrate(12 * mu * u * s, s)  # s h^3 dp/ds, zero on the axis
    slope_over_h = sp.simplify(flux / (s * _h**3) / thickness.diff(s))  # dp/dh = (dp/ds)/(dh/ds)
    rise = sp.integrate(slope_over_h, _h)
    return sp.simplify(rise - rise.subs(_h, x0))


def _over_disc(integrand: sp.Expr, rim: sp.Expr) -> sp.Expr:
    """Integral of a function of h over the wetted disc x < h < rim (2 pi s ds = 2 pi a dh)."""
    return sp.integrate(sp.expand(integrand) * 2 * sp.pi * a, (_h, x, rim))


@cache
def normal_force() -> sp.Expr:
    """F_n, positive against separation: minus the pressure integrated over the disc h < x0."""
    return sp.factor(_over_disc(-pressure(), x0))


@cache
def unbounded_force() -> sp.Expr:
    """F_n of a film of unlimited extent: the limit x0 -> infinity, 6 pi mu a^2 u/x."""
    return sp.factor(sp.limit(sp.expand(normal_force()), x0, sp.oo))


@cache
def sustained_force() -> sp.Expr:
    """F_n while opening, of a liquid that sustains no tension: the pressure is cut off at ambient, max(p, 0).

    For u > 0 the pressure is proportional to -(1/h^2 - 1/x0^2) < 0 on the whole disc, so the force vanishes.
    """
    speed, inside = sp.Symbol("speed", positive=True), sp.Symbol("inside", positive=True)
    at = sp.factor(pressure().subs(u, speed).subs(x0, _h + inside))  # anywhere in the disc, h < x0
    return _over_disc(-sp.Max(at, 0), x0)


@cache
def rim_of_constant_volume() -> sp.Expr:
    """H = sqrt(x^2 + V_b/(pi a)): film thickness at the rim of the disc that holds the bridge volume V_b = V R^3."""
    filled = sp.factor(_over_disc(_h, _rim))  # pi a (H^2 - x^2)
    return next(root for root in sp.solve(sp.Eq(filled, V * R**3), _rim) if root.is_positive)


@cache
def constant_volume_force() -> sp.Expr:
    """F_n with p = 0 at the rim h = H instead of h = x0."""
    return normal_force().subs(x0, _rim)


@cache
def axis_pressure() -> sp.Expr:
    """Pressure on the axis, h = x, where it is largest."""
    return sp.factor(pressure().subs(_h, x))


def _scaled_rim() -> sp.Expr:
    squared = rim_of_constant_volume() ** 2 / x0**2
    return sp.sqrt(sp.expand(squared.subs(x, gap * x0).subs(a, x0 / aspect)))


def _resistance(force: sp.Expr) -> sp.Expr:
    """A force over 6 pi mu a^2 u/x0, with all lengths (also the rim) in x0."""
    viscous_scale = 6 * sp.pi * mu * a**2 * u / x0
    return sp.factor((force / viscous_scale).xreplace({x: gap * x0, _rim: _rim * x0}))


def _taken(force: sp.Expr) -> sp.Expr:
    """Integral of a film's resistance from the gap to the rim: the velocity, times St, that it takes on the way."""
    return sp.expand(sp.integrate(sp.expand(_resistance(force)), (gap, gap, 1)))


def _taken_at_constant_volume() -> sp.Expr:
    """The same of the film of constant volume; d rim/d gap = gap/rim, since rim^2 - gap^2 is constant."""
    taken = sp.log(gap) - 2 * sp.log(gap + _rim) + sp.log(_rim)
    return taken.subs({gap: 1, _rim: _scaled_rim().subs(gap, 1)}, simultaneous=True) - taken


law(
    "film", "finite", source=KANTAK, remark="; derived: pressure integrated over the disc h < x0", falls=True,
    meaning="Reynolds film of finite thickness, the same on approach and rebound (no cavitation)",
    resistance=_resistance(normal_force()), stopping=_taken(normal_force()), braking=_taken(normal_force()),
)  # fmt: skip
law(
    "film", "infinite", source=RAGER, remark="; derived: the limit x0 -> infinity of `finite`", falls=True,
    meaning="no film correction: the pressure of an unbounded film, which ends where the surfaces leave it, x = x0",
    resistance=_resistance(unbounded_force()), stopping=_taken(unbounded_force()), braking=_taken(unbounded_force()),
)  # fmt: skip
law(
    "film", "cavitating", source=BARNOCKY, remark="; derived: the pressure cut off at ambient", falls=True,
    meaning="`finite` on approach; on rebound the liquid sustains no suction and cavitates, which leaves no force",
    resistance=Formula(_resistance(normal_force()), f"{FILM_FORCE} while closing, {INSIDE}."),
    suction=_resistance(sustained_force()), braking=_taken(normal_force()),
)  # fmt: skip

let("rim", _scaled_rim())
law(
    "film", "constant-volume", source=PITOIS, remark="; derived: a disc of that volume", spread=True, falls=True,
    meaning="the rim follows the bridge's liquid, H = sqrt(x^2 + V_b/(pi a)) in place of x0, at any gap",
    resistance=Formula(_resistance(constant_volume_force()), f"{FILM_FORCE}."), braking=_taken_at_constant_volume(),
)  # fmt: skip
